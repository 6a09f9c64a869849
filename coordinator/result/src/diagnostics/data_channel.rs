//! Names and units of fitted data: channels of the wheel, plates, rings.

use job::{PLATE, RING, Spec};
use shared::channel::Channel;
use statistics::Datum;

use crate::words::number;

/// A channel of the likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DataChannel {
    Wheel(Channel),
    Plates,
    Rings,
}

impl DataChannel {
    /// The channel of an index of the likelihood.
    pub(crate) fn of(index: usize) -> Self {
        match index {
            PLATE => DataChannel::Plates,
            RING => DataChannel::Rings,
            wheel => DataChannel::Wheel(Channel::ALL[wheel]),
        }
    }

    /// Those with fitted data, in the order of all tables.
    pub(crate) fn fitted(spec: &Spec) -> Vec<(usize, Self)> {
        let has = |index: &usize| spec.likelihood.data().iter().any(|d| d.channel == *index);
        (0..=RING)
            .filter(has)
            .map(|index| (index, Self::of(index)))
            .collect()
    }

    /// Name in tables: `drawbar_pull`, `plates`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            DataChannel::Wheel(channel) => channel.name(),
            DataChannel::Plates => "plates",
            DataChannel::Rings => "rings",
        }
    }

    /// Words in sentences.
    pub(crate) fn words(self) -> &'static str {
        match self {
            DataChannel::Wheel(channel) => channel.words(),
            other => other.name(),
        }
    }

    /// SI unit; readings of plates and rings count by their natural logarithm.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            DataChannel::Wheel(channel) => channel.unit(),
            DataChannel::Plates | DataChannel::Rings => "1",
        }
    }

    /// Factor and unit in which people read it: millimetres of sinkage, percent of a stress.
    fn shown(self) -> (f64, &'static str) {
        match self {
            DataChannel::Wheel(Channel::Sinkage) => (1000.0, "mm"),
            DataChannel::Wheel(channel) => (1.0, channel.unit()),
            DataChannel::Plates | DataChannel::Rings => (100.0, "%"),
        }
    }
}

/// Factor and unit in which a channel of this name is shown.
pub(crate) fn shown(name: &str) -> (f64, &'static str) {
    let named = (0..=RING)
        .map(DataChannel::of)
        .find(|channel| channel.name() == name);
    named.map_or((1.0, ""), DataChannel::shown)
}

/// A size in a channel of this name, to two digits: `20 N m`, `0.58 mm`, `12 %`.
pub(crate) fn size(name: &str, value: f64) -> String {
    let (scale, unit) = shown(name);
    format!("{} {unit}", number::significant(scale * value, 2))
}

/// The run of a datum, or the test of a reading.
pub(crate) fn run_name<'a>(spec: &'a Spec, datum: &Datum) -> &'a str {
    match DataChannel::of(datum.channel) {
        DataChannel::Wheel(_) => &spec.experiment.runs[spec.fit_runs[datum.run]].name,
        DataChannel::Plates => &spec.bevameter.plates[datum.run].test,
        DataChannel::Rings => &spec.bevameter.rings[datum.run].test,
    }
}

//! Channels in the words and units of a test engineer.

use shared::channel::Channel;

use crate::table::row::ComparisonRow;
use crate::words::number;

/// A channel as it is shown: sinkage in millimetres, everything else in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quantity {
    /// The channel.
    pub(super) channel: Channel,
    /// Shown value over SI value.
    pub(super) scale: f64,
    /// Unit of the shown value.
    pub(super) unit: &'static str,
}

impl Quantity {
    /// How a channel is shown.
    pub(super) fn of(channel: Channel) -> Self {
        let (scale, unit) = match channel {
            Channel::Sinkage => (1000.0, "mm"),
            other => (1.0, other.unit()),
        };
        Quantity { channel, scale, unit }
    }

    /// The channels that any row has, in the order of all tables.
    pub(super) fn measured(rows: &[ComparisonRow]) -> Vec<Self> {
        let has = |c: &Channel| rows.iter().any(|r| r.channel == c.name());
        Channel::ALL.into_iter().filter(has).map(Quantity::of).collect()
    }

    /// Whether a row is about this channel.
    pub(super) fn is_of(self, row: &ComparisonRow) -> bool {
        row.channel == self.channel.name()
    }

    /// `sinkage [mm]`.
    pub(super) fn label(self) -> String {
        format!("{} [{}]", self.channel.words(), self.unit)
    }

    /// An error in this channel, to two digits and with its unit: `9.0 mm`.
    pub(super) fn words(self, value: f64) -> String {
        format!(
            "{}\u{a0}{}",
            number::significant(value * self.scale, 2),
            self.unit
        )
    }
}

//! Lookups from data of the likelihood to their channels and runs, for the diagnostics.

use job::{Spec, TRANSIENT};
use statistics::Datum;

use crate::words::data_channel::{BevameterTest, DataChannel};

/// Returns the channels with fitted data and their indices in the likelihood, in the order of all tables.
pub fn fitted_channels(spec: &Spec) -> Vec<(usize, DataChannel)> {
    let has = |index: &usize| spec.likelihood.data().iter().any(|d| d.channel == *index);
    (0..=TRANSIENT)
        .filter(has)
        .map(|index| (index, DataChannel::from_index(index)))
        .collect()
}

/// Returns the name of the run or bevameter test that a datum belongs to.
pub fn run_name<'a>(spec: &'a Spec, datum: &Datum) -> &'a str {
    match DataChannel::from_index(datum.channel) {
        DataChannel::Wheel(_) | DataChannel::Transient(_) => {
            &spec.experiment.runs[spec.fit_runs[datum.run]].name
        }
        DataChannel::Bevameter(BevameterTest::Plates) => &spec.bevameter.plates[datum.run].test,
        DataChannel::Bevameter(BevameterTest::Rings) => &spec.bevameter.rings[datum.run].test,
    }
}

//! Which of the observables a likelihood takes, and in which order.

use shared::channel::Channel;
use shared::predicted::PredictedValue;
use statistics::{Datum, Likelihood};

use super::bevameter_readings::{PLATE, RING};

/// The predicted values of a likelihood: one for each datum, then one for each sensitive datum.
pub(crate) fn predicted_values(likelihood: &Likelihood) -> Vec<PredictedValue> {
    let data = likelihood.data();
    let value = |d: &Datum| match d.channel {
        PLATE => PredictedValue::LnPlatePressure { reading: d.run },
        RING => PredictedValue::LnShearStress { reading: d.run },
        channel => PredictedValue::Average {
            channel: Channel::ALL[channel],
            run: d.run,
        },
    };
    let sensitive = likelihood
        .sensitive()
        .iter()
        .map(|&i| PredictedValue::Sensitivity {
            channel: Channel::ALL[data[i].channel],
            run: data[i].run,
        });
    data.iter().map(value).chain(sensitive).collect()
}

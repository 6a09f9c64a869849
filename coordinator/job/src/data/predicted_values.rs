//! The order of the observables that a likelihood takes.

use shared::channel::Channel;
use shared::predicted::PredictedValue;
use statistics::{Datum, Likelihood};

use super::bevameter_readings::{PLATE, RING};
use super::shared_error::BY_STRENGTH;
use super::transient_readings::TRANSIENT;

/// Returns the predicted values of a likelihood: one for each datum, then the derivatives.
///
/// # Arguments
/// - `radii_m`: radius of the wheel of each fitted run `[m]`.
pub(crate) fn predicted_values(likelihood: &Likelihood, radii_m: &[f64]) -> Vec<PredictedValue> {
    let data = likelihood.data();
    let mut points = 0..;
    let value = |d: &Datum| match d.channel {
        PLATE => PredictedValue::LnPlatePressure { reading: d.run },
        RING => PredictedValue::LnShearStress { reading: d.run },
        TRANSIENT => PredictedValue::TransientSinkage {
            point: points.next().expect("the range has no end"),
        },
        channel => PredictedValue::Average {
            channel: Channel::ALL[channel],
            run: d.run,
        },
    };
    let sensitive = likelihood.sensitive().iter().map(|sensitive| {
        let Datum { channel, run, .. } = data[sensitive.datum];
        let channel = Channel::ALL[channel];
        match sensitive.derivative {
            BY_STRENGTH => PredictedValue::Strength {
                channel,
                run,
                radius_m: radii_m[run],
            },
            _ => PredictedValue::Sensitivity { channel, run },
        }
    });
    data.iter().map(value).chain(sensitive).collect()
}

//! Whether a wheel moved steadily at the end of its recording.

use super::wheel::WheelGeometry;

/// The share of the sinkage that may change over one length of the contact in a steady run. CMU's 144 runs at slip angles of 0 to 60 degrees
/// have up to 0.027, and their 36 runs at 90 degrees, which sink until the end, 0.054 to 0.101.
pub(super) const STEADY: f64 = 0.04;

/// Length of the two stretches of travel whose mean sinkages are compared, over the length of the contact.
const STRETCH: f64 = 1.5;

/// Returns the share of its sinkage by which a wheel still sinks over one length of its contact, `√(2 R z)`; `None` where it is above the
/// surface, or has not rolled far enough.
///
/// The mean sinkages over the last stretch of travel and over the equal stretch before it are compared. A stretch is 1.5 lengths of the
/// contact, rounded up to whole distances between grousers, whose ripple then cancels.
/// Checked by `history::tests::a_wheel_that_still_sinks_is_not_steady`.
///
/// # Arguments
/// - `travel_m`, `sinkage_m`: the recording, in the order of travel. `average_m`: mean sinkage by the protocol.
/// - `pitch_m`: travel from one grouser to the next; `None` without grousers.
pub(super) fn relative_sinkage_rate(
    travel_m: &[f64],
    sinkage_m: &[f64],
    average_m: f64,
    wheel: &WheelGeometry,
    pitch_m: Option<f64>,
) -> Option<f64> {
    if average_m <= 0.0 {
        return None;
    }
    let contact_m = (2.0 * wheel.radius_m * average_m).sqrt();
    let stretch_m = STRETCH * contact_m;
    let stretch_m = pitch_m.map_or(stretch_m, |pitch_m| (stretch_m / pitch_m).ceil() * pitch_m);
    let (first, last) = (travel_m.first()?, travel_m.last()?);
    if last - first < 2.0 * stretch_m {
        return None;
    }
    // travel never decreases, so each stretch is a slice
    let place = |travel: f64| travel_m.partition_point(|x| *x < travel);
    let (begin, middle) = (place(last - 2.0 * stretch_m), place(last - stretch_m));
    let mean =
        |values: &[f64]| (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64);
    let slope = (mean(&sinkage_m[middle..])? - mean(&sinkage_m[begin..middle])?) / stretch_m;
    Some(slope * contact_m / average_m)
}

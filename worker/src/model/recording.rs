//! The recording of a run: its time histories at the rate of a rig's data logger.

use scm::Rejection;
use scm::spatial::History;
use shared::outcome::SimulatedHistory;
use signal::{INTERVAL_S, SignalError, intervals, resample};

/// Computes means over intervals of 0.1 s of drawbar pull, torque, sinkage, lateral force and wheel load, from the start of
/// the travel. Errors are those of [`resample()`].
pub fn at_10_hz(history: &History) -> Result<[Vec<f64>; 5], SignalError> {
    // the first entry is the wheel at rest
    let edges: Vec<f64> = (0..history.len()).map(|i| i as f64 * history.step_s).collect();
    let samples = intervals(&edges, INTERVAL_S);
    let mut columns: [Vec<f64>; 5] = std::array::from_fn(|_| vec![0.0; samples]);
    for (channel, column) in history.channels().into_iter().zip(&mut columns) {
        resample(&edges, &channel[1..], INTERVAL_S, column)?;
    }
    Ok(columns)
}

/// Converts the channels of a run for the wire, which cannot represent NaN or infinity.
pub(super) fn recorded(history: &History) -> Result<SimulatedHistory, Rejection> {
    let columns = at_10_hz(history)?;
    if let Some(&value) = columns[..4].iter().flatten().find(|x| !x.is_finite()) {
        let quantity = "history";
        return Err(Rejection::NotFinite { quantity, value });
    }
    let [drawbar_pull_n, torque_n_m, sinkage_m, lateral_force_n, _] = columns;
    Ok(SimulatedHistory {
        drawbar_pull_n,
        torque_n_m,
        sinkage_m,
        lateral_force_n,
    })
}

//! Sessions on the rig, each with an error that its runs share.

use statistics::rng::Stream;

use super::case::{SyntheticCase, run, spec};
use super::design::{CHANNELS, PlannedRun};
use crate::error::StudyError;

/// Number of sessions, among which the runs are shared out equally.
const SESSIONS: usize = 4;
/// The random stream of the order of the runs and of the errors.
const STAGE: u64 = (1 << 44) + 2;
/// Sd of the offset of a channel, in noise sds.
const OFFSET_SDS: f64 = 2.0;
/// Relative sd of the stiffness of the soil.
const STIFFNESS: f64 = 0.10;
/// The largest number of draws of the errors that the model may reject.
const MAX_REJECTED: u64 = 100;

/// The quantity that is wrong by another amount in each session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionError {
    /// A channel, by its index, has an offset.
    Offset(usize),
    /// The soil is stiffer or softer.
    Stiffness,
}

impl SessionError {
    /// The offset of each channel, and then the stiffness.
    pub const ALL: [Self; CHANNELS + 1] =
        [Self::Offset(0), Self::Offset(1), Self::Offset(2), Self::Stiffness];

    /// Measures a truth again in sessions, with the same noise.
    pub fn applied(self, case: SyntheticCase, seed: u64, number: u64) -> Result<SyntheticCase, StudyError> {
        for attempt in 0..MAX_REJECTED {
            let mut stream = Stream::new(seed, STAGE, number, attempt);
            let sessions = shuffled(case.rows.len(), &mut stream);
            let errors = stream.normals(SESSIONS);
            if let Some(shifts) = self.shifts(&case, &sessions, &errors)? {
                return Ok(in_sessions(case, &sessions, &shifts));
            }
        }
        Err(format!("the model rejected {MAX_REJECTED} soils of sessions in a row").into())
    }

    /// Returns the change of every value; `None` if the model rejects the soil of a session.
    fn shifts(
        self,
        case: &SyntheticCase,
        sessions: &[usize],
        errors: &[f64],
    ) -> Result<Option<Vec<[f64; CHANNELS]>>, StudyError> {
        let mut shifts = vec![[0.0; CHANNELS]; case.rows.len()];
        match self {
            Self::Offset(channel) => {
                for (shift, session) in shifts.iter_mut().zip(sessions) {
                    shift[channel] = OFFSET_SDS * errors[*session] * case.sds[channel];
                }
            }
            Self::Stiffness => {
                let parameters = spec(&case.truth_job, &case.experiment())?.parameters;
                let place = parameters.iter().position(|p| p.name == "log10_p_ref");
                let place = place.ok_or("the job has no log10_p_ref")?;
                for (error, session) in errors.iter().zip(0..) {
                    let is_in = |(run, _): &(usize, &PlannedRun)| sessions[*run] == session;
                    let (runs, rows): (Vec<usize>, Vec<PlannedRun>) = case
                        .rows
                        .iter()
                        .enumerate()
                        .filter(is_in)
                        .map(|(run, row)| (run, row.clone()))
                        .unzip();
                    let mut theta = case.theta.clone();
                    theta[place] += (1.0 + STIFFNESS * error).log10();
                    let Some(values) = run(&case.truth_job, &rows, &theta)? else {
                        return Ok(None);
                    };
                    for (run, values) in runs.into_iter().zip(values) {
                        shifts[run] = std::array::from_fn(|k| values[k] - case.noise_free[run][k]);
                    }
                }
            }
        }
        Ok(Some(shifts))
    }
}

/// Returns the session of each run, from 0, in random order.
fn shuffled(runs: usize, stream: &mut Stream) -> Vec<usize> {
    let mut sessions: Vec<usize> = (0..runs).map(|run| run % SESSIONS).collect();
    for place in (1..runs).rev() {
        sessions.swap(place, stream.below(place + 1));
    }
    sessions
}

fn in_sessions(mut case: SyntheticCase, sessions: &[usize], shifts: &[[f64; CHANNELS]]) -> SyntheticCase {
    for (measured, shift) in case.measured.iter_mut().zip(shifts) {
        for (value, shift) in measured.iter_mut().zip(shift) {
            *value += shift;
        }
    }
    for (row, session) in case.rows.iter_mut().zip(sessions) {
        row.session = Some(1 + session);
    }
    case
}

//! A calibration in progress: the one place where sampler or fit, likelihood and leases meet.
//!
//! Pure: it is told outcomes and answers with facts to store. The same [`Calibration::complete`] serves a
//! living worker and a replay from the store, so a restart cannot take another path.

mod completion;
mod confirmation;
mod engine;
mod faults;
mod final_draws;
mod process;
mod question;
mod replay;
mod second_answer;
mod simulation_result;
mod verification;

pub use completion::ResultError;
pub use engine::{BeginError, CalibrationEngine, CalibrationResult};
pub use process::{Calibration, CalibrationIdentity};
pub use question::Question;
pub use replay::ReplayError;
pub use second_answer::{Answer, SecondAnswers, Verdict};
pub use simulation_result::{SimulationResult, result_of};
pub use verification::Verification;

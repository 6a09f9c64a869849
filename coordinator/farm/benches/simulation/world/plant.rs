//! Bugs that are planted between the network, the farm and the ledger, where they look like bugs inside the farm.

use record::{EvaluationRow, Fact, Stored};
use shared::api::CalibrationState;

use super::ledger::Ledger;

/// The planted bug loses one row of this many.
const LOST: usize = 20;

/// Defines the planted bugs and the list of all.
macro_rules! plants {
    ($($(#[$doc:meta])* $plant:ident,)+) => {
        /// A planted bug.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(crate) enum Plant {
            $($(#[$doc])* $plant,)+
        }

        impl Plant {
            pub(crate) const ALL: &[Plant] = &[$(Plant::$plant),+];
        }
    };
}

plants! {
    /// Answers leave before their facts are on disk.
    AnswerBeforeDisk,
    /// One row in twenty is never written, though its result is acknowledged.
    RowLost,
    /// A row is written under the number of its neighbour.
    RowUnderOtherNumber,
    /// A row's log-likelihood is rounded to single precision.
    ScoreRounded,
    /// The last two facts of an exchange are written in the wrong order.
    FactsSwapped,
    /// A failed attempt is written twice.
    AttemptTwice,
    /// A failed attempt is not written.
    AttemptLost,
    /// A second answer is not compared with the first.
    DuplicateUnseen,
    /// A second answer counts like a first.
    DuplicateCounted,
    /// A crash leaves a later fact without an earlier one.
    HoleInFacts,
    /// A replay leaves out the last row.
    ReplaySkipsRow,
    /// A replay forgets failed attempts.
    ReplayForgetsAttempts,
    /// A replay forgets that the calibration is paused.
    ReplayForgetsPause,
    /// A replay forgets the pinned version of the equations.
    ReplayForgetsVersion,
    /// A restart repeats lease numbers.
    FenceRepeats,
    /// Leases never expire: they are renewed when their time has come.
    RenewedAfterExpiry,
    /// Leases expire when half of their time is left.
    ExpiresEarly,
    /// Every lease of a worker counts as lost when the worker sends a message.
    TakenForLost,
    /// A lease counts as started when it is renewed.
    RenewedIsStarted,
    /// Reports of a start are not read.
    StartUnread,
    /// The seal of a result is not checked.
    SealUnchecked,
    /// A result is taken from any worker that knows its seal.
    WorkerUnchecked,
    /// Leases are returned by any worker.
    ReturnedByOthers,
    /// The version of a worker is not checked.
    VersionUnchecked,
    /// After a restored backup, a new calibration has the key of the lost one with the same number.
    KeyAgain,
    /// A pause is acknowledged and forgotten.
    PauseLost,
    /// A command is acknowledged before it is on disk.
    CommandBeforeDisk,
    /// A restart forgets which workers compute wrongly.
    QuarantineForgotten,
}

impl Plant {
    /// Returns the facts that are written under this bug.
    pub(crate) fn facts(self, mut facts: Vec<Fact>, ledger: &Ledger) -> Vec<Fact> {
        let is_row = |fact: &Fact| matches!(fact, Fact::Evaluated { .. });
        match self {
            Plant::RowLost if ledger.len().is_multiple_of(LOST) => facts.retain(|fact| !is_row(fact)),
            Plant::FactsSwapped => {
                if let [.., before_last, last] = facts.as_mut_slice() {
                    std::mem::swap(before_last, last);
                }
            }
            Plant::AttemptTwice => {
                let twice = |fact: Fact| {
                    let again = matches!(&fact, Fact::Fault { attempt, .. } if *attempt > 0);
                    std::iter::repeat_n(fact, 1 + usize::from(again))
                };
                facts = facts.into_iter().flat_map(twice).collect();
            }
            Plant::AttemptLost => facts.retain(|fact| !matches!(fact, Fact::Fault { .. })),
            Plant::DuplicateUnseen => facts.retain(|fact| !matches!(fact, Fact::Duplicate { .. })),
            Plant::RowUnderOtherNumber | Plant::ScoreRounded | Plant::DuplicateCounted => {
                facts = facts.into_iter().map(|fact| self.row(fact, ledger)).collect();
            }
            _ => {}
        }
        facts
    }

    fn row(self, fact: Fact, ledger: &Ledger) -> Fact {
        match (self, &fact) {
            (Plant::RowUnderOtherNumber, &Fact::Evaluated { calibration, ref row }) => Fact::Evaluated {
                calibration,
                row: EvaluationRow {
                    evaluation: row.evaluation ^ 1,
                    ..row.clone()
                },
            },
            (Plant::ScoreRounded, &Fact::Evaluated { calibration, ref row }) => Fact::Evaluated {
                calibration,
                row: EvaluationRow {
                    log_likelihood: row.log_likelihood.map(|l| f64::from(l as f32)),
                    ..row.clone()
                },
            },
            (
                Plant::DuplicateCounted,
                &Fact::Duplicate {
                    calibration,
                    evaluation,
                    ..
                },
            ) => match ledger.row(calibration, evaluation).cloned() {
                Some(row) => Fact::Evaluated { calibration, row },
                None => fact,
            },
            _ => fact,
        }
    }

    /// Returns the stored state that a replay gets under this bug.
    pub(crate) fn replayed(self, mut stored: Stored) -> Stored {
        match self {
            Plant::ReplaySkipsRow => drop(stored.evaluations.pop_last()),
            Plant::ReplayForgetsAttempts => stored.failed.clear(),
            Plant::ReplayForgetsPause => stored.state = Some(CalibrationState::Running),
            Plant::ReplayForgetsVersion => stored.model_version = None,
            _ => {}
        }
        stored
    }
}

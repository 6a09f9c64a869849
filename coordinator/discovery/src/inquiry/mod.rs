//! The whole search: one effect, several, laws outside the library, and what to measure next; asked and told from outside.
//!
//! 1. Which one effect: the [`Engine`] over the library.
//! 2. Which part of the model earns its place no longer: the model fitted without it.
//! 3. Which several: beyond each of the best three, a quick search for one more, where the best alone leaves misfit.
//! 4. What outside the library: quick searches over curves, each in one variable on one quantity, and over the simple forms of
//!    the best of them, where the library leaves misfit.
//! 5. Whether that holds: levels of the design are left out, and predicted.
//! 6. What to measure next: draws of the explanations that remain, on runs that the rig could make.
//!
//! # Layout
//! - `task`: what is to be searched. `asked`: what the model is asked.
//! - `search`: an engine that goes on from a set of effects. `left_out`: fits without some of the data.
//! - `next_run`: the information of runs not made yet.
//! - `steps`: from one step to the next. `found`: sets and curves as they are found. `answer`: what is said in the end.

mod answer;
mod asked;
mod found;
mod left_out;
mod next_run;
mod search;
mod steps;
mod task;

pub use answer::{Answer, Fitted, Judgement, Outside, Verdict};
pub use asked::{Asked, Model};
pub use next_run::NextRun;
pub use task::{Pair, Proposed, Reduction, Task};

pub use crate::chi_square::ChiSquare;

use crate::candidate::CandidateError;
use crate::engine::Engine;
use found::Found;
use inference::{InferenceFailure, Proposal, ProposalRound, TellError, TellProgress};
use search::Search;
use statistics::likelihood::LikelihoodError;
use steps::Step;

/// An ask/tell search for what a model is missing.
///
/// Its state is a function of the task and the told values, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct Inquiry {
    task: Task,
    step: Step,
    found: Found,
    round: ProposalRound<Option<Vec<f64>>>,
    asked: Vec<Asked>,
    evaluations: usize,
}

impl Inquiry {
    /// An inquiry whose first round holds the starts of the base's fit.
    ///
    /// # Errors
    /// [`CandidateError`] names the candidate.
    pub fn new(task: Task) -> Result<Self, CandidateError> {
        let all = task.candidates();
        all.iter().try_for_each(|candidate| candidate.check())?;
        let engine = Engine::new(
            &task.prior,
            task.likelihood.clone(),
            task.library.clone(),
            &task.settings,
        )?;
        let singles = Search::new(Vec::new(), (0..task.library.len()).collect(), engine);
        let mut inquiry = Self {
            found: Found::new(all),
            step: Step::Singles(singles),
            task,
            round: ProposalRound::default(),
            asked: Vec::new(),
            evaluations: 0,
        };
        inquiry.go_on();
        Ok(inquiry)
    }

    /// Number of completed rounds.
    #[must_use]
    pub fn round(&self) -> u64 {
        self.round.number()
    }

    /// This round's parameter vectors, numbered from 0.
    #[must_use]
    pub fn pending(&self) -> &[Proposal] {
        self.round.pending()
    }

    /// What a parameter vector of this round is asked of.
    #[must_use]
    pub fn asked(&self, index: usize) -> Option<&Asked> {
        self.asked.get(index)
    }

    /// How many values answer a question.
    #[must_use]
    pub fn expected(&self, asked: &Asked) -> usize {
        if asked.is_proposed {
            self.task.proposed.values()
        } else {
            self.task.likelihood.values()
        }
    }

    /// Takes the values that answer a question; the last one of a round advances the inquiry.
    ///
    /// # Arguments
    /// - `values`: as [`Likelihood::log_likelihood`](statistics::Likelihood::log_likelihood) takes them, of proposed runs each channel of
    ///   each run; `None` where the model refused.
    ///
    /// # Errors
    /// [`TellError`]: told before, never asked for, not as many finite values as are expected. Nothing is changed then.
    pub fn tell(&mut self, index: usize, values: Option<&[f64]>) -> Result<TellProgress, TellError> {
        if let (Some(values), Some(asked)) = (values, self.asked.get(index)) {
            let (expected, given) = (self.expected(asked), values.len());
            if expected != given {
                return Err(TellError::Length { expected, given });
            }
            if asked.is_proposed {
                if let Some(&value) = values.iter().find(|v| !v.is_finite()) {
                    return Err(LikelihoodError::Prediction {
                        run: 0,
                        channel: 0,
                        value,
                    }
                    .into());
                }
            } else {
                self.task.likelihood.check_values(values)?;
            }
        }
        let complete = self.round.tell(index, values.map(<[f64]>::to_vec))?;
        if complete {
            let (_, answers) = self.round.complete();
            self.evaluations += answers.len();
            self.asked.clear();
            self.take(answers);
            self.go_on();
        }
        Ok(match self.step {
            Step::Done(_) => TellProgress::Finished,
            Step::Failed(failure) => TellProgress::Failed(failure),
            _ if complete => TellProgress::NextRound,
            _ => TellProgress::Waiting,
        })
    }

    /// What was found; `None` while the inquiry goes on, and where it failed.
    #[must_use]
    pub fn answer(&self) -> Option<&Answer> {
        match &self.step {
            Step::Done(answer) => Some(answer),
            _ => None,
        }
    }

    /// Why the inquiry failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        match self.step {
            Step::Failed(failure) => Some(failure),
            _ => None,
        }
    }

    /// Asks for what the step in progress wants; one that wants nothing more leads to the next.
    fn go_on(&mut self) {
        loop {
            if matches!(self.step, Step::Done(_) | Step::Failed(_)) {
                return;
            }
            let asked = self.wanted();
            if !asked.is_empty() {
                let proposals = asked.iter().enumerate();
                let proposals = proposals.map(|(i, asked)| Proposal::plain(i, asked.theta.clone()));
                let proposals = proposals.collect();
                self.round.ask(proposals);
                self.asked = asked;
                return;
            }
            self.next_step();
        }
    }
}

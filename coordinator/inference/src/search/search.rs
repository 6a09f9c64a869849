//! Run the rounds: list a generation, take its log-likelihoods, and say when it is over.

use super::settings::{Settings, SettingsError};
use super::strategy::{Next, Strategy};
use crate::point::{Estimate, Generation, Individual, Space, Stop};
use crate::round::{Failure, Progress, Proposal, Round, TellError};
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

/// An ask/tell search for the most probable parameters.
///
/// Its state is a function of prior, settings and the told log-likelihoods, whatever their order within a round:
/// checked by `search::the_order_within_a_generation_does_not_matter`.
#[derive(Debug, Clone)]
pub struct Search {
    pub(super) space: Space,
    pub(super) settings: Settings,
    pub(super) round: Round<LogLikelihood>,
    pub(super) phase: Phase,
    /// The best so far; the first of equals.
    pub(super) best: Option<Individual>,
    pub(super) history: Vec<Generation>,
    pub(super) evaluations: usize,
    pub(super) rejected: usize,
    strategy: Strategy,
    /// Of the pending proposals.
    positions: Vec<Vec<f64>>,
}

/// What the search waits for.
#[derive(Debug, Clone)]
pub(super) enum Phase {
    Generation,
    Done(Box<Estimate>),
    Failed(Failure),
}

impl Search {
    /// A search whose first generation is pending.
    ///
    /// # Errors
    /// [`SettingsError`] names the setting, its value and its bound.
    pub fn new(prior: Prior, settings: Settings) -> Result<Self, SettingsError> {
        settings.check(prior.dimension())?;
        let space = Space::new(prior);
        let mut search = Self {
            strategy: Strategy::new(settings, &space),
            space,
            settings,
            round: Round::default(),
            phase: Phase::Generation,
            best: None,
            history: Vec::new(),
            evaluations: 0,
            rejected: 0,
            positions: Vec::new(),
        };
        search.ask();
        Ok(search)
    }

    /// Takes the log-likelihood of a pending proposal; the last one of a round leads to the next generation.
    ///
    /// # Errors
    /// [`TellError::AlreadyTold`] and [`TellError::NotPending`]; the search is then unchanged.
    pub fn tell(&mut self, particle: usize, value: LogLikelihood) -> Result<Progress, TellError> {
        let complete = self.round.tell(particle, value)?;
        if complete {
            self.advance();
        }
        Ok(match &self.phase {
            Phase::Done(_) => Progress::Finished,
            Phase::Failed(failure) => Progress::Failed(*failure),
            Phase::Generation if complete => Progress::NextRound,
            Phase::Generation => Progress::Waiting,
        })
    }

    fn advance(&mut self) {
        let (proposals, answers) = self.round.complete();
        let positions = std::mem::take(&mut self.positions);
        let generation: Vec<Individual> = proposals
            .into_iter()
            .zip(positions)
            .zip(answers)
            .map(|((proposal, position), answer)| self.space.individual(position, proposal.theta, answer))
            .collect();
        self.evaluations += generation.len();
        self.rejected += generation
            .iter()
            .filter(|individual| individual.log_likelihood.is_impossible())
            .count();
        for individual in &generation {
            let least = self
                .best
                .as_ref()
                .map_or(f64::NEG_INFINITY, Individual::log_posterior);
            if individual.log_posterior() > least {
                self.best = Some(individual.clone());
            }
        }
        self.remember(&generation);
        self.strategy.accept(generation);
        self.ask();
    }

    fn remember(&mut self, generation: &[Individual]) {
        let taken: Vec<f64> = generation
            .iter()
            .filter(|individual| individual.is_possible())
            .map(Individual::log_posterior)
            .collect();
        self.history.push(Generation {
            evaluations: self.evaluations as u64,
            best: self.best.as_ref().map(Individual::log_posterior),
            mean: crate::diagnostics::mean(&taken),
        });
    }

    /// Asks for the next generation, unless there is none; without anybody whom the model took, for half of the budget.
    fn ask(&mut self) {
        let budget = self.settings.max_evaluations();
        match self.strategy.next(&self.space, budget - self.evaluations) {
            Next::Ask(positions)
                if self.best.is_some()
                    || self.evaluations == 0
                    || 2 * (self.evaluations + positions.len()) <= budget =>
            {
                let proposals = positions
                    .iter()
                    .enumerate()
                    .map(|(particle, position)| Proposal::plain(particle, self.space.theta(position)));
                self.round.ask(proposals.collect());
                self.positions = positions;
            }
            Next::Ask(_) => self.fail(),
            Next::End(stop) => self.finish(stop),
        }
    }

    fn fail(&mut self) {
        let draws = self.evaluations;
        self.phase = Phase::Failed(Failure::AllImpossible { draws });
    }

    fn finish(&mut self, stop: Stop) {
        let Some(best) = &self.best else {
            return self.fail();
        };
        self.phase = Phase::Done(Box::new(Estimate {
            theta: best.theta.clone(),
            log_likelihood: best.log_likelihood.value(),
            log_prior: best.log_prior,
            at_bound: self.space.at_bound(&best.position),
            laplace: None,
            evaluations: self.evaluations as u64,
            rejected: self.rejected as u64,
            stop,
            history: self.history.clone(),
        }));
    }
}

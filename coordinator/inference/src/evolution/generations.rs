//! The rounds of an evolution: list a generation, take its log-likelihoods, finish.

use super::next_generation::NextGeneration;
use super::settings::EvolutionSettings;
use super::settings_error::EvolutionSettingsError;
use super::strategy::Strategy;
use crate::evolution::individual::Individual;
use crate::evolution::prior_space::PriorSpace;
use crate::phase::{EvaluationCount, RunPhase};
use crate::point_estimate::{Generation, ModeEstimate, StopReason};
use crate::round::{Proposal, ProposalRound};
use crate::tell::{InferenceFailure, TellError, TellProgress};
use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

/// The most probable parameters by generations, by ask and tell.
///
/// Its state is a function of prior, settings and the told log-likelihoods, whatever their order within a round:
/// checked by `evolution::the_order_within_a_generation_does_not_matter`.
#[derive(Debug, Clone)]
pub struct Evolution {
    space: PriorSpace,
    settings: EvolutionSettings,
    round: ProposalRound<LogLikelihood>,
    phase: RunPhase<(), ModeEstimate>,
    /// The best individual so far; among equals the first.
    best: Option<Individual>,
    history: Vec<Generation>,
    count: EvaluationCount,
    strategy: Strategy,
    positions: Vec<Vec<f64>>,
}

impl Evolution {
    /// Makes an evolution whose first generation is pending.
    ///
    /// # Errors
    /// [`EvolutionSettingsError`] names the setting, its value and its bound.
    pub fn new(prior: Prior, settings: EvolutionSettings) -> Result<Self, EvolutionSettingsError> {
        settings.check(prior.dimension())?;
        let space = PriorSpace::new(prior);
        let mut evolution = Self {
            strategy: Strategy::new(settings, &space),
            space,
            settings,
            round: ProposalRound::default(),
            phase: RunPhase::Waiting(()),
            best: None,
            history: Vec::new(),
            count: EvaluationCount::default(),
            positions: Vec::new(),
        };
        evolution.ask();
        Ok(evolution)
    }

    /// Returns the round in progress, a generation; its list of proposals is empty only when the evolution has ended.
    #[must_use]
    pub fn round(&self) -> &ProposalRound<LogLikelihood> {
        &self.round
    }

    /// Returns the result, once finished.
    #[must_use]
    pub fn estimate(&self) -> Option<&ModeEstimate> {
        self.phase.result()
    }

    /// Returns why the evolution failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        self.phase.failure()
    }

    /// Returns evaluations told so far in completed rounds.
    #[must_use]
    pub fn count(&self) -> EvaluationCount {
        self.count
    }

    /// Returns the completed generations.
    #[must_use]
    pub fn history(&self) -> &[Generation] {
        &self.history
    }

    /// Takes the log-likelihood of a pending proposal; the last one of a round leads to the next generation.
    ///
    /// # Errors
    /// [`TellError::AlreadyTold`] and [`TellError::NotPending`]; the evolution is then unchanged.
    pub fn tell(&mut self, particle: usize, value: LogLikelihood) -> Result<TellProgress, TellError> {
        let complete = self.round.tell(particle, value)?;
        if complete {
            self.advance();
        }
        Ok(self.phase.progress(complete))
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
        let rejections = generation.iter().map(|i| i.log_likelihood.is_impossible());
        self.count.add(rejections);
        for individual in &generation {
            let lowest = self
                .best
                .as_ref()
                .map_or(f64::NEG_INFINITY, Individual::log_posterior);
            if individual.log_posterior() > lowest {
                self.best = Some(individual.clone());
            }
        }
        self.record(&generation);
        self.strategy.accept(generation);
        self.ask();
    }

    /// Appends a generation to the history.
    fn record(&mut self, generation: &[Individual]) {
        let accepted: Vec<f64> = generation
            .iter()
            .filter(|individual| individual.is_possible())
            .map(Individual::log_posterior)
            .collect();
        self.history.push(Generation {
            evaluations: self.count.evaluations as u64,
            best: self.best.as_ref().map(Individual::log_posterior),
            mean: crate::diagnostics::mean(&accepted),
        });
    }

    /// Asks for the next generation, if there is one; fails when the model has rejected half of the budget and accepted nothing.
    fn ask(&mut self) {
        let budget = self.settings.max_evaluations();
        match self.strategy.next(&self.space, budget - self.count.evaluations) {
            NextGeneration::Ask(positions)
                if self.best.is_some()
                    || self.count.evaluations == 0
                    || 2 * (self.count.evaluations + positions.len()) <= budget =>
            {
                let proposals = positions
                    .iter()
                    .enumerate()
                    .map(|(particle, position)| Proposal::new(particle, self.space.theta(position)));
                self.round.ask(proposals.collect());
                self.positions = positions;
            }
            NextGeneration::Ask(_) => self.fail(),
            NextGeneration::End(stop) => self.finish(stop),
        }
    }

    fn fail(&mut self) {
        let draws = self.count.evaluations;
        self.phase = RunPhase::Failed(InferenceFailure::AllImpossible { draws });
    }

    fn finish(&mut self, stop: StopReason) {
        let Some(best) = &self.best else {
            return self.fail();
        };
        self.phase = RunPhase::Done(Box::new(ModeEstimate {
            theta: best.theta.clone(),
            log_likelihood: best.log_likelihood.value(),
            log_prior: best.log_prior,
            at_bound: self.space.at_bound(&best.position),
            laplace: None,
            approximation: None,
            evaluations: self.count.evaluations as u64,
            rejected: self.count.rejected as u64,
            stop,
            history: self.history.clone(),
        }));
    }
}

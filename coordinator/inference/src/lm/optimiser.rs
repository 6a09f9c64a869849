//! Run the rounds: list proposals, take their predicted values, go on to the next kind of round.

use super::damping::Damping;
use super::estimate::{Estimate, Stop};
use super::objective::{Column, Objective, Point};
use super::settings::{Settings, SettingsError};
use super::stencil::{Sides, Stencil};
use crate::likelihood::{GaussianLikelihood, LikelihoodError};
use crate::prior::Prior;
use crate::rng::Stream;
use crate::round::{Failure, Progress, Proposal, Round, TellError};

/// A step so much longer is worth another Jacobian.
const MUCH_LONGER: f64 = 1.5;

/// Predicted values in the order of the data; `None` where the model rejected the parameters.
type Answer = Option<Vec<f64>>;

/// An ask/tell fit of the most probable parameters.
///
/// Its state is a function of prior, likelihood, settings and the told values, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct Optimiser {
    pub(super) objective: Objective,
    pub(super) settings: Settings,
    pub(super) round: Round<Answer>,
    pub(super) phase: Phase,
    /// The best point so far.
    pub(super) best: Option<Point>,
    /// The last known Jacobian: at the best point, or at one before it.
    columns: Vec<Column>,
    /// Differences around the best point.
    stencil: Stencil,
    /// To which sides they were last asked for.
    sides: Sides,
    /// Their steps along the axes.
    lengths: Vec<f64>,
    damping: Damping,
    /// The last step gained too little to go on.
    settled: bool,
    pub(super) steps: usize,
    pub(super) evaluations: usize,
    pub(super) rejected: usize,
}

/// What the fit waits for.
#[derive(Debug, Clone)]
pub(super) enum Phase {
    Starts,
    Differences,
    /// Dampings and promised decreases of the steps that are tried.
    Trials(Vec<(f64, f64)>),
    Done(Box<Estimate>),
    Failed(Failure),
}

impl Optimiser {
    /// A fit whose first round holds the prior mean and prior draws.
    ///
    /// # Arguments
    /// - `likelihood`: the data; their order is that of the values that [`Optimiser::tell`] takes. A parameter that it names
    ///   as a noise sd is not the model's.
    ///
    /// # Errors
    /// [`SettingsError`] names the setting, its value and its bound.
    pub fn new(
        prior: Prior,
        likelihood: GaussianLikelihood,
        settings: Settings,
    ) -> Result<Self, SettingsError> {
        settings.check(prior.dimension())?;
        let objective = Objective::new(prior, likelihood);
        let mut optimiser = Self {
            columns: vec![None; objective.axes.len()],
            stencil: Stencil::new(&[], &[], &[]),
            objective,
            settings,
            round: Round::default(),
            phase: Phase::Starts,
            best: None,
            sides: Sides::One,
            lengths: Vec::new(),
            damping: Damping::default(),
            settled: false,
            steps: 0,
            evaluations: 0,
            rejected: 0,
        };
        optimiser.ask_starts();
        Ok(optimiser)
    }

    /// Takes the predicted values of a pending proposal; the last one of a round advances the fit.
    ///
    /// # Arguments
    /// - `predicted`: the model's values in the order of the likelihood's data, each in the unit of its datum;
    ///   `None` where the model rejected the parameters.
    ///
    /// # Errors
    /// [`TellError`]: told before, never asked for, not one finite value for each datum. The fit is then unchanged.
    pub fn tell(&mut self, particle: usize, predicted: Option<&[f64]>) -> Result<Progress, TellError> {
        if let Some(values) = predicted {
            self.check(values)?;
        }
        let complete = self.round.tell(particle, predicted.map(<[f64]>::to_vec))?;
        if complete {
            self.advance();
        }
        Ok(match &self.phase {
            Phase::Done(_) => Progress::Finished,
            Phase::Failed(failure) => Progress::Failed(*failure),
            _ if complete => Progress::NextRound,
            _ => Progress::Waiting,
        })
    }

    fn check(&self, values: &[f64]) -> Result<(), TellError> {
        let data = self.objective.likelihood.data();
        let (expected, given) = (data.len(), values.len());
        if expected != given {
            return Err(TellError::Length { expected, given });
        }
        match data.iter().zip(values).find(|(_, value)| !value.is_finite()) {
            None => Ok(()),
            Some((datum, &value)) => Err(LikelihoodError::Prediction {
                run: datum.run,
                channel: datum.channel,
                value,
            }
            .into()),
        }
    }

    /// Completes a round and asks for the next, unless the fit has ended.
    fn advance(&mut self) {
        let (proposals, answers) = self.round.complete();
        self.evaluations += answers.len();
        self.rejected += answers.iter().filter(|answer| answer.is_none()).count();
        match std::mem::replace(&mut self.phase, Phase::Starts) {
            Phase::Starts => self.after_starts(&proposals, &answers),
            Phase::Differences => self.after_differences(answers),
            Phase::Trials(trials) => self.after_trials(&trials, &proposals, &answers),
            ended @ (Phase::Done(_) | Phase::Failed(_)) => self.phase = ended,
        }
    }

    fn remaining(&self) -> usize {
        self.settings.max_evaluations - self.evaluations
    }

    fn ask(&mut self, phase: Phase, thetas: impl Iterator<Item = Vec<f64>>) {
        let proposals = thetas
            .enumerate()
            .map(|(particle, theta)| Proposal { particle, theta })
            .collect();
        self.round.ask(proposals);
        self.phase = phase;
    }

    /// The prior mean, then one prior draw after the other; each draw has a stream of its own.
    fn ask_starts(&mut self) {
        let (first, seed) = (self.evaluations, self.settings.seed);
        let prior = &self.objective.prior;
        let starts: Vec<Vec<f64>> = (first..first + self.settings.starts)
            .map(|k| match k {
                0 => prior.marginals().iter().map(|marginal| marginal.mean()).collect(),
                _ => prior.sample(&mut Stream::new(seed, 0, k as u64, 0)),
            })
            .collect();
        self.ask(Phase::Starts, starts.into_iter());
    }

    /// The point with the least f; the first of equals.
    fn least<'a>(&self, proposals: &'a [Proposal], answers: &'a [Answer]) -> Option<(&'a Proposal, Point)> {
        proposals
            .iter()
            .zip(answers)
            .filter_map(|(proposal, answer)| {
                let point = self.objective.point(&proposal.theta, answer.as_ref()?)?;
                Some((proposal, point))
            })
            .reduce(|least, other| {
                if other.1.value < least.1.value {
                    other
                } else {
                    least
                }
            })
    }

    /// Goes on from the best start; if all were rejected, more are drawn with half of the budget.
    fn after_starts(&mut self, proposals: &[Proposal], answers: &[Answer]) {
        match self.least(proposals, answers) {
            Some((_, point)) => self.go_on_from(point, Sides::One),
            None if 2 * (self.evaluations + self.settings.starts) <= self.settings.max_evaluations => {
                self.ask_starts();
            }
            None => {
                let draws = self.evaluations;
                self.phase = Phase::Failed(Failure::AllImpossible { draws });
            }
        }
    }

    fn go_on_from(&mut self, point: Point, sides: Sides) {
        self.best = Some(point);
        if self.objective.axes.is_empty() {
            // Noise sds alone: they are the most probable ones already.
            self.finish(Stop::Decrease);
        } else if !self.differentiate(sides) {
            self.finish(Stop::Budget);
        }
    }

    /// Begins a Jacobian at the best point; `false` where the budget has no room for it.
    fn differentiate(&mut self, sides: Sides) -> bool {
        let Some(point) = &self.best else { return false };
        let steps = self.difference_steps(point, sides);
        self.stencil = Stencil::new(&self.objective.axes, &point.position, &steps);
        self.lengths = steps;
        self.ask_differences(sides)
    }

    fn difference_steps(&self, point: &Point, sides: Sides) -> Vec<f64> {
        let uncertainty = self.objective.quadratic(point, &self.columns).uncertainty();
        uncertainty
            .into_iter()
            .map(|sd| self.settings.difference(sides, sd))
            .collect()
    }

    /// Begins a better Jacobian at the best point: to both sides; then over longer steps, for as long as each shows the
    /// parameters to be less certain than the last. `false` where there is none or the budget has no room for it.
    ///
    /// The noise of a model looks like information that it does not have, the more so the shorter the step.
    fn refine(&mut self) -> bool {
        let Some(point) = &self.best else { return false };
        let mut steps = self
            .difference_steps(point, Sides::Both)
            .into_iter()
            .zip(&self.lengths);
        let better = self.sides == Sides::One || steps.any(|(new, old)| new > MUCH_LONGER * old);
        better && self.differentiate(Sides::Both)
    }

    /// Asks for differences; `false` if nothing is missing or the budget has no room for them and, where the search is
    /// to go on, a trial.
    fn ask_differences(&mut self, sides: Sides) -> bool {
        let Some(point) = &self.best else { return false };
        let differences = self.stencil.ask(sides);
        let trial = usize::from(sides == Sides::One);
        if differences.is_empty()
            || differences.len() + trial > self.settings.max_evaluations - self.evaluations
        {
            return false;
        }
        let thetas: Vec<Vec<f64>> = differences
            .iter()
            .map(|&(k, offset)| {
                let mut position = point.position.clone();
                position[k] += offset;
                self.objective.theta(point, &position)
            })
            .collect();
        self.sides = sides;
        self.ask(Phase::Differences, thetas.into_iter());
        true
    }

    fn after_differences(&mut self, answers: Vec<Answer>) {
        self.stencil.accept(answers);
        if self.stencil.is_incomplete() && self.ask_differences(self.sides) {
            return;
        }
        let Some(point) = &self.best else { return };
        self.columns = self.stencil.columns(&point.predicted);
        self.decide();
    }

    /// With a Jacobian at the best point: stop there, or try steps.
    fn decide(&mut self) {
        let Some(point) = &self.best else { return };
        let parabola = self.objective.quadratic(point, &self.columns);
        // Without a least of its own, the parabola falls further than any step tried will tell.
        let promised = parabola
            .step(0.0)
            .map_or(f64::INFINITY, |step| parabola.decrease(&step));
        if self.settled || promised <= self.least_decrease(point) {
            // A better Jacobian has the last word; it may hold one more step.
            if !self.refine() {
                self.finish(Stop::Decrease);
            }
        } else {
            self.try_steps();
        }
    }

    fn least_decrease(&self, point: &Point) -> f64 {
        self.settings.decrease_tolerance * (1.0 + point.value.abs())
    }

    fn try_steps(&mut self) {
        let Some(point) = &self.best else { return };
        if self.remaining() == 0 {
            return self.finish(Stop::Budget);
        }
        let parabola = self.objective.quadratic(point, &self.columns);
        let mut trials = Vec::new();
        let mut positions: Vec<Vec<f64>> = Vec::new();
        for damping in self.damping.trials() {
            let Some(step) = parabola.step(damping) else {
                continue;
            };
            let length = step.iter().fold(0.0_f64, |longest, part| longest.max(part.abs()));
            let position = self.objective.moved(point, &step);
            // Steps that end in the same corner of the box are one.
            if length >= self.settings.step_tolerance
                && !positions.contains(&position)
                && trials.len() < self.remaining()
            {
                trials.push((damping, parabola.decrease(&step)));
                positions.push(position);
            }
        }
        let thetas: Vec<Vec<f64>> = positions
            .iter()
            .map(|position| self.objective.theta(point, position))
            .collect();
        if !thetas.is_empty() {
            self.ask(Phase::Trials(trials), thetas.into_iter());
        } else if self.refine() {
            // It may yet show the way down.
            self.damping = Damping::default();
        } else {
            self.finish(Stop::Step);
        }
    }

    fn after_trials(&mut self, trials: &[(f64, f64)], proposals: &[Proposal], answers: &[Answer]) {
        let Some(best) = &self.best else { return };
        let gained = self
            .least(proposals, answers)
            .filter(|(_, point)| point.value < best.value);
        let Some((proposal, point)) = gained else {
            self.damping.reject();
            return self.try_steps();
        };
        let decrease = best.value - point.value;
        let (damping, promised) = trials[proposal.particle];
        self.settled = decrease <= self.least_decrease(best);
        self.damping.accept(damping, decrease / promised);
        self.steps += 1;
        let sides = if self.settled { Sides::Both } else { Sides::One };
        self.go_on_from(point, sides);
    }

    fn finish(&mut self, stop: Stop) {
        let Some(point) = &self.best else { return };
        // A step that settled the fit ends it even where the budget has no room for another Jacobian.
        let stop = if self.settled { Stop::Decrease } else { stop };
        let mut estimate = Estimate::at(&self.objective, point, &self.columns, stop);
        estimate.evaluations = self.evaluations as u64;
        estimate.rejected = self.rejected as u64;
        self.phase = Phase::Done(Box::new(estimate));
    }
}

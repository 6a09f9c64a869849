//! The iteration of a fit: starts, differences, trials, and the next round after each.

use super::damping::Damping;
use super::fit::{FitRound, LmFit, PredictedValues};
use super::objective::FitPoint;
use super::stencil::{Sides, Stencil};
use crate::phase::RunPhase;
use crate::point_estimate::StopReason;
use crate::round::Proposal;
use crate::tell::InferenceFailure;
use statistics::rng::Stream;

/// Ratio of the new to the old length of a difference above which a further Jacobian is worth its evaluations.
const MUCH_LONGER: f64 = 1.5;

impl LmFit {
    /// Asks for the prior mean, then one prior draw after the other; each draw has its random stream.
    pub(super) fn ask_starts(&mut self) {
        let (first, seed) = (self.count.evaluations, self.settings.seed);
        let prior = &self.objective.prior;
        let starts: Vec<Vec<f64>> = (first..first + self.settings.starts)
            .map(|k| match k {
                0 => prior.marginals().iter().map(|marginal| marginal.mean()).collect(),
                _ => prior.sample(&mut Stream::new(seed, 0, k as u64, 0)),
            })
            .collect();
        self.ask(FitRound::Starts, starts.into_iter());
    }

    /// Returns the point with the lowest f; among equals the first.
    fn lowest<'a>(
        &self,
        proposals: &'a [Proposal],
        answers: &'a [PredictedValues],
    ) -> Option<(&'a Proposal, FitPoint)> {
        proposals
            .iter()
            .zip(answers)
            .filter_map(|(proposal, answer)| {
                let point = self.objective.point(&proposal.theta, answer.as_ref()?)?;
                Some((proposal, point))
            })
            .reduce(|lowest, point| {
                if point.1.value < lowest.1.value {
                    point
                } else {
                    lowest
                }
            })
    }

    /// Continues from the best start; if all were rejected, draws more, up to half of the budget.
    pub(super) fn after_starts(&mut self, proposals: &[Proposal], answers: &[PredictedValues]) {
        match self.lowest(proposals, answers) {
            Some((_, point)) => self.continue_from(point, Sides::One),
            None if 2 * (self.count.evaluations + self.settings.starts) <= self.settings.max_evaluations => {
                self.ask_starts();
            }
            None => {
                let draws = self.count.evaluations;
                self.phase = RunPhase::Failed(InferenceFailure::AllImpossible { draws });
            }
        }
    }

    /// Makes a point the best and begins a Jacobian there, or finishes.
    fn continue_from(&mut self, point: FitPoint, sides: Sides) {
        self.best = Some(point);
        if self.objective.axes.is_empty() {
            // The model has noise sds only, which are profiled already.
            self.finish(StopReason::Decrease);
        } else if !self.differentiate(sides) {
            self.finish(StopReason::Budget);
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

    fn difference_steps(&self, point: &FitPoint, sides: Sides) -> Vec<f64> {
        let uncertainty = self.objective.quadratic(point, &self.columns).uncertainty();
        uncertainty
            .into_iter()
            .map(|sd| self.settings.difference(sides, sd))
            .collect()
    }

    /// Begins a better Jacobian at the best point: two-sided; then over longer steps, as long as each shows a larger
    /// uncertainty than the last. `false` where there is none or the budget has no room for it.
    ///
    /// Over short steps the numerical noise of a model looks like information.
    fn refine(&mut self) -> bool {
        let Some(point) = &self.best else { return false };
        let mut steps = self
            .difference_steps(point, Sides::Both)
            .into_iter()
            .zip(&self.lengths);
        let better = self.sides == Sides::One || steps.any(|(new, old)| new > MUCH_LONGER * old);
        better && self.differentiate(Sides::Both)
    }

    /// Asks for the missing differences; `false` if none is missing or the budget has no room for them and, one-sided, for a trial.
    fn ask_differences(&mut self, sides: Sides) -> bool {
        let Some(point) = &self.best else { return false };
        let differences = self.stencil.ask(sides);
        let trial = usize::from(sides == Sides::One);
        if differences.is_empty()
            || differences.len() + trial > self.settings.max_evaluations - self.count.evaluations
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
        self.ask(FitRound::Differences, thetas.into_iter());
        true
    }

    pub(super) fn after_differences(&mut self, answers: Vec<PredictedValues>) {
        self.stencil.accept(answers);
        if self.stencil.is_incomplete() && self.ask_differences(self.sides) {
            return;
        }
        let Some(point) = &self.best else { return };
        self.columns = self.stencil.columns(&point.predicted);
        self.decide();
    }

    /// Continues with a Jacobian at the best point: finishes there, or tries steps.
    fn decide(&mut self) {
        let Some(point) = &self.best else { return };
        let parabola = self.objective.quadratic(point, &self.columns);
        // A parabola without a minimum predicts an unbounded decrease.
        let promised = parabola
            .step(0.0)
            .map_or(f64::INFINITY, |step| parabola.decrease(&step));
        if self.is_stagnant || promised <= self.min_decrease(point) {
            // A better Jacobian confirms the optimum or gives one more step.
            if !self.refine() {
                self.finish(StopReason::Decrease);
            }
        } else {
            self.try_steps();
        }
    }

    fn min_decrease(&self, point: &FitPoint) -> f64 {
        self.settings.decrease_tolerance * (1.0 + point.value.abs())
    }

    /// Asks for the steps of several dampings, or finishes.
    fn try_steps(&mut self) {
        let Some(point) = &self.best else { return };
        if self.remaining() == 0 {
            return self.finish(StopReason::Budget);
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
            // Steps that end in the same corner of the box are the same.
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
            self.ask(FitRound::Trials(trials), thetas.into_iter());
        } else if self.refine() {
            // A better Jacobian may show a descent direction.
            self.damping = Damping::default();
        } else {
            self.finish(StopReason::Step);
        }
    }

    pub(super) fn after_trials(
        &mut self,
        trials: &[(f64, f64)],
        proposals: &[Proposal],
        answers: &[PredictedValues],
    ) {
        let Some(best) = &self.best else { return };
        let gained = self
            .lowest(proposals, answers)
            .filter(|(_, point)| point.value < best.value);
        let Some((proposal, point)) = gained else {
            self.damping.reject();
            return self.try_steps();
        };
        let decrease = best.value - point.value;
        let (damping, promised) = trials[proposal.particle];
        self.is_stagnant = decrease <= self.min_decrease(best);
        self.damping.accept(damping, decrease / promised);
        self.steps += 1;
        let sides = if self.is_stagnant { Sides::Both } else { Sides::One };
        self.continue_from(point, sides);
    }
}

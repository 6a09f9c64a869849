//! The posterior mode of one model, by damped Gauss-Newton steps with Broyden's update of the Jacobian.

use std::collections::VecDeque;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::{Correction, quotient};
use crate::laplace::noise;
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use crate::laplace::strength_prior::{mixed_evidence, stated_less_mixed};
use crate::settings::Roughness;
use inference::lm::QuadraticModel;
use statistics::likelihood::Likelihood;

/// Longest finite difference, in standard deviations of the prior; above the shortest it equals the coordinate's current posterior
/// sd. Long differences average over the roughness of a model on a grid, short ones resolve a narrow posterior.
const DIFFERENCE: f64 = 0.15;
/// The damping after the first rejected step, and the factor between successive dampings.
const FIRST_DAMPING: f64 = 0.05;
const DAMPING_FACTOR: f64 = 8.0;
/// Most gain beyond the point that the evidence counts, though no step has reached it `[nats]`.
const MOST_UNREACHED: f64 = 3.0;

/// One step of the plan of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FitStep {
    /// Frees the coordinates that were held.
    Release,
    /// Computes the Jacobian by finite differences: of the companion, as far as its difference from the model is known, and of the
    /// model elsewhere.
    Differences,
    /// At most so many trial steps, one evaluation each. After a step that gains, the Jacobian follows the companion, with no
    /// correction of what the companion alone has screened.
    Trials(usize),
    /// `Differences` and `Trials(trials)`, repeated at most so many times, until a new Jacobian predicts no gain, which ends the plan.
    /// Of a rough model a round whose steps gain nothing ends the plan, too, with the Jacobian that its differences gave.
    Rounds { most: usize, trials: usize },
}

/// A fit of one model.
#[derive(Debug, Clone)]
pub(crate) struct LaplaceFit {
    pub(crate) frame: NormalFrame,
    pub(crate) point: FitPoint,
    /// The Jacobian: derivatives of the predicted values, one column for each coordinate.
    pub(crate) columns: Vec<Vec<f64>>,
    /// Of each column that was measured on the model: the companion is a control variate of the differences.
    pub(crate) corrections: Vec<Option<Correction>>,
    /// Whether a difference follows the companion: an earlier fit measured it on the model, near by. This fit's own corrections are
    /// those of wherever it passes.
    follows: Vec<bool>,
    /// On the model.
    pub(crate) evaluations: usize,
    plan: VecDeque<FitStep>,
    damping: f64,
    failures: usize,
    /// Coordinates that are fixed until a [`FitStep::Release`].
    held: Vec<bool>,
    /// No step was tried since the last Jacobian of a round.
    is_fresh: bool,
    /// A step has gained since then.
    has_gained: bool,
    /// The point has moved since the companion was asked.
    has_moved: bool,
    /// The companion's derivatives at the point, where they were just computed.
    companion: Vec<Option<Vec<f64>>>,
    /// The Jacobian that the differences of the round gave, before the updates by its steps.
    of_round: Vec<Vec<f64>>,
    pending: Pending,
}

/// A completed fit with its log evidence.
#[derive(Debug, Clone)]
pub(crate) struct FittedModel {
    pub(crate) fit: LaplaceFit,
    pub(crate) log_evidence: f64,
}

/// The evaluations that a fit waits for.
#[derive(Debug, Clone)]
enum Pending {
    Nothing,
    /// Of the companion, at each difference and at the point, and whether the model is asked for none.
    Companion(Vec<(usize, f64)>, bool),
    /// Of the model: index and offset of each difference, and whether this is the second attempt, with the opposite sign.
    Differences(Vec<(usize, f64)>, bool),
    /// A trial position and its predicted gain.
    Trial {
        position: Vec<f64>,
        predicted: f64,
    },
}

impl LaplaceFit {
    pub(crate) fn new(frame: NormalFrame, point: FitPoint, columns: Vec<Vec<f64>>, plan: &[FitStep]) -> Self {
        Self {
            held: vec![false; frame.dimension()],
            corrections: vec![None; frame.dimension()],
            follows: vec![false; frame.dimension()],
            companion: Vec::new(),
            frame,
            point,
            columns,
            evaluations: 0,
            plan: plan.iter().copied().collect(),
            damping: 0.0,
            failures: 0,
            is_fresh: false,
            has_gained: true,
            has_moved: false,
            of_round: Vec::new(),
            pending: Pending::Nothing,
        }
    }

    /// The same fit continued with another plan.
    pub(crate) fn continued(&self, plan: &[FitStep]) -> Self {
        self.measured_again(plan).corrected(&self.corrections)
    }

    /// The same fit continued with another plan whose differences are the model's.
    pub(crate) fn measured_again(&self, plan: &[FitStep]) -> Self {
        Self::new(self.frame.clone(), self.point.clone(), self.columns.clone(), plan)
    }

    /// With the corrections of a fit of the same model, or of one that it extends.
    pub(crate) fn corrected(mut self, corrections: &[Option<Correction>]) -> Self {
        self.corrections[..corrections.len()].clone_from_slice(corrections);
        let is_near = |own: &Option<Correction>| own.as_ref().is_some_and(|own| !own.is_secant);
        self.follows = self.corrections.iter().map(is_near).collect();
        self
    }

    /// Whether what it asked for last is to be evaluated by the companion.
    pub(crate) fn asks_companion(&self) -> bool {
        matches!(self.pending, Pending::Companion(..))
    }

    /// Fixes coordinates until [`FitStep::Release`].
    pub(crate) fn hold(&mut self, coordinates: impl Iterator<Item = usize>) {
        for k in coordinates {
            self.held[k] = true;
        }
    }

    /// The most probable parameters.
    pub(crate) fn theta(&self) -> Vec<f64> {
        self.frame.theta(&self.point.position)
    }

    /// The positions to evaluate next; none once the plan is complete.
    pub(crate) fn ask(&mut self, likelihood: &Likelihood) -> Vec<Vec<f64>> {
        if let Pending::Differences(wanted, _) = &self.pending {
            return self.offset(wanted);
        }
        while let Some(step) = self.plan.pop_front() {
            match step {
                FitStep::Release => {
                    self.held.fill(false);
                    self.damping = 0.0;
                    self.failures = 0;
                }
                FitStep::Differences => {
                    let wanted = self.differences(likelihood);
                    return self.ask_differences(wanted, false);
                }
                FitStep::Rounds { most: 0, .. } | FitStep::Trials(0) => {}
                FitStep::Rounds { most, trials } => {
                    let most = most - 1;
                    self.plan.push_front(FitStep::Rounds { most, trials });
                    self.plan.push_front(FitStep::Trials(trials));
                    self.plan.push_front(FitStep::Differences);
                    self.is_fresh = true;
                    self.has_gained = false;
                }
                FitStep::Trials(left) if self.frame.has_companion && std::mem::take(&mut self.has_moved) => {
                    self.plan.push_front(FitStep::Trials(left));
                    let wanted = self.differences(likelihood);
                    if wanted.iter().all(|(k, _)| self.corrections[*k].is_some()) {
                        return self.ask_differences(wanted, true);
                    }
                }
                FitStep::Trials(left) => {
                    if let Some((position, predicted)) = self.trial(likelihood) {
                        self.plan.push_front(FitStep::Trials(left - 1));
                        if std::mem::take(&mut self.is_fresh) {
                            self.of_round.clone_from(&self.columns);
                        }
                        self.pending = Pending::Trial {
                            position: position.clone(),
                            predicted,
                        };
                        return vec![position];
                    }
                    self.damping = 0.0;
                    self.failures = 0;
                    if self.is_fresh {
                        self.plan.clear();
                    } else if self.frame.roughness != Roughness::Smooth && !self.has_gained {
                        // The evidence needs the slope at the point, not that to where the steps failed.
                        self.columns = std::mem::take(&mut self.of_round);
                        self.plan.clear();
                    }
                }
            }
        }
        Vec::new()
    }

    /// Index and offset of each difference.
    fn differences(&self, likelihood: &Likelihood) -> Vec<(usize, f64)> {
        let (_, upper) = self.frame.room(&self.point.position);
        let uncertainty = self.quadratic(likelihood).uncertainty();
        let offset = |k: usize| {
            let length = uncertainty[k].unwrap_or(DIFFERENCE);
            let length = length.clamp(self.frame.roughness.least_difference(), DIFFERENCE);
            if upper[k] >= length { length } else { -length }
        };
        // Predictions do not depend on the noise sds.
        let noise = noise::coordinates(likelihood);
        let is_noise = |k: usize| noise.iter().any(|(own, _)| *own == k);
        (0..self.frame.dimension())
            .filter(|k| !is_noise(*k) && !self.held[*k])
            .map(|k| (k, offset(k)))
            .collect()
    }

    /// # Arguments
    /// - `follows`: the companion alone is asked, with whatever corrections there are.
    fn ask_differences(&mut self, wanted: Vec<(usize, f64)>, follows: bool) -> Vec<Vec<f64>> {
        let mut positions = self.offset(&wanted);
        if self.frame.has_companion {
            positions.push(self.point.position.clone());
            self.pending = Pending::Companion(wanted, follows);
        } else {
            self.pending = Pending::Differences(wanted, false);
        }
        self.has_moved = false;
        positions
    }

    fn offset(&self, wanted: &[(usize, f64)]) -> Vec<Vec<f64>> {
        let moved = |&(k, offset): &(usize, f64)| {
            let mut position = self.point.position.clone();
            position[k] += offset;
            position
        };
        wanted.iter().map(moved).collect()
    }

    /// The next trial position and its predicted gain; `None` where no step is worth an evaluation.
    fn trial(&self, likelihood: &Likelihood) -> Option<(Vec<f64>, f64)> {
        if self.failures >= self.frame.roughness.most_failures() {
            return None;
        }
        let quadratic = self.quadratic(likelihood);
        let step = quadratic.step(self.damping)?;
        let predicted = quadratic.decrease(&step);
        let pairs = self.point.position.iter().zip(&step);
        (predicted > self.frame.roughness.least_gain())
            .then(|| (pairs.map(|(t, by)| t + by).collect(), predicted))
    }

    /// Takes the predicted values at those positions; `None` where the model rejected one.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        if !self.asks_companion() {
            self.evaluations += answers.len();
        }
        match std::mem::replace(&mut self.pending, Pending::Nothing) {
            Pending::Nothing => {}
            Pending::Companion(wanted, follows) => self.after_companion(wanted, follows, answers),
            Pending::Differences(wanted, again) => self.after_differences(wanted, again, answers),
            Pending::Trial { position, predicted } => {
                self.after_trial(
                    likelihood,
                    position,
                    predicted,
                    answers.into_iter().flatten().next(),
                );
            }
        }
    }

    /// Columns whose correction is known are those of the companion with it; the others are asked of the model.
    fn after_companion(
        &mut self,
        wanted: Vec<(usize, f64)>,
        follows: bool,
        mut answers: Vec<Option<Vec<f64>>>,
    ) {
        let here = answers.pop().flatten();
        self.companion = vec![None; self.frame.dimension()];
        for ((k, offset), answer) in wanted.iter().zip(answers) {
            let pair = answer.as_ref().zip(here.as_ref());
            self.companion[*k] = pair.map(|(values, here)| quotient(values, here, *offset));
        }
        let mut measured = Vec::new();
        for (k, offset) in wanted {
            match (&self.companion[k], &self.corrections[k]) {
                (Some(companion), Some(correction)) if follows || self.follows[k] => {
                    self.columns[k] = correction.of_model(companion);
                }
                _ if follows => {}
                _ => measured.push((k, offset)),
            }
        }
        if !measured.is_empty() {
            self.pending = Pending::Differences(measured, false);
        }
    }

    /// A rejected difference is tried once more with the opposite sign; if that fails too, the old column stays.
    fn after_differences(
        &mut self,
        wanted: Vec<(usize, f64)>,
        is_second: bool,
        answers: Vec<Option<Vec<f64>>>,
    ) {
        let (lower, upper) = self.frame.room(&self.point.position);
        let mut again = Vec::new();
        for ((k, offset), answer) in wanted.into_iter().zip(answers) {
            match answer {
                Some(values) => {
                    self.columns[k] = quotient(&values, &self.point.values, offset);
                    // The companion's difference is that of the first attempt.
                    if let Some(Some(companion)) = self.companion.get(k).filter(|_| !is_second) {
                        let own = Correction::between(&self.columns[k], companion, false);
                        self.corrections[k] = Some(own);
                    }
                }
                None if !is_second && (lower[k]..=upper[k]).contains(&-offset) => again.push((k, -offset)),
                None => {}
            }
        }
        if !again.is_empty() {
            self.pending = Pending::Differences(again, true);
        }
    }

    fn after_trial(
        &mut self,
        likelihood: &Likelihood,
        position: Vec<f64>,
        predicted: f64,
        values: Option<Vec<f64>>,
    ) {
        let step: Vec<f64> = position
            .iter()
            .zip(&self.point.position)
            .map(|(a, b)| a - b)
            .collect();
        if let Some(values) = &values {
            self.update_jacobian(&step, values);
        }
        let reached = values.and_then(|v| FitPoint::new(&self.frame, likelihood, position, v));
        match reached {
            Some(point) if point.value < self.point.value => {
                let gain = self.point.value - point.value;
                self.point = point;
                self.has_moved = true;
                if gain < self.frame.roughness.least_counted_gain() {
                    return self.fail();
                }
                self.failures = 0;
                self.has_gained = true;
                self.damping = if gain > 0.5 * predicted && self.damping <= FIRST_DAMPING {
                    0.0
                } else {
                    self.damping / DAMPING_FACTOR
                };
            }
            _ => self.fail(),
        }
    }

    fn fail(&mut self) {
        self.failures += 1;
        self.damping = (DAMPING_FACTOR * self.damping).max(FIRST_DAMPING);
    }

    /// Broyden's update: the smallest change of the Jacobian that reproduces the values at the new position.
    ///
    /// # Source
    /// Broyden 1965, doi:10.1090/S0025-5718-1965-0198670-6.
    fn update_jacobian(&mut self, step: &[f64], values: &[f64]) {
        let squares: f64 = step.iter().map(|s| s * s).sum();
        if squares <= 0.0 {
            return;
        }
        for (i, (new, old)) in values.iter().zip(&self.point.values).enumerate() {
            let expected: f64 = self.columns.iter().zip(step).map(|(c, s)| c[i] * s).sum();
            let missed = (new - old - expected) / squares;
            for (column, s) in self.columns.iter_mut().zip(step) {
                column[i] += missed * s;
            }
        }
    }

    /// The quadratic expansion at the point.
    pub(crate) fn quadratic(&self, likelihood: &Likelihood) -> QuadraticModel {
        QuadraticModel {
            held: self.held.clone(),
            ..quadratic(&self.frame, likelihood, &self.point, &self.columns)
        }
    }

    /// Log evidence by Laplace's approximation at the point; `None` where the Hessian is not positive definite.
    ///
    /// The gradient counts only along half-normal coordinates at their bound. Elsewhere it is set to zero: a gain that was predicted
    /// but not reached by a trial step is unbounded far from the mode or at the limits of the search.
    pub(crate) fn log_evidence(&self, likelihood: &Likelihood) -> Option<f64> {
        let quadratic = self.at_mode(likelihood);
        let (position, value) = (&self.point.position, self.point.value);
        mixed_evidence(&self.frame, position, &quadratic, value, MOST_UNREACHED)
    }

    /// The log evidence with the stated priors of the strengths less that with the widened ones; `None` as
    /// [`log_evidence`](Self::log_evidence).
    pub(crate) fn stated_gain(&self, likelihood: &Likelihood) -> Option<f64> {
        let quadratic = self.at_mode(likelihood);
        let (position, value) = (&self.point.position, self.point.value);
        stated_less_mixed(&self.frame, position, &quadratic, value, MOST_UNREACHED)
    }

    fn at_mode(&self, likelihood: &Likelihood) -> QuadraticModel {
        let halves = self.frame.halves();
        let mut quadratic = self.quadratic(likelihood);
        for (k, slope) in quadratic.gradient.iter_mut().enumerate() {
            let is_at_bound = halves.contains(&k) && quadratic.lower[k] >= 0.0 && *slope > 0.0;
            if !is_at_bound {
                *slope = 0.0;
            }
        }
        quadratic
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::likelihood::{Datum, ErrorSd};
    use statistics::prior::{Distribution, Marginal, Prior};

    /// One parameter, and the datum 3 with the sd 1/2.
    fn one_datum(roughness: Roughness) -> (NormalFrame, Likelihood) {
        let prior = Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None).unwrap();
        let datum = Datum {
            run: 0,
            channel: 0,
            value: 3.0,
            sd: ErrorSd::Known(0.5),
        };
        (
            NormalFrame::base(&Prior::new(vec![prior]), roughness),
            Likelihood::new(vec![datum]).unwrap(),
        )
    }

    /// The fit in rounds of a model of that datum from its prior's middle.
    fn fitted(roughness: Roughness, model: impl Fn(f64) -> f64) -> LaplaceFit {
        let (frame, likelihood) = one_datum(roughness);
        let start = FitPoint::new(&frame, &likelihood, vec![0.0], vec![model(0.0)]).unwrap();
        let plan = [FitStep::Rounds { most: 6, trials: 12 }, FitStep::Differences];
        let mut fit = LaplaceFit::new(frame, start, vec![vec![0.0]], &plan);
        loop {
            let asked = fit.ask(&likelihood);
            if asked.is_empty() {
                return fit;
            }
            let answers = asked.iter().map(|position| Some(vec![model(position[0])]));
            fit.tell(&likelihood, answers.collect());
        }
    }

    #[test]
    fn a_derivative_that_was_measured_on_the_model_follows_the_companion() {
        let (frame, likelihood) = one_datum(Roughness::Rough);
        let frame = frame.beside(true);
        // The model has another slope than its companion and the same curvature.
        let companion = |t: f64| t + 0.5 * t * t;
        let model = |t: f64| 2.0 * t + 0.5 * t * t;
        let differences = |mut fit: LaplaceFit| {
            let mut asked_model = 0;
            loop {
                let asked = fit.ask(&likelihood);
                if asked.is_empty() {
                    return (fit, asked_model);
                }
                let is_companion = fit.asks_companion();
                asked_model += if is_companion { 0 } else { asked.len() };
                let of = |t: f64| if is_companion { companion(t) } else { model(t) };
                let answers = asked.iter().map(|position| Some(vec![of(position[0])]));
                fit.tell(&likelihood, answers.collect());
            }
        };
        let at = |t: f64| {
            let point = FitPoint::new(&frame, &likelihood, vec![t], vec![model(t)]).unwrap();
            LaplaceFit::new(frame.clone(), point, vec![vec![0.0]], &[FitStep::Differences])
        };
        let (measured, asked_model) = differences(at(0.0));
        assert_eq!((asked_model, measured.evaluations), (1, 1));
        let (followed, asked_model) = differences(at(1.0).corrected(&measured.corrections));
        assert_eq!((asked_model, followed.evaluations), (0, 0));
        // The forward difference over 0.15 of 2 t + t^2 / 2 at 1.
        assert!(
            (followed.columns[0][0] - 3.075).abs() < 1e-12,
            "{:?}",
            followed.columns
        );
    }

    #[test]
    fn a_rough_fit_whose_steps_all_fail_keeps_the_jacobian_of_its_differences() {
        // A slope of 1 that no step beyond the difference bears out.
        let fit = fitted(Roughness::Rough, |t| if t.abs() < 0.2 { t } else { -t.abs() });
        assert_eq!(fit.point.position, [0.0]);
        assert!((fit.columns[0][0] - 1.0).abs() < 1e-12, "{:?}", fit.columns);
    }

    #[test]
    fn a_step_of_a_rough_fit_that_gains_next_to_nothing_is_taken_and_begins_no_round() {
        // Beyond the difference the log posterior rises by 0.001 in all.
        let level = |t: f64| 3.0 - (0.5 * (18.0 - 0.5 * t * t - 0.001 * t.min(1.0))).sqrt();
        let model = |t: f64| if t < 0.2 { t } else { level(t) };
        let fit = fitted(Roughness::Rough, model);
        assert!(fit.point.position[0] > 0.0, "{:?}", fit.point);
        assert!(fit.evaluations <= 4, "{}", fit.evaluations);
        assert!(fitted(Roughness::Smooth, model).evaluations > 4);
    }
}

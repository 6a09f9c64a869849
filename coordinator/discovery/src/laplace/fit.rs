//! The posterior mode of one model, by damped Gauss-Newton steps with Broyden's update of the Jacobian.

use std::collections::VecDeque;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::{Correction, quotient};
use crate::laplace::noise;
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use crate::laplace::strength_prior::{mixed_evidence, stated_less_mixed};
use crate::settings::Smoothness;
use inference::lm::QuadraticModel;
use statistics::likelihood::Likelihood;

/// Longest finite difference, in standard deviations of the prior; above the shortest it equals the coordinate's current posterior
/// sd. Long differences average over the numerical noise of a model on a grid, short ones resolve a narrow posterior.
const DIFFERENCE: f64 = 0.15;
/// The damping after the first rejected step, and the factor between successive dampings.
const FIRST_DAMPING: f64 = 0.05;
const DAMPING_FACTOR: f64 = 8.0;
/// Limit of a predicted gain that no step has reached, in the evidence `[nats]`.
const MAX_UNREACHED: f64 = 3.0;

/// One step of the plan of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FitStep {
    /// Frees the coordinates that were held.
    Release,
    /// Computes the Jacobian by finite differences: of the low-fidelity model where its correction is known, of the model
    /// elsewhere.
    Differences,
    /// At most this number of trial steps, one evaluation each. After a step that gains, the low-fidelity model, if there is one,
    /// updates the Jacobian.
    Trials(usize),
    /// `Differences` and `Trials(trials)`, repeated at most `max` times, until a new Jacobian predicts no gain, which ends the
    /// plan. With numerical noise a round without a gain ends the plan too, with the Jacobian that its differences gave.
    Rounds { max: usize, trials: usize },
}

/// A fit of one model.
#[derive(Debug, Clone)]
pub(crate) struct LaplaceFit {
    pub(crate) frame: NormalFrame,
    pub(crate) point: FitPoint,
    /// The Jacobian: derivatives of the predicted values, one column for each coordinate.
    pub(crate) columns: Vec<Vec<f64>>,
    /// Correction of each column that was measured on the model; the low-fidelity model is a control variate of the differences.
    pub(crate) corrections: Vec<Option<Correction>>,
    /// Whether a [`FitStep::Differences`] may compute the column by the low-fidelity model, because an earlier fit of nearly the
    /// same parameters measured its correction. A correction that this fit measures holds only at the point of its measurement.
    reuses_correction: Vec<bool>,
    /// Evaluations of the model, without those of the low-fidelity model.
    pub(crate) evaluations: usize,
    plan: VecDeque<FitStep>,
    damping: f64,
    failures: usize,
    /// Coordinates that are fixed until a [`FitStep::Release`].
    held: Vec<bool>,
    progress: Progress,
    /// Whether the point has moved since the last differences.
    has_moved: bool,
    /// Whether the model rejected the last trial position.
    pub(crate) is_at_rejection: bool,
    /// The low-fidelity derivatives at the point, where they were just computed.
    low_fidelity: Vec<Option<Vec<f64>>>,
    pending: Pending,
}

/// The outcome of the trial steps since the last [`FitStep::Rounds`] began a round.
#[derive(Debug, Clone)]
enum Progress {
    /// No step was tried yet.
    Untried,
    /// Steps were tried and none has gained; the Jacobian is that of the round's differences, before its updates by the steps.
    Stuck { jacobian: Vec<Vec<f64>> },
    /// A step has gained, or no round has begun.
    Gained,
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
    /// Low-fidelity predictions at each offset and at the point.
    LowFidelity {
        offsets: Vec<Offset>,
        purpose: Purpose,
    },
    /// Predictions of the model at each offset.
    Differences {
        offsets: Vec<Offset>,
        attempt: Attempt,
    },
    /// A trial position and its predicted gain.
    Trial {
        position: Vec<f64>,
        predicted: f64,
    },
}

/// Index of a coordinate and the length of its difference.
type Offset = (usize, f64);

/// The use of derivatives of the low-fidelity model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// A full Jacobian; the model is asked for the columns without a correction to reuse.
    Jacobian,
    /// An update of the columns after a step; the model is asked for nothing.
    Update,
}

/// A difference that the model rejects is attempted a second time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Attempt {
    First,
    OppositeSign,
}

impl LaplaceFit {
    pub(crate) fn new(frame: NormalFrame, point: FitPoint, columns: Vec<Vec<f64>>, plan: &[FitStep]) -> Self {
        Self {
            held: vec![false; frame.dimension()],
            corrections: vec![None; frame.dimension()],
            reuses_correction: vec![false; frame.dimension()],
            low_fidelity: Vec::new(),
            frame,
            point,
            columns,
            evaluations: 0,
            plan: plan.iter().copied().collect(),
            damping: 0.0,
            failures: 0,
            progress: Progress::Gained,
            has_moved: false,
            is_at_rejection: false,
            pending: Pending::Nothing,
        }
    }

    /// Returns this fit continued with another plan.
    pub(crate) fn continued(&self, plan: &[FitStep]) -> Self {
        self.measured_again(plan).corrected(&self.corrections)
    }

    /// Returns this fit continued with another plan, without its corrections: all differences are measured on the model again.
    pub(crate) fn measured_again(&self, plan: &[FitStep]) -> Self {
        Self::new(self.frame.clone(), self.point.clone(), self.columns.clone(), plan)
    }

    /// Returns this fit with the corrections of a fit of the same model, or of one that it extends.
    pub(crate) fn corrected(mut self, corrections: &[Option<Correction>]) -> Self {
        self.corrections[..corrections.len()].clone_from_slice(corrections);
        let is_local =
            |slot: &Option<Correction>| slot.as_ref().is_some_and(|correction| !correction.is_secant);
        self.reuses_correction = self.corrections.iter().map(is_local).collect();
        self
    }

    /// Returns whether the positions that it asked for last are to be evaluated by the low-fidelity model.
    pub(crate) fn asks_low_fidelity(&self) -> bool {
        matches!(self.pending, Pending::LowFidelity { .. })
    }

    /// Fixes coordinates until a [`FitStep::Release`].
    pub(crate) fn hold(&mut self, coordinates: impl Iterator<Item = usize>) {
        for k in coordinates {
            self.held[k] = true;
        }
    }

    pub(crate) fn theta(&self) -> Vec<f64> {
        self.frame.theta(&self.point.position)
    }

    /// Returns the positions to evaluate next; none once the plan is complete.
    pub(crate) fn ask(&mut self, likelihood: &Likelihood) -> Vec<Vec<f64>> {
        if let Pending::Differences { offsets, .. } = &self.pending {
            return self.positions(offsets);
        }
        while let Some(step) = self.plan.pop_front() {
            match step {
                FitStep::Release => {
                    self.held.fill(false);
                    self.reset_damping();
                }
                FitStep::Differences => {
                    let offsets = self.offsets(likelihood);
                    return self.ask_differences(offsets, Purpose::Jacobian);
                }
                FitStep::Rounds { max: 0, .. } | FitStep::Trials(0) => {}
                FitStep::Rounds { max, trials } => {
                    let max = max - 1;
                    self.plan.push_front(FitStep::Rounds { max, trials });
                    self.plan.push_front(FitStep::Trials(trials));
                    self.plan.push_front(FitStep::Differences);
                    self.progress = Progress::Untried;
                }
                FitStep::Trials(left)
                    if self.frame.has_low_fidelity && std::mem::take(&mut self.has_moved) =>
                {
                    self.plan.push_front(FitStep::Trials(left));
                    let offsets = self.offsets(likelihood);
                    if offsets.iter().all(|(k, _)| self.corrections[*k].is_some()) {
                        return self.ask_differences(offsets, Purpose::Update);
                    }
                }
                FitStep::Trials(left) => {
                    if let Some((position, predicted)) = self.trial(likelihood) {
                        self.plan.push_front(FitStep::Trials(left - 1));
                        return self.ask_trial(position, predicted);
                    }
                    self.end_trials();
                }
            }
        }
        Vec::new()
    }

    fn ask_trial(&mut self, position: Vec<f64>, predicted: f64) -> Vec<Vec<f64>> {
        if let Progress::Untried = self.progress {
            self.progress = Progress::Stuck {
                jacobian: self.columns.clone(),
            };
        }
        self.pending = Pending::Trial {
            position: position.clone(),
            predicted,
        };
        vec![position]
    }

    /// Ends the trial steps of a round, and the whole plan if the round has gained nothing.
    fn end_trials(&mut self) {
        self.reset_damping();
        let is_noisy = self.frame.smoothness != Smoothness::Smooth;
        match &mut self.progress {
            Progress::Untried => self.plan.clear(),
            // The evidence needs the derivatives at the point. The failed steps have replaced them by slopes to the trial
            // positions.
            Progress::Stuck { jacobian } if is_noisy => {
                self.columns = std::mem::take(jacobian);
                self.plan.clear();
            }
            Progress::Stuck { .. } | Progress::Gained => {}
        }
    }

    fn reset_damping(&mut self) {
        self.damping = 0.0;
        self.failures = 0;
    }

    /// Returns the difference of each coordinate that the predictions depend on and that is not held.
    fn offsets(&self, likelihood: &Likelihood) -> Vec<Offset> {
        let (_, upper) = self.frame.room(&self.point.position);
        let uncertainty = self.quadratic(likelihood).uncertainty();
        let offset = |k: usize| {
            let length = uncertainty[k].unwrap_or(DIFFERENCE);
            let length = length.clamp(self.frame.smoothness.min_difference(), DIFFERENCE);
            if upper[k] >= length { length } else { -length }
        };
        let noise_sds = noise::coordinates(likelihood);
        let is_noise_sd = |k: usize| noise_sds.iter().any(|(sd, _)| *sd == k);
        (0..self.frame.dimension())
            .filter(|k| !is_noise_sd(*k) && !self.held[*k])
            .map(|k| (k, offset(k)))
            .collect()
    }

    fn ask_differences(&mut self, offsets: Vec<Offset>, purpose: Purpose) -> Vec<Vec<f64>> {
        let mut positions = self.positions(&offsets);
        self.pending = if self.frame.has_low_fidelity {
            positions.push(self.point.position.clone());
            Pending::LowFidelity { offsets, purpose }
        } else {
            Pending::Differences {
                offsets,
                attempt: Attempt::First,
            }
        };
        self.has_moved = false;
        positions
    }

    fn positions(&self, offsets: &[Offset]) -> Vec<Vec<f64>> {
        let moved = |&(k, offset): &Offset| {
            let mut position = self.point.position.clone();
            position[k] += offset;
            position
        };
        offsets.iter().map(moved).collect()
    }

    /// Returns the next trial position and its predicted gain; `None` where no step is worth an evaluation.
    fn trial(&self, likelihood: &Likelihood) -> Option<(Vec<f64>, f64)> {
        if self.failures >= self.frame.smoothness.max_failures() {
            return None;
        }
        let quadratic = self.quadratic(likelihood);
        let step = quadratic.step(self.damping)?;
        let predicted = quadratic.decrease(&step);
        let pairs = self.point.position.iter().zip(&step);
        (predicted > self.frame.smoothness.min_gain())
            .then(|| (pairs.map(|(t, by)| t + by).collect(), predicted))
    }

    /// Takes the predicted values at the positions of [`ask`](Self::ask); `None` where the model rejected one.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        if !self.asks_low_fidelity() {
            self.evaluations += answers.len();
        }
        match std::mem::replace(&mut self.pending, Pending::Nothing) {
            Pending::Nothing => {}
            Pending::LowFidelity { offsets, purpose } => self.take_low_fidelity(offsets, purpose, answers),
            Pending::Differences { offsets, attempt } => self.take_differences(offsets, attempt, answers),
            Pending::Trial { position, predicted } => {
                let values = answers.into_iter().flatten().next();
                self.take_trial(likelihood, position, predicted, values);
            }
        }
    }

    /// Takes the predictions of the low-fidelity model: a column with a known correction is the derivative of the low-fidelity
    /// model plus that correction. For a full Jacobian, the differences of all other columns are evaluated by the model next.
    fn take_low_fidelity(
        &mut self,
        offsets: Vec<Offset>,
        purpose: Purpose,
        mut answers: Vec<Option<Vec<f64>>>,
    ) {
        let at_point = answers.pop().flatten();
        self.low_fidelity = vec![None; self.frame.dimension()];
        for ((k, offset), answer) in offsets.iter().zip(answers) {
            let pair = answer.as_ref().zip(at_point.as_ref());
            self.low_fidelity[*k] = pair.map(|(values, at_point)| quotient(values, at_point, *offset));
        }
        let mut unknown = Vec::new();
        for (k, offset) in offsets {
            let is_update = purpose == Purpose::Update;
            match (&self.low_fidelity[k], &self.corrections[k]) {
                (Some(derivative), Some(correction)) if is_update || self.reuses_correction[k] => {
                    self.columns[k] = correction.applied_to(derivative);
                }
                _ if is_update => {}
                _ => unknown.push((k, offset)),
            }
        }
        if !unknown.is_empty() {
            self.pending = Pending::Differences {
                offsets: unknown,
                attempt: Attempt::First,
            };
        }
    }

    /// Computes columns from predictions of the model. A difference that the model rejects is attempted once more with the opposite
    /// sign; if the model rejects it again, the column keeps its value.
    fn take_differences(&mut self, offsets: Vec<Offset>, attempt: Attempt, answers: Vec<Option<Vec<f64>>>) {
        let (lower, upper) = self.frame.room(&self.point.position);
        let is_first = attempt == Attempt::First;
        let mut rejected = Vec::new();
        for ((k, offset), answer) in offsets.into_iter().zip(answers) {
            match answer {
                Some(values) => {
                    self.columns[k] = quotient(&values, &self.point.values, offset);
                    // The low-fidelity model was evaluated at the offset of the first attempt.
                    if let Some(Some(derivative)) = self.low_fidelity.get(k).filter(|_| is_first) {
                        let correction = Correction::between(&self.columns[k], derivative, false);
                        self.corrections[k] = Some(correction);
                    }
                }
                None if is_first && (lower[k]..=upper[k]).contains(&-offset) => rejected.push((k, -offset)),
                None => {}
            }
        }
        if !rejected.is_empty() {
            self.pending = Pending::Differences {
                offsets: rejected,
                attempt: Attempt::OppositeSign,
            };
        }
    }

    /// Moves to a trial position if it is more probable, and adapts the damping.
    fn take_trial(
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
        self.is_at_rejection = values.is_none();
        if let Some(values) = &values {
            self.update_jacobian(&step, values);
        }
        let reached = values.and_then(|v| FitPoint::new(&self.frame, likelihood, position, v));
        match reached {
            Some(point) if point.value < self.point.value => {
                let gain = self.point.value - point.value;
                self.point = point;
                self.has_moved = true;
                if gain < self.frame.smoothness.min_counted_gain() {
                    return self.fail();
                }
                self.failures = 0;
                self.progress = Progress::Gained;
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

    /// Applies Broyden's update: the smallest change of the Jacobian that reproduces the values at the new position.
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

    pub(crate) fn quadratic(&self, likelihood: &Likelihood) -> QuadraticModel {
        QuadraticModel {
            held: self.held.clone(),
            ..quadratic(&self.frame, likelihood, &self.point, &self.columns)
        }
    }

    /// Returns the log evidence by Laplace's approximation at the point; `None` where the Hessian is not positive definite.
    ///
    /// The gradient counts only along half-normal coordinates at their bound. Elsewhere it is set to zero: a gain that was
    /// predicted but not reached by a trial step is unbounded far from the mode or at the limits of the search.
    pub(crate) fn log_evidence(&self, likelihood: &Likelihood) -> Option<f64> {
        let quadratic = self.at_mode(likelihood);
        let (position, value) = (&self.point.position, self.point.value);
        mixed_evidence(&self.frame, position, &quadratic, value, MAX_UNREACHED, 1.0)
    }

    /// Returns the log evidence with the stated priors of the strengths less that with the widened ones; `None` if the Hessian is
    /// not positive definite.
    pub(crate) fn stated_gain(&self, likelihood: &Likelihood) -> Option<f64> {
        let quadratic = self.at_mode(likelihood);
        let (position, value) = (&self.point.position, self.point.value);
        stated_less_mixed(&self.frame, position, &quadratic, value, MAX_UNREACHED)
    }

    /// The log evidence with the widths of all strengths' priors multiplied by a factor, less that with the priors of the search; `None`
    /// if the Hessian is not positive definite.
    pub(crate) fn gain_by_width(&self, likelihood: &Likelihood, width: f64) -> Option<f64> {
        let quadratic = self.at_mode(likelihood);
        let (position, value) = (&self.point.position, self.point.value);
        let evidence =
            |width: f64| mixed_evidence(&self.frame, position, &quadratic, value, MAX_UNREACHED, width);
        Some(evidence(width)? - evidence(1.0)?)
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
    fn one_datum(smoothness: Smoothness) -> (NormalFrame, Likelihood) {
        let prior = Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None).unwrap();
        let datum = Datum {
            run: 0,
            channel: 0,
            value: 3.0,
            sd: ErrorSd::Known(0.5),
        };
        (
            NormalFrame::base(&Prior::new(vec![prior]), smoothness),
            Likelihood::new(vec![datum]).unwrap(),
        )
    }

    /// A fit of the model to that datum, in rounds from the prior's mean.
    fn fitted(smoothness: Smoothness, model: impl Fn(f64) -> f64) -> LaplaceFit {
        let (frame, likelihood) = one_datum(smoothness);
        let start = FitPoint::new(&frame, &likelihood, vec![0.0], vec![model(0.0)]).unwrap();
        let plan = [FitStep::Rounds { max: 6, trials: 12 }, FitStep::Differences];
        let mut fit = LaplaceFit::new(frame, start, vec![vec![0.0]], &plan);
        loop {
            let requests = fit.ask(&likelihood);
            if requests.is_empty() {
                return fit;
            }
            let answers = requests.iter().map(|position| Some(vec![model(position[0])]));
            fit.tell(&likelihood, answers.collect());
        }
    }

    #[test]
    fn a_derivative_that_was_measured_on_the_model_follows_the_low_fidelity_model() {
        let (frame, likelihood) = one_datum(Smoothness::Rough);
        let frame = frame.with_low_fidelity(true);
        // The low-fidelity model has another slope and the same curvature.
        let low_fidelity = |t: f64| t + 0.5 * t * t;
        let model = |t: f64| 2.0 * t + 0.5 * t * t;
        let differences = |mut fit: LaplaceFit| {
            let mut asked_model = 0;
            loop {
                let requests = fit.ask(&likelihood);
                if requests.is_empty() {
                    return (fit, asked_model);
                }
                let is_low_fidelity = fit.asks_low_fidelity();
                asked_model += if is_low_fidelity { 0 } else { requests.len() };
                let value = |t: f64| {
                    if is_low_fidelity {
                        low_fidelity(t)
                    } else {
                        model(t)
                    }
                };
                let answers = requests.iter().map(|position| Some(vec![value(position[0])]));
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
        // The difference sees a slope of 1; longer steps lead downwards.
        let fit = fitted(Smoothness::Rough, |t| if t.abs() < 0.2 { t } else { -t.abs() });
        assert_eq!(fit.point.position, [0.0]);
        assert!((fit.columns[0][0] - 1.0).abs() < 1e-12, "{:?}", fit.columns);
    }

    #[test]
    fn a_step_of_a_rough_fit_that_gains_next_to_nothing_is_taken_and_begins_no_round() {
        // Beyond the difference the log posterior rises by 0.001 in all.
        let level = |t: f64| 3.0 - (0.5 * (18.0 - 0.5 * t * t - 0.001 * t.min(1.0))).sqrt();
        let model = |t: f64| if t < 0.2 { t } else { level(t) };
        let fit = fitted(Smoothness::Rough, model);
        assert!(fit.point.position[0] > 0.0, "{:?}", fit.point);
        assert!(fit.evaluations <= 4, "{}", fit.evaluations);
        assert!(fitted(Smoothness::Smooth, model).evaluations > 4);
    }
}

//! Follow a parabola to its least, learning from every step: Levenberg, Marquardt and Broyden.

use std::collections::VecDeque;

use nalgebra::DMatrix;

use crate::coordinate::Frame;
use crate::evidence::log_evidence;
use crate::noise;
use inference::lm::QuadraticModel;
use statistics::likelihood::Likelihood;
use statistics::log_likelihood::LogLikelihood;

/// Longest step of a difference, in standard deviations of the prior; down to the shortest it is as long as the coordinate is
/// uncertain by what is known so far. Long steps survive the noise of a model on a grid, short ones follow a sharp valley.
const DIFFERENCE: f64 = 0.15;
/// A step that gains, or promises, less than this ends the trials `[nats]`: far below what a Bayes factor is read to.
const LEAST_GAIN: f64 = 0.01;
/// The damping after the first step without gain, and how dampings follow each other.
const FIRST_DAMPING: f64 = 0.05;
const SPREAD: f64 = 8.0;
/// Steps without gain in a row that end the trials.
const MOST_FAILURES: usize = 4;

/// An evaluated position.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    pub(crate) position: Vec<f64>,
    pub(crate) values: Vec<f64>,
    /// `-log-likelihood + |t|^2/2`, in nats.
    pub(crate) value: f64,
}

impl Point {
    /// `None` where the data are impossible.
    pub(crate) fn new(
        frame: &Frame,
        likelihood: &Likelihood,
        position: Vec<f64>,
        values: Vec<f64>,
    ) -> Option<Self> {
        let theta = frame.theta(&position);
        let Ok(LogLikelihood::Finite(nats)) = likelihood.log_likelihood(&values, &theta) else {
            return None;
        };
        let squares: f64 = position.iter().map(|t| t * t).sum();
        Some(Self {
            value: 0.5 * squares - nats.get(),
            position,
            values,
        })
    }

    /// ln p(data | t).
    pub(crate) fn log_likelihood(&self) -> f64 {
        let squares: f64 = self.position.iter().map(|t| t * t).sum();
        0.5 * squares - self.value
    }
}

/// What a descent does, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// Coordinates that were held move from here on.
    Release,
    /// A fresh Jacobian.
    Differences,
    /// At most so many steps, each an evaluation.
    Trials(usize),
    /// A fresh Jacobian and at most so many steps, so many times: until one promises nothing more.
    Rounds { most: usize, trials: usize },
}

/// A fit of one model.
#[derive(Debug, Clone)]
pub(crate) struct Descent {
    pub(crate) frame: Frame,
    pub(crate) point: Point,
    /// Change of every predicted value along each coordinate.
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) evaluations: usize,
    plan: VecDeque<Step>,
    damping: f64,
    failures: usize,
    /// Coordinates that do not move.
    held: Vec<bool>,
    /// No step was tried since the Jacobian of a round.
    is_fresh: bool,
    asked: Asked,
}

#[derive(Debug, Clone)]
enum Asked {
    Nothing,
    /// Coordinate and offset of each difference; whether they were asked for to the other side before.
    Differences(Vec<(usize, f64)>, bool),
    /// What the step is to gain.
    Trial {
        position: Vec<f64>,
        promised: f64,
    },
}

impl Descent {
    pub(crate) fn new(frame: Frame, point: Point, columns: Vec<Vec<f64>>, plan: &[Step]) -> Self {
        Self {
            held: vec![false; frame.dimension()],
            frame,
            point,
            columns,
            evaluations: 0,
            plan: plan.iter().copied().collect(),
            damping: 0.0,
            failures: 0,
            is_fresh: false,
            asked: Asked::Nothing,
        }
    }

    /// Lets some coordinates stay where they are until they are released.
    pub(crate) fn hold(&mut self, coordinates: impl Iterator<Item = usize>) {
        for k in coordinates {
            self.held[k] = true;
        }
    }

    /// The positions to be evaluated next; none when the plan is done.
    pub(crate) fn ask(&mut self, likelihood: &Likelihood) -> Vec<Vec<f64>> {
        if let Asked::Differences(again, _) = &self.asked {
            return self.offset(again);
        }
        while let Some(step) = self.plan.pop_front() {
            match step {
                Step::Release => {
                    self.held.fill(false);
                    self.damping = 0.0;
                    self.failures = 0;
                }
                Step::Differences => {
                    let (_, upper) = self.frame.room(&self.point.position);
                    let uncertainty = self.parabola(likelihood).uncertainty();
                    let offset = |k: usize| {
                        let length = uncertainty[k].unwrap_or(DIFFERENCE);
                        let length = length.clamp(self.frame.least_difference.min(DIFFERENCE), DIFFERENCE);
                        if upper[k] >= length { length } else { -length }
                    };
                    // Noise changes no prediction.
                    let noise = noise::coordinates(likelihood);
                    let is_noise = |k: usize| noise.iter().any(|(own, _)| *own == k);
                    let wanted: Vec<(usize, f64)> = (0..self.frame.dimension())
                        .filter(|k| !is_noise(*k) && !self.held[*k])
                        .map(|k| (k, offset(k)))
                        .collect();
                    let positions = self.offset(&wanted);
                    self.asked = Asked::Differences(wanted, false);
                    return positions;
                }
                Step::Rounds { most: 0, .. } | Step::Trials(0) => {}
                Step::Rounds { most, trials } => {
                    let most = most - 1;
                    self.plan.push_front(Step::Rounds { most, trials });
                    self.plan.push_front(Step::Trials(trials));
                    self.plan.push_front(Step::Differences);
                    self.is_fresh = true;
                }
                Step::Trials(left) => {
                    if let Some((position, promised)) = self.trial(likelihood) {
                        self.plan.push_front(Step::Trials(left - 1));
                        self.is_fresh = false;
                        self.asked = Asked::Trial {
                            position: position.clone(),
                            promised,
                        };
                        return vec![position];
                    }
                    self.damping = 0.0;
                    self.failures = 0;
                    if self.is_fresh {
                        self.plan.clear();
                    }
                }
            }
        }
        Vec::new()
    }

    fn offset(&self, wanted: &[(usize, f64)]) -> Vec<Vec<f64>> {
        let moved = |&(k, offset): &(usize, f64)| {
            let mut position = self.point.position.clone();
            position[k] += offset;
            position
        };
        wanted.iter().map(moved).collect()
    }

    /// The next step and what it promises; `None` where no step is worth an evaluation.
    fn trial(&self, likelihood: &Likelihood) -> Option<(Vec<f64>, f64)> {
        if self.failures >= MOST_FAILURES {
            return None;
        }
        let parabola = self.parabola(likelihood);
        let step = parabola.step(self.damping)?;
        let promised = parabola.decrease(&step);
        let pairs = self.point.position.iter().zip(&step);
        (promised > LEAST_GAIN).then(|| (pairs.map(|(t, by)| t + by).collect(), promised))
    }

    /// Takes the predicted values at the positions asked for; `None` where the model refused.
    pub(crate) fn tell(&mut self, likelihood: &Likelihood, answers: Vec<Option<Vec<f64>>>) {
        self.evaluations += answers.len();
        match std::mem::replace(&mut self.asked, Asked::Nothing) {
            Asked::Nothing => {}
            Asked::Differences(wanted, again) => self.after_differences(wanted, again, answers),
            Asked::Trial { position, promised } => {
                self.after_trial(
                    likelihood,
                    position,
                    promised,
                    answers.into_iter().flatten().next(),
                );
            }
        }
    }

    /// A difference that the model refused is asked for once more, to the other side; then the old column stays.
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
                    let pairs = values.iter().zip(&self.point.values);
                    self.columns[k] = pairs.map(|(x, m)| (x - m) / offset).collect();
                }
                None if !is_second && (lower[k]..=upper[k]).contains(&-offset) => again.push((k, -offset)),
                None => {}
            }
        }
        if !again.is_empty() {
            self.asked = Asked::Differences(again, true);
        }
    }

    fn after_trial(
        &mut self,
        likelihood: &Likelihood,
        position: Vec<f64>,
        promised: f64,
        values: Option<Vec<f64>>,
    ) {
        let step: Vec<f64> = position
            .iter()
            .zip(&self.point.position)
            .map(|(a, b)| a - b)
            .collect();
        if let Some(values) = &values {
            self.learn(&step, values);
        }
        let reached = values.and_then(|v| Point::new(&self.frame, likelihood, position, v));
        match reached {
            Some(point) if point.value < self.point.value => {
                let gain = self.point.value - point.value;
                self.failures = 0;
                self.damping = if gain > 0.5 * promised && self.damping <= FIRST_DAMPING {
                    0.0
                } else {
                    self.damping / SPREAD
                };
                self.point = point;
            }
            _ => {
                self.failures += 1;
                self.damping = (SPREAD * self.damping).max(FIRST_DAMPING);
            }
        }
    }

    /// Broyden's update: the least change of the Jacobian that explains what a step did.
    fn learn(&mut self, step: &[f64], values: &[f64]) {
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

    /// The parabola of f at the point.
    pub(crate) fn parabola(&self, likelihood: &Likelihood) -> QuadraticModel {
        QuadraticModel {
            held: self.held.clone(),
            ..parabola(&self.frame, likelihood, &self.point, &self.columns)
        }
    }

    /// ln evidence by the parabola at the point; `None` where it has no least.
    ///
    /// A slope is left only where a half-normal coordinate is at its bound. What a parabola promises beyond the steps that were tried
    /// is not counted: far from the least, or at the end of what is looked at, it has no end.
    pub(crate) fn log_evidence(&self, likelihood: &Likelihood) -> Option<f64> {
        let halves = self.frame.halves();
        let mut parabola = self.parabola(likelihood);
        for (k, slope) in parabola.gradient.iter_mut().enumerate() {
            let is_at_bound = halves.contains(&k) && parabola.lower[k] >= 0.0 && *slope > 0.0;
            if !is_at_bound {
                *slope = 0.0;
            }
        }
        log_evidence(&parabola, self.point.value, &halves)
    }
}

/// The parabola of `-log-likelihood + |t|^2/2` with these derivatives of the predicted values.
pub(crate) fn parabola(
    frame: &Frame,
    likelihood: &Likelihood,
    point: &Point,
    columns: &[Vec<f64>],
) -> QuadraticModel {
    let count = point.position.len();
    let mut gradient = point.position.clone();
    let mut hessian = DMatrix::identity(count, count);
    // What cannot be whitened has no finite f, and so is no point.
    if let Ok(whitening) = likelihood.whitening(&point.values, &frame.theta(&point.position)) {
        let scaled: Vec<Vec<f64>> = columns.iter().map(|column| whitening.apply(column)).collect();
        for k in 0..count {
            gradient[k] -= whitening.slope(&scaled[k]);
            for l in 0..count {
                hessian[(k, l)] += whitening.curvature(&scaled[k], &scaled[l]);
            }
        }
    }
    noise::add(frame, likelihood, point, &mut gradient, &mut hessian);
    let (lower, upper) = frame.room(&point.position);
    QuadraticModel {
        gradient,
        hessian,
        lower,
        upper,
        held: vec![false; count],
    }
}

//! Formulas of a located law, fitted through the equations of motion and weighed there.

use std::sync::Arc;

use equation::{FormulaLibrary, FormulaText, Tree, search};
use nalgebra::{DMatrix, DVector};

use super::dynamic_system::{DynamicSystem, Experiment};
use super::grouping::{classes, is_within};
use super::least_squares::{Coordinate, fit};
use super::located_law::LocatedLaw;
use super::parametric_law::ParametricLaw;

/// Formulas that are fitted through the equations of motion, the most probable by the curve.
const FITTED: usize = 60;
/// The number of damped steps of a fit.
const STEPS: usize = 15;
/// The step of a derivative by a coordinate, over the coordinate's sd.
const STEP: f64 = 0.01;
/// Points at which formulas are compared.
const POINTS: usize = 41;

/// A formula that was fitted through the equations of motion.
#[derive(Debug, Clone)]
pub struct WeighedFormula {
    pub tree: Arc<Tree>,
    /// The formula with its fitted values.
    pub text: String,
    law: ParametricLaw,
    /// Coordinates of the law, then the parameters of the system.
    place: Vec<f64>,
    covariance: DMatrix<f64>,
    pub probability: f64,
    /// Number of its class, from 0.
    pub class: usize,
}

impl WeighedFormula {
    /// Returns the law at a value of the variable.
    pub fn value(&self, at: f64) -> f64 {
        self.law.value(&self.law.constants(&self.place), at)
    }

    /// Returns the fitted parameters of the system.
    pub fn parameters(&self) -> &[f64] {
        &self.place[self.law.count()..]
    }

    fn predict(&self, system: &DynamicSystem, place: &[f64], experiment: &Experiment) -> Option<Vec<f64>> {
        let (law, parameters) = place.split_at(self.law.count());
        let constants = self.law.constants(law);
        system.predict(|x| self.law.value(&constants, x), parameters, experiment)
    }

    /// Returns the values that it predicts for an experiment, and their covariance by its constants and parameters, linearised; `None`
    /// where a prediction is not finite.
    pub fn prediction(
        &self,
        system: &DynamicSystem,
        experiment: &Experiment,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let mean = self.predict(system, &self.place, experiment)?;
        let mut slopes = DMatrix::zeros(mean.len(), self.place.len());
        for k in 0..self.place.len() {
            let step = STEP * self.covariance[(k, k)].sqrt();
            let mut moved = self.place.clone();
            moved[k] += step;
            let there = self.predict(system, &moved, experiment)?;
            there
                .iter()
                .zip(&mean)
                .enumerate()
                .for_each(|(i, (a, b))| slopes[(i, k)] = (a - b) / step);
        }
        let covariance = &slopes * &self.covariance * slopes.transpose();
        Some((DVector::from_vec(mean), covariance))
    }
}

/// Searches the formulas of a law's curve, and weighs the leading ones through the equations of motion, the most probable first.
///
/// The likelihood of a fit there stands in place of the curve's. The prior of a formula, and the volume of its constants, are those of
/// the curve.
pub fn weighed(
    system: &DynamicSystem,
    experiments: &[Experiment],
    law: &LocatedLaw,
    library: &FormulaLibrary,
) -> Vec<WeighedFormula> {
    let answer = search(&law.curve, library);
    let mut fitted = Vec::new();
    for formula in answer.formulas.iter().take(FITTED) {
        let mut text = FormulaText::new(&law.curve, formula, "0", "x");
        let Some((candidate, begin)) = ParametricLaw::new(&text) else {
            continue;
        };
        let free = begin.iter().map(|x| Coordinate {
            mean: *x,
            sd: f64::INFINITY,
            scale: x.abs().max(0.01),
        });
        let coordinates: Vec<Coordinate> = free.chain(system.coordinates()).collect();
        let start = begin.iter().chain(&law.parameters).copied().collect();
        let reached = fit(&coordinates, start, STEPS, |place| {
            let (free, parameters) = place.split_at(begin.len());
            let constants = candidate.constants(free);
            system.residuals(|x| candidate.value(&constants, x), parameters, experiments)
        });
        // A constant that nothing determines makes the matrix singular.
        let Some((reached, root)) = reached.and_then(|r| Some((r.clone(), r.hessian.cholesky()?))) else {
            continue;
        };
        let constants = candidate.constants(&reached.place[..begin.len()]);
        let pairs = text.parameters.iter_mut().zip(constants);
        pairs.for_each(|(parameter, value)| parameter.value = value);
        fitted.push(WeighedFormula {
            tree: formula.tree.clone(),
            text: text.with_values(3).trim_start_matches("0 + ").to_owned(),
            law: candidate,
            place: reached.place,
            covariance: root.inverse(),
            probability: libm::log(formula.probability) + formula.misfit - reached.objective,
            class: 0,
        });
    }
    normalised(&mut fitted);
    classified(law, &mut fitted);
    fitted
}

/// Turns log weights into probabilities, the highest first.
fn normalised(fitted: &mut [WeighedFormula]) {
    fitted.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let best = fitted.first().map_or(0.0, |formula| formula.probability);
    let weights = fitted.iter_mut().map(|formula| {
        formula.probability = libm::exp(formula.probability - best);
        formula.probability
    });
    let sum: f64 = weights.sum();
    fitted.iter_mut().for_each(|formula| formula.probability /= sum);
}

/// Groups formulas that the curve cannot tell apart: a formula joins the first class whose best it resembles.
fn classified(law: &LocatedLaw, fitted: &mut [WeighedFormula]) {
    let [low, high] = law.curve.range();
    let share = |i: usize| i as f64 / (POINTS - 1) as f64;
    let points: Vec<f64> = (0..POINTS).map(|i| low + (high - low) * share(i)).collect();
    let sds: Vec<f64> = points.iter().map(|x| law.curve.sd(*x)).collect();
    let of_points = |formula: &WeighedFormula| points.iter().map(|x| formula.value(*x)).collect();
    let values: Vec<Vec<f64>> = fitted.iter().map(of_points).collect();
    let joined = classes(fitted.len(), |a, b| is_within(&sds, &values[a], &values[b]));
    let pairs = fitted.iter_mut().zip(joined);
    pairs.for_each(|(formula, class)| formula.class = class);
}

/// Returns the probability of each class.
pub fn class_probabilities(fitted: &[WeighedFormula]) -> Vec<f64> {
    let count = fitted.iter().map(|formula| formula.class + 1).max().unwrap_or(0);
    let of_class = |class: usize| {
        let members = fitted.iter().filter(|formula| formula.class == class);
        members.map(|formula| formula.probability).sum()
    };
    (0..count).map(of_class).collect()
}

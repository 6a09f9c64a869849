//! The experiment that is expected to separate the leading classes of formulas.

use nalgebra::DMatrix;

use super::dynamic_system::{DynamicSystem, Experiment};
use super::weighed::WeighedFormula;

/// Classes that are compared, the most probable.
const CLASSES: usize = 5;

/// Returns the index of the experiment that separates the classes best; `None` without an experiment.
///
/// The separation of two classes is the squared distance of the predictions of their best formulas, by the covariance of measurements and
/// of both formulas' constants (Buzzi-Ferraris and Forzatti 1984), so that what other constants would explain does not count.
/// Pairs are weighed by the root of the product of their probabilities, and a distance counts by its logarithm.
pub fn best(
    system: &DynamicSystem,
    formulas: &[WeighedFormula],
    experiments: &[Experiment],
) -> Option<usize> {
    let mut leaders: Vec<&WeighedFormula> = Vec::new();
    for formula in formulas {
        if leaders.len() < CLASSES && leaders.iter().all(|leader| leader.class != formula.class) {
            leaders.push(formula);
        }
    }
    let score = |experiment: &Experiment| -> f64 {
        let predicted = leaders.iter().filter_map(|formula| {
            let (mean, covariance) = formula.prediction(system, experiment)?;
            Some((formula.probability, mean, covariance))
        });
        let predicted: Vec<_> = predicted.collect();
        let mut sum = 0.0;
        for (i, (p, a, of_a)) in predicted.iter().enumerate() {
            for (q, b, of_b) in &predicted[..i] {
                let noise = DMatrix::identity(a.len(), a.len()) * (system.sd * system.sd);
                if let Some(root) = (noise + of_a + of_b).cholesky() {
                    let difference = a - b;
                    sum += (p * q).sqrt() * libm::log1p(difference.dot(&root.solve(&difference)));
                }
            }
        }
        sum
    };
    let scores = experiments.iter().map(score).enumerate();
    scores.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}

//! What the difference of two options comes from: model, parameters, errors.

use super::answer::{DecidedBy, ParameterShare};
use super::loss_table::LossTable;
use crate::draw::ERRORS;
use crate::ensemble::Simulated;
use crate::spread::{mean, variance};

/// Number of parameters that are listed.
const LISTED: usize = 3;

/// Returns the shares of the variance of the difference between the losses of two options; `None` if it does not vary.
///
/// By the law of total variance the variance for one run is that of the mean of each model, plus that of the draws within the models, plus
/// that of the errors within the draws. The mean over finitely many errors adds their variance over their number to that of the draws,
/// which is taken off.
pub(super) fn decided_by(
    simulated: &Simulated,
    table: &LossTable,
    option: usize,
    other: usize,
) -> Option<DecidedBy> {
    let parts = Parts::new(table, option, other);
    let total = parts.model + parts.parameters + parts.noise;
    (total > 0.0).then(|| DecidedBy {
        sd: total.sqrt(),
        model: parts.model / total,
        parameters: parts.parameters / total,
        noise: parts.noise / total,
        each: each(simulated, table, option, other),
    })
}

/// The parts of the variance of a difference.
#[derive(Debug, Clone, Copy)]
struct Parts {
    model: f64,
    parameters: f64,
    noise: f64,
}

impl Parts {
    fn new(table: &LossTable, option: usize, other: usize) -> Parts {
        let rows = || table.losses.iter().zip(&table.weights).zip(&table.draws);
        let mut within = Vec::new();
        let mut differences = Vec::new();
        for ((row, &weight), draw) in rows() {
            let errors: Vec<(f64, f64)> = (0..ERRORS)
                .map(|e| (row[option][e] - row[other][e], 1.0))
                .collect();
            let unbiased = ERRORS as f64 / (ERRORS - 1) as f64;
            within.push((unbiased * variance(&errors).unwrap_or(0.0), weight));
            differences.push((draw.model, mean(&errors).unwrap_or(0.0), weight));
        }
        let noise = mean(&within).unwrap_or(0.0);
        let models = differences
            .iter()
            .map(|(model, _, _)| *model)
            .max()
            .map_or(0, |last| last + 1);
        let of_model = |model: usize| -> Vec<(f64, f64)> {
            let own = differences.iter().filter(|(of, _, _)| *of == model);
            own.map(|&(_, difference, weight)| (difference, weight)).collect()
        };
        let (mut means, mut inside) = (Vec::new(), 0.0);
        for values in (0..models).map(of_model) {
            let weight: f64 = values.iter().map(|(_, weight)| weight).sum();
            if let Some((center, spread)) = mean(&values).zip(variance(&values)) {
                means.push((center, weight));
                inside += weight * spread;
            }
        }
        Parts {
            model: variance(&means).unwrap_or(0.0),
            parameters: (inside - noise / ERRORS as f64).max(0.0),
            noise,
        }
    }
}

/// Returns what each parameter of the model with the most weight explains of the mean difference.
fn each(simulated: &Simulated, table: &LossTable, option: usize, other: usize) -> Vec<ParameterShare> {
    let models = simulated.models.iter().enumerate();
    let heaviest = models.reduce(|a, b| if b.1.weight > a.1.weight { b } else { a });
    let Some((model, weighted)) = heaviest else {
        return Vec::new();
    };
    let calibration = &weighted.calibration;
    let thetas = calibration.predictive_draws();
    let own = || {
        let rows = table.draws.iter().zip(&table.means);
        rows.filter(move |(draw, _)| draw.model == model)
    };
    let differences: Vec<f64> = own().map(|(_, row)| row[option] - row[other]).collect();
    let share = |(position, name): (usize, &String)| {
        let values: Vec<f64> = own().map(|(draw, _)| thetas[draw.draw].theta[position]).collect();
        ParameterShare {
            parameter: name.clone(),
            share: squared_correlation(&values, &differences),
        }
    };
    let names: Vec<String> = calibration
        .spec
        .parameters
        .iter()
        .map(|p| p.name.clone())
        .collect();
    let mut shares: Vec<ParameterShare> = names.iter().enumerate().map(share).collect();
    shares.sort_by(|a, b| b.share.total_cmp(&a.share));
    shares.truncate(LISTED);
    shares
}

/// Returns the squared correlation of two samples; 0 if one of them does not vary.
fn squared_correlation(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().max(1) as f64;
    let center = |x: &[f64]| x.iter().sum::<f64>() / count;
    let (mean_a, mean_b) = (center(a), center(b));
    let product = |x: &[f64], y: &[f64], mean_x: f64, mean_y: f64| -> f64 {
        x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum()
    };
    let (both, of_a, of_b) = (
        product(a, b, mean_a, mean_b),
        product(a, a, mean_a, mean_a),
        product(b, b, mean_b, mean_b),
    );
    match of_a > 0.0 && of_b > 0.0 {
        true => both * both / (of_a * of_b),
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::loss_table::tests::table;
    use super::*;

    #[test]
    fn the_parts_of_a_variance_are_told_apart() {
        let mut losses = table(&[[1.0, 0.0], [3.0, 0.0], [11.0, 0.0], [13.0, 0.0]]);
        losses.draws[2].model = 1;
        losses.draws[3].model = 1;
        let parts = Parts::new(&losses, 0, 1);
        assert!((parts.model - 25.0).abs() < 1e-9 && (parts.parameters - 1.0).abs() < 1e-9);
        assert!(parts.noise.abs() < 1e-12);
        for row in &mut losses.losses {
            for (i, loss) in row[0].iter_mut().enumerate() {
                *loss += if i % 2 == 0 { 3.0 } else { -3.0 };
            }
        }
        let noisy = Parts::new(&losses, 0, 1);
        assert!((noisy.noise - 10.0).abs() < 1e-9, "{noisy:?}");
        assert!((noisy.model - 25.0).abs() < 1e-9);
    }

    #[test]
    fn a_parameter_that_moves_the_difference_alone_explains_all_of_it() {
        assert!((squared_correlation(&[1.0, 2.0, 3.0], &[5.0, 3.0, 1.0]) - 1.0).abs() < 1e-12);
        assert!(squared_correlation(&[1.0, 1.0], &[5.0, 3.0]).abs() < 1e-12);
    }
}

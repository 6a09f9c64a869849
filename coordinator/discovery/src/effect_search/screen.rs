//! The screen: the evidence of every candidate by finite steps from the fitted base.

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::evidence::{log_evidence, log_sum_exp};
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use statistics::likelihood::Likelihood;

/// Steps of the strength, in standard deviations of its prior; each is tried where the model rejects the one before.
pub(super) const STRENGTHS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

/// A position with its predicted values; `None` where the model rejected it.
pub(super) type Evaluated = (Vec<f64>, Option<Vec<f64>>);

/// The screen's result for one candidate.
#[derive(Debug, Clone)]
pub(super) struct Screened {
    /// At the best shape. Of several strengths: where they are absent.
    pub(super) point: FitPoint,
    /// Change of the predictions per unit of the strength's coordinate. Of several strengths: that of the linear solution.
    pub(super) change: Vec<f64>,
    /// Derivatives along the candidate's own coordinates, in the order of the frame; zeros for all others.
    pub(super) columns: Vec<Vec<f64>>,
    /// Mean over the shapes.
    pub(super) log_bayes_factor: f64,
}

/// The positions to evaluate: every shape that is tried, or a step along each of several strengths.
pub(super) fn positions(frame: &NormalFrame, base: &[f64], shapes: &[f64], strength: f64) -> Vec<Vec<f64>> {
    let Some((k, neutral)) = frame.strength() else {
        let mut absent = base.to_vec();
        absent.resize(frame.dimension(), 0.0);
        let absent = frame.without(&absent);
        let along = |&(k, neutral): &(usize, f64)| {
            let mut position = absent.clone();
            position[k] = neutral + strength;
            position
        };
        return frame.strengths.iter().map(along).collect();
    };
    let shapes = if frame.dimension() > base.len() + 1 {
        shapes
    } else {
        &shapes[..1]
    };
    let at = |&shape: &f64| {
        let mut position = base.to_vec();
        position.resize(frame.dimension(), shape);
        position[k] = neutral + strength;
        position
    };
    shapes.iter().map(at).collect()
}

/// The screen's result from the evaluated positions.
///
/// # Returns
/// With one strength, the log Bayes factor of the extension linear in it, `s^2 / (2 (I + 1)) - ln(1 + I) / 2` with `I = g' P g` and
/// `s = g' P r` of the change g and the residuals r, P the projection of
/// [`Projection`](crate::effect_search::class::Projection); one-sided strengths truncated. With several, that of the model linear
/// in all of them. `None` if the model rejected all positions of the former, or one of the latter.
pub(super) fn screened(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    match frame.strength() {
        Some(strength) => of_one(frame, strength, base, likelihood, evaluated),
        None => of_several(frame, base, likelihood, evaluated),
    }
}

/// The finite difference of the predicted values over a step.
fn difference(values: &[f64], base: &LaplaceFit, step: f64) -> Vec<f64> {
    let pairs = values.iter().zip(&base.point.values);
    pairs.map(|(with, without)| (with - without) / step).collect()
}

fn of_one(
    frame: &NormalFrame,
    (strength, neutral): (usize, f64),
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    let FittedModel {
        fit: base,
        log_evidence: base_evidence,
    } = base;
    let halves = frame.halves();
    let shapes = || (base.point.position.len()..frame.dimension()).filter(|k| *k != strength);
    let nodes = evaluated.iter().filter_map(|(position, values)| {
        let values = values.clone()?;
        let change = difference(&values, base, position[strength] - neutral);
        let mut columns = base.columns.clone();
        columns.resize(frame.dimension(), vec![0.0; values.len()]);
        columns[strength].clone_from(&change);
        let absent = frame.without(position);
        let absent = FitPoint::new(frame, likelihood, absent, base.point.values.clone())?;
        // The prior of the shape is no part of the evidence at one shape.
        let mut quadratic = quadratic(frame, likelihood, &absent, &columns);
        let mut value = absent.value;
        for k in shapes() {
            value -= 0.5 * position[k] * position[k];
            quadratic.gradient[k] = 0.0;
        }
        let factor = log_evidence(&quadratic, value, &halves)? - base_evidence;
        let point = FitPoint::new(frame, likelihood, position.clone(), values)?;
        Some((factor, point, change))
    });
    let nodes: Vec<(f64, FitPoint, Vec<f64>)> = nodes.collect();
    let factors = nodes.iter().map(|node| node.0);
    let mean = log_sum_exp(factors) - libm::log(nodes.len() as f64);
    let best = nodes
        .iter()
        .reduce(|best, node| if node.0 > best.0 { node } else { best })?;
    let mut columns = vec![vec![0.0; best.1.values.len()]; frame.dimension()];
    for k in shapes() {
        let t = |node: &(f64, FitPoint, Vec<f64>)| node.1.position[k];
        let distance = |node: &(f64, FitPoint, Vec<f64>)| (t(node) - t(best)).abs();
        // The nearest other shape of the screen.
        let other = nodes
            .iter()
            .filter(|node| distance(node) > 0.0)
            .reduce(|a, b| if distance(b) < distance(a) { b } else { a });
        if let Some(other) = other {
            let pairs = other.1.values.iter().zip(&best.1.values);
            columns[k] = pairs.map(|(x, m)| (x - m) / (t(other) - t(best))).collect();
        }
    }
    columns[strength].clone_from(&best.2);
    Some(Screened {
        point: best.1.clone(),
        change: best.2.clone(),
        columns,
        log_bayes_factor: mean,
    })
}

/// The log Bayes factor is `g' H^-1 g / 2 - ln det(H) / 2` less that of the base.
fn of_several(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    let fit = &base.fit;
    let mut columns = fit.columns.clone();
    columns.resize(frame.dimension(), vec![0.0; fit.point.values.len()]);
    for ((k, neutral), (position, values)) in frame.strengths.iter().zip(evaluated) {
        columns[*k] = difference(values.as_ref()?, fit, position[*k] - neutral);
    }
    let absent = frame.without(&evaluated.first()?.0);
    let absent = FitPoint::new(frame, likelihood, absent, fit.point.values.clone())?;
    let quadratic = quadratic(frame, likelihood, &absent, &columns);
    let evidence = log_evidence(&quadratic, absent.value, &frame.halves())?;
    let solution = quadratic.step(0.0)?;
    let own = || frame.strengths.iter().map(|(k, _)| *k);
    let change = (0..absent.values.len())
        .map(|i| own().map(|k| solution[k] * columns[k][i]).sum())
        .collect();
    for column in &mut columns[..fit.columns.len()] {
        column.fill(0.0);
    }
    Some(Screened {
        point: absent,
        change,
        columns,
        log_bayes_factor: evidence - base.log_evidence,
    })
}

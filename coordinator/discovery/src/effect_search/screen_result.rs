//! The result of the screen (phase 2) for one candidate: its evidence by finite steps from the fitted base.

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::{Correction, quotient};
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use crate::laplace::strength_prior::mixed_evidence;
use statistics::likelihood::Likelihood;

/// A position with its predicted values; `None` where the model rejected it.
pub(super) type Evaluated = (Vec<f64>, Option<Vec<f64>>);

/// The screen's result for one candidate.
#[derive(Debug, Clone)]
pub(super) struct Screened {
    /// The point at the best shape and strength; with several strengths, the point where all are zero.
    pub(super) point: FitPoint,
    /// Change of the predictions per unit of the strength's coordinate, over its longest step; with several strengths, the change
    /// by the linear solution.
    pub(super) change: Vec<f64>,
    /// Derivatives along the candidate's own coordinates, in the order of the frame; empty for the base's coordinates.
    pub(super) columns: Vec<Vec<f64>>,
    /// The step over which the change of a single strength was taken; 1 otherwise.
    pub(super) longest_step: f64,
    /// Model derivative minus low-fidelity derivative, by coordinate; `None` where only one of them was evaluated.
    pub(super) corrections: Vec<Option<Correction>>,
    /// Log of the mean Bayes factor over the shapes, each at its best strength.
    pub(super) log_bayes_factor: f64,
    /// Log Bayes factor at the best shape.
    pub(super) best_shape_log_bayes_factor: f64,
}

/// Derives the screen's result from the evaluated positions.
///
/// # Returns
/// With one strength, the log Bayes factor of the extension linear in it, `s^2 / (2 (I + 1)) - ln(1 + I) / 2` with `I = g' P g` and
/// `s = g' P r` for the change g and the residuals r, where P is the projection of
/// [`Projection`](crate::effect_search::projection::Projection); one-sided strengths are truncated. With several strengths, the one
/// of the model linear in all of them. For a switch, the one of the model linear in the base's parameters, with the base's
/// derivatives. `None` if the model rejected all positions of a single strength, or one of several.
pub(super) fn screened(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    match frame.strength() {
        _ if frame.is_switch() => screen_switch(frame, base, likelihood, evaluated),
        Some(strength) => screen_one_strength(frame, strength, base, likelihood, evaluated),
        None => screen_several_strengths(frame, base, likelihood, evaluated),
    }
}

/// A step of the screen.
struct Node {
    log_bayes_factor: f64,
    /// Step of the strength from its neutral value.
    step: f64,
    point: FitPoint,
    change: Vec<f64>,
}

/// Returns the best step of one strength, with the derivatives there.
fn screen_one_strength(
    frame: &NormalFrame,
    strength: (usize, f64),
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    let (k, _) = strength;
    let fit = &base.fit;
    let shapes: Vec<usize> = (fit.point.position.len()..frame.dimension())
        .filter(|shape| *shape != k)
        .collect();
    let nodes = evaluated.iter().filter_map(|(position, values)| {
        let values = values.clone()?;
        node(frame, strength, base, likelihood, &shapes, position, values)
    });
    let nodes: Vec<Node> = nodes.collect();
    let best = nodes.iter().reduce(|best, node| {
        if node.log_bayes_factor > best.log_bayes_factor {
            node
        } else {
            best
        }
    })?;
    let usual = nodes
        .iter()
        .filter(|node| has_shape_of(node, best, &shapes))
        .reduce(|a, b| if b.step > a.step { b } else { a })?;
    let mut columns = vec![Vec::new(); fit.columns.len()];
    columns.resize(frame.dimension(), vec![0.0; best.point.values.len()]);
    for &shape in &shapes {
        if let Some(column) = shape_column(shape, &shapes, best, usual, &nodes) {
            columns[shape] = column;
        }
    }
    columns[k] = slope(best, &nodes, fit, &shapes);
    Some(Screened {
        corrections: vec![None; columns.len()],
        point: best.point.clone(),
        change: usual.change.clone(),
        longest_step: usual.step,
        columns,
        log_bayes_factor: mean_over_shapes(&nodes, &shapes),
        best_shape_log_bayes_factor: best.log_bayes_factor,
    })
}

/// Returns the step to an evaluated position, with the log Bayes factor of the model linear in the strength.
fn node(
    frame: &NormalFrame,
    (strength, neutral): (usize, f64),
    base: &FittedModel,
    likelihood: &Likelihood,
    shapes: &[usize],
    position: &[f64],
    values: Vec<f64>,
) -> Option<Node> {
    let fit = &base.fit;
    let step = position[strength] - neutral;
    let change = quotient(&values, &fit.point.values, step);
    let mut columns = fit.columns.clone();
    columns.resize(frame.dimension(), vec![0.0; values.len()]);
    columns[strength].clone_from(&change);
    let absent = frame.without(position);
    let absent = FitPoint::new(frame, likelihood, absent, fit.point.values.clone())?;
    // The prior of the shape is no part of the evidence at one shape.
    let mut quadratic = quadratic(frame, likelihood, &absent, &columns);
    let mut value = absent.value;
    for &k in shapes {
        value -= 0.5 * position[k] * position[k];
        quadratic.gradient[k] = 0.0;
    }
    let evidence = mixed_evidence(frame, &absent.position, &quadratic, value, f64::INFINITY, 1.0)?;
    Some(Node {
        log_bayes_factor: evidence - base.log_evidence,
        step,
        point: FitPoint::new(frame, likelihood, position.to_vec(), values)?,
        change,
    })
}

/// Returns whether two steps have the same shape.
fn has_shape_of(a: &Node, b: &Node, shapes: &[usize]) -> bool {
    let coordinate = |node: &Node, k: usize| node.point.position[k].to_bits();
    shapes.iter().all(|&k| coordinate(a, k) == coordinate(b, k))
}

/// Returns the log of the mean Bayes factor over the shapes, each at its best strength.
fn mean_over_shapes(nodes: &[Node], shapes: &[usize]) -> f64 {
    let highest = |i: usize| {
        nodes
            .iter()
            .filter(|node| has_shape_of(node, &nodes[i], shapes))
            .map(|node| node.log_bayes_factor)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    // The first node of a shape represents it.
    let is_first = |i: &usize| {
        !nodes[..*i]
            .iter()
            .any(|earlier| has_shape_of(earlier, &nodes[*i], shapes))
    };
    let by_shape: Vec<f64> = (0..nodes.len()).filter(is_first).map(highest).collect();
    log_sum_exp(by_shape.iter().copied()) - libm::log(by_shape.len() as f64)
}

/// Returns the derivative along a shape at the best node, from the nearest other shape at the usual strength; `None` without one. A node
/// that differs in this shape alone comes before all others.
fn shape_column(
    shape: usize,
    shapes: &[usize],
    best: &Node,
    usual: &Node,
    nodes: &[Node],
) -> Option<Vec<f64>> {
    let t = |node: &Node| node.point.position[shape];
    let distance = |node: &Node| (t(node) - t(usual)).abs();
    let rest: Vec<usize> = shapes.iter().copied().filter(|k| *k != shape).collect();
    let rank = |node: &Node| (!has_shape_of(node, usual, &rest), distance(node));
    let nearest = nodes
        .iter()
        .filter(|node| distance(node) > 0.0 && node.step.to_bits() == usual.step.to_bits())
        .reduce(|a, b| if rank(b) < rank(a) { b } else { a })?;
    let share = best.step / usual.step / (t(nearest) - t(usual));
    let pairs = nearest.point.values.iter().zip(&usual.point.values);
    Some(pairs.map(|(x, m)| (x - m) * share).collect())
}

/// Returns the derivative along the strength at a node, between the neighbouring steps; the base is the step of length zero.
fn slope(node: &Node, nodes: &[Node], base: &LaplaceFit, shapes: &[usize]) -> Vec<f64> {
    let same_shape = || nodes.iter().filter(|a| has_shape_of(a, node, shapes));
    let below = same_shape()
        .filter(|a| a.step < node.step)
        .reduce(|a, b| if b.step > a.step { b } else { a });
    let above = same_shape()
        .filter(|a| a.step > node.step)
        .reduce(|a, b| if b.step < a.step { b } else { a });
    let (low, from) = below.map_or((0.0, &base.point.values), |node| (node.step, &node.point.values));
    let to = above.unwrap_or(node);
    quotient(&to.point.values, from, to.step - low)
}

/// Returns the result for another model with the same parameters.
fn screen_switch(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    let (position, values) = evaluated.first()?;
    let fit = &base.fit;
    let point = FitPoint::new(frame, likelihood, position.clone(), values.clone()?)?;
    let quadratic = quadratic(frame, likelihood, &point, &fit.columns);
    let evidence = mixed_evidence(
        frame,
        &point.position,
        &quadratic,
        point.value,
        f64::INFINITY,
        1.0,
    )?;
    Some(Screened {
        change: quotient(&point.values, &fit.point.values, 1.0),
        longest_step: 1.0,
        columns: fit.columns.clone(),
        corrections: vec![None; fit.columns.len()],
        log_bayes_factor: evidence - base.log_evidence,
        best_shape_log_bayes_factor: evidence - base.log_evidence,
        point,
    })
}

/// Returns the result for several strengths. The log Bayes factor is `g' H^-1 g / 2 - ln det(H) / 2` less the log evidence of the
/// base.
fn screen_several_strengths(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    let fit = &base.fit;
    let mut columns = fit.columns.clone();
    columns.resize(frame.dimension(), vec![0.0; fit.point.values.len()]);
    for ((k, neutral), (position, values)) in frame.strengths.iter().zip(evaluated) {
        columns[*k] = quotient(values.as_ref()?, &fit.point.values, position[*k] - neutral);
    }
    let absent = frame.without(&evaluated.first()?.0);
    let absent = FitPoint::new(frame, likelihood, absent, fit.point.values.clone())?;
    let quadratic = quadratic(frame, likelihood, &absent, &columns);
    let evidence = mixed_evidence(
        frame,
        &absent.position,
        &quadratic,
        absent.value,
        f64::INFINITY,
        1.0,
    )?;
    let solution = quadratic.step(0.0)?;
    let strengths = || frame.strengths.iter().map(|(k, _)| *k);
    let change = (0..absent.values.len())
        .map(|i| strengths().map(|k| solution[k] * columns[k][i]).sum())
        .collect();
    columns[..fit.columns.len()].fill(Vec::new());
    Some(Screened {
        point: absent,
        change,
        longest_step: 1.0,
        corrections: vec![None; columns.len()],
        columns,
        log_bayes_factor: evidence - base.log_evidence,
        best_shape_log_bayes_factor: evidence - base.log_evidence,
    })
}

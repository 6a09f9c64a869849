//! The screen: the evidence of every candidate by finite steps from the fitted base.

use crate::effect_search::depth::Depth;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::{Correction, quotient};
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use crate::laplace::strength_prior::mixed_evidence;
use statistics::likelihood::Likelihood;

/// Steps of each of several strengths, and the last resort of a single one; each is tried where the model rejects the one before.
pub(super) const LEVELS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

/// A position with its predicted values; `None` where the model rejected it.
pub(super) type Evaluated = (Vec<f64>, Option<Vec<f64>>);

/// The screen's result for one candidate.
#[derive(Debug, Clone)]
pub(super) struct Screened {
    /// At the best shape and strength. Of several strengths: where they are absent.
    pub(super) point: FitPoint,
    /// Change of the predictions per unit of the strength's coordinate, at its usual size. Of several strengths: that of the linear
    /// solution.
    pub(super) change: Vec<f64>,
    /// Derivatives along the candidate's own coordinates, in the order of the frame; zeros for all others.
    pub(super) columns: Vec<Vec<f64>>,
    /// The step over which the change of a single strength was taken; 1 of others.
    pub(super) longest_step: f64,
    /// By how much those exceed the companion's, as far as that is known: nothing where the companion alone was screened.
    pub(super) corrections: Vec<Option<Correction>>,
    /// Mean over the shapes of the best among the strengths.
    pub(super) log_bayes_factor: f64,
    /// That of the best shape.
    pub(super) of_best_shape: f64,
}

/// The positions to evaluate: every strength at the first shape and the usual strength at the others, a step along each of several
/// strengths, or the base's fit with a switch turned.
///
/// # Arguments
/// - `shape`: the only coordinate of the shapes, where the best one is known.
pub(super) fn positions(
    frame: &NormalFrame,
    base: &[f64],
    depth: &Depth,
    shape: Option<f64>,
    level: usize,
) -> Vec<Vec<f64>> {
    if frame.is_switch() {
        return if level == 0 {
            vec![base.to_vec()]
        } else {
            Vec::new()
        };
    }
    let Some((k, neutral)) = frame.strength() else {
        let mut absent = base.to_vec();
        absent.resize(frame.dimension(), 0.0);
        let absent = frame.without(&absent);
        let along = |&(k, neutral): &(usize, f64)| {
            let mut position = absent.clone();
            position[k] = neutral + LEVELS[level];
            position
        };
        return frame.strengths.iter().map(along).collect();
    };
    let shapes = match &shape {
        Some(known) => std::slice::from_ref(known),
        None if frame.dimension() > base.len() + 1 => depth.shapes,
        None => &depth.shapes[..1],
    };
    let at = |shape: f64, strength: f64| {
        let mut position = base.to_vec();
        position.resize(frame.dimension(), shape);
        position[k] = neutral + strength;
        position
    };
    let last = LEVELS.len() - 1;
    match level {
        0 => {
            let strengths = depth.strengths.iter().map(|&strength| at(shapes[0], strength));
            let others = shapes[1..].iter().map(|&shape| at(shape, depth.strengths[0]));
            strengths.chain(others).collect()
        }
        level if level == last => vec![at(shapes[0], LEVELS[last])],
        _ => Vec::new(),
    }
}

/// The screen's result from the evaluated positions.
///
/// # Returns
/// With one strength, the log Bayes factor of the extension linear in it, `s^2 / (2 (I + 1)) - ln(1 + I) / 2` with `I = g' P g` and
/// `s = g' P r` of the change g and the residuals r, P the projection of
/// [`Projection`](crate::effect_search::projection::Projection); one-sided strengths truncated. With several, that of the model linear
/// in all of them. Of a switch, that of the model linear in the base's parameters, with the base's derivatives. `None` if the model
/// rejected all positions of the first, or one of the others.
pub(super) fn screened(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    match frame.strength() {
        _ if frame.is_switch() => of_switch(frame, base, likelihood, evaluated),
        Some(strength) => of_one(frame, strength, base, likelihood, evaluated),
        None => of_several(frame, base, likelihood, evaluated),
    }
}

/// A step of the screen.
struct Node {
    log_bayes_factor: f64,
    /// Of the strength.
    step: f64,
    point: FitPoint,
    change: Vec<f64>,
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
    let shapes = || (base.point.position.len()..frame.dimension()).filter(|k| *k != strength);
    let nodes = evaluated.iter().filter_map(|(position, values)| {
        let values = values.clone()?;
        let step = position[strength] - neutral;
        let change = quotient(&values, &base.point.values, step);
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
        let evidence = mixed_evidence(frame, &absent.position, &quadratic, value, f64::INFINITY)?;
        let point = FitPoint::new(frame, likelihood, position.clone(), values)?;
        Some(Node {
            log_bayes_factor: evidence - base_evidence,
            step,
            point,
            change,
        })
    });
    let nodes: Vec<Node> = nodes.collect();
    let highest = |nodes: &mut dyn Iterator<Item = &Node>| {
        nodes
            .map(|node| node.log_bayes_factor)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let is_shape_of =
        |a: &Node, b: &Node| shapes().all(|k| a.point.position[k].to_bits() == b.point.position[k].to_bits());
    // Of each shape, its best strength; the first node of a shape stands for it.
    let first_of_shape = |i: &usize| !nodes[..*i].iter().any(|other| is_shape_of(other, &nodes[*i]));
    let by_shape: Vec<f64> = (0..nodes.len())
        .filter(first_of_shape)
        .map(|i| highest(&mut nodes.iter().filter(|node| is_shape_of(node, &nodes[i]))))
        .collect();
    let mean = log_sum_exp(by_shape.iter().copied()) - libm::log(by_shape.len() as f64);
    let best = nodes.iter().reduce(|best, node| {
        if node.log_bayes_factor > best.log_bayes_factor {
            node
        } else {
            best
        }
    })?;
    let mut columns = vec![vec![0.0; best.point.values.len()]; frame.dimension()];
    let usual = nodes
        .iter()
        .filter(|node| is_shape_of(node, best))
        .reduce(|a, b| if b.step > a.step { b } else { a })?;
    for k in shapes() {
        let t = |node: &Node| node.point.position[k];
        let distance = |node: &Node| (t(node) - t(usual)).abs();
        // The nearest other shape at the same strength.
        let other = nodes
            .iter()
            .filter(|node| distance(node) > 0.0 && node.step.to_bits() == usual.step.to_bits())
            .reduce(|a, b| if distance(b) < distance(a) { b } else { a });
        if let Some(other) = other {
            let share = best.step / usual.step / (t(other) - t(usual));
            let pairs = other.point.values.iter().zip(&usual.point.values);
            columns[k] = pairs.map(|(x, m)| (x - m) * share).collect();
        }
    }
    columns[strength] = slope(best, &nodes, base, is_shape_of);
    Some(Screened {
        corrections: vec![None; columns.len()],
        point: best.point.clone(),
        change: usual.change.clone(),
        longest_step: usual.step,
        columns,
        log_bayes_factor: mean,
        of_best_shape: best.log_bayes_factor,
    })
}

/// The derivative along the strength at a node: between the steps below and above it, of which the lowest is that of the base.
fn slope(
    node: &Node,
    nodes: &[Node],
    base: &LaplaceFit,
    is_shape_of: impl Fn(&Node, &Node) -> bool,
) -> Vec<f64> {
    let same = || nodes.iter().filter(|other| is_shape_of(other, node));
    let below = same()
        .filter(|other| other.step < node.step)
        .reduce(|a, b| if b.step > a.step { b } else { a });
    let above = same()
        .filter(|other| other.step > node.step)
        .reduce(|a, b| if b.step < a.step { b } else { a });
    let (low, from) = below.map_or((0.0, &base.point.values), |node| (node.step, &node.point.values));
    let to = above.unwrap_or(node);
    quotient(&to.point.values, from, to.step - low)
}

fn of_switch(
    frame: &NormalFrame,
    base: &FittedModel,
    likelihood: &Likelihood,
    evaluated: &[Evaluated],
) -> Option<Screened> {
    let (position, values) = evaluated.first()?;
    let fit = &base.fit;
    let point = FitPoint::new(frame, likelihood, position.clone(), values.clone()?)?;
    let quadratic = quadratic(frame, likelihood, &point, &fit.columns);
    let evidence = mixed_evidence(frame, &point.position, &quadratic, point.value, f64::INFINITY)?;
    Some(Screened {
        change: quotient(&point.values, &fit.point.values, 1.0),
        longest_step: 1.0,
        columns: fit.columns.clone(),
        corrections: vec![None; fit.columns.len()],
        log_bayes_factor: evidence - base.log_evidence,
        of_best_shape: evidence - base.log_evidence,
        point,
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
        columns[*k] = quotient(values.as_ref()?, &fit.point.values, position[*k] - neutral);
    }
    let absent = frame.without(&evaluated.first()?.0);
    let absent = FitPoint::new(frame, likelihood, absent, fit.point.values.clone())?;
    let quadratic = quadratic(frame, likelihood, &absent, &columns);
    let evidence = mixed_evidence(frame, &absent.position, &quadratic, absent.value, f64::INFINITY)?;
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
        longest_step: 1.0,
        corrections: vec![None; columns.len()],
        columns,
        log_bayes_factor: evidence - base.log_evidence,
        of_best_shape: evidence - base.log_evidence,
    })
}

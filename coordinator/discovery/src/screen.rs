//! Ask what an effect of one prior standard deviation would change, and what is left of that when the base is refitted.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::block;
use crate::coordinate::Frame;
use crate::descent::{Descent, Point, parabola};
use crate::evidence::log_evidence;
use statistics::likelihood::{Likelihood, Whitening};

/// Steps of the strength that are tried, in standard deviations of its prior: each where the model refuses the one before.
pub(crate) const STRENGTHS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];
/// The fitted base with its curvature: what changes of the predictions it can absorb.
pub(crate) struct Absorbed {
    whitening: Whitening,
    columns: Vec<Vec<f64>>,
    cholesky: Cholesky<f64, Dyn>,
}

impl Absorbed {
    /// `None` where the data cannot be whitened at the base's fit.
    pub(crate) fn new(base: &Descent, likelihood: &Likelihood) -> Option<Self> {
        let theta = base.frame.theta(&base.point.position);
        let whitening = likelihood.whitening(&base.point.values, &theta).ok()?;
        Some(Self {
            columns: base
                .columns
                .iter()
                .map(|column| whitening.apply(column))
                .collect(),
            cholesky: Cholesky::new(base.parabola(likelihood).hessian)?,
            whitening,
        })
    }

    /// The inner products of changes of the predicted values after projection out of `[J; I]`:
    /// `a'b - a'J (I + J'J)^-1 J'b`, whitened.
    pub(crate) fn products(&self, changes: &[Vec<f64>]) -> DMatrix<f64> {
        let changes: Vec<Vec<f64>> = changes.iter().map(|g| self.whitening.apply(g)).collect();
        let along: Vec<DVector<f64>> = changes
            .iter()
            .map(|g| {
                let products = self.columns.iter().map(|c| self.whitening.curvature(c, g));
                DVector::from_iterator(self.columns.len(), products)
            })
            .collect();
        let solved: Vec<DVector<f64>> = along.iter().map(|v| self.cholesky.solve(v)).collect();
        DMatrix::from_fn(changes.len(), changes.len(), |i, j| {
            self.whitening.curvature(&changes[i], &changes[j]) - along[i].dot(&solved[j])
        })
    }
}

/// Where a candidate is asked: at every shape that is tried, or along each of its strengths.
pub(crate) fn positions(frame: &Frame, base: &[f64], shapes: &[f64], strength: f64) -> Vec<Vec<f64>> {
    let Some((k, neutral)) = frame.strength() else {
        return block::positions(frame, base, strength);
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

/// What the screen found of one candidate.
#[derive(Debug, Clone)]
pub(crate) struct Screened {
    /// At the best shape: the effect's point and the change of the predictions per unit of the strength's coordinate. Of several
    /// strengths: the point where they are absent, and the change that the linear solution makes.
    pub(crate) point: Point,
    pub(crate) change: Vec<f64>,
    /// Changes along the candidate's own coordinates there, in the order of the frame; zeros for all others.
    pub(crate) columns: Vec<Vec<f64>>,
    /// Mean over the shapes.
    pub(crate) log_bayes_factor: f64,
}

/// Judges a candidate by its finite steps; `None` if the model refused them all.
///
/// # Returns
/// The log Bayes factor of the extension linear in its strength, `s^2 / (2 (I + 1)) - ln(1 + I) / 2` with `I = g' P g` and
/// `s = g' P r` of the change g and the residuals r, P the projection of [`Absorbed::products`]; one-sided strengths truncated.
pub(crate) fn judge(
    frame: &Frame,
    base: &Descent,
    base_evidence: f64,
    likelihood: &Likelihood,
    evaluated: &[(Vec<f64>, Option<Vec<f64>>)],
) -> Option<Screened> {
    let Some((strength, neutral)) = frame.strength() else {
        return block::judge(frame, base, base_evidence, likelihood, evaluated);
    };
    let halves = frame.halves();
    let nodes = evaluated.iter().filter_map(|(position, values)| {
        let values = values.clone()?;
        let step = position[strength] - neutral;
        let pairs = values.iter().zip(&base.point.values);
        let change: Vec<f64> = pairs.map(|(with, without)| (with - without) / step).collect();
        let mut columns = base.columns.clone();
        columns.resize(frame.dimension(), vec![0.0; values.len()]);
        columns[strength].clone_from(&change);
        let absent = frame.without(position);
        let absent = Point::new(frame, likelihood, absent, base.point.values.clone())?;
        // The shape's own prior is no part of a factor at one shape.
        let mut parabola = parabola(frame, likelihood, &absent, &columns);
        let mut value = absent.value;
        for k in (base.point.position.len()..frame.dimension()).filter(|k| *k != strength) {
            value -= 0.5 * position[k] * position[k];
            parabola.gradient[k] = 0.0;
        }
        let factor = log_evidence(&parabola, value, &halves)? - base_evidence;
        let point = Point::new(frame, likelihood, position.clone(), values)?;
        Some((factor, point, change))
    });
    let nodes: Vec<(f64, Point, Vec<f64>)> = nodes.collect();
    let factors = nodes.iter().map(|node| node.0);
    let mean = crate::evidence::log_sum_exp(factors) - libm::log(nodes.len() as f64);
    let best = nodes
        .iter()
        .reduce(|best, node| if node.0 > best.0 { node } else { best })?;
    let mut columns = vec![vec![0.0; best.1.values.len()]; frame.dimension()];
    for k in (base.point.position.len()..frame.dimension()).filter(|k| *k != strength) {
        let t = |node: &(f64, Point, Vec<f64>)| node.1.position[k];
        // The other shapes of the screen, the nearest first.
        let other = nodes
            .iter()
            .filter(|node| (t(node) - t(best)).abs() > 0.0)
            .reduce(|a, b| {
                if (t(b) - t(best)).abs() < (t(a) - t(best)).abs() {
                    b
                } else {
                    a
                }
            });
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

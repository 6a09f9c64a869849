//! The prior of the strengths that a search adds: a scale mixture of normals.

use inference::lm::QuadraticModel;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::evidence::{log_evidence, log_sum_exp};

/// Weight and scale of each part, in standard deviations of the stated prior.
///
/// The stated width of a strength's prior is a judgement from the literature, often by orders of magnitude. With 40 % it is taken at
/// its word; otherwise four times wider, or four or sixteen times narrower. A strength five standard deviations out costs 3.8 nats
/// and not 12.5; one at a twentieth gains 1.3. Two effects that fit alike are then not told apart by the widths of their priors.
const PARTS: [(f64, f64); 4] = [(0.4, 1.0), (0.2, 4.0), (0.2, 0.25), (0.2, 0.0625)];

/// `-ln` of the prior density of a position, relative to that of independent standard normals at the origin: `|t|^2 / 2` of the
/// coordinates of the base and of shapes, and `-ln sum_i w_i s_i^-n exp(-|t|^2 / (2 s_i^2))` of the n strengths of each candidate,
/// which share a scale.
pub(crate) fn penalty(frame: &NormalFrame, position: &[f64]) -> f64 {
    let all: f64 = position.iter().map(|t| t * t).sum();
    let of_groups: f64 = frame
        .groups
        .iter()
        .map(|group| {
            let squares = squares(group, position);
            -log_sum_exp(log_parts(group.len(), squares)) - 0.5 * squares
        })
        .sum();
    0.5 * all + of_groups
}

/// Adds the difference from a normal prior to gradient and Hessian: with the strengths given, the mixture is a normal prior of the
/// precision `sum_i r_i / s_i^2`, r the shares of the parts in its density.
pub(crate) fn add(
    frame: &NormalFrame,
    position: &[f64],
    gradient: &mut [f64],
    hessian: &mut nalgebra::DMatrix<f64>,
) {
    for group in &frame.groups {
        let more = precision(group, position) - 1.0;
        for &k in group {
            gradient[k] += more * position[k];
            hessian[(k, k)] += more;
        }
    }
}

/// Log evidence under the mixture: the parts are normal priors, so their evidences add.
///
/// # Arguments
/// - `quadratic`, `value`: the expansion at `position`, with the prior of [`add`] and [`penalty`].
///
/// # Returns
/// Nats; `None` where a Hessian is not positive definite.
///
/// # Validity
/// As [`log_evidence`]. Checked by `effect_search::evidence_of_a_linear_extension_is_exact`.
pub(crate) fn mixed_evidence(
    frame: &NormalFrame,
    position: &[f64],
    quadratic: &QuadraticModel,
    value: f64,
) -> Option<f64> {
    let halves = frame.halves();
    let mut parts = vec![(quadratic.clone(), value)];
    for group in &frame.groups {
        let squares = squares(group, position);
        let own = -log_sum_exp(log_parts(group.len(), squares));
        let precision = precision(group, position);
        parts = parts
            .into_iter()
            .flat_map(|(quadratic, value)| {
                log_parts(group.len(), squares)
                    .zip(PARTS)
                    .map(move |(log_part, (_, scale))| {
                        let mut quadratic = quadratic.clone();
                        let more = 1.0 / (scale * scale) - precision;
                        for &k in group {
                            quadratic.gradient[k] += more * position[k];
                            quadratic.hessian[(k, k)] += more;
                        }
                        (quadratic, value - own - log_part)
                    })
                    .collect::<Vec<_>>()
            })
            .collect();
    }
    let evidences: Option<Vec<f64>> = parts
        .iter()
        .map(|(quadratic, value)| log_evidence(quadratic, *value, &halves))
        .collect();
    Some(log_sum_exp(evidences?.into_iter()))
}

/// The same under the stated prior alone, less [`mixed_evidence`]: nats, `None` as there.
pub(crate) fn stated_less_mixed(
    frame: &NormalFrame,
    position: &[f64],
    quadratic: &QuadraticModel,
    value: f64,
) -> Option<f64> {
    let mut stated = quadratic.clone();
    let mut stated_value = value - penalty(frame, position);
    stated_value += 0.5 * position.iter().map(|t| t * t).sum::<f64>();
    for group in &frame.groups {
        let more = 1.0 - precision(group, position);
        for &k in group {
            stated.gradient[k] += more * position[k];
            stated.hessian[(k, k)] += more;
        }
    }
    let own = log_evidence(&stated, stated_value, &frame.halves())?;
    Some(own - mixed_evidence(frame, position, quadratic, value)?)
}

fn squares(group: &[usize], position: &[f64]) -> f64 {
    group.iter().map(|&k| position[k] * position[k]).sum()
}

/// `ln (w_i s_i^-n) - |t|^2 / (2 s_i^2)` of each part.
fn log_parts(count: usize, squares: f64) -> impl Iterator<Item = f64> + Clone {
    PARTS.iter().map(move |&(weight, scale)| {
        libm::log(weight) - count as f64 * libm::log(scale) - 0.5 * squares / (scale * scale)
    })
}

fn precision(group: &[usize], position: &[f64]) -> f64 {
    let squares = squares(group, position);
    let sum = log_sum_exp(log_parts(group.len(), squares));
    let parts = log_parts(group.len(), squares).zip(PARTS);
    parts
        .map(|(log_part, (_, scale))| libm::exp(log_part - sum) / (scale * scale))
        .sum()
}

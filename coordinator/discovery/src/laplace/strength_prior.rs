//! The prior of the strengths that a search adds: a scale mixture of normals.

use inference::lm::QuadraticModel;
use nalgebra::DMatrix;

use crate::laplace::coordinate::NormalFrame;
use crate::laplace::evidence::{log_evidence, log_sum_exp, log_volume};

/// Weight and scale of each component, in standard deviations of the stated prior.
///
/// The stated width of a strength's prior is a judgement from the literature, often by orders of magnitude. It holds with 40 %;
/// otherwise the prior is four times wider, or four or sixteen times narrower. A strength of five standard deviations then costs
/// 3.8 nats instead of 12.5; one of a twentieth gains 1.3. The widths of the priors alone do not separate two effects that fit
/// alike.
const PARTS: [(f64, f64); 4] = [(0.4, 1.0), (0.2, 4.0), (0.2, 0.25), (0.2, 0.0625)];

/// Returns `-ln` of the prior density of a position, relative to that of independent standard normals at the origin: `t^2 / 2` of
/// the coordinates of the base, of shapes and of curves, and `-ln sum_i w_i exp(-t^2 / (2 s_i^2)) / s_i` of the other strengths.
pub(crate) fn penalty(frame: &NormalFrame, position: &[f64]) -> f64 {
    let all: f64 = position.iter().map(|t| t * t).sum();
    0.5 * all + stated_over_mixed(frame, position)
}

/// Returns the log of the density of the stated priors of the strengths over that of the mixture.
pub(crate) fn stated_over_mixed(frame: &NormalFrame, position: &[f64]) -> f64 {
    let log_ratios = frame.widened.iter().map(|&k| {
        let t = position[k];
        -log_sum_exp(log_parts(t)) - 0.5 * t * t
    });
    log_ratios.sum()
}

/// Adds the difference from a normal prior to gradient and Hessian. At given strengths the mixture equals a normal prior of the
/// precision `sum_i r_i / s_i^2`, where r are the shares of the components in its density.
pub(crate) fn add(frame: &NormalFrame, position: &[f64], gradient: &mut [f64], hessian: &mut DMatrix<f64>) {
    for &k in &frame.widened {
        let excess = precision(position[k]) - 1.0;
        gradient[k] += excess * position[k];
        hessian[(k, k)] += excess;
    }
}

/// A component of the mixture: one of the normal priors for each strength.
struct MixturePart {
    quadratic: QuadraticModel,
    value: f64,
    /// Log density of that prior at its peak, relative to standard normals.
    log_peak: f64,
}

/// Returns the log evidence under the mixture: its components are normal priors, whose evidences add.
///
/// # Arguments
/// - `width`: factor on the width of every component; 1 for the mixture of the search.
/// - `quadratic`, `value`: the expansion at `position`, with the prior of [`add`] and [`penalty`].
/// - `max_gain`: how far the likelihood may rise above that at `position`, in nats, where a component is wider than the mixture
///   there. The expansion of a fit that a narrow component holds near absence predicts any gain, but no step has reached it.
///
/// # Returns
/// Nats; `None` where a Hessian is not positive definite.
///
/// # Validity
/// The validity is that of [`log_evidence`]. Checked by `effect_search::evidence_of_a_linear_extension_is_exact`.
pub(crate) fn mixed_evidence(
    frame: &NormalFrame,
    position: &[f64],
    quadratic: &QuadraticModel,
    value: f64,
    max_gain: f64,
    width: f64,
) -> Option<f64> {
    let mut parts = vec![MixturePart {
        quadratic: quadratic.clone(),
        value,
        log_peak: 0.0,
    }];
    for &k in &frame.widened {
        let t = position[k];
        let log_mixture = -log_sum_exp(log_parts(t));
        let with = |part: &MixturePart| {
            let component = |(weight, scale): (f64, f64)| {
                let scale = scale * width;
                MixturePart {
                    quadratic: with_precision(&part.quadratic, k, t, 1.0 / (scale * scale)),
                    value: part.value - log_mixture - log_part(t, weight, scale),
                    log_peak: part.log_peak + libm::log(weight / scale),
                }
            };
            PARTS.map(component)
        };
        parts = parts.iter().flat_map(with).collect();
    }
    let halves = frame.halves();
    let limit = max_gain + highest(frame, position, value);
    let evidence = |part: &MixturePart| {
        let evidence = log_evidence(&part.quadratic, part.value, &halves)?;
        Some(evidence.min(limit + part.log_peak + log_volume(&part.quadratic)?))
    };
    let evidences: Option<Vec<f64>> = parts.iter().map(evidence).collect();
    Some(log_sum_exp(evidences?.into_iter()))
}

/// Returns `ln(likelihood times priors)` at a position of this `value`, with half-normal priors doubled and without the priors of
/// the widened strengths.
fn highest(frame: &NormalFrame, position: &[f64], value: f64) -> f64 {
    let log_mixtures = frame
        .widened
        .iter()
        .map(|&k| -log_sum_exp(log_parts(position[k])));
    libm::log(2.0) * frame.halves().len() as f64 - value + log_mixtures.sum::<f64>()
}

/// Returns the log evidence under the stated priors less [`mixed_evidence`] \[nats\]; `None` where a Hessian is not positive
/// definite.
///
/// # Arguments
/// - `max_gain`: bounds both evidences, because a bound of one alone would be the difference.
pub(crate) fn stated_less_mixed(
    frame: &NormalFrame,
    position: &[f64],
    quadratic: &QuadraticModel,
    value: f64,
    max_gain: f64,
) -> Option<f64> {
    let stated = stated(frame, position, quadratic);
    let squares: f64 = position.iter().map(|t| t * t).sum();
    let stated_value = value - penalty(frame, position) + 0.5 * squares;
    let limit = max_gain + highest(frame, position, value) + log_volume(&stated)?;
    let evidence = log_evidence(&stated, stated_value, &frame.halves())?.min(limit);
    Some(evidence - mixed_evidence(frame, position, quadratic, value, max_gain, 1.0)?)
}

/// Returns the expansion with the stated priors of the strengths.
pub(crate) fn stated(frame: &NormalFrame, position: &[f64], quadratic: &QuadraticModel) -> QuadraticModel {
    let strengths = frame.widened.iter();
    strengths.fold(quadratic.clone(), |stated, &k| {
        with_precision(&stated, k, position[k], 1.0)
    })
}

/// Returns the expansion with a normal prior of another precision for the strength `k`, at t.
fn with_precision(quadratic: &QuadraticModel, k: usize, t: f64, new_precision: f64) -> QuadraticModel {
    let mut changed = quadratic.clone();
    let excess = new_precision - precision(t);
    changed.gradient[k] += excess * t;
    changed.hessian[(k, k)] += excess;
    changed
}

/// Returns `ln (w_i / s_i) - t^2 / (2 s_i^2)` of each part.
fn log_parts(t: f64) -> impl Iterator<Item = f64> + Clone {
    PARTS
        .iter()
        .map(move |&(weight, scale)| log_part(t, weight, scale))
}

/// `ln (w / s) - t^2 / (2 s^2)`.
fn log_part(t: f64, weight: f64, scale: f64) -> f64 {
    libm::log(weight / scale) - 0.5 * (t / scale) * (t / scale)
}

fn precision(t: f64) -> f64 {
    let sum = log_sum_exp(log_parts(t));
    let parts = log_parts(t).zip(PARTS);
    parts
        .map(|(log_part, (_, scale))| libm::exp(log_part - sum) / (scale * scale))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candidate::Candidate;
    use crate::settings::Smoothness;
    use statistics::prior::{Distribution, Marginal, Prior};

    #[test]
    fn a_fit_that_a_narrow_part_holds_near_absence_promises_no_more_than_it_may() {
        let prior = Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None).unwrap();
        let effect = Candidate::new("e", vec![prior], vec![0]);
        let frame = NormalFrame::base(&Prior::new(Vec::new()), Smoothness::Smooth).with(&effect);
        // The likelihood rises by 8 nats per standard deviation and hardly bends; the narrow parts balance it at once.
        let position = [0.04];
        let (mut gradient, mut hessian) = (position.to_vec(), DMatrix::from_element(1, 1, 1.001));
        add(&frame, &position, &mut gradient, &mut hessian);
        let quadratic = QuadraticModel {
            gradient: vec![0.0],
            hessian,
            lower: vec![-10.0],
            upper: vec![10.0],
            held: vec![false],
        };
        let value = penalty(&frame, &position);
        let evidence =
            |max_gain| mixed_evidence(&frame, &position, &quadratic, value, max_gain, 1.0).unwrap();
        assert!(evidence(f64::INFINITY) > 100.0);
        assert!(evidence(3.0) < 3.0 && evidence(3.0) > 0.0);
        let stated = |max_gain| stated_less_mixed(&frame, &position, &quadratic, value, max_gain).unwrap();
        assert!(stated(f64::INFINITY) < -100.0);
        assert!(stated(3.0).abs() < 2.0, "{}", stated(3.0));
    }
}

//! The inferred noise sds that are known well enough to support a claim (step 13).
//!
//! An inferred sd measures the misfit of the fitted model. Each effect that bends the model towards the data shrinks it, and the
//! smaller sd makes the next effect count more. Two things limit this: repeats of a condition, which no effect can follow, and many
//! data per parameter, whose misfit is a good estimate.

use std::collections::BTreeMap;

use crate::laplace::fit::LaplaceFit;
use crate::laplace::noise;
use crate::probability::DETECTED;
use crate::stages::scored_fit::ScoredFit;
use statistics::likelihood::{ErrorSd, Likelihood};

/// Relative uncertainty up to which an inferred sd supports a claim. Log Bayes factors scale with its inverse square: of 10 nats, 4
/// are then uncertain.
const LARGEST_UNCERTAINTY: f64 = 0.2;
/// Number of repeats from which the scatter is known, as for `"replicates"` in an experiment.
const MIN_REPEATS: usize = 3;

/// Returns the parameters of inferred noise sds that do not support the claim; empty if the claim stands without them.
///
/// An sd is supported by at least three repeats, or by `v` residual degrees of freedom with `1 / sqrt(2 v) <= 0.2`: the number of
/// its data less its share of the fitted parameters. A claim that gains more than 3 nats in log-likelihood on the data of
/// declared and supported noise alone stands. Checked by
/// `inferred_noise::an_effect_is_named_on_inferred_noise_only_with_data_or_repeats_enough`.
///
/// # Arguments
/// - `conditions`: the data of each condition. `base`, `best`: the fits of the base and of the explanation that would be claimed.
///
/// # Returns
/// Indices among the parameters of `best`.
pub(super) fn unsupported_noise(conditions: &[Vec<usize>], base: ScoredFit, best: ScoredFit) -> Vec<usize> {
    let likelihood = best.likelihood;
    let fitted = fitted_parameters(best.fit, likelihood);
    let unsupported: Vec<usize> = data_of_sds(likelihood)
        .into_iter()
        .filter(|(_, data)| !is_supported(data, likelihood.data().len(), fitted, conditions))
        .map(|(parameter, _)| parameter)
        .collect();
    let gain = gain_without(&unsupported, base, best);
    if gain > DETECTED { Vec::new() } else { unsupported }
}

/// Returns the data of each inferred noise sd, by its parameter.
fn data_of_sds(likelihood: &Likelihood) -> BTreeMap<usize, Vec<usize>> {
    let mut data: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (place, datum) in likelihood.data().iter().enumerate() {
        if let Some(parameter) = datum.sd.parameter() {
            data.entry(parameter).or_default().push(place);
        }
    }
    data
}

/// Returns the effective number of fitted parameters without sds, the sum of 1 - posterior variance over prior variance.
fn fitted_parameters(fit: &LaplaceFit, likelihood: &Likelihood) -> f64 {
    let sds: Vec<usize> = noise::coordinates(likelihood)
        .into_iter()
        .map(|(k, _)| k)
        .collect();
    let uncertainty = fit.quadratic(likelihood).uncertainty();
    let of_predictions = uncertainty.iter().enumerate().filter(|(k, _)| !sds.contains(k));
    of_predictions
        .filter_map(|(_, sd)| *sd)
        .map(|sd| 1.0 - sd * sd)
        .sum()
}

/// Returns whether an sd has enough repeats or residual degrees of freedom.
///
/// # Arguments
/// - `data`: indices of the sd's data. `count`: number of all data. `fitted`: effective number of fitted parameters.
fn is_supported(data: &[usize], count: usize, fitted: f64, conditions: &[Vec<usize>]) -> bool {
    let repeats = |condition: &Vec<usize>| {
        let measured = data.iter().filter(|place| condition.contains(place)).count();
        measured.saturating_sub(1)
    };
    let share = data.len() as f64 / count as f64;
    let freedom = data.len() as f64 - share * fitted;
    conditions.iter().map(repeats).sum::<usize>() >= MIN_REPEATS
        || 2.0 * freedom * LARGEST_UNCERTAINTY * LARGEST_UNCERTAINTY >= 1.0
}

/// Returns the explanation's gain in log-likelihood on the data of other noise sds than these; 0 without such data.
fn gain_without(sds: &[usize], base: ScoredFit, best: ScoredFit) -> f64 {
    let is_unsupported = |sd: ErrorSd| sd.parameter().is_some_and(|parameter| sds.contains(&parameter));
    let data = best.likelihood.data().iter().enumerate();
    let kept = data.filter(|(_, datum)| !is_unsupported(datum.sd));
    let kept: Vec<usize> = kept.map(|(i, _)| i).collect();
    let scored = |ScoredFit { fit, likelihood }: ScoredFit| {
        let (part, places) = likelihood.subset(&kept).ok()?;
        let values: Vec<f64> = places.iter().map(|&i| fit.point.values[i]).collect();
        Some(part.log_likelihood(&values, &fit.theta()).ok()?.value())
    };
    match (kept.is_empty(), scored(base), scored(best)) {
        (false, Some(base), Some(best)) => best - base,
        _ => 0.0,
    }
}

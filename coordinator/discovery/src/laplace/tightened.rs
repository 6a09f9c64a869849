//! A likelihood with less room for the inadequacy of the model, to fit with at first.

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::{Discrepancy, LEAST_DISCREPANCY, Likelihood};

/// Share of an unknown discrepancy that is left.
const SHARE: f64 = 0.25;

/// The likelihood with each unknown discrepancy held at a quarter of its posterior mean at a fit, or at the least that it
/// may be; `None` where none is unknown.
///
/// An unknown discrepancy is as large as what the model misses, so that no small step explains much of it: a fit that would shrink it
/// to a fraction may have a maximum of its own where nothing changes. With less room the data pull harder, and a fit that ends here
/// begins anew on the other side. Checked by `pairs::an_unknown_discrepancy_does_not_hide_what_two_effects_explain`.
///
/// # Source
/// Blake & Zisserman 1987, *Visual Reconstruction*: graduated non-convexity.
pub(crate) fn tightened(likelihood: &Likelihood, fit: &LaplaceFit) -> Option<Likelihood> {
    if !likelihood.discrepancies().contains(&Discrepancy::Unknown) {
        return None;
    }
    let levels = likelihood
        .discrepancy_weights(&fit.point.values, &fit.theta())
        .ok()?;
    let held = likelihood
        .discrepancies()
        .iter()
        .zip(&levels)
        .map(|(own, levels)| match own {
            Discrepancy::Unknown => {
                let mean: f64 = levels.iter().map(|(m, probability)| m * probability).sum();
                Discrepancy::Known((SHARE * mean).max(LEAST_DISCREPANCY))
            }
            certain => *certain,
        });
    let (data, common) = (likelihood.data().to_vec(), likelihood.common().to_vec());
    Likelihood::with_common(data, likelihood.law(), common, held.collect()).ok()
}

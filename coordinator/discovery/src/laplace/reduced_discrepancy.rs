//! The likelihood with a reduced model discrepancy, for a preliminary fit.

use crate::laplace::fit::LaplaceFit;
use statistics::likelihood::{Discrepancy, Likelihood, MIN_DISCREPANCY};

/// The share of an unknown discrepancy that remains.
const SHARE: f64 = 0.25;

/// Returns the likelihood with each unknown discrepancy fixed at a quarter of its posterior mean at a fit, or at its lower limit;
/// `None` if no discrepancy is unknown.
///
/// An unknown discrepancy grows until it covers the misfit of the model, so that a small step gains little: the model without the
/// effect may be a local maximum. A smaller discrepancy gives the data more weight, and a fit with it leads away from that maximum.
/// Checked by `pairs::an_unknown_discrepancy_does_not_hide_what_two_effects_explain`.
///
/// # Source
/// Blake & Zisserman 1987, *Visual Reconstruction*: graduated non-convexity.
pub(crate) fn reduced_discrepancy(likelihood: &Likelihood, fit: &LaplaceFit) -> Option<Likelihood> {
    if !likelihood.discrepancies().contains(&Discrepancy::Unknown) {
        return None;
    }
    let levels = likelihood
        .discrepancy_weights(&fit.point.values, &fit.theta())
        .ok()?;
    let held =
        likelihood
            .discrepancies()
            .iter()
            .zip(&levels)
            .map(|(discrepancy, levels)| match discrepancy {
                Discrepancy::Unknown => {
                    let mean: f64 = levels.iter().map(|(m, probability)| m * probability).sum();
                    Discrepancy::Known((SHARE * mean).max(MIN_DISCREPANCY))
                }
                certain => *certain,
            });
    let (data, common) = (likelihood.data().to_vec(), likelihood.common().to_vec());
    Likelihood::with_common(data, likelihood.law(), common, held.collect()).ok()
}

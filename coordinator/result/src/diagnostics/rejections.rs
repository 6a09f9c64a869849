//! Rejections: where in the prior the model rejects parameters and leases fail.

use std::collections::BTreeMap;

use inference::diagnostics::{self, BINS, Region, Side};
use job::{FreeParameter, Spec};
use record::PriorDraw;
use shared::parameters::behind;

use crate::finished_calibration::FinishedCalibration;
use crate::words::number;
use crate::words::probability::{LEVEL, p_words};
use crate::words::rejection::rejection_counts;

/// Rejected parameter vectors and failed leases.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct RejectionDiagnostics {
    /// Number of parameter vectors that the model rejected, by reason.
    pub refused: BTreeMap<String, u64>,
    /// Number of failed leases in the whole calibration, by message. Each was retried, because a failure does not depend on the
    /// parameters.
    pub faults: BTreeMap<String, u64>,
    /// Number of draws from the prior, which define the regions.
    pub prior_draws: u64,
    /// Number of these draws that the model rejected.
    pub prior_refused: u64,
    /// The prior of each parameter, divided into bins of equal probability.
    pub parameters: Vec<BinnedParameter>,
    /// The region with significantly many rejections; null if there is none.
    pub region: Option<PriorRegion>,
}

/// The prior of a parameter, divided into bins of equal probability.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct BinnedParameter {
    /// Name of the parameter.
    pub name: String,
    /// Unit of the parameter.
    pub unit: String,
    /// The bins in ascending order.
    pub bins: Vec<PriorBin>,
}

/// A bin of a prior.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PriorBin {
    /// Lower end; null if it is infinite.
    pub from: Option<f64>,
    /// Upper end; null if it is infinite.
    pub to: Option<f64>,
    /// Number of draws from the prior.
    pub draws: u64,
    /// Number of rejected draws, by reason.
    pub refused: BTreeMap<String, u64>,
    /// Number of failed leases of these draws.
    pub faults: u64,
}

/// A region of the prior in which rejections concentrate.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PriorRegion {
    /// Bounds of one parameter, or of two that must both hold.
    pub sides: Vec<RegionSide>,
    /// Number of draws from the prior.
    pub draws: u64,
    /// Number of rejected draws, by reason.
    pub refused: BTreeMap<String, u64>,
    /// Probability of at least as many rejections in one region by chance, corrected for the number of regions tested.
    pub p: f64,
}

/// A bound of one parameter.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct RegionSide {
    /// Name of the parameter.
    pub parameter: String,
    /// Unit of the parameter.
    pub unit: String,
    /// Lower bound; null without one.
    pub above: Option<f64>,
    /// Upper bound; null without one.
    pub below: Option<f64>,
}

/// Counts of the draws from the prior.
pub fn rejections(calibration: &FinishedCalibration) -> RejectionDiagnostics {
    let draws = calibration.prior_draws();
    // Noise standard deviations are not inputs of the model, so rejections do not depend on them.
    let free = &calibration.spec.parameters[..calibration.spec.fit_variant.parameters.len()];
    let bin_of = |draw: &PriorDraw| -> Vec<usize> {
        let parameters = free.iter().zip(&draw.theta);
        parameters
            .map(|(p, &x)| diagnostics::bin(p.marginal.cumulative(x)))
            .collect()
    };
    let binned: Vec<(Vec<usize>, bool)> = draws.iter().map(|d| (bin_of(d), d.result.is_err())).collect();
    let parameters = free.iter().enumerate().map(|(i, p)| BinnedParameter {
        name: p.name.clone(),
        unit: p.unit.clone(),
        bins: (0..BINS)
            .filter(|_| !draws.is_empty())
            .map(|b| {
                bin(
                    p,
                    b,
                    draws
                        .iter()
                        .zip(&binned)
                        .filter(|(_, (bins, _))| bins[i] == b)
                        .map(|(d, _)| d),
                )
            })
            .collect(),
    });
    let found = diagnostics::concentration(&binned).filter(|region| region.p < LEVEL);
    RejectionDiagnostics {
        refused: calibration.rejections.clone(),
        faults: calibration.faults.clone(),
        prior_draws: draws.len() as u64,
        prior_refused: draws.iter().filter(|d| d.result.is_err()).count() as u64,
        parameters: parameters.collect(),
        region: found.map(|region| prior_region(&calibration.spec, &region, draws, &binned)),
    }
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// Returns the lower end of a bin of a parameter, which is the upper end of the bin below.
fn edge(free: &FreeParameter, bin: usize) -> f64 {
    free.marginal.quantile(bin as f64 / BINS as f64)
}

fn bin<'a>(free: &FreeParameter, number: usize, draws: impl Iterator<Item = &'a PriorDraw>) -> PriorBin {
    let draws: Vec<&PriorDraw> = draws.collect();
    PriorBin {
        from: finite(edge(free, number)),
        to: finite(edge(free, number + 1)),
        draws: draws.len() as u64,
        refused: reasons(draws.iter().copied()),
        faults: draws.iter().map(|d| d.faults).sum(),
    }
}

/// Counts the rejections by reason, which is the part of a message before the colon.
fn reasons<'a>(draws: impl Iterator<Item = &'a PriorDraw>) -> BTreeMap<String, u64> {
    let mut reasons = BTreeMap::new();
    for reason in draws.filter_map(|d| d.result.as_ref().err()) {
        *reasons.entry(reason.kind().to_owned()).or_default() += 1;
    }
    reasons
}

fn prior_region(
    spec: &Spec,
    region: &Region,
    draws: &[PriorDraw],
    binned: &[(Vec<usize>, bool)],
) -> PriorRegion {
    let inside = |bins: &[usize]| {
        region
            .sides
            .iter()
            .all(|s| (s.from..s.to).contains(&bins[s.parameter]))
    };
    let drawn = draws.iter().zip(binned).filter(|(_, (bins, _))| inside(bins));
    let side = |side: &Side| {
        let free = &spec.parameters[side.parameter];
        RegionSide {
            parameter: free.name.clone(),
            unit: free.unit.clone(),
            above: (side.from > 0).then(|| edge(free, side.from)),
            below: (side.to < BINS).then(|| edge(free, side.to)),
        }
    };
    PriorRegion {
        sides: region.sides.iter().map(side).collect(),
        draws: region.drawn as u64,
        refused: reasons(drawn.map(|(draw, _)| draw)),
        p: region.p,
    }
}

impl RegionSide {
    /// States the bounds of the parameter, for example `k_c below -2.0e8 N/m^2.1`; of a logarithm those of the quantity, too, such as
    /// `log10_p_ref below 3.10 (1.26 kPa)`.
    fn words(&self) -> String {
        let value = |x: f64| match self.unit.strip_prefix("log10 ") {
            Some(base) => format!("{} ({})", number::significant(x, 3), antilogarithm(x, base)),
            None => format!("{}{}", number::significant(x, 3), behind(&self.unit)),
        };
        let bound = |word: &str, x: Option<f64>| x.map(|x| format!("{word} {}", value(x)));
        let bounds: Vec<String> = bound("above", self.above)
            .into_iter()
            .chain(bound("below", self.below))
            .collect();
        format!("{} {}", self.parameter, number::list(&bounds))
    }
}

/// Formats the quantity of a decimal logarithm; a pressure in kPa, as the page shows it.
fn antilogarithm(x: f64, base: &str) -> String {
    let (scale, unit) = match base {
        "Pa" => (1e-3, "kPa"),
        base => (1.0, base),
    };
    format!(
        "{}{}",
        number::significant(scale * libm::pow(10.0, x), 3),
        behind(unit)
    )
}

impl RejectionDiagnostics {
    /// Returns a sentence on the region where rejections concentrate; `None` if there is no such region.
    pub fn words(&self) -> Option<String> {
        let region = self.region.as_ref()?;
        let refused: u64 = region.refused.values().sum();
        let percent = |part: u64, whole: u64| number::significant(100.0 * part as f64 / whole as f64, 2);
        let sides: Vec<String> = region.sides.iter().map(RegionSide::words).collect();
        Some(format!(
            "{} % of the {} rejections among {} draws from the prior have {}: {}; this region holds {} % of the prior, and {} % of it is rejected ({} by chance)",
            percent(refused, self.prior_refused),
            self.prior_refused,
            self.prior_draws,
            number::list(&sides),
            number::list(&rejection_counts(&region.refused)),
            percent(region.draws, self.prior_draws),
            percent(refused, region.draws),
            p_words(region.p)
        ))
    }
}

#[cfg(test)]
mod tests {
    use record::RejectionReason;

    use super::*;
    use crate::fixture;

    /// Returns 200 draws spread evenly over the prior; the model rejects those with n in its lowest fifth.
    fn with_low_n_rejected() -> FinishedCalibration {
        let mut calibration = fixture::calibration();
        let priors: Vec<_> = calibration
            .spec
            .parameters
            .iter()
            .map(|p| p.marginal.clone())
            .collect();
        let kept = calibration
            .prior_draws()
            .iter()
            .find_map(|d| d.result.as_ref().ok().cloned())
            .unwrap();
        fixture::sampled(&mut calibration).prior_draws = (0..200)
            .map(|k| {
                let share = |i: usize| (f64::from(k / 5_i32.pow(i as u32) % 5) + 0.5) / 5.0;
                PriorDraw {
                    theta: priors
                        .iter()
                        .enumerate()
                        .map(|(i, p)| p.quantile(share(i)))
                        .collect(),
                    result: if share(1) < 0.2 {
                        Err(RejectionReason("no_support: k* < 0".into()))
                    } else {
                        Ok(kept.clone())
                    },
                    faults: u64::from(k == 3),
                }
            })
            .collect();
        calibration
    }

    #[test]
    fn rejections_at_low_n_are_found_there() {
        let found = rejections(&with_low_n_rejected());
        // n is uniform from 0.8 to 1.6: its lowest fifth ends at 0.96.
        let side = &found.region.as_ref().unwrap().sides;
        assert_eq!(
            (side.len(), side[0].parameter.as_str(), side[0].above),
            (1, "n", None)
        );
        assert!((side[0].below.unwrap() - 0.96).abs() < 1e-12);
        assert_eq!(
            found.words().unwrap(),
            "100 % of the 40 rejections among 200 draws from the prior have n below 0.960: the soil does not carry the load (no_support, 40); this region holds 20 % of the prior, and 100 % of it is rejected (p < 1e-12 by chance)"
        );
        let n = &found.parameters[1];
        let counts: Vec<(u64, u64)> = n
            .bins
            .iter()
            .map(|b| (b.draws, b.refused.values().sum()))
            .collect();
        assert_eq!(counts, [(40, 40), (40, 0), (40, 0), (40, 0), (40, 0)]);
        assert_eq!((n.bins[0].from, n.bins[4].to), (Some(0.8), Some(1.6)));
        assert_eq!(found.parameters.len(), 3, "noise has no bins");
        let faults: Vec<u64> = found
            .parameters
            .iter()
            .map(|p| p.bins.iter().map(|b| b.faults).sum())
            .collect();
        assert_eq!(faults, [1, 1, 1]);
    }

    #[test]
    fn a_bound_of_a_logarithm_has_its_quantity() {
        let side = |parameter: &str, unit: &str, below: f64| RegionSide {
            parameter: parameter.into(),
            unit: unit.into(),
            above: None,
            below: Some(below),
        };
        assert_eq!(
            side("log10_p_ref", "log10 Pa", 3.1).words(),
            "log10_p_ref below 3.10 (1.26 kPa)"
        );
        assert_eq!(side("n", "1", 0.96).words(), "n below 0.960");
    }

    #[test]
    fn a_few_rejections_prove_no_region() {
        let found = rejections(&fixture::calibration());
        assert_eq!((found.prior_refused, found.region), (2, None));
    }
}

//! Principal directions of the posterior: combinations of parameters that the data determine well or badly.

use inference::diagnostics::{self, Direction};

use crate::finished_calibration::FinishedCalibration;
use crate::words::number;

/// Share of a direction's squared length below which a parameter is not named in the sentence.
const MIN_SHARE: f64 = 0.1;
/// Ratio of the best to the worst combination's standard deviation below which parameters are known only in combination.
const NARROW: f64 = 0.5;
/// Ratio of posterior to prior standard deviation above which the data say almost nothing about a direction.
const UNKNOWN: f64 = 0.95;

/// Maximum number of directions in a list of the worst-known ones.
pub const WORST_KNOWN: usize = 3;
/// Absolute value below which a component is left out of the list.
const MIN_LOADING: f64 = 0.2;

/// A principal direction of the posterior, in units of the prior's standard deviations.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct DirectionDiagnostics {
    /// Ratio of posterior to prior standard deviation along the direction; 1 if the data are uninformative.
    pub sd_ratio: f64,
    /// Components of the unit vector, in prior standard deviations of the sampler's coordinates.
    pub loadings: Vec<Loading>,
}

/// A component of a direction.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Loading {
    /// Name of the parameter.
    pub parameter: String,
    /// Component along the parameter.
    pub loading: f64,
}

impl DirectionDiagnostics {
    /// Lists the large components, for example `n +0.80, kappa -0.60`.
    pub fn words(&self) -> String {
        let mut named: Vec<_> = self
            .loadings
            .iter()
            .filter(|l| l.loading.abs() >= MIN_LOADING)
            .collect();
        named.sort_by(|a, b| b.loading.abs().total_cmp(&a.loading.abs()));
        let words: Vec<String> = named
            .iter()
            .map(|l| format!("{} {:+.2}", l.parameter, l.loading))
            .collect();
        words.join(", ")
    }
}

/// Returns the principal directions, the worst-known first. They are empty for a fit, and for a correlated prior, because the data need
/// not be the cause of its correlations.
pub fn directions(calibration: &FinishedCalibration) -> Vec<DirectionDiagnostics> {
    if calibration.spec.prior().is_correlated() {
        return Vec::new();
    }
    let all: Vec<usize> = (0..calibration.spec.parameters.len()).collect();
    let named = |direction: &Direction| DirectionDiagnostics {
        sd_ratio: direction.variance.sqrt(),
        loadings: calibration
            .spec
            .parameters
            .iter()
            .zip(&direction.loadings)
            .map(|(free, &loading)| Loading {
                parameter: free.name.clone(),
                loading,
            })
            .collect(),
    };
    diagnostics::principal_directions(&whitened(calibration, &all))
        .iter()
        .map(named)
        .collect()
}

/// Returns the draws of some parameters, in prior standard deviations of the sampler's coordinates.
fn whitened(calibration: &FinishedCalibration, parameters: &[usize]) -> Vec<Vec<f64>> {
    let scales: Vec<(usize, f64, f64)> = parameters
        .iter()
        .map(|&i| {
            let (mean, sd) = calibration.spec.parameters[i].marginal.coordinate_moments();
            (i, mean, sd)
        })
        .collect();
    let draw = |theta: &[f64]| {
        let coordinate = |&(i, mean, sd): &(usize, f64, f64)| {
            (calibration.spec.parameters[i].marginal.coordinate(theta[i]) - mean) / sd
        };
        scales.iter().map(coordinate).collect()
    };
    calibration.posterior().iter().map(|s| draw(&s.theta)).collect()
}

/// Returns a sentence on the worst-known direction; `None` without directions.
pub fn worst_known(calibration: &FinishedCalibration, directions: &[DirectionDiagnostics]) -> Option<String> {
    let worst = directions.first()?;
    let mut named: Vec<usize> = (0..worst.loadings.len())
        .filter(|&i| worst.loadings[i].loading.powi(2) >= MIN_SHARE)
        .collect();
    named.sort_by(|&a, &b| {
        let size = |i: usize| worst.loadings[i].loading.abs();
        size(b).total_cmp(&size(a))
    });
    let among_named = diagnostics::principal_directions(&whitened(calibration, &named));
    let (wide, narrow) = (among_named.first()?, among_named.last()?);
    let names: Vec<String> = named
        .iter()
        .map(|&i| worst.loadings[i].parameter.clone())
        .collect();
    Some(sentence(&names, wide, narrow))
}

fn sentence(names: &[String], wide: &Direction, narrow: &Direction) -> String {
    let percent = |d: &Direction| number::significant(100.0 * d.variance.sqrt(), 2);
    let who = number::list(names);
    if names.len() == 1 {
        return format!(
            "the data determine {who} least: {} % of its prior standard deviation remains",
            percent(wide)
        );
    }
    if narrow.variance.sqrt() > NARROW * wide.variance.sqrt() {
        let what = if wide.variance.sqrt() > UNKNOWN {
            "say almost nothing about"
        } else {
            "determine least"
        };
        return format!(
            "the data {what} {who}: {} % of the prior standard deviation remains in their worst combination, {} % in their best",
            percent(wide),
            percent(narrow)
        );
    }
    let moves: Vec<String> = names
        .iter()
        .zip(&wide.loadings)
        .map(|(name, loading)| format!("{name} by {loading:+.1}"))
        .collect();
    format!(
        "{who} are known only in combination: moving {} prior standard deviations hardly changes the fit ({} % of the prior standard deviation remains along this line, {} % along the best-known one)",
        number::list(&moves),
        percent(wide),
        percent(narrow)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    fn direction(sd: f64, loadings: &[f64]) -> Direction {
        Direction {
            variance: sd * sd,
            loadings: loadings.to_vec(),
        }
    }

    #[test]
    fn a_ridge_is_described_by_what_may_be_exchanged() {
        let names = ["n", "friction_angle_deg"].map(String::from);
        let (wide, narrow) = (direction(0.7, &[0.8, -0.6]), direction(0.05, &[0.6, 0.8]));
        assert_eq!(
            sentence(&names, &wide, &narrow),
            "n and friction_angle_deg are known only in combination: moving n by +0.8 and friction_angle_deg by -0.6 prior standard deviations hardly changes the fit (70 % of the prior standard deviation remains along this line, 5.0 % along the best-known one)"
        );
        let round = sentence(&names, &wide, &direction(0.6, &[0.6, 0.8]));
        assert!(
            round.starts_with("the data determine least n and friction_angle_deg: 70 %"),
            "{round}"
        );
        let single = sentence(&names[..1], &wide, &wide);
        assert_eq!(
            single,
            "the data determine n least: 70 % of its prior standard deviation remains"
        );
    }

    #[test]
    fn draws_on_a_line_are_known_only_in_combination() {
        let mut calibration = fixture::calibration();
        let priors: Vec<_> = calibration
            .spec
            .parameters
            .iter()
            .map(|p| p.marginal.clone())
            .collect();
        // n varies over half of its prior and the friction angle with it; all other parameters are constant.
        for (k, sample) in fixture::sampled(&mut calibration).draws.iter_mut().enumerate() {
            let share = 0.25 + 0.5 * (k as f64 + 0.5) / 40.0;
            sample.theta = priors
                .iter()
                .enumerate()
                .map(|(i, marginal)| marginal.quantile(if i == 1 || i == 2 { share } else { 0.5 }))
                .collect();
        }
        let directions = directions(&calibration);
        assert!(directions[0].sd_ratio > 0.4 && directions[1].sd_ratio < 0.1);
        let words = worst_known(&calibration, &directions).unwrap();
        assert!(
            words.starts_with(
                "n and friction_angle_deg are known only in combination: moving n by +0.8 and friction_angle_deg by +0.6"
            ),
            "{words}"
        );
    }
}

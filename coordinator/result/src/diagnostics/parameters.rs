//! Parameter diagnostics: contraction, bounds and prior conflict of each parameter.

use inference::diagnostics::{self, Conflict};
use job::FreeParameter;

use crate::finished_calibration::FinishedCalibration;

/// The posterior of a parameter compared with its prior.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ParameterDiagnostics {
    /// Name of the parameter.
    pub name: String,
    /// Unit of the parameter.
    pub unit: String,
    /// One minus the ratio of posterior to prior standard deviation, in the sampler's coordinate (the logarithm of lognormal and
    /// log-uniform parameters): 0 if the data are uninformative, 1 if they determine the parameter. Null for a fit.
    pub contraction: Option<f64>,
    /// Whether the parameter lies at a bound of its prior.
    pub at_bound: bool,
    /// Probability, if the prior is correct, of a posterior at least this far in the prior's tail; null if the data are uninformative.
    pub conflict_p: Option<f64>,
}

/// The conflict of the whole prior with the data.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PriorConflict {
    /// Squared distance between posterior and prior, in the directions that the data inform.
    pub statistic: f64,
    /// Number of directions that the data inform.
    pub degrees_of_freedom: usize,
    /// Probability, if the prior is correct, of a distance at least this large; null if the data inform no direction.
    pub p: Option<f64>,
}

/// Share of rejected prior draws above which the accepted draws replace the declared prior.
const CUT: f64 = 0.05;

/// Returns the diagnostics of each parameter in the order of the job, and the conflict of the whole prior with the data.
pub fn parameters(calibration: &FinishedCalibration) -> (Vec<ParameterDiagnostics>, Option<PriorConflict>) {
    let draws: Vec<&[f64]> = calibration
        .posterior()
        .iter()
        .map(|s| s.theta.as_slice())
        .collect();
    let accepted: Vec<&[f64]> = calibration
        .prior_draws()
        .iter()
        .filter(|draw| draw.result.is_ok())
        .map(|draw| draw.theta.as_slice())
        .collect();
    let refused = calibration.prior_draws().len() - accepted.len();
    let is_cut = refused as f64 > CUT * calibration.prior_draws().len() as f64;
    // Where the model rejects, the likelihood is zero. If it rejects much, the effective prior differs from the declared one.
    let conflict = if is_cut {
        None
    } else {
        diagnostics::conflict(&calibration.spec.prior(), &draws)
    };
    let parameter = |(i, free): (usize, &FreeParameter)| {
        let draws = calibration.draws(i);
        let p_value = |c: &Conflict| c.parameters[i];
        ParameterDiagnostics {
            name: free.name.clone(),
            unit: free.unit.clone(),
            contraction: match is_cut {
                true => spread(free, accepted.iter().map(|theta| theta[i]))
                    .and_then(|before| contraction(free, &draws, before)),
                false => contraction(free, &draws, free.marginal.coordinate_moments().1),
            },
            at_bound: match calibration.estimate() {
                Some(estimate) => estimate.at_bound[i],
                None => diagnostics::summary(&draws).is_some_and(|s| free.marginal.at_bound(s.q05, s.q95)),
            },
            conflict_p: conflict.as_ref().and_then(p_value),
        }
    };
    let together = conflict.as_ref().map(|c| PriorConflict {
        statistic: c.statistic,
        degrees_of_freedom: c.degrees_of_freedom,
        p: c.p,
    });
    let parameters = calibration.spec.parameters.iter().enumerate().map(parameter);
    (parameters.collect(), together)
}

/// Returns one minus the ratio of the posterior's standard deviation to the prior's, `before`.
fn contraction(free: &FreeParameter, draws: &[f64], before: f64) -> Option<f64> {
    let after = spread(free, draws.iter().copied())?;
    (before > 0.0).then(|| 1.0 - after / before)
}

/// Returns the standard deviation in the sampler's coordinate; `None` for fewer than two values.
fn spread(free: &FreeParameter, values: impl Iterator<Item = f64>) -> Option<f64> {
    let coordinates: Vec<f64> = values.map(|x| free.marginal.coordinate(x)).collect();
    let (_, sd) = diagnostics::mean_and_sd(&coordinates).filter(|_| coordinates.len() > 1)?;
    Some(sd)
}

#[cfg(test)]
mod tests {
    use record::RejectionReason;
    use statistics::{Distribution, Marginal};

    use super::*;
    use crate::fixture;

    fn free(distribution: Distribution) -> FreeParameter {
        FreeParameter {
            name: "x".into(),
            unit: "1".into(),
            marginal: Marginal::new(distribution, None).unwrap(),
        }
    }

    #[test]
    fn contraction_is_one_less_the_ratio_of_widths() {
        // A uniform posterior a tenth as wide as its uniform prior.
        let uniform = free(Distribution::Uniform {
            lower: 2.0,
            upper: 4.0,
        });
        let draws: Vec<f64> = (0..4000).map(|k| 3.0 + 0.2 * (k as f64 + 0.5) / 4000.0).collect();
        let before = uniform.marginal.coordinate_moments().1;
        assert!((contraction(&uniform, &draws, before).unwrap() - 0.9).abs() < 1e-3);
        assert_eq!(contraction(&uniform, &[3.0], before), None);
        // With a = sqrt(1/2) ln 2, the logarithm of exp(a) and exp(-a) has half of the prior's standard deviation ln 4.
        let lognormal = free(Distribution::Lognormal {
            median: 1.0,
            factor: 4.0,
        });
        let a = 0.5_f64.sqrt() * 2.0_f64.ln();
        let before = lognormal.marginal.coordinate_moments().1;
        let left = contraction(&lognormal, &[a.exp(), (-a).exp()], before).unwrap();
        assert!((left - 0.5).abs() < 1e-9);
    }

    #[test]
    fn where_the_model_rejects_much_the_accepted_draws_are_the_prior() {
        let mut calibration = fixture::calibration();
        let (whole, conflict) = parameters(&calibration);
        assert!(conflict.is_some());
        // The model now accepts only the prior draws in the lower half of the first parameter.
        let mut first: Vec<f64> = calibration
            .prior_draws()
            .iter()
            .map(|draw| draw.theta[0])
            .collect();
        first.sort_by(f64::total_cmp);
        let middle = first[first.len() / 2];
        for draw in &mut fixture::sampled(&mut calibration).prior_draws {
            if draw.theta[0] > middle {
                draw.result = Err(RejectionReason("no_support: condition 0: toy".into()));
            }
        }
        let (cut, conflict) = parameters(&calibration);
        assert!(conflict.is_none());
        assert!(
            cut[0].contraction.unwrap() < whole[0].contraction.unwrap() - 0.02,
            "{cut:?} {whole:?}"
        );
    }
}

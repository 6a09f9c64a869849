//! What the data did to each parameter.

use inference::diagnostics::{self, Conflict};

use crate::result::Outcome;
use crate::spec::FreeParameter;

/// A parameter after the data, beside its prior.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ParameterDiagnostics {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// 1 - sd after / sd before, in the sampler's coordinate (the logarithm of lognormal and log-uniform parameters):
    /// 0 where the data say nothing, 1 where they say everything. Null of a fit.
    pub contraction: Option<f64>,
    /// Whether it lies at a bound of its prior.
    pub at_bound: bool,
    /// Probability that a right prior has the posterior so far out; null where the data say too little.
    pub conflict_p: Option<f64>,
}

/// The prior of all parameters together against the data.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PriorConflict {
    /// Squared distance of posterior and prior, in the directions that the data inform.
    pub statistic: f64,
    /// As many directions.
    pub degrees_of_freedom: usize,
    /// Probability of so large a distance where the prior is right; null where the data inform no direction.
    pub p: Option<f64>,
}

/// Every parameter, in the order of the job, and all of them together.
pub(super) fn parameters(outcome: &Outcome) -> (Vec<ParameterDiagnostics>, Option<PriorConflict>) {
    let draws: Vec<&[f64]> = outcome.posterior.iter().map(|s| s.theta.as_slice()).collect();
    let conflict = diagnostics::conflict(&outcome.spec.prior(), &draws);
    let parameter = |(i, free): (usize, &FreeParameter)| {
        let draws = outcome.draws(i);
        let of = |c: &Conflict| c.parameters[i];
        ParameterDiagnostics {
            name: free.name.clone(),
            unit: free.unit.clone(),
            contraction: contraction(free, &draws),
            at_bound: match &outcome.estimate {
                Some(estimate) => estimate.at_bound[i],
                None => diagnostics::summary(&draws).is_some_and(|s| free.marginal.at_bound(s.q05, s.q95)),
            },
            conflict_p: conflict.as_ref().and_then(of),
        }
    };
    let together = conflict.as_ref().map(|c| PriorConflict {
        statistic: c.statistic,
        degrees_of_freedom: c.degrees_of_freedom,
        p: c.p,
    });
    let parameters = outcome.spec.parameters.iter().enumerate().map(parameter);
    (parameters.collect(), together)
}

fn contraction(free: &FreeParameter, draws: &[f64]) -> Option<f64> {
    let coordinates: Vec<f64> = draws.iter().map(|&x| free.marginal.coordinate(x)).collect();
    let (_, after) = diagnostics::mean_and_sd(&coordinates).filter(|_| draws.len() > 1)?;
    Some(1.0 - after / free.marginal.coordinate_moments().1)
}

#[cfg(test)]
mod tests {
    use inference::{Distribution, Marginal};

    use super::*;

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
        assert!((contraction(&uniform, &draws).unwrap() - 0.9).abs() < 1e-3);
        // exp(+-a) with a = sqrt(1/2) ln 2 has the sd ln 2 of its logarithm, factor 4 in the prior: one half is left.
        let lognormal = free(Distribution::Lognormal {
            median: 1.0,
            factor: 4.0,
        });
        let a = 0.5_f64.sqrt() * 2.0_f64.ln();
        assert!((contraction(&lognormal, &[a.exp(), (-a).exp()]).unwrap() - 0.5).abs() < 1e-9);
        assert_eq!(contraction(&uniform, &[3.0]), None);
    }
}

//! `SurfaceParameter`: a parameter of a response surface with its coordinate and its range.

use inference::diagnostics;
use job::FreeParameter;

use crate::figure::is_logarithmic;

/// Share of the draws below and above the range of a parameter.
const TAIL: f64 = 0.005;

/// A parameter of the model, with the range over which the draws determine the surface.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct SurfaceParameter {
    /// Name of the parameter.
    pub name: String,
    /// Unit of the parameter.
    pub unit: String,
    /// Whether its coordinate x is the natural logarithm of its value; otherwise the coordinate is the value.
    pub logarithmic: bool,
    /// Mean of the coordinate over the posterior.
    pub centre: f64,
    /// Posterior mean of the value.
    pub mean: f64,
    /// Lower end of the central 99 % of the posterior.
    pub lower: f64,
    /// Upper end of the central 99 % of the posterior.
    pub upper: f64,
}

impl SurfaceParameter {
    /// Takes the range of a parameter from its draws; `None` without draws. The centre is known with the whitening of all parameters.
    pub(super) fn new(parameter: &FreeParameter, draws: &[f64]) -> Option<Self> {
        let logarithmic = is_logarithmic(&parameter.marginal, draws);
        Some(SurfaceParameter {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            logarithmic,
            centre: 0.0,
            mean: diagnostics::mean(draws)?,
            lower: diagnostics::quantile(draws, TAIL)?,
            upper: diagnostics::quantile(draws, 1.0 - TAIL)?,
        })
    }

    /// Returns the coordinate of a value.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        if self.logarithmic { libm::log(value) } else { value }
    }
}

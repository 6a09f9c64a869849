//! The response surface of a calibration in `summary.json`: its size and its errors, without the coefficients.

use std::collections::BTreeMap;

use result::response_surface::{ResponseSurface, SurfaceError};

/// The response surface of the model's outputs over the posterior.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ResponseSurfaceSummary {
    /// Degree of the polynomials: `quadratic` or `linear`.
    pub degree: String,
    /// Number of coefficients of each output.
    pub terms: usize,
    /// Number of outputs: measured runs and channels.
    pub outputs: usize,
    /// Number of distinct draws that the surfaces rest on.
    pub draws: usize,
    /// Mahalanobis distance from the posterior mean within which 99 % of the draws lie; beyond it the surfaces extrapolate.
    pub radius: f64,
    /// Size of the surfaces as JSON.
    pub size_bytes: usize,
    /// Error against the model at draws that are left out of the fit, by channel.
    pub error: BTreeMap<String, SurfaceErrorSummary>,
}

/// The error of the surfaces of a channel.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct SurfaceErrorSummary {
    /// Unit of `rmse`.
    pub unit: String,
    /// Root mean square error.
    pub rmse: f64,
    /// The same in noise standard deviations; null if the noise of a run is unknown.
    pub rmse_sigma: Option<f64>,
}

impl From<&ResponseSurface> for ResponseSurfaceSummary {
    fn from(surface: &ResponseSurface) -> Self {
        let error = |error: &SurfaceError| SurfaceErrorSummary {
            unit: error.unit.clone(),
            rmse: error.rmse,
            rmse_sigma: error.rmse_sigma,
        };
        ResponseSurfaceSummary {
            degree: surface.degree.name().into(),
            terms: surface.terms,
            outputs: surface.outputs.len(),
            draws: surface.draws,
            radius: surface.radius,
            size_bytes: surface.size_bytes(),
            error: surface
                .channels
                .iter()
                .map(|channel| (channel.channel.name().to_owned(), error(channel)))
                .collect(),
        }
    }
}

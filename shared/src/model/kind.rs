//! The forward models by name.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::parameters::{BASE, BaseParameter, SPATIAL};

/// A forward model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelKind {
    /// The smooth-wheel quasi-static Soil Contact Model.
    QuasiStatic,
    /// The three-dimensional Soil Contact Model: a wheel that rolls over deformable terrain.
    Scm,
}

impl ModelKind {
    /// Name in files and results.
    pub fn name(self) -> &'static str {
        match self {
            ModelKind::QuasiStatic => "quasi_static",
            ModelKind::Scm => "scm",
        }
    }

    /// The base parameters that a model of this kind has.
    pub fn parameters(self) -> impl Iterator<Item = &'static BaseParameter> {
        let spatial: &[BaseParameter] = match self {
            ModelKind::QuasiStatic => &[],
            ModelKind::Scm => &SPATIAL,
        };
        BASE.iter().chain(spatial)
    }
}

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
    /// A program that a worker's operator allows.
    Command,
    /// A model of a UM-Bridge server that a worker's operator allows.
    Umbridge,
}

impl ModelKind {
    /// Every kind.
    pub const ALL: [ModelKind; 4] = [
        ModelKind::QuasiStatic,
        ModelKind::Scm,
        ModelKind::Command,
        ModelKind::Umbridge,
    ];

    /// Name in files and results.
    pub fn name(self) -> &'static str {
        match self {
            ModelKind::QuasiStatic => "quasi_static",
            ModelKind::Scm => "scm",
            ModelKind::Command => "command",
            ModelKind::Umbridge => "umbridge",
        }
    }

    /// Whether the model is not ours: its parameters stand in the job.
    pub fn is_external(self) -> bool {
        matches!(self, ModelKind::Command | ModelKind::Umbridge)
    }

    /// The base parameters that a model of this kind has; of one that is not ours, its job says.
    pub fn parameters(self) -> impl Iterator<Item = &'static BaseParameter> {
        let (base, spatial): (&[BaseParameter], &[BaseParameter]) = match self {
            ModelKind::QuasiStatic => (&BASE, &[]),
            ModelKind::Scm => (&BASE, &SPATIAL),
            ModelKind::Command | ModelKind::Umbridge => (&[], &[]),
        };
        base.iter().chain(spatial)
    }
}

//! The forward models by name.

use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray};
use utoipa::ToSchema;

use crate::parameters::{BASE, BaseParameter, RFT, SPATIAL, WHEEL_RADIUS, WONG_REECE};

/// A forward model.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    ToSchema,
    EnumString,
    IntoStaticStr,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum ModelKind {
    /// The smooth-wheel quasi-static Soil Contact Model.
    QuasiStatic,
    /// The three-dimensional Soil Contact Model: a wheel that rolls over deformable terrain.
    Scm,
    /// The smooth wheel of Wong & Reece: the pressure peaks ahead of the axle, shear builds up with displacement.
    WongReece,
    /// Three-dimensional resistive force theory of granular soil.
    Rft,
    /// A program that a worker's operator allows.
    Command,
    /// A model of a UM-Bridge server that a worker's operator allows.
    Umbridge,
}

impl ModelKind {
    /// Every kind.
    pub const ALL: &'static [Self] = Self::VARIANTS;

    /// Returns the name in files and results.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns whether the model is external: its parameters are stated in the job.
    pub fn is_external(self) -> bool {
        matches!(self, ModelKind::Command | ModelKind::Umbridge)
    }

    /// Finds the model of a name.
    pub fn find(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// Returns the base parameters of a model of this kind; an external model's are stated in its job.
    pub fn parameters(self) -> impl Iterator<Item = &'static BaseParameter> {
        let specific: &[BaseParameter] = match self {
            ModelKind::QuasiStatic | ModelKind::Command | ModelKind::Umbridge => &[],
            ModelKind::Scm => &SPATIAL,
            ModelKind::WongReece => &WONG_REECE,
            ModelKind::Rft => &RFT,
        };
        let shared = BASE.iter().filter(move |p| match self {
            ModelKind::Rft => p.name == WHEEL_RADIUS,
            ModelKind::Command | ModelKind::Umbridge => false,
            _ => specific.iter().all(|specific| specific.name != p.name),
        });
        shared.chain(specific)
    }

    /// Returns whether it uses the laws of Bekker and Mohr-Coulomb for the soil at a point, as plates, rings and the effects
    /// on these laws need.
    pub fn has_soil_laws(self) -> bool {
        !matches!(self, ModelKind::Rft | ModelKind::Command | ModelKind::Umbridge)
    }

    /// Returns whether it predicts the sinkage on the way to the steady state.
    pub fn has_transients(self) -> bool {
        matches!(
            self,
            ModelKind::QuasiStatic | ModelKind::WongReece | ModelKind::Scm
        )
    }

    /// Returns whether its wheel is a smooth cylinder, whatever grousers are declared.
    pub fn is_smooth(self) -> bool {
        matches!(self, ModelKind::QuasiStatic | ModelKind::WongReece)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_model_has_each_of_its_parameters_once() {
        for &kind in ModelKind::ALL {
            assert_eq!(ModelKind::find(kind.name()), Some(kind));
            let names: Vec<&str> = kind.parameters().map(|p| p.name).collect();
            let set: BTreeSet<&str> = names.iter().copied().collect();
            assert_eq!(names.len(), set.len(), "{}", kind.name());
            assert_eq!(set.contains(WHEEL_RADIUS), !kind.is_external());
        }
        let gamma = ModelKind::WongReece
            .parameters()
            .find(|p| p.name == "gamma_exponent");
        assert_eq!(gamma.unwrap().default, Some(0.0));
    }
}

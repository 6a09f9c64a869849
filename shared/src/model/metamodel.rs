//! The cheap model beside the one that counts: what a worker needs to take a metamodel's moves.

use serde::{Deserialize, Serialize};
use statistics::Metamodel;
use utoipa::ToSchema;

use super::{ModelKind, ModelVariant};
use crate::parameters;
use crate::predicted::Predicted;

/// The quasi-static model beside a variant of the three-dimensional one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Companion {
    /// The values that are compared, in the order of the likelihood.
    pub values: Vec<Predicted>,
    /// The metamodel of a stage; absent before the first: then both models are evaluated, and no moves are taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Object>)]
    pub metamodel: Option<Box<Metamodel>>,
}

impl ModelVariant {
    /// The same conditions and parameters for the quasi-static model.
    ///
    /// # Errors
    /// A sentence that names what that model cannot express.
    pub fn coarse(&self) -> Result<ModelVariant, String> {
        let coarse = ModelVariant {
            kind: ModelKind::QuasiStatic,
            spatial: None,
            companion: None,
            histories: false,
            fixed: self
                .fixed
                .iter()
                .filter(|(name, _)| parameters::SPATIAL.iter().all(|p| p.name != name.as_str()))
                .map(|(name, &value)| (name.clone(), value))
                .collect(),
            ..self.clone()
        };
        let effects = super::EffectSet::read(&coarse.effects)?;
        coarse.check_expressible(&effects)?;
        Ok(coarse)
    }

    /// The same with the metamodel of a stage.
    pub fn with_metamodel(&self, metamodel: &Metamodel) -> ModelVariant {
        ModelVariant {
            companion: self.companion.as_ref().map(|companion| Companion {
                values: companion.values.clone(),
                metamodel: Some(Box::new(metamodel.clone())),
            }),
            ..self.clone()
        }
    }
}

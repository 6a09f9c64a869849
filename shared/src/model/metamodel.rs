//! The variants that a metamodel needs: the quasi-static one, and the one with the metamodel of a stage.

use statistics::Metamodel;

use super::effects::EffectSet;
use super::error::ModelError;
use super::kind::ModelKind;
use super::low_fidelity::LowFidelityModel;
use super::variant::ModelVariant;
use crate::parameters;

impl ModelVariant {
    /// Returns the variant of the quasi-static model with the same conditions and parameters; [`ModelError`] names what
    /// that model cannot express.
    pub fn coarse(&self) -> Result<ModelVariant, ModelError> {
        let coarse = ModelVariant {
            kind: ModelKind::QuasiStatic,
            spatial: None,
            low_fidelity: None,
            histories: false,
            fixed: self
                .fixed
                .iter()
                .filter(|(name, _)| parameters::SPATIAL.iter().all(|p| p.name != name.as_str()))
                .map(|(name, &value)| (name.clone(), value))
                .collect(),
            ..self.clone()
        };
        let effects = EffectSet::read(&coarse.effects)?;
        coarse.check_expressible(&effects)?;
        Ok(coarse)
    }

    /// Returns the variant with the metamodel of a stage.
    pub fn with_metamodel(&self, metamodel: &Metamodel) -> ModelVariant {
        ModelVariant {
            low_fidelity: self.low_fidelity.as_ref().map(|low_fidelity| LowFidelityModel {
                values: low_fidelity.values.clone(),
                metamodel: Some(Box::new(metamodel.clone())),
            }),
            ..self.clone()
        }
    }
}

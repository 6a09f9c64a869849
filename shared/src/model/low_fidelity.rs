//! The quasi-static variant of a three-dimensional one: its low-fidelity model.

use super::effects::EffectSet;
use super::error::ModelError;
use super::kind::ModelKind;
use super::variant::ModelVariant;
use crate::parameters;

impl ModelVariant {
    /// Returns the variant of the quasi-static model with the same conditions and parameters, by which a search screens its
    /// candidates; [`ModelError`] names what that model cannot express.
    pub fn low_fidelity(&self) -> Result<ModelVariant, ModelError> {
        let low_fidelity = ModelVariant {
            kind: ModelKind::QuasiStatic,
            spatial: None,
            histories: false,
            fixed: self
                .fixed
                .iter()
                .filter(|(name, _)| parameters::SPATIAL.iter().all(|p| p.name != name.as_str()))
                .map(|(name, &value)| (name.clone(), value))
                .collect(),
            ..self.clone()
        };
        let effects = EffectSet::read(&low_fidelity.effects)?;
        low_fidelity.check_expressible(&effects)?;
        Ok(low_fidelity)
    }
}

//! The capabilities of forward models: the check that a model can express a variant.

use std::collections::BTreeSet;

use formula::effect::Mechanism;
use formula::{Effect, Hook, Variable};

use super::effects::EffectSet;
use super::error::ModelError;
use super::kind::ModelKind;
use super::spatial::DisplacementFrame;
use super::variant::ModelVariant;
use crate::parameters;

impl ModelKind {
    /// Returns whether the model has a form of an effect.
    pub fn has_form(self, effect: &Effect) -> bool {
        match self {
            ModelKind::QuasiStatic => effect.mechanism != Some(Mechanism::SideWall),
            ModelKind::Scm | ModelKind::Command | ModelKind::Umbridge => true,
            ModelKind::WongReece => effect.hooks().next().is_some(),
            ModelKind::Rft => effect.hooks().next().is_some() && !effect.needs_soil_laws(),
        }
    }
}

impl ModelVariant {
    /// Checks that the forward model can express the variant and its effects. Without conditions no wheel rolls, and there
    /// is nothing to check. [`ModelError`] names the missing capability.
    pub fn check_expressible(&self, effects: &EffectSet) -> Result<(), ModelError> {
        if self.conditions.is_empty() {
            return Ok(());
        }
        if let Some(spatial) = &self.spatial {
            spatial.check_protocol(&self.protocol)?;
            if spatial.displacement != DisplacementFrame::Rim && effects.using(Variable::J).is_none() {
                let message =
                    "displacement has no effect without an effect that uses j, such as janosi_hanamoto";
                return Err(ModelError::Inexpressible(message.to_owned()));
            }
        }
        let meshes: BTreeSet<&str> = self.conditions.iter().map(|c| c.wheel.as_str()).collect();
        let meshes: BTreeSet<&str> = meshes.into_iter().filter(|wheel| self.has_mesh(wheel)).collect();
        let names: BTreeSet<&str> = self.names().collect();
        if let Some(model) = &self.external {
            return model.check_expressible(effects, &names);
        }
        if self.kind.is_external() {
            return Err(ModelError::Incomplete(format!(
                "kind = \"{}\" comes without its description",
                self.kind.name()
            )));
        }
        let terrain = names
            .iter()
            .find(|n| parameters::SPATIAL.iter().any(|p| p.name == **n));
        let kind = self.kind.name();
        if let Some(name) = terrain.filter(|_| self.kind != ModelKind::Scm) {
            return Err(ModelError::Inexpressible(format!(
                "{name}: {kind} has no terrain that deforms; use kind = \"scm\""
            )));
        }
        self.check_effects(effects)?;
        self.check_rolled_grousers(effects, &names)?;
        match meshes.first() {
            Some(wheel) if self.kind.is_smooth() => Err(ModelError::Inexpressible(format!(
                "wheel {wheel} is a surface mesh: {kind} rolls a smooth cylinder; use kind = \"scm\""
            ))),
            _ => self.check_meshes(effects, &names, &meshes),
        }
    }

    /// Checks that the model has a form of every effect.
    fn check_effects(&self, effects: &EffectSet) -> Result<(), ModelError> {
        match effects.iter().find(|effect| !self.kind.has_form(effect)) {
            None => Ok(()),
            Some(effect) => Err(ModelError::Inexpressible(format!(
                "effect {} has no form in {}",
                effect.name,
                self.kind.name()
            ))),
        }
    }

    /// Checks that nothing changes the shape of a surface mesh.
    fn check_meshes(
        &self,
        effects: &EffectSet,
        names: &BTreeSet<&str>,
        meshes: &BTreeSet<&str>,
    ) -> Result<(), ModelError> {
        let Some(wheel) = meshes.first() else {
            return Ok(());
        };
        if names.iter().any(|n| n.starts_with("wheel_radius_m")) {
            return Err(ModelError::Inexpressible(format!(
                "wheel {wheel} is a surface mesh, which has its radius: wheel_radius_m cannot be a parameter"
            )));
        }
        for effect in effects.iter() {
            let wheels: BTreeSet<&str> = self.wheels.keys().map(String::as_str).collect();
            let reach = EffectSet::acts_on(effect, names, &wheels);
            let dimension = effect.hooks().find(|h| [Hook::Radius, Hook::Width].contains(h));
            let shapes = effect.mechanism == Some(Mechanism::FlatPatch) || dimension.is_some();
            if let Some(wheel) = meshes.intersection(&reach).next().filter(|_| shapes) {
                return Err(ModelError::Inexpressible(format!(
                    "effect {} reshapes the rim: wheel {wheel} is a surface mesh, which has its shape",
                    effect.name
                )));
            }
        }
        Ok(())
    }

    fn has_mesh(&self, wheel: &str) -> bool {
        self.wheels.get(wheel).is_some_and(|wheel| wheel.mesh.is_some())
    }
}

//! Check that effects can act around an external model: on its inputs and its outputs.

use std::collections::BTreeSet;

use formula::variable::Variables;
use formula::{Effect, Hook, Variable};

use super::effects::EffectSet;
use super::error::ModelError;
use super::external::{ExternalModel, RunInput};
use crate::channel::Channel;

impl ExternalModel {
    /// Checks that every effect has a quantity to act on, and that every named parameter belongs to the model or an effect.
    /// [`ModelError`] names the effect and the hidden quantity.
    pub(super) fn check_expressible(
        &self,
        effects: &EffectSet,
        names: &BTreeSet<&str>,
    ) -> Result<(), ModelError> {
        if names.iter().any(|name| name.starts_with("wheel_radius_m")) && !self.takes(RunInput::RadiusM) {
            let message = "wheel_radius_m has no effect: radius_m is not among the inputs of the model";
            return Err(ModelError::Inexpressible(message.to_owned()));
        }
        effects.iter().try_for_each(|effect| match self.why_not(effect) {
            None => Ok(()),
            Some(why) => {
                let message = format!("effect {}: {why}", effect.name);
                Err(ModelError::Inexpressible(message))
            }
        })
    }

    /// Returns the reason why an effect cannot act around the model; `None` if it can.
    pub fn why_not(&self, effect: &Effect) -> Option<String> {
        if effect.hooks().next().is_none() {
            return Some(INSIDE.to_owned());
        }
        if let Some(why) = effect.hooks().find_map(|hook| self.lacks(hook)) {
            return Some(why);
        }
        let uses = effect.uses();
        if effect.hooks().any(|hook| hook == Hook::WheelLoad) && uses.meets(Variables::new(&REACTION)) {
            let why = "the load depends on what the soil answers to it, which only a model that balances it can follow";
            return Some(why.to_owned());
        }
        let unknown = uses.iter().find(|variable| !self.knows(*variable))?;
        Some(format!(
            "it needs {}, which this model does not show",
            unknown.name()
        ))
    }

    /// Returns the reason why no effect can act on a quantity; `None` if one can.
    fn lacks(&self, hook: Hook) -> Option<String> {
        let among = |is_there: bool, name: &str, list: &str| {
            (!is_there).then(|| format!("{name} is not among the {list} of this model"))
        };
        let output = |channel: Channel| {
            let is_there = self.outputs.contains(&channel);
            among(is_there, channel.column(), "outputs")
        };
        let input = |input: RunInput| among(self.takes(input), input.name(), "inputs");
        match hook {
            Hook::Pressure | Hook::ShearLimit | Hook::Shear => Some(INSIDE.to_owned()),
            Hook::Slip => input(RunInput::Slip).and(input(RunInput::SledSpeedMS)),
            Hook::Radius => input(RunInput::RadiusM),
            Hook::Width => input(RunInput::WidthM),
            Hook::WheelLoad => input(RunInput::WheelLoadN),
            Hook::SinkageExponent => among(self.shares("n"), "n", "parameters"),
            Hook::DrawbarPull => output(Channel::DrawbarPull),
            Hook::Torque => output(Channel::Torque),
            Hook::Sinkage => output(Channel::Sinkage),
            Hook::LateralForce => output(Channel::LateralForce),
        }
    }

    /// Returns whether a variable has a value outside the contact.
    fn knows(&self, variable: Variable) -> bool {
        let parameter = |name: &str| self.shares(name);
        let output = |channel: Channel| self.outputs.contains(&channel);
        match variable {
            Variable::P
            | Variable::Z
            | Variable::Vn
            | Variable::Vt
            | Variable::J
            | Variable::Position
            | Variable::KStar
            | Variable::BEff
            | Variable::TauMax
            | Variable::Tau
            | Variable::ContactLength => false,
            Variable::FrictionAngle => parameter("friction_angle_deg"),
            Variable::Cohesion => parameter("cohesion_pa"),
            Variable::N => parameter("n"),
            Variable::ShearVelocity => parameter("shear_velocity_m_s"),
            Variable::DrawbarPull => output(Channel::DrawbarPull),
            Variable::Torque => output(Channel::Torque),
            Variable::Sinkage => output(Channel::Sinkage),
            Variable::LateralForce => output(Channel::LateralForce),
            Variable::Slip
            | Variable::SlipAngle
            | Variable::LongitudinalSlip
            | Variable::LateralSlip
            | Variable::SledSpeed
            | Variable::WheelLoad
            | Variable::Radius
            | Variable::Width
            | Variable::Density
            | Variable::Gravity
            | Variable::GrouserCount
            | Variable::GrouserHeight
            | Variable::Pass
            | Variable::BinLength
            | Variable::Order => true,
        }
    }
}

/// The message for an effect inside the contact.
const INSIDE: &str = "it acts inside the contact of wheel and soil, which this model does not show";

/// The reaction of the soil to a load.
const REACTION: [Variable; 2] = [Variable::DrawbarPull, Variable::Torque];

#[cfg(test)]
mod tests {
    use formula::catalogue::{catalogue, find};

    use super::*;
    use crate::model::ModelSettings;

    fn model(inputs: &str, parameters: &str) -> ExternalModel {
        let text = format!(
            "kind = \"command\"\nprogram = \"w\"\nversion = \"1\"\ninputs = [{inputs}]\nparameters = [{parameters}]\n\
             outputs = [\"drawbar_pull_n\", \"torque_n_m\", \"sinkage_m\"]"
        );
        let settings = ModelSettings::from_table(&text.parse().unwrap()).unwrap();
        settings.external.unwrap()
    }

    fn why(model: &ExternalModel, effect: &str) -> Option<String> {
        model.why_not(find(effect).unwrap())
    }

    #[test]
    fn effects_act_on_the_inputs_and_outputs_of_a_model() {
        let bare = model("\"slip\"", "\"k_phi\"");
        let inputs = r#""slip", "wheel_load_n", "radius_m", "width_m""#;
        let all = model(inputs, r#""n", "friction_angle_deg""#);
        for effect in "sled_tare sled_drag torque_gain sinkage_offset bearing_friction".split(' ') {
            assert_eq!(why(&bare, effect), None, "{effect}");
        }
        for (effect, missing) in [
            ("load_scale", "wheel_load_n"),
            ("edge_loss", "width_m"),
            ("slip_sinkage", "n"),
        ] {
            let reason = format!("{missing} is not among the");
            assert!(why(&bare, effect).unwrap().starts_with(&reason));
            assert_eq!(why(&all, effect), None, "{effect}");
        }
        for (effect, reason) in [
            ("adhesion", "inside the contact"),
            ("elastic_rebound", "inside the contact"),
            ("load_transfer", "the load depends on"),
            ("lug_thrust", "which this model does not show"),
            (
                "drift_lateral_force_zero",
                "lateral_force_n is not among the outputs",
            ),
        ] {
            assert!(why(&all, effect).unwrap().contains(reason), "{effect}");
        }
        let able = catalogue().iter().filter(|effect| all.why_not(effect).is_none());
        assert!(able.count() >= 14);
    }
}

//! Effects around a model outside this crate: on its inputs and on its outputs.

use formula::Variable;

use crate::effects::case::Case;
use crate::effects::{Active, Site};
use crate::{Condition, Rejection, Soil, Wheel};

/// The inputs of a model outside this crate for one run.
#[derive(Debug, Clone)]
pub struct OutsideRun(Case);

/// The channels in the order of [`OutsideRun::measured`].
const CHANNELS: [Variable; 4] = [
    Variable::DrawbarPull,
    Variable::Torque,
    Variable::Sinkage,
    Variable::LateralForce,
];

impl OutsideRun {
    /// Applies the effects on slip, dimensions, sinkage exponent and load to a run.
    ///
    /// # Arguments
    /// - `soil`: the parameters that formulas may use; NaN for a parameter that the model lacks, which no effect may use.
    /// - `effects`: compiled for [`ModelForm::Outside`](crate::effects::ModelForm::Outside); the load does not depend on
    ///   pull or torque.
    ///
    /// # Errors
    /// [`Rejection::InvalidParameter`]: a field of wheel or condition is outside its bounds. [`Rejection::Formula`]: a formula
    /// gives an inadmissible value.
    pub fn new(
        soil: &Soil,
        wheel: &Wheel,
        condition: &Condition,
        effects: &Active,
        site: &Site,
    ) -> Result<Self, Rejection> {
        let (wheel, condition) = (wheel.checked()?, condition.checked()?);
        let case = effects.case(soil, &wheel, &condition, site)?;
        case.wheel.checked()?;
        case.condition.checked()?;
        Ok(OutsideRun(case))
    }

    /// Returns the condition of the run.
    pub fn condition(&self) -> &Condition {
        &self.0.condition
    }

    /// Returns the wheel after the effects.
    pub fn wheel(&self) -> &Wheel {
        &self.0.wheel
    }

    /// Returns the sinkage exponent after the effects.
    pub fn sinkage_exponent(&self) -> f64 {
        self.0.soil.n
    }

    /// Returns the measured channels: drawbar pull `[N]`, torque \[N m\], sinkage `[m]`, lateral force `[N]`, from
    /// those that the model answered; NaN is a channel that the model lacks, which no effect may use.
    ///
    /// [`Rejection::Formula`]: a formula gives an inadmissible value.
    pub fn measured(&self, effects: &Active, channels: [f64; 4]) -> Result<[f64; 4], Rejection> {
        if !effects.change_channels() {
            return Ok(channels);
        }
        let mut variables = self.0.variables;
        for (variable, value) in CHANNELS.into_iter().zip(channels) {
            variables[variable as usize] = value;
        }
        effects.measure(&mut variables)?;
        Ok(CHANNELS.map(|variable| variables[variable as usize]))
    }
}

#[cfg(test)]
mod tests {
    use formula::catalogue::find;

    use super::*;
    use crate::effects::{CompiledEffects, ModelForm};
    use crate::fixture::{CONDITION, WHEEL};

    const NO_SOIL: Soil = Soil {
        k_c: f64::NAN,
        k_phi: f64::NAN,
        n: 1.0,
        cohesion_pa: f64::NAN,
        friction_angle_rad: f64::NAN,
        shear_velocity_m_s: f64::NAN,
        gamma_exponent: f64::NAN,
    };

    fn with(name: &str, values: &[f64]) -> (OutsideRun, [f64; 4]) {
        let effects = CompiledEffects::compile(ModelForm::Outside, find(name)).unwrap();
        let active = effects.activate([values.to_vec()]);
        let run = OutsideRun::new(&NO_SOIL, &WHEEL, &CONDITION, &active, &Site::default()).unwrap();
        let measured = run.measured(&active, [20.0, 5.0, 0.01, f64::NAN]).unwrap();
        (run, measured)
    }

    #[test]
    fn effects_act_on_inputs_and_outputs() {
        // 100 N (1 + 0.1), n + 0.5 |0.2|, 20 N - 3 N
        let (run, channels) = with("load_scale", &[0.1]);
        assert!((run.condition().wheel_load_n - 110.0).abs() < 1e-9);
        assert!((channels[0] - 20.0).abs() < f64::EPSILON);
        assert!((with("slip_sinkage", &[0.5]).0.sinkage_exponent() - 1.1).abs() < 1e-12);
        assert!((with("sled_tare", &[3.0]).1[0] - 17.0).abs() < 1e-12);
        // the motor keeps its speed: (1 - 0.2) v / (1 - s) with the new slip s
        let (run, _) = with("slip_radius_error", &[0.03]);
        let speed = CONDITION.rig_rim_speed_m_s() * (1.0 - run.condition().slip);
        assert!((run.condition().sled_speed_m_s - speed).abs() < 1e-12);
    }

    #[test]
    fn effects_inside_the_contact_have_no_form_outside() {
        let error = CompiledEffects::compile(ModelForm::Outside, find("elastic_rebound")).unwrap_err();
        assert!(error.to_string().contains("a model that is not ours"), "{error}");
    }
}

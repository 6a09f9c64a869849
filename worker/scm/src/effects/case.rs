//! The case to simulate: a run after the effects on slip, dimensions, exponent and load.

use formula::variable::Variables;
use formula::{Hook, Program, Variable};

use super::{Active, Law, Site};
use crate::{Condition, Rejection, Soil, Wheel};

/// Soil, wheel and condition that a model integrates, with the variables that formulas see.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) soil: Soil,
    pub(crate) wheel: Wheel,
    pub(crate) condition: Condition,
    /// Values by [`Variable`]; the model fills in those of nodes and channels.
    pub(crate) variables: [f64; Variable::COUNT],
}

impl Active<'_> {
    /// Applies the effects on slip, radius, width and sinkage exponent, and on the load up to the first that depends on pull
    /// or torque.
    pub(crate) fn case(
        &self,
        soil: &Soil,
        wheel: &Wheel,
        condition: &Condition,
        site: &Site,
    ) -> Result<Case, Rejection> {
        let mut variables = [0.0; Variable::COUNT];
        for (variable, value) in [
            (Variable::SledSpeed, condition.sled_speed_m_s),
            (Variable::WheelLoad, condition.wheel_load_n),
            (Variable::Radius, wheel.radius_m),
            (Variable::Width, wheel.width_m),
            (Variable::FrictionAngle, soil.friction_angle_rad),
            (Variable::Cohesion, soil.cohesion_pa),
            (Variable::N, soil.n),
            (Variable::ShearVelocity, soil.shear_velocity_m_s),
            (Variable::Density, site.density_kg_m3.unwrap_or(f64::NAN)),
            (Variable::Gravity, site.gravity_m_s2),
            (Variable::GrouserCount, f64::from(site.grouser_count)),
            (Variable::GrouserHeight, site.grouser_height_m),
            (Variable::Pass, f64::from(condition.pass)),
            (Variable::BinLength, site.bin_length_m.unwrap_or(f64::NAN)),
            (Variable::Order, site.order.unwrap_or(f64::NAN)),
        ] {
            variables[variable as usize] = value;
        }
        slide(condition.slip, condition, &mut variables);
        if self.enter(Hook::Slip) {
            replace(Hook::Slip, self.at(Hook::Slip), &mut variables)?;
        }
        let slip = variables[Variable::Slip as usize];
        if slip.to_bits() != condition.slip.to_bits() {
            // the motor keeps its speed: a changed slip changes the speed of the sled
            let rim = condition.rig_rim_speed_m_s();
            variables[Variable::SledSpeed as usize] = if slip < 0.0 {
                rim / (1.0 + slip)
            } else {
                rim * (1.0 - slip)
            };
            slide(slip, condition, &mut variables);
        }
        for hook in [Hook::Radius, Hook::Width, Hook::SinkageExponent] {
            if self.enter(hook) {
                replace(hook, self.at(hook), &mut variables)?;
            }
        }
        if self.enter(Hook::WheelLoad) {
            let load_laws = self
                .at(Hook::WheelLoad)
                .take_while(|law| !follows_reaction(law.0));
            replace(Hook::WheelLoad, load_laws, &mut variables)?;
        }
        let value_of = |variable: Variable| variables[variable as usize];
        Ok(Case {
            soil: Soil {
                n: value_of(Variable::N),
                ..*soil
            },
            wheel: Wheel {
                radius_m: value_of(Variable::Radius),
                width_m: value_of(Variable::Width),
                ..*wheel
            },
            condition: Condition {
                slip: value_of(Variable::Slip),
                sled_speed_m_s: value_of(Variable::SledSpeed),
                wheel_load_n: value_of(Variable::WheelLoad),
                ..*condition
            },
            variables,
        })
    }

    /// Returns whether the load that the soil must carry depends on pull or torque.
    pub(crate) fn load_follows_reaction(&self) -> bool {
        self.at(Hook::WheelLoad).any(|law| follows_reaction(law.0))
    }

    /// Returns whether the load that depends on pull and torque may jump with them.
    pub(crate) fn load_jumps(&self) -> bool {
        let reaction = Variables::new(&REACTION);
        self.at(Hook::WheelLoad).any(|law| law.0.kinks().meets(reaction))
    }

    /// Returns the load that the soil must carry for this pull and torque: the case's load after the formulas from the first
    /// that uses pull or torque.
    pub(crate) fn wheel_load(&self, case: &Case, drawbar_pull: f64, torque: f64) -> Result<f64, Rejection> {
        let mut variables = case.variables;
        variables[Variable::DrawbarPull as usize] = drawbar_pull;
        variables[Variable::Torque as usize] = torque;
        let following = self
            .at(Hook::WheelLoad)
            .skip_while(|law| !follows_reaction(law.0));
        replace(Hook::WheelLoad, following, &mut variables)?;
        Ok(variables[Variable::WheelLoad as usize])
    }
}

/// The reaction of the soil to a load.
const REACTION: [Variable; 2] = [Variable::DrawbarPull, Variable::Torque];

fn follows_reaction(program: &Program) -> bool {
    program.uses().meets(Variables::new(&REACTION))
}

/// Writes the slip variables of the wheel.
fn slide(slip: f64, condition: &Condition, variables: &mut [f64; Variable::COUNT]) {
    for (variable, value) in formula::slip::variables(slip, condition.slip_angle_rad) {
        variables[variable as usize] = value;
    }
}

/// Replaces a quantity of the run by the results of the formulas at its hook.
fn replace<'a, 'b>(
    hook: Hook,
    laws: impl Iterator<Item = (&'a Program, &'a Law, &'b [f64])>,
    variables: &mut [f64; Variable::COUNT],
) -> Result<(), Rejection> {
    let mut scalars = Vec::new();
    for (program, law, parameters) in laws {
        // Without nodes all points share all variables.
        let value = program
            .settle(variables, parameters, &mut scalars)
            .unwrap_or(f64::NAN);
        if !hook.admits(value) {
            return Err(law.refusal(hook, parameters, value, |v| variables[v as usize]));
        }
        variables[hook.target() as usize] = value;
    }
    Ok(())
}

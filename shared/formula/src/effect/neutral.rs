//! Whether an effect is absent at the neutral value of its strengths.

use super::{Effect, Mechanism, Parameter};
use crate::hook::Hook;
use crate::variable::{Variable, Variables};

/// Relative difference that rounding explains.
const ROUNDING: f64 = 1e-9;
/// Where formulas are tried: shares of the size of each variable.
const SHARES: [f64; 3] = [0.31, 0.74, 1.0];

impl Effect {
    /// What the effect changes at the neutral values of all its strengths, where it should change nothing, in words: since it is not
    /// evaluated there, the model jumps.
    ///
    /// Formulas are tried at three states of a wheel, at the values that other parameters have or may have. What is not finite there
    /// says nothing: a limit may be neutral that cannot be evaluated. Checked by
    /// `tests::an_effect_that_acts_at_its_neutral_value_says_where`.
    pub fn change_at_neutral(&self) -> Option<String> {
        let strengths: Vec<String> = self
            .parameters
            .iter()
            .filter_map(|p| Some(format!("{} = {}", p.name, p.neutral?)))
            .collect();
        strengths.first()?;
        let parameters: Vec<f64> = self.parameters.iter().map(value).collect();
        let (hook, before, after) = self.change(&parameters, &[])?;
        Some(format!(
            "at {}, its neutral value, effect {} turns a {} of {before} {unit} into {after} {unit}",
            strengths.join(", "),
            self.name,
            hook.name(),
            unit = hook.target().unit_name()
        ))
    }

    /// Whether the effect changes nothing where variables have these values, at the typical values of its strengths. What a mechanism
    /// does is not known here, and counts as a change; but a side wall pushes at a slip angle alone.
    ///
    /// Checked by `tests::an_effect_of_the_slip_angle_is_absent_straight_ahead`.
    pub fn is_absent_at(&self, held: &[(Variable, f64)]) -> bool {
        let typical = |p: &Parameter| p.typical.unwrap_or_else(|| value(p));
        let parameters: Vec<f64> = self.parameters.iter().map(typical).collect();
        let is_straight = held.contains(&(Variable::SlipAngle, 0.0));
        let can_act = match self.mechanism {
            None => false,
            Some(Mechanism::SideWall) => !is_straight,
            Some(_) => true,
        };
        !can_act && self.change(&parameters, held).is_none()
    }

    /// The first change that is found at three states of a wheel: of which quantity, from what to what.
    fn change(&self, parameters: &[f64], held: &[(Variable, f64)]) -> Option<(Hook, f64, f64)> {
        for hook in self.hooks() {
            let Some(program) = self.program(hook, Variables::default()) else {
                continue;
            };
            for share in SHARES {
                let mut variables = [0.0; Variable::COUNT];
                for variable in Variable::ALL {
                    variables[variable as usize] = share * size(variable);
                }
                for (variable, value) in held {
                    variables[*variable as usize] = *value;
                }
                let before = variables[hook.target() as usize];
                let after = program.settle(&variables, parameters, &mut Vec::new())?;
                if after.is_finite() && (after - before).abs() > ROUNDING * before.abs() {
                    return Some((hook, before, after));
                }
            }
        }
        None
    }
}

/// A value that a parameter has, or may have.
fn value(parameter: &Parameter) -> f64 {
    let number = |value: &toml::Value| value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
    let of_prior = || {
        let table = parameter.prior.as_table()?;
        let first = table.values().find_map(toml::Value::as_array)?;
        first.iter().rev().find_map(number)
    };
    let stated = parameter.neutral.or(parameter.typical);
    stated
        .or_else(|| number(&parameter.prior))
        .or_else(of_prior)
        .unwrap_or(1.0)
}

/// The size of a variable at the wheel of a small rover, in its SI unit.
fn size(variable: Variable) -> f64 {
    match variable {
        Variable::P => 1e4,
        Variable::TauMax => 6e3,
        Variable::Tau => 4e3,
        Variable::KStar => 1e6,
        Variable::Z | Variable::Vn | Variable::Vt | Variable::Sinkage | Variable::GrouserHeight => 0.01,
        Variable::J | Variable::SledSpeed => 0.02,
        Variable::BEff | Variable::ContactLength | Variable::Width => 0.08,
        Variable::Radius => 0.125,
        Variable::ShearVelocity => 1e-3,
        Variable::Position | Variable::FrictionAngle | Variable::Slip | Variable::Order => 0.5,
        Variable::SlipAngle | Variable::LongitudinalSlip | Variable::LateralSlip => 0.4,
        Variable::N => 1.0,
        Variable::Pass | Variable::BinLength => 2.0,
        Variable::Torque => 5.0,
        Variable::Gravity => 9.81,
        Variable::GrouserCount => 12.0,
        Variable::DrawbarPull | Variable::LateralForce => 20.0,
        Variable::WheelLoad => 100.0,
        Variable::Cohesion => 300.0,
        Variable::Density => 1500.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue;

    fn effect(formula: &str, neutral: f64) -> Effect {
        let text = format!(
            "name = \"e\"\nsummary = \"s\"\nsource = \"t\"\ndrawbar_pull = \"{formula}\"\n\
             [parameters.a]\nunit = \"1\"\nneutral = {neutral}\nprior = {{ half_normal = 0.1 }}\n"
        );
        Effect::read(&text).expect("an effect")
    }

    #[test]
    fn an_effect_that_acts_at_its_neutral_value_says_where() {
        let words = effect("drawbar_pull * (1 + a)", 1.0).change_at_neutral();
        assert_eq!(
            words.unwrap(),
            "at a = 1, its neutral value, effect e turns a drawbar_pull of 6.2 N into 12.4 N"
        );
        for (formula, neutral) in [
            ("drawbar_pull * (1 + a)", 0.0),
            ("drawbar_pull * a", 1.0),
            ("drawbar_pull * tanh(1 / a)", 0.0),
            ("drawbar_pull * a / a", 0.0),
        ] {
            assert_eq!(effect(formula, neutral).change_at_neutral(), None, "{formula}");
        }
    }

    #[test]
    fn an_effect_of_the_slip_angle_is_absent_straight_ahead() {
        let absent = |slip: f64, angle: f64| -> Vec<&str> {
            let slips = crate::slip::variables(slip, angle);
            let catalogue = catalogue::catalogue().iter();
            let absent = catalogue.filter(|effect| effect.is_absent_at(&slips));
            absent.map(|effect| effect.name.as_str()).collect()
        };
        let sideways = [
            "lateral_slip_sinkage",
            "side_bulldozing",
            "side_drag",
            "buried_side_wall",
        ];
        assert_eq!(absent(-0.3, 0.0), sideways);
        assert_eq!(absent(0.3, 0.0)[1..], sideways);
        assert_eq!(absent(0.3, 0.0)[0], "skid_sinkage");
        assert_eq!(absent(-0.3, 0.5), [""; 0]);
    }

    #[test]
    fn the_catalogue_is_neutral_where_it_says_so() {
        for effect in catalogue::catalogue() {
            assert_eq!(effect.change_at_neutral(), None, "{}", effect.name);
        }
    }
}

//! Check that an effect is absent at the neutral value of its strengths.

use super::{Effect, Mechanism, Parameter};
use crate::hook::Hook;
use crate::variable::{Variable, Variables};

/// Relative difference that rounding can cause.
const ROUNDING: f64 = 1e-9;
/// The points at which formulas are evaluated, as shares of the size of each variable.
const SHARES: [f64; 3] = [0.31, 0.74, 1.0];

impl Effect {
    /// Describes what the effect changes at the neutral values of all its strengths; `None` if it changes nothing, as it should.
    ///
    /// Because an effect is not evaluated there, such a change would be a jump of the model.
    ///
    /// Formulas are evaluated at three states of a wheel, at actual or possible values of the other parameters. A value
    /// that is not finite is skipped: a limit may be neutral that cannot be evaluated. Checked by
    /// `tests::an_effect_that_acts_at_its_neutral_value_is_named_with_its_quantity`.
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

    /// Returns whether the effect changes nothing when variables have these values, at the values at which its
    /// strengths are shown ([`Parameter::shown_at`]).
    ///
    /// The change by a mechanism is not known here and counts as a change, except that a side wall acts only at a slip angle.
    ///
    /// Checked by `tests::an_effect_of_the_slip_angle_is_absent_straight_ahead`.
    pub fn is_absent_at(&self, held: &[(Variable, f64)]) -> bool {
        let shown = |p: &Parameter| p.shown_at().unwrap_or_else(|| value(p));
        let parameters: Vec<f64> = self.parameters.iter().map(shown).collect();
        let is_straight = held.contains(&(Variable::SlipAngle, 0.0));
        let can_act = match self.mechanism {
            None => false,
            Some(Mechanism::SideWall) => !is_straight,
            Some(_) => true,
        };
        !can_act && self.change(&parameters, held).is_none()
    }

    /// Returns the first change found at three states of a wheel: the quantity, its value before and its value after.
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

impl Parameter {
    /// Returns the value at which a strength is shown: the file's, or else one scale of its prior.
    ///
    /// Checked by `tests::every_strength_is_shown_at_a_value_that_is_not_neutral`.
    #[must_use]
    pub fn shown_at(&self) -> Option<f64> {
        let prior = &self.prior;
        let pair = |key: &str| -> Option<[f64; 2]> {
            let [a, b] = prior.get(key)?.as_array()?.as_slice() else {
                return None;
            };
            Some([number(a)?, number(b)?])
        };
        let prior_centre = || {
            // The middle of a uniform prior about the neutral value would be that.
            let uniform = || {
                pair("uniform").map(|[a, b]| match f64::midpoint(a, b) {
                    middle if Some(middle) == self.neutral => b,
                    middle => middle,
                })
            };
            let loguniform = || pair("loguniform").map(|[a, b]| libm::sqrt(a * b));
            let normal = || pair("normal").map(|[mean, sd]| mean + sd);
            let lognormal = || pair("lognormal").map(|[median, _]| median);
            let half = || number(prior.get("half_normal")?);
            let table = uniform().or_else(loguniform).or_else(normal);
            table.or_else(lognormal).or_else(half)
        };
        self.typical.or_else(|| number(prior)).or_else(prior_centre)
    }
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

/// Returns the fixed value of a parameter, or a possible one.
fn value(parameter: &Parameter) -> f64 {
    let prior_value = || {
        let table = parameter.prior.as_table()?;
        let first = table.values().find_map(toml::Value::as_array)?;
        first.iter().rev().find_map(number)
    };
    let stated = parameter.neutral.or(parameter.typical);
    stated
        .or_else(|| number(&parameter.prior))
        .or_else(prior_value)
        .unwrap_or(1.0)
}

/// Returns the size of a variable for the wheel of a small rover, in its SI unit.
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
    fn every_strength_is_shown_at_a_value_that_is_not_neutral() {
        for effect in catalogue::catalogue() {
            for parameter in effect.parameters.iter().filter(|p| p.neutral.is_some()) {
                let name = format!("{}.{}", effect.name, parameter.name);
                assert_ne!(parameter.shown_at(), parameter.neutral, "{name}");
            }
        }
        // Priors about the neutral value, without a typical value.
        for prior in ["normal = [0.0, 0.2]", "uniform = [-0.2, 0.2]"] {
            let text = effect("drawbar_pull * (1 + a)", 0.0).text;
            let about_neutral = Effect::read(&text.replace("half_normal = 0.1", prior)).expect("an effect");
            assert_eq!(about_neutral.parameters[0].shown_at(), Some(0.2), "{prior}");
            assert!(
                !about_neutral.is_absent_at(&[(Variable::SlipAngle, 0.0)]),
                "{prior}"
            );
        }
    }

    #[test]
    fn an_effect_that_acts_at_its_neutral_value_is_named_with_its_quantity() {
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
    fn the_catalogue_is_neutral_at_its_neutral_values() {
        for effect in catalogue::catalogue() {
            assert_eq!(effect.change_at_neutral(), None, "{}", effect.name);
        }
    }
}

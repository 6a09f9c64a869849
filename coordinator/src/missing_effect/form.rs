//! Simple forms of a dependence outside the library, as effect files.

use std::fmt::Write;

use super::candidate::Explanation;
use super::range::{DependsOn, rounded};
use super::scan::{Pair, SOURCE};
use record::Extension;

/// A form with one variable; the magnitude m of the variable counts where x would lose its meaning below 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Form {
    /// A stress times (m / its middle)^a; a channel plus a (m / its greatest)^b.
    Power,
    /// Times 1 + a (1 − e^(−m/scale)); plus a (1 − e^(−m/scale)).
    Saturation,
    /// Times 1 + a x / its greatest; plus a x / its greatest.
    Linear,
    /// Above a threshold times 1 + a; plus a.
    Step,
    /// Times 1 + a ln(1 + m/scale); plus a ln(1 + m/scale).
    Log,
    /// Times 1 − a e^(−m/scale); plus a e^(−m/scale).
    Decay,
    /// Times (1 + m/scale)^(−a); plus a / (1 + m/scale).
    InversePower,
}

/// What shapes a form beside its strength.
enum Shape {
    None,
    /// The exponent of a channel's power.
    Exponent,
    Scale,
    Threshold,
}

/// Least factor of forms that would otherwise change the sign of a stress beyond the range in which they were fitted.
const LEAST_FACTOR: f64 = 0.05;
/// A scale or threshold reaches down to this share of the greatest magnitude of the variable `[1]`.
const LEAST_SCALE: f64 = 0.05;
/// The same where it is logarithmic, but the range of its variable is not `[1]`.
const LEAST_DEPTH: f64 = 1.0 / 30.0;
/// Below this share of the greatest magnitude a power is constant, where the range itself begins at 0 `[1]`.
const LEAST_BASE: f64 = 0.01;

impl Form {
    /// Every form.
    pub const ALL: [Form; 7] = [
        Form::Power,
        Form::Saturation,
        Form::Linear,
        Form::Step,
        Form::Log,
        Form::Decay,
        Form::InversePower,
    ];

    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Form::Power => "power",
            Form::Saturation => "saturation",
            Form::Linear => "linear",
            Form::Step => "step",
            Form::Log => "log",
            Form::Decay => "decay",
            Form::InversePower => "inverse_power",
        }
    }

    /// The effect file of this form for a pair.
    ///
    /// One strength, neutral at 0; a scale or a threshold where the form has one, with a prior over the range of the variable. Checked
    /// by `tests::forms_are_what_their_names_say`.
    pub fn of(self, pair: &Pair) -> Explanation {
        let name = format!("{}_{}", pair.name(), self.name());
        let strength = self.strength(pair);
        let formula = match pair.addition_sd {
            None => format!("{} * {}", pair.target(), self.factor(pair, &strength)),
            Some(_) => format!("{} + {strength} * {}", pair.target(), self.added(pair)),
        };
        let prior = match pair.addition_sd {
            None => self.factor_prior().to_owned(),
            Some(sd) => format!("{{ normal = [0.0, {sd:?}] }}"),
        };
        let mut text = format!(
            "name = \"{name}\"\nsummary = \"{}\"\nsource = \"{SOURCE}\"\n{} = \"{formula}\"\n\n\
             [parameters.{strength}]\nunit = \"{}\"\nneutral = 0.0\nprior = {prior}\n",
            self.summary(pair),
            pair.acts_on.name(),
            pair.unit(),
        );
        if let Some((parameter, unit, prior)) = self.shape_parameter(pair) {
            // Writing to a text cannot fail.
            let _ = write!(
                text,
                "\n[parameters.{parameter}]\nunit = \"{unit}\"\nprior = {prior}\n"
            );
        }
        Explanation {
            extension: Extension::File {
                name: format!("{name}.toml"),
                text,
            },
            name,
        }
    }

    fn summary(self, pair: &Pair) -> String {
        let (quantity, variable) = (pair.acts_on.words(), pair.depends_on.words());
        match self {
            Form::Power => format!("{quantity} changes with a power of the {variable}"),
            Form::Saturation => format!("{quantity} changes with the {variable} and settles"),
            Form::Linear => format!("{quantity} changes in proportion to the {variable}"),
            Form::Step => format!("above a {variable} of its own {quantity} is another"),
            Form::Log => format!("{quantity} changes with the logarithm of the {variable}"),
            Form::Decay => format!("at a small {variable} {quantity} is another"),
            Form::InversePower => format!("{quantity} changes with an inverse power of the {variable}"),
        }
    }

    /// The name of the strength.
    fn strength(self, pair: &Pair) -> String {
        match (pair.addition_sd, self) {
            (Some(_), _) => format!("addition{}", suffix(pair.unit())),
            (None, Form::Power | Form::InversePower) => "exponent".into(),
            (None, _) => "change".into(),
        }
    }

    /// What a stress is multiplied by.
    fn factor(self, pair: &Pair, strength: &str) -> String {
        let (x, m, greatest) = (pair.depends_on.name(), magnitude(pair), greatest(pair));
        let (least, scale) = (LEAST_FACTOR, scale_name(pair));
        match self {
            Form::Power => format!(
                "(max({m}, {:?}) / {:?})^{strength}",
                least_base(pair),
                middle(pair)
            ),
            Form::Saturation => format!("(1 + {strength} * (1 - exp(-{m} / {scale})))"),
            Form::Linear => format!("max(1 + {strength} * {x} / {greatest:?}, {least:?})"),
            Form::Step => format!("if({x} > {}, 1 + {strength}, 1)", threshold_name(pair)),
            Form::Log => format!("max(1 + {strength} * log(1 + {m} / {scale}), {least:?})"),
            Form::Decay => format!("(1 - {strength} * exp(-{m} / {scale}))"),
            Form::InversePower => format!("(1 + {m} / {scale})^(-{strength})"),
        }
    }

    /// Bounded where the factor would change its sign within the range.
    fn factor_prior(self) -> &'static str {
        match self {
            Form::Power => "{ normal = [0.0, 0.3] }",
            Form::InversePower => "{ normal = [0.0, 0.5] }",
            Form::Saturation | Form::Linear => "{ normal = [0.0, 0.5], bounds = [-0.95, 3.0] }",
            Form::Step => "{ normal = [0.0, 0.4], bounds = [-0.9, 2.0] }",
            Form::Log => "{ normal = [0.0, 0.3], bounds = [-0.9, 3.0] }",
            Form::Decay => "{ normal = [0.0, 0.5], bounds = [-3.0, 0.95] }",
        }
    }

    /// What is added to a channel, over the strength.
    fn added(self, pair: &Pair) -> String {
        let (x, m, greatest) = (pair.depends_on.name(), magnitude(pair), greatest(pair));
        let scale = scale_name(pair);
        match self {
            Form::Power => format!("(max({m}, {:?}) / {greatest:?})^exponent", least_base(pair)),
            Form::Saturation => format!("(1 - exp(-{m} / {scale}))"),
            Form::Linear => format!("{x} / {greatest:?}"),
            Form::Step => format!("if({x} > {}, 1, 0)", threshold_name(pair)),
            Form::Log => format!("log(1 + {m} / {scale})"),
            Form::Decay => format!("exp(-{m} / {scale})"),
            Form::InversePower => format!("(1 + {m} / {scale})^(-1)"),
        }
    }

    fn shape(self, pair: &Pair) -> Shape {
        match self {
            Form::Linear => Shape::None,
            Form::Power if pair.addition_sd.is_none() => Shape::None,
            Form::Power => Shape::Exponent,
            Form::Step => Shape::Threshold,
            Form::Saturation | Form::Log | Form::Decay | Form::InversePower => Shape::Scale,
        }
    }

    /// Name, unit and prior of what shapes the form.
    fn shape_parameter(self, pair: &Pair) -> Option<(String, &'static str, String)> {
        let unit = pair.variable().unit_name();
        let highest = greatest(pair);
        let from = |lowest: f64| -> String {
            let spans = pair.range.is_logarithmic || pair.depends_on == DependsOn::Z;
            let kind = if spans { "loguniform" } else { "uniform" };
            format!("{{ {kind} = [{lowest:?}, {highest:?}] }}")
        };
        let least = match (pair.range.is_logarithmic, pair.depends_on) {
            (true, _) => pair.range.lowest,
            (false, DependsOn::Z) => rounded(LEAST_DEPTH * highest, 4),
            (false, _) => rounded(LEAST_SCALE * highest, 4),
        };
        match self.shape(pair) {
            Shape::None => None,
            Shape::Exponent => Some(("exponent".into(), "1", "{ uniform = [0.2, 3.0] }".into())),
            Shape::Scale => Some((scale_name(pair), unit, from(least))),
            Shape::Threshold => {
                let prior = match pair.depends_on {
                    DependsOn::Slip | DependsOn::Position | DependsOn::WheelLoad | DependsOn::Sinkage => {
                        let (lowest, highest) = (pair.range.lowest, pair.range.highest);
                        format!("{{ uniform = [{lowest:?}, {highest:?}] }}")
                    }
                    _ => from(least),
                };
                Some((threshold_name(pair), unit, prior))
            }
        }
    }
}

/// The formula of the magnitude: slip counts alike in driving and skid, and a wheel above the surface is at it.
fn magnitude(pair: &Pair) -> String {
    let x = pair.depends_on.name();
    match pair.depends_on {
        _ if pair.range.lowest >= 0.0 => x.to_owned(),
        DependsOn::Sinkage => format!("max({x}, 0)"),
        _ => format!("abs({x})"),
    }
}

fn greatest(pair: &Pair) -> f64 {
    pair.range.greatest()
}

/// Where a power is 1: in the middle of the range.
fn middle(pair: &Pair) -> f64 {
    let middle = match pair.range.is_logarithmic {
        true => (pair.range.lowest * pair.range.highest).sqrt(),
        false => 0.5 * greatest(pair),
    };
    rounded(middle, 4)
}

/// Below it a power is constant, so that it is finite at 0.
fn least_base(pair: &Pair) -> f64 {
    match pair.range.is_logarithmic {
        true => pair.range.lowest,
        false => rounded(LEAST_BASE * greatest(pair), 4),
    }
}

fn scale_name(pair: &Pair) -> String {
    format!("scale{}", suffix(pair.variable().unit_name()))
}

fn threshold_name(pair: &Pair) -> String {
    format!("threshold{}", suffix(pair.variable().unit_name()))
}

/// What a name ends in for its unit: `_m_s`.
fn suffix(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => format!("_{}", unit.replace([' ', '/'], "_").to_lowercase()),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::missing_effect::candidate::extended;
    use crate::missing_effect::curve::{curve, written};
    use crate::missing_effect::scan::pairs;
    use crate::missing_effect::scan::tests::{read, text};
    use job::Spec;

    fn pair(folder: &str, name: &str) -> Pair {
        let mut pairs = pairs(&read(folder).2).into_iter();
        pairs.find(|pair| pair.name() == name).unwrap()
    }

    /// The curve of a form at these values of its parameters.
    fn shown(form: Form, pair: &Pair, values: &[f64]) -> Vec<[f64; 2]> {
        let explanation = form.of(pair);
        let (text, effect) = text(&explanation);
        let names = effect
            .parameters
            .iter()
            .map(|p| format!("{}.{}", effect.name, p.name));
        let parameters: BTreeMap<String, f64> = names.zip(values.iter().copied()).collect();
        curve(text, &parameters, pair).unwrap()
    }

    #[test]
    fn every_form_is_an_effect_file_that_a_model_takes() {
        for folder in ["tests/data/shear-mobilisation", "examples/cmu-sand"] {
            let (job, files, experiment) = read(folder);
            for pair in pairs(&experiment) {
                for form in Form::ALL {
                    let explanation = form.of(&pair);
                    assert_eq!(explanation.name, format!("{}_{}", pair.name(), form.name()));
                    let (_, effect) = text(&explanation);
                    assert_eq!(
                        effect.parameters.iter().filter(|p| p.neutral.is_some()).count(),
                        1
                    );
                    let with = extended("job.toml", &job, &[&explanation.extension]).unwrap();
                    let spec = Spec::new("job.toml", &with, "experiment.toml", &files);
                    spec.unwrap_or_else(|e| panic!("{e}"));
                    // at its neutral strength it changes nothing, at another one something
                    let neutral: f64 = if pair.addition_sd.is_some() { 0.0 } else { 1.0 };
                    let x0 = 0.5 * pair.range.highest;
                    let off = shown(form, &pair, &[0.0, x0]);
                    assert!(
                        off.iter().all(|[_, y]| (y - neutral).abs() < 1e-12),
                        "{}",
                        explanation.name
                    );
                    let on = shown(form, &pair, &[0.3, x0]);
                    assert!(
                        on.iter().any(|[_, y]| (y - neutral).abs() > 1e-3),
                        "{}",
                        explanation.name
                    );
                    assert!(pair.addition_sd.is_some() || on.iter().all(|[_, y]| *y > 0.0));
                }
            }
        }
    }

    #[test]
    fn forms_are_what_their_names_say() {
        let depth = pair("tests/data/shear-mobilisation", "pressure_z");
        let (a, x0, most) = (0.4, 0.004, depth.range.highest);
        let factor = |form: Form, z: f64| match form {
            Form::Power => libm::pow(z.max(0.01 * most) / (0.5 * most), a),
            Form::Saturation => 1.0 + a * (1.0 - libm::exp(-z / x0)),
            Form::Linear => 1.0 + a * z / most,
            Form::Step => 1.0 + if z > x0 { a } else { 0.0 },
            Form::Log => 1.0 + a * libm::log(1.0 + z / x0),
            Form::Decay => 1.0 - a * libm::exp(-z / x0),
            Form::InversePower => libm::pow(1.0 + z / x0, -a),
        };
        for form in Form::ALL {
            for [z, y] in shown(form, &depth, &[a, x0]) {
                // files show their numbers to four digits
                assert!((y - factor(form, z)).abs() < 1e-3, "{form:?} at {z}: {y}");
            }
        }
    }

    #[test]
    fn a_step_says_where_it_stands_and_reads_as_a_sentence() {
        let slip = pair("tests/data/shear-mobilisation", "shear_slip");
        let explanation = Form::Step.of(&slip);
        let (text, effect) = text(&explanation);
        assert_eq!(effect.name, "shear_slip_step");
        assert_eq!(
            effect.summary,
            "above a slip of its own the shear stress is another"
        );
        assert!(
            text.contains("shear = \"tau * if(slip > threshold, 1 + change, 1)\""),
            "{text}"
        );
        assert!(text.contains("prior = { uniform = [0.05, 0.6] }"), "{text}");
        let best = BTreeMap::from([
            ("shear_slip_step.change".to_owned(), 0.312_345),
            ("shear_slip_step.threshold".to_owned(), 0.21),
        ]);
        let written = written(text, &best);
        assert!(
            written.contains("# most probable value: 0.3123\n[parameters.change]\n"),
            "{written}"
        );
        assert!(
            written.contains("# most probable value: 0.21\n[parameters.threshold]\n"),
            "{written}"
        );
        let again = formula::Effect::read(&written).unwrap();
        assert_eq!((again.name, again.summary), (effect.name, effect.summary));
    }

    #[test]
    fn skid_counts_like_driving_where_a_form_needs_a_magnitude() {
        let slip = pair("examples/cmu-sand", "drawbar_pull_slip");
        assert!(slip.range.lowest < -0.6);
        let shown = shown(Form::Decay, &slip, &[2.0, 0.3]);
        for [s, y] in shown {
            assert!((y - 2.0 * libm::exp(-s.abs() / 0.3)).abs() < 1e-9, "{s}: {y}");
        }
    }
}

//! Simple forms of a dependence outside the library, as effect files.

use std::fmt::Write;

use super::dependence::{Dependence, SOURCE};
use super::range::{DependsOn, rounded};
use crate::candidate::CandidateEffect;
use record::Extension;

/// A form in one variable x. m is its magnitude, used where the form is undefined for x < 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum LawForm {
    /// A stress times (m / its middle)^a; a channel plus a (m / its maximum)^b.
    Power,
    /// Times 1 + a (1 − e^(−m/scale)); plus a (1 − e^(−m/scale)).
    Saturation,
    /// Times 1 + a x / its maximum; plus a x / its maximum.
    Linear,
    /// Above a threshold times 1 + a; plus a.
    Step,
    /// Times 1 + a ln(1 + m/scale); plus a ln(1 + m/scale).
    Log,
    /// Times 1 − a e^(−m/scale); plus a e^(−m/scale).
    Decay,
    /// Times (1 + m/scale)^(−a); plus a / (1 + m/scale).
    InversePower,
    /// Times 1 + a (m / its maximum)^b. A channel has the power in its place.
    Growth,
    /// Times 1 + a m / (m + scale); plus a m / (m + scale).
    Hyperbola,
    /// Times 1 + a e^(−((x − centre)/width)²/2); plus a e^(−((x − centre)/width)²/2). A variable with a logarithmic range has none.
    Bump,
}

/// A shape parameter of a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FormShape {
    /// The exponent of a growth, and of a channel's power.
    Exponent,
    Scale,
    Threshold,
    /// The place of a bump.
    Centre,
    /// The standard width of a bump.
    Width,
}

/// Least factor on a stress, which keeps its sign beyond the fitted range.
const MIN_FACTOR: f64 = 0.05;
/// Lower end of a scale or threshold, as a share of the variable's maximum `[1]`.
const MIN_SCALE: f64 = 0.05;
/// The same for the depth, where the prior is log-uniform `[1]`.
const MIN_DEPTH: f64 = 1.0 / 30.0;
/// Below this share of the variable's maximum a power is constant, where the range begins at 0 `[1]`.
const MIN_BASE: f64 = 0.01;
/// Range of the width of a bump, as a share of the range of the variable `[1]`.
const BUMP_WIDTH: [f64; 2] = [0.05, 0.7];

impl LawForm {
    /// Every form.
    pub(crate) const ALL: [LawForm; 10] = [
        LawForm::Power,
        LawForm::Saturation,
        LawForm::Linear,
        LawForm::Step,
        LawForm::Log,
        LawForm::Decay,
        LawForm::InversePower,
        LawForm::Growth,
        LawForm::Hyperbola,
        LawForm::Bump,
    ];

    /// Returns whether a dependence may have the form.
    pub(crate) fn suits(self, dependence: &Dependence) -> bool {
        match self {
            LawForm::Growth => dependence.addition_sd.is_none(),
            LawForm::Bump => !dependence.range.is_logarithmic,
            _ => true,
        }
    }

    /// Returns the name in results.
    pub(crate) fn name(self) -> &'static str {
        match self {
            LawForm::Power => "power",
            LawForm::Saturation => "saturation",
            LawForm::Linear => "linear",
            LawForm::Step => "step",
            LawForm::Log => "log",
            LawForm::Decay => "decay",
            LawForm::InversePower => "inverse_power",
            LawForm::Growth => "growth",
            LawForm::Hyperbola => "hyperbola",
            LawForm::Bump => "bump",
        }
    }

    /// Returns the effect file of this form of a dependence.
    ///
    /// It has one strength, neutral at 0, and at most two shape parameters, with priors over the range of the variable. Checked by
    /// `tests::forms_are_what_their_names_say`.
    pub(crate) fn effect(self, dependence: &Dependence) -> CandidateEffect {
        let name = format!("{}_{}", dependence.name(), self.name());
        let strength = self.strength(dependence);
        let formula = match dependence.addition_sd {
            None => format!("{} * {}", dependence.target(), self.factor(dependence, &strength)),
            Some(_) => format!(
                "{} + {strength} * {}",
                dependence.target(),
                self.added(dependence)
            ),
        };
        let prior = match dependence.addition_sd {
            None => self.factor_prior().to_owned(),
            Some(sd) => format!("{{ normal = [0.0, {sd:?}] }}"),
        };
        let mut text = format!(
            "name = \"{name}\"\nsummary = \"{}\"\nsource = \"{SOURCE}\"\n{} = \"{formula}\"\n\n\
             [parameters.{strength}]\nunit = \"{}\"\nneutral = 0.0\nprior = {prior}\n",
            self.summary(dependence),
            dependence.acts_on.name(),
            dependence.unit(),
        );
        for shape in self.shapes(dependence) {
            let (parameter, unit, prior) = shape.parameter(dependence);
            // Writing to a text cannot fail.
            let _ = write!(
                text,
                "\n[parameters.{parameter}]\nunit = \"{unit}\"\nprior = {prior}\n"
            );
        }
        CandidateEffect {
            extension: Extension::File {
                name: format!("{name}.toml"),
                text,
            },
            name,
        }
    }

    fn summary(self, dependence: &Dependence) -> String {
        let (quantity, variable) = (dependence.acts_on.words(), dependence.depends_on.words());
        match self {
            LawForm::Power => format!("{quantity} changes with a power of the {variable}"),
            LawForm::Saturation => format!("{quantity} changes with the {variable} and saturates"),
            LawForm::Linear => format!("{quantity} changes in proportion to the {variable}"),
            LawForm::Step => format!("{quantity} steps at a threshold of the {variable}"),
            LawForm::Log => format!("{quantity} changes with the logarithm of the {variable}"),
            LawForm::Decay => format!("{quantity} differs at a small {variable}"),
            LawForm::InversePower => format!("{quantity} changes with an inverse power of the {variable}"),
            LawForm::Growth => format!("{quantity} changes from 0 of the {variable} on by a power"),
            LawForm::Hyperbola => format!("{quantity} changes with the {variable} and saturates slowly"),
            LawForm::Bump => format!("{quantity} differs about one {variable}"),
        }
    }

    /// Returns the name of the strength.
    fn strength(self, dependence: &Dependence) -> String {
        match (dependence.addition_sd, self) {
            (Some(_), _) => format!("addition{}", suffix(dependence.unit())),
            (None, LawForm::Power | LawForm::InversePower) => "exponent".into(),
            (None, _) => "change".into(),
        }
    }

    /// Returns the factor on a stress.
    fn factor(self, dependence: &Dependence, strength: &str) -> String {
        let (x, m, greatest) = (
            dependence.depends_on.name(),
            magnitude(dependence),
            greatest(dependence),
        );
        let (least, scale) = (MIN_FACTOR, FormShape::Scale.name(dependence));
        match self {
            LawForm::Power => format!(
                "(max({m}, {:?}) / {:?})^{strength}",
                min_base(dependence),
                middle(dependence)
            ),
            LawForm::Saturation => format!("(1 + {strength} * (1 - exp(-{m} / {scale})))"),
            LawForm::Linear => format!("max(1 + {strength} * {x} / {greatest:?}, {least:?})"),
            LawForm::Step => format!(
                "if({x} > {}, 1 + {strength}, 1)",
                FormShape::Threshold.name(dependence)
            ),
            LawForm::Log => format!("max(1 + {strength} * log(1 + {m} / {scale}), {least:?})"),
            LawForm::Decay => format!("(1 - {strength} * exp(-{m} / {scale}))"),
            LawForm::InversePower => format!("(1 + {m} / {scale})^(-{strength})"),
            LawForm::Growth => {
                format!("max(1 + {strength} * ({m} / {greatest:?})^exponent, {least:?})")
            }
            LawForm::Hyperbola => format!("(1 + {strength} * {m} / ({m} + {scale}))"),
            LawForm::Bump => format!("(1 + {strength} * {})", bump(dependence)),
        }
    }

    /// Returns the prior of the strength of a factor, bounded where the factor would change its sign within the range. The other bound
    /// lies beyond all that a search reaches.
    fn factor_prior(self) -> &'static str {
        match self {
            LawForm::Power => "{ normal = [0.0, 0.3] }",
            LawForm::InversePower => "{ normal = [0.0, 0.5] }",
            LawForm::Saturation | LawForm::Linear | LawForm::Growth | LawForm::Hyperbola | LawForm::Bump => {
                "{ normal = [0.0, 0.7], bounds = [-0.95, 100.0] }"
            }
            LawForm::Step => "{ normal = [0.0, 0.4], bounds = [-0.9, 100.0] }",
            LawForm::Log => "{ normal = [0.0, 0.3], bounds = [-0.9, 100.0] }",
            LawForm::Decay => "{ normal = [0.0, 0.7], bounds = [-100.0, 0.95] }",
        }
    }

    /// Returns the addition to a channel per unit of the strength.
    fn added(self, dependence: &Dependence) -> String {
        let (x, m, greatest) = (
            dependence.depends_on.name(),
            magnitude(dependence),
            greatest(dependence),
        );
        let scale = FormShape::Scale.name(dependence);
        match self {
            LawForm::Power | LawForm::Growth => {
                format!("(max({m}, {:?}) / {greatest:?})^exponent", min_base(dependence))
            }
            LawForm::Saturation => format!("(1 - exp(-{m} / {scale}))"),
            LawForm::Linear => format!("{x} / {greatest:?}"),
            LawForm::Step => format!("if({x} > {}, 1, 0)", FormShape::Threshold.name(dependence)),
            LawForm::Log => format!("log(1 + {m} / {scale})"),
            LawForm::Decay => format!("exp(-{m} / {scale})"),
            LawForm::InversePower => format!("(1 + {m} / {scale})^(-1)"),
            LawForm::Hyperbola => format!("{m} / ({m} + {scale})"),
            LawForm::Bump => bump(dependence),
        }
    }

    /// Returns the shape parameters.
    fn shapes(self, dependence: &Dependence) -> &'static [FormShape] {
        match self {
            LawForm::Linear => &[],
            LawForm::Power if dependence.addition_sd.is_none() => &[],
            LawForm::Power | LawForm::Growth => &[FormShape::Exponent],
            LawForm::Step => &[FormShape::Threshold],
            LawForm::Saturation
            | LawForm::Log
            | LawForm::Decay
            | LawForm::InversePower
            | LawForm::Hyperbola => &[FormShape::Scale],
            LawForm::Bump => &[FormShape::Centre, FormShape::Width],
        }
    }
}

impl FormShape {
    /// Returns the name of the parameter.
    fn name(self, dependence: &Dependence) -> String {
        let name = match self {
            FormShape::Exponent => return "exponent".into(),
            FormShape::Scale => "scale",
            FormShape::Threshold => "threshold",
            FormShape::Centre => "centre",
            FormShape::Width => "bump_width",
        };
        format!("{name}{}", suffix(dependence.variable().unit_name()))
    }

    /// Returns the name, unit and prior of the parameter.
    fn parameter(self, dependence: &Dependence) -> (String, &'static str, String) {
        let unit = dependence.variable().unit_name();
        let (range, greatest) = (dependence.range, greatest(dependence));
        let from_least = || {
            let (lowest, kind) = match (range.is_logarithmic, dependence.depends_on) {
                (true, _) => (range.lowest, "loguniform"),
                (false, DependsOn::Z) => (rounded(MIN_DEPTH * greatest, 4), "loguniform"),
                (false, _) => (rounded(MIN_SCALE * greatest, 4), "uniform"),
            };
            format!("{{ {kind} = [{lowest:?}, {greatest:?}] }}")
        };
        let over_range = || format!("{{ uniform = [{:?}, {:?}] }}", range.lowest, range.highest);
        let (unit, prior) = match self {
            FormShape::Exponent => ("1", "{ uniform = [0.2, 3.0] }".into()),
            FormShape::Scale => (unit, from_least()),
            FormShape::Threshold => match dependence.depends_on {
                DependsOn::Slip | DependsOn::Position | DependsOn::WheelLoad | DependsOn::Sinkage => {
                    (unit, over_range())
                }
                _ => (unit, from_least()),
            },
            FormShape::Centre => (unit, over_range()),
            FormShape::Width => {
                let [narrowest, widest] =
                    BUMP_WIDTH.map(|share| rounded(share * (range.highest - range.lowest), 4));
                (unit, format!("{{ loguniform = [{narrowest:?}, {widest:?}] }}"))
            }
        };
        (self.name(dependence), unit, prior)
    }
}

/// Returns the formula of a bump of height 1.
fn bump(dependence: &Dependence) -> String {
    let [centre, width] = [FormShape::Centre, FormShape::Width].map(|shape| shape.name(dependence));
    format!(
        "exp(-0.5 * (({} - {centre}) / {width})^2)",
        dependence.depends_on.name()
    )
}

/// Returns the formula of the magnitude: that of a negative slip counts, that of a negative sinkage is 0.
fn magnitude(dependence: &Dependence) -> String {
    let x = dependence.depends_on.name();
    match dependence.depends_on {
        _ if dependence.range.lowest >= 0.0 => x.to_owned(),
        DependsOn::Sinkage => format!("max({x}, 0)"),
        _ => format!("abs({x})"),
    }
}

fn greatest(dependence: &Dependence) -> f64 {
    dependence.range.greatest()
}

/// Returns the middle of the range, where a power is 1.
fn middle(dependence: &Dependence) -> f64 {
    let middle = match dependence.range.is_logarithmic {
        true => (dependence.range.lowest * dependence.range.highest).sqrt(),
        false => 0.5 * greatest(dependence),
    };
    rounded(middle, 4)
}

/// Returns the value below which a power is constant, so that it is finite at 0.
fn min_base(dependence: &Dependence) -> f64 {
    match dependence.range.is_logarithmic {
        true => dependence.range.lowest,
        false => rounded(MIN_BASE * greatest(dependence), 4),
    }
}

/// Returns the suffix of a name for its unit: `_m_s`.
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
    use crate::candidate::extended;
    use crate::fixture::{read, text};
    use crate::law::curve::{curve, with_values};
    use crate::law::dependence::dependences;
    use job::Spec;

    fn dependence(folder: &str, name: &str) -> Dependence {
        let mut dependences = dependences(&read(folder).2).into_iter();
        dependences.find(|dependence| dependence.name() == name).unwrap()
    }

    /// The curve of a form at these values of its parameters.
    fn shown(form: LawForm, dependence: &Dependence, values: &[f64]) -> Vec<[f64; 2]> {
        let candidate = form.effect(dependence);
        let (text, effect) = text(&candidate);
        let names = effect
            .parameters
            .iter()
            .map(|p| format!("{}.{}", effect.name, p.name));
        let parameters: BTreeMap<String, f64> = names.zip(values.iter().copied()).collect();
        curve(text, &parameters, dependence).unwrap()
    }

    #[test]
    fn every_form_is_an_effect_file_that_a_model_takes() {
        for folder in ["tests/data/shear-mobilisation", "examples/cmu-sand"] {
            let (job, files, experiment) = read(folder);
            for dependence in dependences(&experiment) {
                for form in LawForm::ALL.into_iter().filter(|form| form.suits(&dependence)) {
                    let candidate = form.effect(&dependence);
                    assert_eq!(candidate.name, format!("{}_{}", dependence.name(), form.name()));
                    let (_, effect) = text(&candidate);
                    assert_eq!(
                        effect.parameters.iter().filter(|p| p.neutral.is_some()).count(),
                        1
                    );
                    let with = extended("job.toml", &job, &[&candidate.extension]).unwrap();
                    let spec = Spec::new("job.toml", &with, "experiment.toml", &files);
                    spec.unwrap_or_else(|e| panic!("{e}"));
                    // at its neutral strength it changes nothing, at another one something
                    let neutral: f64 = if dependence.addition_sd.is_some() {
                        0.0
                    } else {
                        1.0
                    };
                    let x0 = 0.5 * dependence.range.highest;
                    let off = shown(form, &dependence, &[0.0, x0, x0]);
                    assert!(
                        off.iter().all(|[_, y]| (y - neutral).abs() < 1e-12),
                        "{}",
                        candidate.name
                    );
                    let on = shown(form, &dependence, &[0.3, x0, x0]);
                    assert!(
                        on.iter().any(|[_, y]| (y - neutral).abs() > 1e-3),
                        "{}",
                        candidate.name
                    );
                    // A factor is positive at the bound of its prior, and at a strength that no prior excludes.
                    let is_positive = |strength: f64| {
                        let curve = shown(form, &dependence, &[strength, x0, x0]);
                        curve.iter().all(|[_, y]| *y > 0.0)
                    };
                    let strongest = match form {
                        LawForm::Decay => [-5.0, 0.95],
                        LawForm::Step | LawForm::Log => [-0.9, 5.0],
                        _ => [-0.95, 5.0],
                    };
                    assert!(
                        dependence.addition_sd.is_some() || strongest.into_iter().all(is_positive),
                        "{}",
                        candidate.name
                    );
                }
            }
        }
    }

    #[test]
    fn forms_are_what_their_names_say() {
        let depth = dependence("tests/data/shear-mobilisation", "pressure_z");
        let (a, x0, width, most) = (0.4, 0.004, 0.0015, depth.range.highest);
        let factor = |form: LawForm, z: f64| match form {
            LawForm::Power => libm::pow(z.max(0.01 * most) / (0.5 * most), a),
            LawForm::Saturation => 1.0 + a * (1.0 - libm::exp(-z / x0)),
            LawForm::Linear => 1.0 + a * z / most,
            LawForm::Step => 1.0 + if z > x0 { a } else { 0.0 },
            LawForm::Log => 1.0 + a * libm::log(1.0 + z / x0),
            LawForm::Decay => 1.0 - a * libm::exp(-z / x0),
            LawForm::InversePower => libm::pow(1.0 + z / x0, -a),
            LawForm::Growth => 1.0 + a * libm::pow(z / most, x0),
            LawForm::Hyperbola => 1.0 + a * z / (z + x0),
            LawForm::Bump => 1.0 + a * libm::exp(-0.5 * libm::pow((z - x0) / width, 2.0)),
        };
        for form in LawForm::ALL {
            for [z, y] in shown(form, &depth, &[a, x0, width]) {
                // Files round numbers to four digits.
                assert!((y - factor(form, z)).abs() < 1e-3, "{form:?} at {z}: {y}");
            }
        }
    }

    #[test]
    fn only_a_variable_with_a_linear_range_has_a_bump_and_only_a_stress_a_growth() {
        let suits =
            |name: &str, form: LawForm| form.suits(&dependence("tests/data/shear-mobilisation", name));
        for name in ["shear_z", "shear_slip", "torque_slip", "sinkage_sinkage"] {
            assert!(suits(name, LawForm::Bump), "{name}");
        }
        for name in ["shear_v_t", "pressure_j", "torque_sled_speed"] {
            assert!(!suits(name, LawForm::Bump), "{name}");
        }
        assert!(suits("shear_v_t", LawForm::Growth) && !suits("torque_slip", LawForm::Growth));
    }

    #[test]
    fn a_step_has_a_threshold_and_a_summary() {
        let slip = dependence("tests/data/shear-mobilisation", "shear_slip");
        let candidate = LawForm::Step.effect(&slip);
        let (text, effect) = text(&candidate);
        assert_eq!(effect.name, "shear_slip_step");
        assert_eq!(
            effect.summary,
            "the shear stress steps at a threshold of the slip"
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
        let written = with_values(text, &best);
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
        let slip = dependence("examples/cmu-sand", "drawbar_pull_slip");
        assert!(slip.range.lowest < -0.6);
        let shown = shown(LawForm::Decay, &slip, &[2.0, 0.3]);
        for [s, y] in shown {
            assert!((y - 2.0 * libm::exp(-s.abs() / 0.3)).abs() < 1e-9, "{s}: {y}");
        }
    }
}

//! The dependence of a quantity on a variable, as a curve: a factor on a stress, or an addition to a channel.

use std::fmt::Write;

use formula::{Hook, Variable};
use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse, TestRun};
use shared::model::ExternalModel;

use super::range::{DependsOn, KNOTS, VariableRange, measured, ranges, rounded};
use crate::candidate::CandidateEffect;
use record::Extension;

/// Prior standard deviation of the logarithm of a factor on a stress `[1]`.
const FACTOR_SD: f64 = 0.5;
/// Prior standard deviation of an addition to a channel, over the root mean square of its measurements `[1]`.
const ADDITION_SD: f64 = 0.2;
/// The source that the effect files of a search state.
pub(super) const SOURCE: &str = "found by the constitutive scan";

/// The quantity that a law changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ActsOn {
    /// The normal pressure; the law is a factor.
    Pressure,
    /// The shear stress; the law is a factor.
    Shear,
    /// The drawbar pull; the law is an addition.
    DrawbarPull,
    /// The torque; the law is an addition.
    Torque,
    /// The sinkage of the wheel; the law is an addition.
    Sinkage,
}

impl ActsOn {
    /// Every quantity, in the order of the search.
    pub(crate) const ALL: [ActsOn; 5] = [
        ActsOn::Pressure,
        ActsOn::Shear,
        ActsOn::DrawbarPull,
        ActsOn::Torque,
        ActsOn::Sinkage,
    ];

    /// Returns the hook of its formula.
    pub(crate) fn hook(self) -> Hook {
        match self {
            ActsOn::Pressure => Hook::Pressure,
            ActsOn::Shear => Hook::Shear,
            ActsOn::DrawbarPull => Hook::DrawbarPull,
            ActsOn::Torque => Hook::Torque,
            ActsOn::Sinkage => Hook::Sinkage,
        }
    }

    /// Returns the name in effect files and results.
    pub(crate) fn name(self) -> &'static str {
        self.hook().name()
    }

    /// Returns the name in sentences.
    pub(crate) fn words(self) -> &'static str {
        match self {
            ActsOn::Pressure => "the normal pressure",
            ActsOn::Shear => "the shear stress",
            ActsOn::DrawbarPull => "the drawbar pull",
            ActsOn::Torque => "the torque",
            ActsOn::Sinkage => "the wheel sinkage",
        }
    }

    /// Returns the channel; `None` for a stress.
    pub(crate) fn channel(self) -> Option<Channel> {
        match self {
            ActsOn::Pressure | ActsOn::Shear => None,
            ActsOn::DrawbarPull => Some(Channel::DrawbarPull),
            ActsOn::Torque => Some(Channel::Torque),
            ActsOn::Sinkage => Some(Channel::Sinkage),
        }
    }

    fn may_depend_on(self) -> &'static [DependsOn] {
        match self.channel() {
            None => &DependsOn::OF_STRESSES,
            Some(_) => &DependsOn::OF_CHANNELS,
        }
    }
}

/// A quantity that may depend on a variable, in one experiment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dependence {
    /// The quantity.
    pub(crate) acts_on: ActsOn,
    /// The variable.
    pub(crate) depends_on: DependsOn,
    /// Range of the variable.
    pub(crate) range: VariableRange,
    /// Prior standard deviation of the addition, in the channel's SI unit; `None` for a stress, which is multiplied.
    pub(crate) addition_sd: Option<f64>,
}

/// Lists the dependences that an experiment can show: 28, without unmeasured channels and variables with too few levels.
///
/// Checked by `tests::dependences_are_those_that_fitted_runs_can_show`.
pub(crate) fn dependences(experiment: &Experiment) -> Vec<Dependence> {
    let ranges = ranges(experiment);
    let runs = experiment.runs.iter().filter(|r| r.usage == RunUse::Fit);
    let runs: Vec<&TestRun> = runs.collect();
    let mut dependences = Vec::new();
    for acts_on in ActsOn::ALL {
        let addition_sd = acts_on
            .channel()
            .map(|channel| rounded(ADDITION_SD * root_mean_square(&runs, channel), 3));
        if addition_sd.is_some_and(|sd| sd <= 0.0) {
            continue;
        }
        for &depends_on in acts_on.may_depend_on() {
            let range = ranges.get(&depends_on);
            dependences.extend(range.map(|&range| Dependence {
                acts_on,
                depends_on,
                range,
                addition_sd,
            }));
        }
    }
    dependences
}

/// Returns the root mean square of the measurements; 0 without any.
fn root_mean_square(runs: &[&TestRun], channel: Channel) -> f64 {
    let squares = measured(runs, channel).map(|value| value * value);
    let (sum, count) = squares.fold((0.0, 0_u32), |(sum, count), square| (sum + square, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

impl Dependence {
    /// Returns whether a model shows the dependence: an external model has no stresses, and only the channels that it outputs.
    pub(crate) fn is_shown_by(&self, external: Option<&ExternalModel>) -> bool {
        let Some(model) = external else {
            return true;
        };
        let has = |channel: Channel| model.outputs.contains(&channel);
        let knows_variable = self.depends_on != DependsOn::Sinkage || has(Channel::Sinkage);
        self.acts_on.channel().is_some_and(has) && knows_variable
    }

    /// Returns the name in results: `pressure_z`.
    pub(crate) fn name(&self) -> String {
        format!("{}_{}", self.acts_on.name(), self.depends_on.name())
    }

    /// Returns the variable that the formula replaces: `p`.
    pub(super) fn target(&self) -> &'static str {
        self.acts_on.hook().target().name()
    }

    /// Returns the unit of the addition; that of a factor is 1.
    pub(super) fn unit(&self) -> &'static str {
        self.acts_on.channel().map_or("1", Channel::unit)
    }

    /// Returns the variable.
    pub(super) fn variable(&self) -> Variable {
        self.depends_on.variable()
    }

    /// Makes a piecewise linear curve, constant beyond the range: the logarithm of the factor on a stress, or the addition to a
    /// channel.
    ///
    /// The knots are equidistant; those of a logarithmic range are equidistant in the logarithm. Their values `a0` to `a4` are
    /// strengths, neutral at 0. Checked by `tests::a_curve_of_one_value_multiplies_everywhere`.
    pub(crate) fn curve(&self) -> CandidateEffect {
        let (target, words) = (self.target(), self.depends_on.words());
        let (formula, summary, sd) = match self.addition_sd {
            None => (
                format!("{target} * exp(curve)"),
                format!("{} is multiplied by a curve over {words}", self.acts_on.words()),
                FACTOR_SD,
            ),
            Some(sd) => (
                format!("{target} + curve"),
                format!("a curve over {words} is added to {}", self.acts_on.words()),
                sd,
            ),
        };
        let name = format!("scan_{}", self.name());
        let mut text = format!(
            "name = \"{name}\"\nsummary = \"{summary}\"\nsource = \"{SOURCE}\"\n{} = \"{formula}\"\n\n[definitions]\n\
             # from 0 to {last} over the range, in which a knot stands at every whole number\n\
             place = \"{}\"\ncurve = \"{}\"\n",
            self.acts_on.name(),
            self.place(),
            hats(),
            last = KNOTS - 1,
        );
        for (i, knot) in self.range.knots().into_iter().enumerate() {
            // Writing to a text cannot fail.
            let _ = write!(
                text,
                "\n[parameters.a{i}] # at {} = {:?} {}\nunit = \"{}\"\nneutral = 0.0\nprior = {{ normal = [0.0, {sd:?}] }}\n",
                self.depends_on.name(),
                rounded(knot, 4),
                self.variable().unit_name(),
                self.unit()
            );
        }
        CandidateEffect {
            name: self.name(),
            extension: Extension::File {
                name: format!("{name}.toml"),
                text,
            },
        }
    }

    /// Returns the formula of the place among the knots, from 0 to their number minus one.
    fn place(&self) -> String {
        let VariableRange {
            lowest,
            highest,
            is_logarithmic,
        } = self.range;
        let variable = self.depends_on.name();
        let last = (KNOTS - 1) as f64;
        if is_logarithmic {
            let width = libm::log(highest / lowest);
            format!("{last:?} * min(log(max({variable}, {lowest:?}) / {lowest:?}) / {width:?}, 1)")
        } else {
            let width = highest - lowest;
            format!("{last:?} * min(max(({variable} - {lowest:?}) / {width:?}, 0), 1)")
        }
    }
}

/// Returns the formula of the sum of the hat functions of the knots, each times its value.
fn hats() -> String {
    let hats: Vec<String> = (0..KNOTS)
        .map(|i| format!("a{i} * max(1 - abs(place - {i}), 0)"))
        .collect();
    hats.join(" + ")
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;
    use shared::outcome::Outcome;

    use super::*;
    use crate::candidate::extended;
    use crate::fixture::{read, text};
    use job::Spec;

    /// The values predicted for the fitted runs by a job, with some parameters other than the given ones.
    fn predicted(job: &FileSet, files: &FileSet, with: &[(&str, f64)]) -> Vec<f64> {
        let spec = Spec::new("job.toml", job, "experiment.toml", files).unwrap();
        let of = |name: &str| match name {
            "log10_p_ref" => 5.0,
            "n" => 1.1,
            "friction_angle_deg" => 28.0,
            "wheel_radius_m" => 0.13,
            _ => 0.0,
        };
        let said = |name: &str| with.iter().find(|(n, _)| *n == name).map(|(_, value)| *value);
        let names = spec.parameters.iter().map(|p| p.name.as_str());
        let theta: Vec<f64> = names.map(|name| said(name).unwrap_or_else(|| of(name))).collect();
        match worker::model::CompiledVariant::new(&spec.fit_variant, &Default::default())
            .unwrap()
            .evaluate(spec.model_theta(&theta))
        {
            Outcome::Evaluated(observables) => spec.predicted_values(&observables),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn dependences_are_those_that_fitted_runs_can_show() {
        let names = |folder: &str| -> Vec<String> {
            dependences(&read(folder).2)
                .iter()
                .map(Dependence::name)
                .collect()
        };
        let designed = names("tests/data/shear-mobilisation");
        assert_eq!(designed.len(), 28, "{designed:?}");
        assert!(designed.contains(&"sinkage_sinkage".to_owned()) && designed[0] == "pressure_z");
        // no torque is measured, and neither load nor sled speed have levels
        let sand = names("examples/cmu-sand");
        assert_eq!(sand.len(), 2 * 6 + 2 * 2, "{sand:?}");
    }

    #[test]
    fn every_curve_is_an_effect_file_that_a_model_takes() {
        let (job, files, experiment) = read("tests/data/shear-mobilisation");
        let base = predicted(&job, &files, &[]);
        for dependence in dependences(&experiment) {
            let curve = dependence.curve();
            let (_, effect) = text(&curve);
            assert_eq!(effect.hooks().collect::<Vec<_>>(), [dependence.acts_on.hook()]);
            let with = extended("job.toml", &job, &[&curve.extension]).unwrap();
            assert_eq!(
                predicted(&with, &files, &[]),
                base,
                "{} at zero",
                dependence.name()
            );
            let bent: Vec<(String, f64)> = (0..KNOTS)
                .map(|i| (format!("{}.a{i}", effect.name), 0.001 * (i + 1) as f64))
                .collect();
            let bent: Vec<(&str, f64)> = bent.iter().map(|(n, v)| (n.as_str(), *v)).collect();
            let changed = predicted(&with, &files, &bent);
            assert_ne!(changed, base, "{}", dependence.name());
        }
    }

    #[test]
    fn a_curve_of_one_value_multiplies_everywhere() {
        let (job, files, experiment) = read("tests/data/shear-mobilisation");
        let c: f64 = 0.2;
        let stiffer = [("log10_p_ref", 5.0 + c / std::f64::consts::LN_10)];
        let friction = libm::atan(libm::tan(28_f64.to_radians()) * libm::exp(c)).to_degrees();
        let rougher = [("friction_angle_deg", friction)];
        for dependence in dependences(&experiment)
            .into_iter()
            .filter(|p| p.addition_sd.is_none())
        {
            let curve = dependence.curve();
            let with = extended("job.toml", &job, &[&curve.extension]).unwrap();
            let values: Vec<(String, f64)> = (0..KNOTS)
                .map(|i| (format!("scan_{}.a{i}", dependence.name()), c))
                .collect();
            let values: Vec<(&str, f64)> = values.iter().map(|(n, v)| (n.as_str(), *v)).collect();
            let found = predicted(&with, &files, &values);
            let expected = match dependence.acts_on {
                ActsOn::Pressure => predicted(&job, &files, &stiffer),
                _ => predicted(&job, &files, &rougher),
            };
            for (found, expected) in found.iter().zip(&expected) {
                assert!(
                    (found - expected).abs() < 1e-6 * expected.abs().max(1e-3),
                    "{}: {found} {expected}",
                    dependence.name()
                );
            }
        }
    }
}

//! Laws outside the library: a stress times a curve, or a channel plus one, along one variable.

use std::fmt::Write;

use formula::{Hook, Variable};
use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse, TestRun};

use super::candidate::Explanation;
use super::range::{DependsOn, KNOTS, Range, measured, ranges, rounded};
use record::Extension;

/// Prior standard deviation of the logarithm of a factor on a stress `[1]`.
const FACTOR_SD: f64 = 0.5;
/// Prior standard deviation of what is added to a channel, over the root mean square of its measurements `[1]`.
const ADDITION_SD: f64 = 0.2;
/// Where the files of a search say that they come from.
pub(super) const SOURCE: &str = "found by the constitutive scan";

/// What a correction acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ActsOn {
    /// The normal pressure, which it multiplies.
    Pressure,
    /// The shear stress, which it multiplies.
    Shear,
    /// The drawbar pull, to which it adds.
    DrawbarPull,
    /// The torque, to which it adds.
    Torque,
    /// The sinkage of the wheel, to which it adds.
    Sinkage,
}

impl ActsOn {
    /// Every quantity, in the order of the scan.
    pub const ALL: [ActsOn; 5] = [
        ActsOn::Pressure,
        ActsOn::Shear,
        ActsOn::DrawbarPull,
        ActsOn::Torque,
        ActsOn::Sinkage,
    ];

    /// Where its formula enters.
    pub fn hook(self) -> Hook {
        match self {
            ActsOn::Pressure => Hook::Pressure,
            ActsOn::Shear => Hook::Shear,
            ActsOn::DrawbarPull => Hook::DrawbarPull,
            ActsOn::Torque => Hook::Torque,
            ActsOn::Sinkage => Hook::Sinkage,
        }
    }

    /// Name in effect files and results.
    pub fn name(self) -> &'static str {
        self.hook().name()
    }

    /// Words for people.
    pub fn words(self) -> &'static str {
        match self {
            ActsOn::Pressure => "the normal pressure",
            ActsOn::Shear => "the shear stress",
            ActsOn::DrawbarPull => "the drawbar pull",
            ActsOn::Torque => "the torque",
            ActsOn::Sinkage => "the wheel sinkage",
        }
    }

    /// The channel, where it is one.
    pub fn channel(self) -> Option<Channel> {
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

/// A quantity and what a correction of it depends on, in one experiment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The quantity.
    pub acts_on: ActsOn,
    /// The variable.
    pub depends_on: DependsOn,
    /// How far the variable reaches.
    pub range: Range,
    /// Prior standard deviation of what is added, in the channel's SI unit; `None` of a stress, which is multiplied.
    pub addition_sd: Option<f64>,
}

/// The pairs that an experiment can show: 28, less channels that are not measured and variables without enough levels.
///
/// Checked by `tests::pairs_are_those_that_fitted_runs_can_show`.
pub fn pairs(experiment: &Experiment) -> Vec<Pair> {
    let ranges = ranges(experiment);
    let runs = experiment.runs.iter().filter(|r| r.usage == RunUse::Fit);
    let runs: Vec<&TestRun> = runs.collect();
    let mut pairs = Vec::new();
    for acts_on in ActsOn::ALL {
        let addition_sd = acts_on
            .channel()
            .map(|channel| rounded(ADDITION_SD * root_mean_square(&runs, channel), 3));
        if addition_sd.is_some_and(|sd| sd <= 0.0) {
            continue;
        }
        for &depends_on in acts_on.may_depend_on() {
            let range = ranges.get(&depends_on);
            pairs.extend(range.map(|&range| Pair {
                acts_on,
                depends_on,
                range,
                addition_sd,
            }));
        }
    }
    pairs
}

/// Of what the runs measured; 0 where they measured nothing.
fn root_mean_square(runs: &[&TestRun], channel: Channel) -> f64 {
    let squares = measured(runs, channel).map(|value| value * value);
    let (sum, count) = squares.fold((0.0, 0_u32), |(sum, count), square| (sum + square, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

impl Pair {
    /// Name in results: `pressure_z`.
    pub fn name(&self) -> String {
        format!("{}_{}", self.acts_on.name(), self.depends_on.name())
    }

    /// What the formula replaces: `p`.
    pub(super) fn target(&self) -> &'static str {
        self.acts_on.hook().target().name()
    }

    /// Unit of what is added; that of a factor is 1.
    pub(super) fn unit(&self) -> &'static str {
        self.acts_on.channel().map_or("1", Channel::unit)
    }

    /// The variable.
    pub(super) fn variable(&self) -> Variable {
        self.depends_on.variable()
    }

    /// A piecewise linear curve with its knots evenly over the range (of what spans orders of magnitude, over its logarithm) and
    /// constant beyond: of a stress the logarithm of a factor, of a channel what is added.
    ///
    /// The values `a0` to `a4` at the knots are strengths: at 0 the model is without it.
    /// Checked by `tests::a_curve_of_one_value_multiplies_everywhere`.
    pub fn curve(&self) -> Explanation {
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
        Explanation {
            name: self.name(),
            extension: Extension::File {
                name: format!("{name}.toml"),
                text,
            },
        }
    }

    /// The formula of the place among the knots, from 0 to their number less one.
    fn place(&self) -> String {
        let Range {
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

/// Hat functions around the knots, each times its value.
fn hats() -> String {
    let hats: Vec<String> = (0..KNOTS)
        .map(|i| format!("a{i} * max(1 - abs(place - {i}), 0)"))
        .collect();
    hats.join(" + ")
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use formula::Effect;
    use shared::file::FileSet;
    use shared::model::effects::own;
    use shared::outcome::Outcome;

    use super::*;
    use crate::embedded::Evaluate;
    use crate::missing_effect::candidate::extended;
    use crate::missing_effect::curve::curve;
    use job::{Spec, check_own};

    /// An experiment of the repository, with the job beside it.
    pub(in crate::missing_effect) fn read(folder: &str) -> (FileSet, FileSet, Experiment) {
        let file = |name: &str| Path::new("..").join(folder).join(name);
        let job = FileSet {
            toml: std::fs::read_to_string(file("job.toml")).unwrap(),
            ..FileSet::default()
        };
        let files = Experiment::read_files(&file("experiment.toml")).unwrap();
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        (job, files, experiment)
    }

    /// The text of an explanation's file, read and checked as a user's.
    pub(in crate::missing_effect) fn text(explanation: &Explanation) -> (&str, Effect) {
        let Extension::File { name, text } = &explanation.extension else {
            panic!("{explanation:?}")
        };
        let effect = own(name, text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        check_own(name, &effect).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(format!("{}.toml", effect.name), *name);
        (text, effect)
    }

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
        match Evaluate::new(&spec.fit_variant)
            .unwrap()
            .evaluate(spec.model_theta(&theta))
        {
            Outcome::Evaluated(observables) => spec.predicted_values(&observables),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn pairs_are_those_that_fitted_runs_can_show() {
        let names = |folder: &str| -> Vec<String> { pairs(&read(folder).2).iter().map(Pair::name).collect() };
        let designed = names("tests/data/shear-mobilisation");
        // 28, without the wheel load of each quantity: two levels
        assert_eq!(designed.len(), 23, "{designed:?}");
        assert!(!designed.iter().any(|name| name.ends_with("wheel_load")));
        assert!(designed.contains(&"sinkage_sinkage".to_owned()) && designed[0] == "pressure_z");
        // no torque is measured, and neither load nor sled speed have levels
        let sand = names("examples/cmu-sand");
        assert_eq!(sand.len(), 2 * 6 + 2 * 2, "{sand:?}");
    }

    #[test]
    fn every_curve_is_an_effect_file_that_a_model_takes() {
        let (job, files, experiment) = read("tests/data/shear-mobilisation");
        let base = predicted(&job, &files, &[]);
        for pair in pairs(&experiment) {
            let curve = pair.curve();
            let (_, effect) = text(&curve);
            assert_eq!(effect.hooks().collect::<Vec<_>>(), [pair.acts_on.hook()]);
            let with = extended("job.toml", &job, &[&curve.extension]).unwrap();
            assert_eq!(predicted(&with, &files, &[]), base, "{} at zero", pair.name());
            let bent: Vec<(String, f64)> = (0..KNOTS)
                .map(|i| (format!("{}.a{i}", effect.name), 0.001 * (i + 1) as f64))
                .collect();
            let bent: Vec<(&str, f64)> = bent.iter().map(|(n, v)| (n.as_str(), *v)).collect();
            let changed = predicted(&with, &files, &bent);
            assert_ne!(changed, base, "{}", pair.name());
        }
    }

    #[test]
    fn a_curve_of_one_value_multiplies_everywhere() {
        let (job, files, experiment) = read("tests/data/shear-mobilisation");
        let c: f64 = 0.2;
        let stiffer = [("log10_p_ref", 5.0 + c / std::f64::consts::LN_10)];
        let friction = libm::atan(libm::tan(28_f64.to_radians()) * libm::exp(c)).to_degrees();
        let rougher = [("friction_angle_deg", friction)];
        for pair in pairs(&experiment).into_iter().filter(|p| p.addition_sd.is_none()) {
            let curve = pair.curve();
            let with = extended("job.toml", &job, &[&curve.extension]).unwrap();
            let values: Vec<(String, f64)> = (0..KNOTS)
                .map(|i| (format!("scan_{}.a{i}", pair.name()), c))
                .collect();
            let values: Vec<(&str, f64)> = values.iter().map(|(n, v)| (n.as_str(), *v)).collect();
            let found = predicted(&with, &files, &values);
            let expected = match pair.acts_on {
                ActsOn::Pressure => predicted(&job, &files, &stiffer),
                _ => predicted(&job, &files, &rougher),
            };
            for (found, expected) in found.iter().zip(&expected) {
                assert!(
                    (found - expected).abs() < 1e-6 * expected.abs().max(1e-3),
                    "{}: {found} {expected}",
                    pair.name()
                );
            }
        }
    }

    #[test]
    fn the_knots_carry_a_known_curve() {
        let (_, _, experiment) = read("tests/data/shear-mobilisation");
        let values = [0.3, -0.2, 0.5, 0.0, -0.4];
        for pair in pairs(&experiment) {
            let explanation = pair.curve();
            let (text, effect) = text(&explanation);
            let parameters: BTreeMap<String, f64> = (0..KNOTS)
                .map(|i| (format!("{}.a{i}", effect.name), values[i]))
                .collect();
            let shown = curve(text, &parameters, &pair).unwrap();
            for (i, knot) in pair.range.knots().into_iter().enumerate() {
                let [x, y] = shown[10 * i];
                let expected = match pair.addition_sd {
                    None => libm::exp(values[i]),
                    Some(_) => values[i],
                };
                assert!(
                    (x - knot).abs() <= 1e-12 * knot.abs(),
                    "{}: {x} {knot}",
                    pair.name()
                );
                assert!((y - expected).abs() < 1e-6, "{}: {y} {expected}", pair.name());
                // halfway to the next knot the curve is halfway
                if let Some(next) = values.get(i + 1) {
                    let halfway = f64::midpoint(values[i], *next);
                    let expected = pair.addition_sd.map_or(libm::exp(halfway), |_| halfway);
                    assert!((shown[10 * i + 5][1] - expected).abs() < 1e-6, "{}", pair.name());
                }
            }
        }
    }
}

//! The effects of a job, their order and their parameters.

use std::collections::BTreeSet;

use formula::catalogue::{catalogue, find};
use formula::{Effect, Parameter, Variable};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use utoipa::ToSchema;

use super::error::ModelError;
use crate::file::{FileError, unknown_word};
use crate::parameters::{self, ParameterBounds};

/// An effect and the text of its file, as sent to a worker, which may have another version of the catalogue and lacks the
/// user's files.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectText {
    /// Name of the effect.
    pub name: String,
    /// The text of its file, as written.
    pub text: String,
}

/// The effects of a job in the order of their evaluation at a hook: first the catalogue's in its order, then those from
/// files in the order of the job.
#[derive(Debug, Clone, Default)]
pub struct EffectSet(Vec<Chosen>);

/// An effect of a job.
#[derive(Debug, Clone)]
pub struct Chosen {
    /// The effect, as its file describes it.
    pub effect: Effect,
    /// The user's file; `None` for an effect of the catalogue.
    pub file: Option<String>,
}

/// A parameter of an effect for which a job states neither prior nor value.
#[derive(Debug, Clone)]
pub struct UnstatedParameter<'a> {
    /// Name of the parameter in the job: `EFFECT.PARAMETER`, or `EFFECT.PARAMETER.WHEEL`.
    pub name: String,
    /// The effect, with its file.
    pub chosen: &'a Chosen,
    /// The parameter, with the prior from its file.
    pub parameter: &'a Parameter,
}

/// Splits a parameter's name into effect, parameter and wheel.
fn parts(name: &str) -> Option<(&str, &str, Option<&str>)> {
    let (effect, rest) = name.split_once('.')?;
    let (parameter, wheel) = rest.split_once('.').map_or((rest, None), |(p, w)| (p, Some(w)));
    Some((effect, parameter, wheel))
}

impl EffectSet {
    /// The maximum number of effects of a job.
    pub const MAX_EFFECTS: usize = 10;

    /// Reads the effects that a model lists and, from the catalogue, those whose parameters are named.
    ///
    /// # Arguments
    /// - `file`: the name of the job in messages.
    /// - `effects`, `files`: the effects of the catalogue and the effect files that the model lists.
    /// - `names`: every parameter that the job names.
    /// - `read`: reads an effect file by its name; `None` for a file that is not in the set.
    ///
    /// # Errors
    /// [`FileError`] of the effect's file with line and column, or of the job.
    pub fn choose<'a>(
        file: &str,
        (effects, files): (&[String], &[String]),
        names: impl IntoIterator<Item = &'a str>,
        read: impl Fn(&str) -> Option<Result<Effect, FileError>>,
    ) -> Result<Self, FileError> {
        let listed = effects.iter().map(String::as_str);
        let named = names.into_iter().filter_map(|name| Some(parts(name)?.0));
        let wanted: BTreeSet<&str> = listed.chain(named).collect();
        let listed = catalogue().iter().filter(|e| wanted.contains(e.name.as_str()));
        let mut chosen: Vec<Chosen> = listed
            .map(|effect| Chosen {
                effect: effect.clone(),
                file: None,
            })
            .collect();
        for named in files {
            let effect = read(named).ok_or_else(|| {
                FileError::whole(file, format!("file \"{named}\" is named but was not sent"))
            })??;
            if let Some(other) = chosen.iter().find(|c| c.effect.name == effect.name) {
                let message = format!(
                    "effect {} is already in {}",
                    effect.name,
                    other.file.as_deref().unwrap_or("the catalogue")
                );
                return Err(FileError::whole(named, message));
            }
            chosen.push(Chosen {
                effect,
                file: Some(named.clone()),
            });
        }
        Self::check_count(chosen.len()).map_err(|e| FileError::whole(file, e))?;
        Ok(EffectSet(chosen))
    }

    /// Rejects more effects than a job may have.
    pub(super) fn check_count(count: usize) -> Result<(), ModelError> {
        if count > Self::MAX_EFFECTS {
            let message = format!("{count} effects must be at most {}", Self::MAX_EFFECTS);
            return Err(ModelError::Invalid(message));
        }
        Ok(())
    }

    /// Reads the effects of a message; [`ModelError`] names the effect and the mistake in its file.
    pub fn read(texts: &[EffectText]) -> Result<Self, ModelError> {
        let read = |sent: &EffectText| {
            // An effect of the catalogue with the same text has been read already.
            let listed = find(&sent.name).filter(|effect| effect.text == sent.text);
            let effect = match listed {
                Some(effect) => effect.clone(),
                None => Effect::read(&sent.text).map_err(|error| ModelError::Effect {
                    name: sent.name.clone(),
                    error,
                })?,
            };
            if effect.name != sent.name {
                return Err(ModelError::EffectName {
                    in_file: effect.name,
                    sent: sent.name.clone(),
                });
            }
            Ok(Chosen { effect, file: None })
        };
        texts.iter().map(read).collect::<Result<_, _>>().map(EffectSet)
    }

    /// Returns the files of the effects, in order.
    pub fn texts(&self) -> Vec<EffectText> {
        let text = |effect: &Effect| EffectText {
            name: effect.name.clone(),
            text: effect.text.clone(),
        };
        self.iter().map(text).collect()
    }

    /// Returns the effects, in order.
    pub fn iter(&self) -> impl Iterator<Item = &Effect> {
        self.0.iter().map(|chosen| &chosen.effect)
    }

    /// Returns an effect that uses a variable, if there is one.
    pub fn using(&self, variable: Variable) -> Option<&Effect> {
        self.iter().find(|effect| effect.uses().contains(variable))
    }

    /// Returns the bounds of an effect's parameter; `None` if the name has another form. [`ModelError`] names an
    /// unknown word and the nearest known one.
    pub fn lookup(&self, name: &str, wheels: &BTreeSet<&str>) -> Option<Result<ParameterBounds, ModelError>> {
        let (effect, parameter, wheel) = parts(name)?;
        Some(self.find(effect).and_then(|effect| {
            let names = effect.parameters.iter().map(|p| p.name.as_str());
            let Some(place) = effect.parameter(parameter) else {
                let what = format!("parameter of effect {}", effect.name);
                return Err(ModelError::Unknown(unknown_word(&what, parameter, names)));
            };
            if let Some(unknown) = wheel.filter(|w| !wheels.contains(w)) {
                let names = wheels.iter().copied();
                return Err(ModelError::Unknown(unknown_word("wheel", unknown, names)));
            }
            let parameter = &effect.parameters[place];
            // A prior on positive values in the file means that the parameter is a magnitude.
            let magnitude = ["half_normal", "lognormal", "loguniform"];
            let positive = magnitude.iter().any(|d| parameter.prior.get(d).is_some());
            Ok(ParameterBounds {
                unit: parameter.unit.clone(),
                lower: if positive { 0.0 } else { f64::NEG_INFINITY },
                upper: f64::INFINITY,
            })
        }))
    }

    fn find(&self, name: &str) -> Result<&Effect, ModelError> {
        let names = || self.iter().map(|effect| effect.name.as_str());
        self.iter().find(|effect| effect.name == name).ok_or_else(|| {
            let catalogue = catalogue().iter().map(|effect| effect.name.as_str());
            ModelError::Unknown(unknown_word("effect", name, names().chain(catalogue)))
        })
    }

    /// Returns the parameters of effects that are missing among these names: for an effect on all wheels its
    /// parameters, and for an effect with a strength for one wheel the parameters of that wheel.
    pub fn unstated_parameters<'a>(
        &'a self,
        names: &BTreeSet<&str>,
        wheels: &BTreeSet<&str>,
    ) -> Vec<UnstatedParameter<'a>> {
        let mut unstated = Vec::new();
        for chosen in &self.0 {
            let reach = Reach::new(&chosen.effect, names, wheels);
            for parameter in &chosen.effect.parameters {
                let strength = parameter.neutral.is_some();
                let is_stated = |wheel: Option<&str>| reach.says(parameter, wheel);
                let missing: Vec<Option<&str>> = if is_stated(None) {
                    Vec::new()
                } else if strength && wheels.iter().any(|w| is_stated(Some(w))) {
                    // the effect is neutral on the other wheels
                    Vec::new()
                } else if strength && reach.on_some {
                    reach.wheels.iter().map(|&w| Some(w)).collect()
                } else if !reach.wheels.is_empty() && reach.wheels.iter().all(|w| is_stated(Some(w))) {
                    Vec::new()
                } else {
                    vec![None]
                };
                unstated.extend(missing.into_iter().map(|wheel| UnstatedParameter {
                    name: parameter_name(&chosen.effect, parameter, wheel),
                    chosen,
                    parameter,
                }));
            }
        }
        unstated
    }

    /// Checks that the names of effects' parameters do not contradict each other, and that none is missing; [`ModelError`]
    /// names the parameter.
    pub(crate) fn check_complete(
        &self,
        names: &BTreeSet<&str>,
        wheels: &BTreeSet<&str>,
    ) -> Result<(), ModelError> {
        for chosen in &self.0 {
            let effect = &chosen.effect;
            let reach = Reach::new(effect, names, wheels);
            for parameter in &effect.parameters {
                let one = wheels.iter().find(|w| reach.says(parameter, Some(w)));
                let Some(wheel) = one else { continue };
                let name = parameter_name(effect, parameter, None);
                if reach.says(parameter, None) {
                    return Err(ModelError::Incomplete(format!(
                        "{name} is given both for all wheels and for one wheel"
                    )));
                }
                if !reach.wheels.contains(wheel) {
                    return Err(ModelError::Inexpressible(format!(
                        "{name}.{wheel} has no effect: effect {} does not act on wheel {wheel}",
                        effect.name
                    )));
                }
            }
        }
        match self.unstated_parameters(names, wheels).first() {
            Some(UnstatedParameter { name, .. }) => Err(ModelError::Unset(name.clone())),
            None => Ok(()),
        }
    }

    /// Returns the wheels, among these, that an effect acts on, by the names of a complete job.
    pub fn acts_on<'a>(
        effect: &Effect,
        names: &BTreeSet<&str>,
        wheels: &BTreeSet<&'a str>,
    ) -> BTreeSet<&'a str> {
        Reach::new(effect, names, wheels).wheels
    }

    /// Returns the effects' part of a model version: empty without effects, otherwise the first bytes of the SHA-256 of
    /// their files in order.
    pub fn version(texts: &[EffectText]) -> String {
        if texts.is_empty() {
            return String::new();
        }
        let mut hash = Sha256::new();
        for effect in texts {
            hash.update(effect.text.as_bytes());
        }
        let hex: String = hash.finalize()[..4].iter().map(|b| format!("{b:02x}")).collect();
        format!("+effects.{hex}")
    }
}

/// Builds `EFFECT.PARAMETER`, or `EFFECT.PARAMETER.WHEEL`.
pub fn parameter_name(effect: &Effect, parameter: &Parameter, wheel: Option<&str>) -> String {
    let wheel = wheel.map(|w| format!(".{w}")).unwrap_or_default();
    format!("{}.{}{wheel}", effect.name, parameter.name)
}

/// The wheels that an effect acts on.
struct Reach<'a, 'n> {
    effect: &'n Effect,
    names: &'n BTreeSet<&'n str>,
    wheels: BTreeSet<&'a str>,
    /// True if the effect's strengths are stated for single wheels only.
    on_some: bool,
}

impl<'a, 'n> Reach<'a, 'n> {
    fn new(effect: &'n Effect, names: &'n BTreeSet<&'n str>, wheels: &BTreeSet<&'a str>) -> Self {
        let mut reach = Reach {
            effect,
            names,
            wheels: BTreeSet::new(),
            on_some: false,
        };
        let strengths = || effect.parameters.iter().filter(|p| p.neutral.is_some());
        let single = |wheel: &&&str| strengths().any(|p| reach.says(p, Some(wheel)));
        let some: BTreeSet<&str> = wheels.iter().filter(single).copied().collect();
        let on_all = some.is_empty() || strengths().any(|p| reach.says(p, None));
        reach.wheels = if on_all { wheels.clone() } else { some };
        reach.on_some = !on_all;
        reach
    }

    fn says(&self, parameter: &Parameter, wheel: Option<&str>) -> bool {
        let name = parameter_name(self.effect, parameter, wheel);
        self.names.contains(name.as_str())
    }
}

/// Reads a user's effect file, which may not use names or mechanisms of the catalogue. A [`FileError`] names line and column
/// if known.
pub fn read_user_effect(file: &str, text: &str) -> Result<Effect, FileError> {
    let effect = Effect::read(text).map_err(|e| FileError {
        file: file.to_owned(),
        line: e.line,
        column: e.column,
        message: e.message,
    })?;
    let name = effect.name.as_str();
    let line = |key: &str| text.lines().position(|line| line.trim_start().starts_with(key));
    let wrong = |key: &str, message: String| FileError {
        file: file.to_owned(),
        line: line(key).map(|l| l + 1),
        column: None,
        message,
    };
    if effect.mechanism.is_some() {
        let message = "mechanism is reserved for the catalogue: a file has formulas".to_owned();
        return Err(wrong("mechanism", message));
    }
    if find(name).is_some() {
        let message = format!("name \"{name}\" belongs to an effect of the catalogue");
        return Err(wrong("name", message));
    }
    if parameters::is_taken(name) {
        return Err(wrong(
            "name",
            format!("name \"{name}\" has another meaning in a job"),
        ));
    }
    Ok(effect)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::case_table::cases;

    const MINE: &str = "name = \"mine\"\nsummary = \"s\"\nsource = \"s\"\nshear = \"tau * (1 - a * exp(-v_t / v_a))\"\n\
        [parameters.a]\nunit = \"1\"\nneutral = 0.0\nprior = { uniform = [0.0, 0.8] }\n\
        [parameters.v_a]\nunit = \"m/s\"\nprior = 0.01\n";

    const MECHANISM: &str = " 4: mechanism is reserved for the catalogue: a file has formulas";

    fn choose(effects: &[&str], names: &[&str], mine: &str) -> Result<EffectSet, String> {
        let effects: Vec<String> = effects.iter().map(|&e| e.to_owned()).collect();
        let files = ["mine.toml".to_owned()];
        let texts = BTreeMap::from([("mine.toml".to_owned(), mine.to_owned())]);
        let read = |name: &str| texts.get(name).map(|text| read_user_effect(name, text));
        EffectSet::choose("job.toml", (&effects, &files), names.iter().copied(), read)
            .map_err(|e| e.to_string())
    }

    fn unstated(set: &EffectSet, names: &[&str]) -> Vec<String> {
        let (names, wheels) = (names.iter().copied().collect(), BTreeSet::from(["w", "x"]));
        let unstated = set.unstated_parameters(&names, &wheels).into_iter();
        unstated.map(|parameter| parameter.name).collect()
    }

    #[test]
    fn effects_follow_each_other_as_the_catalogue_has_them_then_files() {
        let named = &["slip_sinkage.exponent_per_slip"];
        let set = choose(&["sled_tare", "hard_pan"], named, MINE).unwrap();
        let names: Vec<&str> = set.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(names, ["slip_sinkage", "hard_pan", "sled_tare", "mine"]);
    }

    #[test]
    fn a_strength_for_one_wheel_leaves_the_others_alone_and_shapes_are_shared() {
        let set = choose(&[], &[], MINE).unwrap();
        assert_eq!(unstated(&set, &[]), ["mine.a", "mine.v_a"]);
        assert_eq!(unstated(&set, &["mine.a.w"]), ["mine.v_a"]);
        assert_eq!(unstated(&set, &["mine.a.w", "mine.v_a.w"]), Vec::<String>::new());
        assert_eq!(unstated(&set, &["mine.a", "mine.v_a.w"]), ["mine.v_a"]);
        let two = choose(&["peak_pressure_angle"], &[], MINE).unwrap();
        let stated = ["peak_pressure_angle.front_share.x", "mine.a", "mine.v_a"];
        let missing = ["peak_pressure_angle.front_share_per_slip.x"];
        assert_eq!(unstated(&two, &stated), missing);
    }

    #[test]
    fn contradictory_and_idle_parameters_are_refused() {
        let set = choose(&[], &[], MINE).unwrap();
        for (names, message) in cases(
            r#"
            mine.a mine.a.w mine.v_a => mine.a is given both for all wheels and for one wheel
            mine.a.w mine.v_a.x => mine.v_a.x has no effect: effect mine does not act on wheel x
            mine.a.w => parameter mine.v_a has neither a prior nor a fixed value"#,
        ) {
            let refused = set.check_complete(&names.split(' ').collect(), &BTreeSet::from(["w", "x"]));
            assert_eq!(refused.unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn files_with_names_of_the_catalogue_are_refused_by_line() {
        for (old, new, message) in [
            (
                "\"mine\"",
                "\"bulldozing\"",
                " 1: name \"bulldozing\" belongs to an effect of the catalogue",
            ),
            (
                "\"mine\"",
                "\"noise\"",
                " 1: name \"noise\" has another meaning in a job",
            ),
            ("shear =", "mechanism = \"rebound\"\nshear =", MECHANISM),
            (
                "-v_t",
                "-vt",
                " 4, column 30: unknown name \"vt\"; the nearest known is \"v_t\"",
            ),
        ] {
            let refused = choose(&[], &[], &MINE.replace(old, new)).unwrap_err();
            assert_eq!(refused, format!("mine.toml line{message}"));
        }
    }
}

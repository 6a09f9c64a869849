//! The keys and tables of an effect file.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::{Effect, EffectError, Parameter, check_sight, check_units, names};
use crate::graph::{Graph, Id};
use crate::hook::Hook;
use crate::parse::{Scope, parse};
use crate::token::{Mistake, Token, Tokens};
use crate::unit::Unit;
use crate::variable::{Variable, Variables};
use crate::word::unknown_word;

/// Most parameters of an effect.
const MOST_PARAMETERS: usize = 16;
/// Most definitions of an effect.
const MOST_DEFINITIONS: usize = 32;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawEffect {
    name: Spanned<String>,
    summary: String,
    source: String,
    mechanism: Option<Spanned<String>>,
    slip: Option<Spanned<String>>,
    radius: Option<Spanned<String>>,
    width: Option<Spanned<String>>,
    sinkage_exponent: Option<Spanned<String>>,
    wheel_load: Option<Spanned<String>>,
    pressure: Option<Spanned<String>>,
    shear_limit: Option<Spanned<String>>,
    shear: Option<Spanned<String>>,
    drawbar_pull: Option<Spanned<String>>,
    torque: Option<Spanned<String>>,
    sinkage: Option<Spanned<String>>,
    lateral_force: Option<Spanned<String>>,
    #[serde(default)]
    definitions: BTreeMap<String, Spanned<String>>,
    #[serde(default)]
    parameters: BTreeMap<String, Spanned<RawParameter>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawParameter {
    unit: String,
    neutral: Option<f64>,
    typical: Option<f64>,
    prior: toml::Value,
}

impl RawEffect {
    fn formula(&self, hook: Hook) -> Option<&Spanned<String>> {
        match hook {
            Hook::Slip => &self.slip,
            Hook::Radius => &self.radius,
            Hook::Width => &self.width,
            Hook::SinkageExponent => &self.sinkage_exponent,
            Hook::WheelLoad => &self.wheel_load,
            Hook::Pressure => &self.pressure,
            Hook::ShearLimit => &self.shear_limit,
            Hook::Shear => &self.shear,
            Hook::DrawbarPull => &self.drawbar_pull,
            Hook::Torque => &self.torque,
            Hook::Sinkage => &self.sinkage,
            Hook::LateralForce => &self.lateral_force,
        }
        .as_ref()
    }
}

/// Reads an effect file.
pub(super) fn read(text: &str) -> Result<Effect, EffectError> {
    if text.len() > Effect::LONGEST {
        let message = format!(
            "an effect file of {} bytes must have at most {}",
            text.len(),
            Effect::LONGEST
        );
        return Err(whole(message));
    }
    let raw: RawEffect = toml::from_str(text).map_err(|e| toml_error(text, &e))?;
    let wrong = |span: Range<usize>, message: String| at(text, span.start, None, message);
    names::check_form("name", raw.name.get_ref()).map_err(|e| wrong(raw.name.span(), e))?;
    let mechanism = match &raw.mechanism {
        None => None,
        Some(name) => Some(names::mechanism(name.get_ref()).map_err(|e| wrong(name.span(), e))?),
    };
    if mechanism.is_none() && Hook::ALL.iter().all(|&h| raw.formula(h).is_none()) {
        let hooks = Hook::ALL.map(Hook::name).join(", ");
        return Err(whole(format!(
            "the effect has no formula; it may replace {hooks}"
        )));
    }
    let (parameters, units) = parameters(text, &raw)?;
    let parameter_names: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
    let mut graph = Graph::default();
    let definitions = define(text, &raw, &parameter_names, &mut graph)?;
    let mut formulas = Vec::new();
    for hook in Hook::ALL {
        let Some(formula) = raw.formula(hook) else {
            continue;
        };
        let scope = Scope {
            variables: hook.sees(),
            parameters: &parameter_names,
            definitions: &definitions,
            place: &format!("in {}", hook.name()),
        };
        let result =
            parse(formula.get_ref(), &scope, &mut graph).map_err(|m| in_formula(text, formula, m))?;
        let first = |message: String| in_formula(text, formula, Mistake::new(0, message));
        check_sight(&graph, hook, result).map_err(first)?;
        check_units(&graph, hook, result, &units).map_err(first)?;
        formulas.push((hook, result));
    }
    let effect = Effect {
        name: raw.name.get_ref().clone(),
        summary: raw.summary,
        source: raw.source,
        mechanism,
        parameters,
        text: text.to_owned(),
        formulas,
        graph,
    };
    check_used(text, &effect, &raw.definitions, &definitions)?;
    Ok(effect)
}

fn parameters(text: &str, raw: &RawEffect) -> Result<(Vec<Parameter>, Vec<Unit>), EffectError> {
    let count = raw.parameters.len();
    if count > MOST_PARAMETERS {
        return Err(whole(format!(
            "{count} parameters must be at most {MOST_PARAMETERS}"
        )));
    }
    let mut entries: Vec<_> = raw.parameters.iter().collect();
    entries.sort_by_key(|(_, entry)| entry.span().start);
    let (mut parameters, mut units) = (Vec::new(), Vec::new());
    for (name, entry) in entries {
        let wrong = |message: String| at(text, entry.span().start, None, message);
        names::check_free("parameter", name).map_err(wrong)?;
        let RawParameter {
            unit,
            neutral,
            typical,
            prior,
        } = entry.get_ref();
        units.push(Unit::parse(unit).map_err(|e| wrong(format!("parameter {name}: {e}")))?);
        for (key, value) in [("neutral", neutral), ("typical", typical)] {
            if let Some(value) = value.filter(|v| !v.is_finite()) {
                return Err(wrong(format!(
                    "parameter {name}: {key} = {value} {unit} must be finite"
                )));
            }
        }
        if !(prior.is_table() || prior.is_float() || prior.is_integer()) {
            let message =
                format!("parameter {name}: prior = {prior} must be a number or a table with a distribution");
            return Err(wrong(message));
        }
        parameters.push(Parameter {
            name: name.clone(),
            unit: unit.clone(),
            neutral: *neutral,
            typical: *typical,
            prior: prior.clone(),
            line: line(text, entry.span().start),
        });
    }
    if !parameters.is_empty() && parameters.iter().all(|p| p.neutral.is_none()) {
        let message = "no parameter has a neutral value: one must be the strength, at whose neutral value the effect is absent";
        return Err(whole(message.to_owned()));
    }
    Ok((parameters, units))
}

/// The operations behind the definitions, each after those it uses.
fn define(
    text: &str,
    raw: &RawEffect,
    parameters: &[String],
    graph: &mut Graph,
) -> Result<BTreeMap<String, Id>, EffectError> {
    let count = raw.definitions.len();
    if count > MOST_DEFINITIONS {
        return Err(whole(format!(
            "{count} definitions must be at most {MOST_DEFINITIONS}"
        )));
    }
    let mut waiting: BTreeMap<&str, &Spanned<String>> = BTreeMap::new();
    for (name, formula) in &raw.definitions {
        let wrong = |message: String| at(text, formula.span().start, None, message);
        names::check_free("definition", name).map_err(wrong)?;
        if parameters.contains(name) {
            return Err(wrong(format!(
                "definition \"{name}\" has the name of a parameter"
            )));
        }
        waiting.insert(name, formula);
    }
    let mut known = BTreeMap::new();
    while let Some((&first, &its_formula)) = waiting.first_key_value() {
        let ready = waiting
            .iter()
            .find(|(_, formula)| !names_in(formula.get_ref()).any(|name| waiting.contains_key(name)));
        let Some((&name, &formula)) = ready else {
            let message = format!("definition {first} rests on itself through other definitions");
            return Err(at(text, its_formula.span().start, None, message));
        };
        let scope = Scope {
            variables: Variables::of(&Variable::ALL),
            parameters,
            definitions: &known,
            place: "in definitions",
        };
        let result = parse(formula.get_ref(), &scope, graph).map_err(|m| in_formula(text, formula, m))?;
        known.insert(name.to_owned(), result);
        waiting.remove(name);
    }
    Ok(known)
}

/// The names in a formula, as far as it can be cut into words.
fn names_in(formula: &str) -> impl Iterator<Item = &str> {
    let mut tokens = Tokens::new(formula);
    std::iter::from_fn(move || match tokens.take() {
        Ok(Token::End) | Err(_) => None,
        Ok(token) => Some(token),
    })
    .filter_map(|token| match token {
        Token::Name(name) => Some(name),
        _ => None,
    })
}

/// Whether all that is declared serves something.
fn check_used(
    text: &str,
    effect: &Effect,
    definitions: &BTreeMap<String, Spanned<String>>,
    places: &BTreeMap<String, Id>,
) -> Result<(), EffectError> {
    let mut used = vec![false; effect.graph.len()];
    for (_, result) in &effect.formulas {
        for id in effect.graph.behind(*result) {
            used[usize::from(id.0)] = true;
        }
    }
    for (name, formula) in definitions {
        if !places.get(name).is_some_and(|id| used[usize::from(id.0)]) {
            let message = format!("definition {name} is used by no formula");
            return Err(at(text, formula.span().start, None, message));
        }
    }
    if effect.mechanism.is_some() {
        return Ok(());
    }
    for (place, parameter) in effect.parameters.iter().enumerate() {
        let node = crate::graph::Node::Parameter(place as u8);
        if !effect.graph.find(node).is_some_and(|id| used[usize::from(id.0)]) {
            return Err(EffectError {
                line: Some(parameter.line),
                column: None,
                message: format!("parameter {} is used by no formula", parameter.name),
            });
        }
    }
    Ok(())
}

fn whole(message: String) -> EffectError {
    EffectError {
        line: None,
        column: None,
        message,
    }
}

/// An error at a byte of the file; with its column, if that is asked for.
fn at(text: &str, byte: usize, column: Option<usize>, message: String) -> EffectError {
    EffectError {
        line: Some(line(text, byte)),
        column,
        message,
    }
}

fn line(text: &str, byte: usize) -> usize {
    text.bytes().take(byte).filter(|&b| b == b'\n').count() + 1
}

/// An error within a formula: at its own line and column, where the formula stands in the file as it is.
fn in_formula(text: &str, formula: &Spanned<String>, mistake: Mistake) -> EffectError {
    let span = formula.span();
    let content = formula.get_ref();
    let begin = text.get(span.clone()).and_then(|raw| raw.find(content.as_str()));
    let Some(begin) = begin else {
        return at(text, span.start, None, mistake.message);
    };
    let before: usize = content.chars().take(mistake.at).map(char::len_utf8).sum();
    let byte = span.start + begin + before;
    let start_of_line = text[..byte].rfind('\n').map_or(0, |newline| newline + 1);
    let column = text[start_of_line..byte].chars().count() + 1;
    at(text, byte, Some(column), mistake.message)
}

/// What the TOML reader says, with the nearest known key.
fn toml_error(text: &str, error: &toml::de::Error) -> EffectError {
    let message = error.message();
    let mut quoted = message.split('`').skip(1).step_by(2);
    let message = match (message.starts_with("unknown field"), quoted.next()) {
        (true, Some(unknown)) => unknown_word("key", unknown, quoted),
        _ => message.trim_end().replace('`', "\"").replace('\n', " "),
    };
    EffectError {
        line: error.span().map(|span| line(text, span.start)),
        column: None,
        message,
    }
}

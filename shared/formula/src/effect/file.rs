//! The keys and tables of an effect file.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Effect, EffectError, Parameter, names, place};
use crate::hook::Hook;
use crate::nesting::too_deep;
use crate::syntax::graph::{Graph, Node};
use crate::syntax::parse::{Definition, Scope, parse};
use crate::syntax::token::{Mistake, Token, Tokens};
use crate::unit::Unit;
use crate::variable::{Variable, Variables};
use crate::word::unknown_word;

/// The maximum number of parameters of an effect.
const MAX_PARAMETERS: usize = 16;
/// The maximum number of definitions of an effect.
const MAX_DEFINITIONS: usize = 32;
/// The maximum nesting of tables and arrays: a prior's arguments need 5.
const DEEPEST: usize = 8;

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
    unit: Spanned<String>,
    neutral: Option<Spanned<f64>>,
    typical: Option<Spanned<f64>>,
    prior: Spanned<toml::Value>,
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

impl Effect {
    /// Reads an effect file.
    ///
    /// # Errors
    /// [`EffectError`] with the line and the column of the first mistake, and with the nearest known name or all expected names;
    /// without a place if the whole file is to blame. Checked by `messages::every_message_is_as_written` and, for any text, by
    /// `fuzzed::any_text_is_read_or_refused_at_a_place_that_is_there`.
    ///
    /// # Validity
    /// Time, memory and stack depth are bounded by [`Effect::LONGEST`]; the stack stays far below that of a thread.
    pub fn read(text: &str) -> Result<Effect, EffectError> {
        read(text)
    }
}

fn read(text: &str) -> Result<Effect, EffectError> {
    if text.len() > Effect::LONGEST {
        let (length, max) = (text.len(), Effect::LONGEST);
        return Err(whole(format!(
            "an effect file of {length} bytes must have at most {max}"
        )));
    }
    let junk = |c: char| c == '\u{fffd}' || c.is_control() && !matches!(c, '\t' | '\n' | '\r');
    if let Some((byte, actual)) = text.char_indices().find(|&(_, c)| junk(c)) {
        return Err(at(
            text,
            byte,
            format!("{actual:?} is not allowed in a UTF-8 text file"),
        ));
    }
    let raw = tables(text)?;
    names::check_form("name", raw.name.get_ref()).map_err(|e| at(text, raw.name.span().start, e))?;
    let mechanism = match &raw.mechanism {
        None => None,
        Some(name) => Some(names::mechanism(name.get_ref()).map_err(|e| at(text, name.span().start, e))?),
    };
    if mechanism.is_none() && Hook::ALL.iter().all(|&h| raw.formula(h).is_none()) {
        let hooks = Hook::ALL.map(Hook::name).join(", ");
        return Err(whole(format!(
            "the effect has no formula: expected one for {hooks}"
        )));
    }
    let parameters = parameters(text, &raw)?;
    let mut graph = Graph::default();
    let definitions = define(text, &raw, &parameters, &mut graph)?;
    let mut formulas = Vec::new();
    for hook in Hook::ALL {
        let Some(formula) = raw.formula(hook) else {
            continue;
        };
        let scope = Scope {
            variables: hook.sees(),
            parameters: &parameters,
            definitions: &definitions,
            place: hook.name(),
        };
        let in_formula = |mistake: Mistake| in_formula(text, formula, mistake);
        let result = parse(formula.get_ref(), &scope, &mut graph).map_err(in_formula)?;
        let target = hook.target();
        if let (Some(actual), Some(expected)) = (graph.unit(result), target.unit())
            && actual != expected
        {
            let message = format!(
                "{} must be in {}, not in {actual}",
                hook.name(),
                target.unit_name()
            );
            return Err(in_formula(Mistake::new(0, message)));
        }
        formulas.push((hook, result));
    }
    let used = |node: Node| {
        let id = graph.find(node);
        id.is_some_and(|id| {
            formulas
                .iter()
                .any(|(_, result)| graph.behind(*result).contains(&id))
        })
    };
    check_definitions_used(text, &raw)?;
    for (number, (name, _)) in parameters.iter().enumerate() {
        if mechanism.is_none() && !used(Node::Parameter(number as u8)) {
            let message = format!("parameter {name} is not used by any formula");
            return Err(at(text, raw.parameters[name].span().start, message));
        }
    }
    let finished = |(name, _): &(String, Unit)| {
        let entry = &raw.parameters[name];
        let RawParameter {
            unit,
            neutral,
            typical,
            prior,
        } = entry.get_ref();
        Parameter {
            name: name.clone(),
            unit: unit.get_ref().clone(),
            neutral: neutral.as_ref().map(|value| *value.get_ref()),
            typical: typical.as_ref().map(|value| *value.get_ref()),
            prior: prior.get_ref().clone(),
            line: place::line_and_column(text, entry.span().start).0,
        }
    };
    Ok(Effect {
        parameters: parameters.iter().map(finished).collect(),
        name: raw.name.into_inner(),
        summary: raw.summary,
        source: raw.source,
        mechanism,
        text: text.to_owned(),
        formulas,
        graph,
    })
}

/// Parses the file's keys and tables.
fn tables(text: &str) -> Result<RawEffect, EffectError> {
    if let Some(byte) = too_deep(text, DEEPEST) {
        let message = format!("brackets must be nested at most {DEEPEST} deep");
        return Err(at(text, byte, message));
    }
    let table = DeTable::parse(text).map_err(|e| toml_error(text, &e))?;
    let mut waiting: Vec<(&Spanned<DeValue>, usize)> = table.get_ref().values().map(|v| (v, 1)).collect();
    while let Some((value, depth)) = waiting.pop() {
        if depth > DEEPEST {
            let message = format!("tables and arrays must be nested at most {DEEPEST} deep");
            return Err(at(text, value.span().start, message));
        }
        match value.get_ref() {
            DeValue::Table(table) => waiting.extend(table.values().map(|v| (v, depth + 1))),
            DeValue::Array(array) => waiting.extend(array.iter().map(|v| (v, depth + 1))),
            _ => {}
        }
    }
    RawEffect::deserialize(toml::Deserializer::from(table)).map_err(|e| toml_error(text, &e))
}

/// Checks the parameters; returns their names and units in the order of the file.
fn parameters(text: &str, raw: &RawEffect) -> Result<Vec<(String, Unit)>, EffectError> {
    let mut entries: Vec<_> = raw.parameters.iter().collect();
    entries.sort_by_key(|(_, entry)| entry.span().start);
    if let Some((_, first_too_many)) = entries.get(MAX_PARAMETERS) {
        let message = format!("{} parameters, must be at most {MAX_PARAMETERS}", entries.len());
        return Err(at(text, first_too_many.span().start, message));
    }
    let mut parameters = Vec::new();
    for &(name, entry) in &entries {
        names::check_free("parameter", name).map_err(|m| at(text, entry.span().start, m))?;
        let parameter = entry.get_ref();
        let unit = Unit::parse(parameter.unit.get_ref()).map_err(|m| {
            at(
                text,
                parameter.unit.span().start,
                format!("parameter {name}: {m}"),
            )
        })?;
        for (key, value) in [("neutral", &parameter.neutral), ("typical", &parameter.typical)] {
            if let Some(value) = value.as_ref().filter(|v| !v.get_ref().is_finite()) {
                let unit = Some(parameter.unit.get_ref().as_str()).filter(|&unit| unit != "1");
                let number = format!("{} {}", value.get_ref(), unit.unwrap_or_default());
                let message = format!("parameter {name}: {key} = {} must be finite", number.trim_end());
                return Err(at(text, value.span().start, message));
            }
        }
        let prior = parameter.prior.get_ref();
        let wrong = match prior {
            toml::Value::Table(_) | toml::Value::Integer(_) => None,
            toml::Value::Float(value) if value.is_finite() => None,
            toml::Value::Float(value) => Some(format!("{value}")),
            other => Some(format!("a value of type {}", other.type_str())),
        };
        if let Some(wrong) = wrong {
            let message = format!(
                "parameter {name}: prior is {wrong}, must be a finite number or a table such as \
                 {{ uniform = [0, 1] }}"
            );
            return Err(at(text, parameter.prior.span().start, message));
        }
        parameters.push((name.clone(), unit));
    }
    if let Some((_, first)) = entries.first()
        && entries.iter().all(|(_, entry)| entry.get_ref().neutral.is_none())
    {
        let message = "no parameter has a key neutral: expected it for the effect's strength, with the value at which \
                       the effect is absent";
        return Err(at(text, first.span().start, message));
    }
    Ok(parameters)
}

/// Adds the operations of the definitions to the graph.
fn define(
    text: &str,
    raw: &RawEffect,
    parameters: &[(String, Unit)],
    graph: &mut Graph,
) -> Result<BTreeMap<String, Definition>, EffectError> {
    let mut entries: Vec<_> = raw.definitions.iter().collect();
    entries.sort_by_key(|(_, formula)| formula.span().start);
    if let Some((_, first_too_many)) = entries.get(MAX_DEFINITIONS) {
        let message = format!("{} definitions, must be at most {MAX_DEFINITIONS}", entries.len());
        return Err(at(text, first_too_many.span().start, message));
    }
    for &(name, formula) in &entries {
        let start = formula.span().start;
        names::check_free("definition", name).map_err(|e| at(text, start, e))?;
        if raw.parameters.contains_key(name) {
            let message = format!("definition {name} has the name of a parameter");
            return Err(at(text, start, message));
        }
    }
    let mut definitions = BTreeMap::new();
    let mut waiting = entries;
    while !waiting.is_empty() {
        let is_waiting = |name: &str| waiting.iter().any(|(waiting, _)| *waiting == name);
        let rests_on = |formula| names_in(formula).find(|name| is_waiting(name));
        let ready = waiting
            .iter()
            .position(|(_, formula)| rests_on(formula).is_none());
        let Some(ready) = ready else {
            let circle = circle(waiting[0].0, |name| {
                rests_on(&raw.definitions[name]).unwrap_or(name)
            });
            let message = format!(
                "definition {} depends on itself: {}",
                circle[0],
                circle.join(" uses ")
            );
            return Err(at(text, raw.definitions[circle[0]].span().start, message));
        };
        let (name, formula) = waiting.remove(ready);
        let scope = Scope {
            variables: Variables::new(&Variable::ALL),
            parameters,
            definitions: &definitions,
            place: "a definition",
        };
        let result = parse(formula.get_ref(), &scope, graph).map_err(|m| in_formula(text, formula, m))?;
        let uses = graph.variables(result);
        definitions.insert(name.clone(), Definition { result, uses });
    }
    Ok(definitions)
}

/// Follows `next` from name to name until one repeats; returns the names from its first to its second visit.
fn circle<'a>(first: &'a str, next: impl Fn(&'a str) -> &'a str) -> Vec<&'a str> {
    let mut path = vec![first];
    loop {
        let name = next(path[path.len() - 1]);
        let before = path.iter().position(|&n| n == name);
        path.push(name);
        if let Some(before) = before {
            return path.split_off(before);
        }
    }
}

/// Returns the names in a formula, up to the first character that is no token.
fn names_in(formula: &Spanned<String>) -> impl Iterator<Item = &str> {
    let mut tokens = Tokens::new(formula.get_ref());
    std::iter::from_fn(move || match tokens.take() {
        Ok(Token::End) | Err(_) => None,
        Ok(token) => Some(token),
    })
    .filter_map(|token| match token {
        Token::Name(name) => Some(name),
        _ => None,
    })
}

/// Checks that every definition serves a formula, directly or through other definitions.
fn check_definitions_used(text: &str, raw: &RawEffect) -> Result<(), EffectError> {
    let formulas = Hook::ALL.iter().filter_map(|&hook| raw.formula(hook));
    let mut waiting: Vec<&Spanned<String>> = formulas.collect();
    let mut used = BTreeSet::new();
    while let Some(formula) = waiting.pop() {
        for (name, definition) in names_in(formula).filter_map(|name| raw.definitions.get_key_value(name)) {
            if used.insert(name) {
                waiting.push(definition);
            }
        }
    }
    let unused = raw.definitions.iter().filter(|(name, _)| !used.contains(name));
    match unused.min_by_key(|(_, formula)| formula.span().start) {
        Some((name, formula)) => {
            let message = format!("definition {name} is not used by any formula");
            Err(at(text, formula.span().start, message))
        }
        None => Ok(()),
    }
}

fn whole(message: String) -> EffectError {
    EffectError {
        line: None,
        column: None,
        message,
    }
}

/// Returns an error at a byte of the file.
fn at(text: &str, byte: usize, message: impl ToString) -> EffectError {
    let (line, column) = place::line_and_column(text, byte);
    EffectError {
        line: Some(line),
        column: Some(column),
        message: message.to_string(),
    }
}

/// Returns an error within a formula.
fn in_formula(text: &str, formula: &Spanned<String>, mistake: Mistake) -> EffectError {
    let span = formula.span();
    let raw = text.get(span.clone()).unwrap_or_default();
    let byte = span.start + place::in_string(raw, formula.get_ref(), mistake.at);
    at(text, byte, mistake.message)
}

/// Returns the message of the TOML parser with the nearest known key.
fn toml_error(text: &str, error: &toml::de::Error) -> EffectError {
    let message = error.message();
    let mut quoted = message.split('`').skip(1).step_by(2);
    let message = match (message.starts_with("unknown field"), quoted.next()) {
        (true, Some(unknown)) => unknown_word("key", unknown, quoted),
        _ => in_our_words(message),
    };
    match error.span() {
        Some(span) => at(text, span.start, message),
        None => whole(message),
    }
}

/// Rewords the message of the TOML parser to match the messages of this crate.
fn in_our_words(message: &str) -> String {
    let wrong_type = message.trim_end().strip_prefix("invalid type: ");
    let message = match wrong_type.and_then(|rest| rest.rsplit_once(", expected ")) {
        Some((actual, "f64")) => format!("expected a number, found {actual}"),
        Some((actual, "a string")) => format!("expected a text in quotes, found {actual}"),
        Some((actual, expected)) => format!("expected {expected}, found {actual}"),
        None => message.trim_end().replace("missing field", "missing key"),
    };
    let message = message
        .replace("`\"`", "a closing quote")
        .replace("`\"\"\"`", "three closing quotes");
    message.replace('`', "\"").replace('\n', " ")
}

//! `coordinator effects`: lists the catalogue, or shows one effect with its influence.

use std::fmt::Write;

use anyhow::Context;
use formula::catalogue::{catalogue, find};
use shared::model::ModelKind;
use shared::model::effects::read_user_effect;
use shared::model::settings::unknown_effect;
use shared::parameters::behind;
use shared::text_file::read_text;

use super::output::say;
use crate::config::{EffectsArguments, ModelChoice};
use crate::effect::signature::{ChannelSignature, Signature, signature};
use crate::effect::{EffectCard, Group};
use job::check_effect;
use result::number;

/// Maximum length of a line `[columns]`.
const COLUMNS: usize = 100;
/// The characters for the heights of a curve.
const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

pub(super) async fn effects(config: &EffectsArguments) -> anyhow::Result<()> {
    let kind = match config.model {
        ModelChoice::QuasiStatic => ModelKind::QuasiStatic,
        ModelChoice::Scm => ModelKind::Scm,
    };
    let effect = match (&config.file, &config.name) {
        (Some(path), _) => {
            // The file passes the same checks as the effect file of a job.
            let file = path.display().to_string();
            let effect = read_user_effect(&file, &read_text(path)?)?;
            check_effect(&file, &effect)?;
            effect
        }
        (None, Some(name)) => find(name).with_context(|| unknown_effect(name))?.clone(),
        (None, None) => return Ok(say(&list())?),
    };
    let text = effect.text.trim_end().to_owned();
    let shown = tokio::task::spawn_blocking(move || signature(&effect, kind)).await?;
    let shown = shown.map_err(anyhow::Error::msg)?;
    Ok(say(&format!("{text}\n\n{}", deeds(&shown)))?)
}

/// Returns every effect of the catalogue, by the part of the model that it concerns.
fn list() -> String {
    let cards: Vec<EffectCard> = catalogue().iter().map(EffectCard::new).collect();
    let mut text = wrapped(
        &format!(
            "{} effects that a wheel-soil model may miss. A job takes one by [model] effects = [\"NAME\"], by a prior for \
             \"NAME.PARAMETER\", or by --effect NAME; `coordinator effects NAME` shows its file and what it does.",
            cards.len()
        ),
        0,
    );
    for group in Group::ALL {
        let _ = writeln!(text, "\n{}\n{}", group.title(), "-".repeat(group.title().len()));
        for card in cards.iter().filter(|card| card.group == group) {
            text.push_str(&entry(card));
        }
    }
    text
}

fn entry(card: &EffectCard) -> String {
    let mut text = wrapped(&format!("{}: {}", card.name, card.summary), 0);
    text += &wrapped(&format!("at {}; {}", card.enters(), card.source), 4);
    for p in &card.parameters {
        let unit = if p.unit == "1" { "" } else { &p.unit };
        let role = match (p.neutral, p.typical) {
            (Some(neutral), Some(typical)) => {
                format!(
                    "absent at {}, typical {}",
                    number::plain(neutral),
                    number::plain(typical)
                )
            }
            _ => String::new(),
        };
        let line = format!("    {:<26} {unit:<6} {:<32} {role}", p.name, prior(&p.prior));
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// Formats a prior as in a job, without braces.
fn prior(prior: &serde_json::Value) -> String {
    let value = |v: &serde_json::Value| match (v.as_f64(), v.as_array()) {
        (Some(x), _) => number::plain(x),
        (None, Some(list)) => {
            let list: Vec<String> = list
                .iter()
                .filter_map(|v| v.as_f64().map(number::plain))
                .collect();
            format!("[{}]", list.join(", "))
        }
        _ => v.to_string(),
    };
    match prior.as_object() {
        None => format!("fixed at {}", value(prior)),
        Some(table) => {
            let bounds = table.get("bounds").map(|b| format!(" in {}", value(b)));
            let density = table.iter().find(|(key, _)| *key != "bounds");
            let density = density.map_or(String::new(), |(key, v)| format!("{key} {}", value(v)));
            density + &bounds.unwrap_or_default()
        }
    }
}

/// Breaks words into lines. The first line is indented by `indent`, the others by four more where `indent` is not 0.
fn wrapped(words: &str, indent: usize) -> String {
    let mut text = String::new();
    let mut line = " ".repeat(indent);
    let mut bare = true;
    for word in words.split_whitespace() {
        if !bare && line.chars().count() + 1 + word.chars().count() > COLUMNS {
            let _ = writeln!(text, "{line}");
            line = " ".repeat(if indent == 0 { 0 } else { indent + 4 });
            bare = true;
        }
        if !bare {
            line.push(' ');
        }
        line.push_str(word);
        bare = false;
    }
    text + &line + "\n"
}

/// Formats the changes by each strength, as a table and as curves.
fn deeds(signature: &Signature) -> String {
    let pass = if signature.pass > 1 { "; second pass" } else { "" };
    let angle = match signature.slip_angle_deg {
        angle if angle > 0.0 => format!("; slip angle {angle:.0} deg"),
        _ => String::new(),
    };
    let mut text = wrapped(
        &format!(
            "What it does in {}: a wheel of 0.130 m, 0.112 m wide, with 12 grousers of 9 mm, in sand (k_phi 1e7, n 1.1, \
             30 deg, 1400 kg/m^3); 100 N, slip 0.2 and a rim speed of 10 mm/s where nothing else is said{pass}{angle}.",
            signature.model_kind
        ),
        0,
    );
    if !signature.shapes.is_empty() {
        let shapes = signature.shapes.iter();
        let shapes: Vec<String> = shapes
            .map(|held| set(&held.name, held.value, &held.unit))
            .collect();
        text += &format!("with {}\n", shapes.join(", "));
    }
    for shown in &signature.strengths {
        let at = shown.value.map(|value| set(&shown.parameter, value, &shown.unit));
        let _ = writeln!(text, "\n{}", at.map_or("always".into(), |at| format!("at {at}")));
        let heads: String = signature.conditions.iter().map(|c| format!(" {c:>11}")).collect();
        let _ = writeln!(text, "{:<24}{heads}", "");
        for channel in &shown.channels {
            let name = format!("{} {}", channel.channel.replace('_', " "), channel.unit);
            for (what, values, signed) in [("", &channel.base, false), ("change", &channel.change, true)] {
                let label = if signed { "" } else { name.as_str() };
                let cells: String = values
                    .iter()
                    .map(|v| format!(" {:>11}", cell(*v, signed)))
                    .collect();
                let _ = writeln!(text, "{label:<17}{what:<7}{cells}");
            }
        }
        let _ = writeln!(text, "\nchange over slip -0.4 to 0.8, one bar each 0.05");
        for channel in &shown.channels {
            text.push_str(&curve(channel));
        }
        if let Some(refusal) = &shown.refusal {
            text += &wrapped(&format!("The model refuses some of it: {refusal}"), 0);
        }
        if unchanged(&shown.channels) {
            text.push_str("It changes nothing under these conditions.\n");
        }
    }
    text
}

/// Formats a value with its name and unit, as in `v_a = 0.01 m/s`.
fn set(name: &str, value: f64, unit: &str) -> String {
    format!("{name} = {}{}", number::plain(value), behind(unit))
}

fn unchanged(channels: &[ChannelSignature]) -> bool {
    let all = || channels.iter().flat_map(|c| c.change.iter().chain(&c.curve));
    all().all(|change| change.is_some_and(|x| x.abs() < 1e-12))
}

fn cell(value: Option<f64>, signed: bool) -> String {
    match value {
        None => "refused".into(),
        Some(x) if signed && x.abs() < 5e-4 => "0".into(),
        Some(x) if signed => format!("{x:+.3}"),
        Some(x) => format!("{x:.3}"),
    }
}

/// Draws the curve of a channel as bars between its least and its greatest value, followed by these values.
fn curve(channel: &ChannelSignature) -> String {
    let values = || channel.curve.iter().flatten().copied();
    let (least, most) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    let bar = |value: &Option<f64>| match value {
        None => '·',
        Some(x) if most - least > 1e-9 => {
            let share = (x - least) / (most - least) * BARS.len() as f64;
            BARS[(share as usize).min(BARS.len() - 1)]
        }
        Some(_) => BARS[0],
    };
    let bars: String = channel.curve.iter().map(bar).collect();
    let name = channel.channel.replace('_', " ");
    let [low, high] = [least, most].map(|x| cell(Some(x), true));
    let range = match values().next() {
        None => "refused".into(),
        Some(_) if low == high => format!("{low} {} throughout", channel.unit),
        Some(_) => format!("{low} to {high} {}", channel.unit),
    };
    format!("{name:<17}{bars}  {range}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_list_fits_the_terminal() {
        let list = list();
        for line in list.lines() {
            assert!(line.chars().count() <= COLUMNS, "{line}");
        }
        for effect in catalogue() {
            assert!(list.contains(&format!("\n{}: ", effect.name)), "{}", effect.name);
        }
    }

    #[test]
    fn a_curve_runs_from_its_least_to_its_greatest_value() {
        let channel = ChannelSignature {
            channel: "torque".into(),
            unit: "N m".into(),
            base: Vec::new(),
            change: Vec::new(),
            curve: vec![Some(-1.0), Some(0.0), None, Some(1.0)],
        };
        assert_eq!(curve(&channel), "torque           ▁▅·█  -1.000 to +1.000 N m\n");
    }
}

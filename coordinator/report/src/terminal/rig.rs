//! What the rig did, as text: a table for a job, sentences for a study.

use job::Spec;

use super::column::{cell, labelled};
use super::table::Table;
use crate::story::rig_sentences;
use crate::summary::study::study_rig;
use result::rig::{RepeatOffsets, repeat_offsets};
use result::study::Study;

/// Heading of the table and of the sentences.
const HEADING: &str = "what the rig did";

/// Warns where sessions, tarings or operators of a job are confounded with conditions, and tabulates their offsets; empty if no run states
/// any.
pub fn rig(spec: &Spec) -> String {
    let found = repeat_offsets(&spec.experiment, &spec.fit_runs).unwrap_or_default();
    let mut reasons: Vec<&String> = Vec::new();
    for reason in found.iter().filter_map(|quantity| quantity.confounded.as_ref()) {
        if !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
    let warnings = reasons.iter().map(|reason| format!("warning: {reason}\n"));
    let mut text: String = warnings.collect();
    let is_estimated = |quantity: &&RepeatOffsets| quantity.confounded.is_none();
    let estimated: Vec<&RepeatOffsets> = found.iter().filter(is_estimated).collect();
    if !estimated.is_empty() {
        text += &format!("\n{}", table(&estimated));
    }
    text
}

fn table(found: &[&RepeatOffsets]) -> String {
    let name = |found: &RepeatOffsets| {
        let wheel = found.wheel.as_deref().unwrap_or("all wheels");
        format!(
            "{wheel}, {} {}",
            found.quantity.words(),
            found.quantity.shown().name
        )
    };
    let width = found
        .iter()
        .map(|found| name(found).chars().count())
        .fold(HEADING.len(), usize::max);
    let sd = |found: &RepeatOffsets, sd: Option<f64>| {
        cell(sd, |sd| format!("{:.2}", found.quantity.shown().factor * sd))
    };
    Table::<&RepeatOffsets>::new()
        .left(width, HEADING, name)
        .left(8, "by", |found| found.column.name())
        .right(7, "P", |found| cell(found.probability, shown))
        .right(9, "offset sd", move |found| sd(found, found.offset_sd))
        .right(9, "repeat sd", move |found| sd(found, found.repeat_sd))
        .right(9, "without", move |found| sd(found, found.repeat_sd_without))
        .text(found.iter().copied())
}

/// Formats a probability, which is never 0 or 1.
fn shown(probability: f64) -> String {
    match probability {
        p if p > 0.999 => "> 0.999".to_owned(),
        p => format!("{p:.3}"),
    }
}

/// Says what the rig did in the fitted runs of the current model; empty if no run states a session, a taring or an operator.
pub(super) fn rig_of_study(study: &Study) -> String {
    let sentences = rig_sentences(&study_rig(study).unwrap_or_default());
    match sentences.is_empty() {
        true => String::new(),
        false => {
            let lines = sentences.iter().map(|sentence| labelled("", sentence));
            format!("{HEADING}\n{}\n", lines.collect::<String>())
        }
    }
}

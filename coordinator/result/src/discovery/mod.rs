//! What the searches of a study found.
//!
//! # Layout
//! - `summary`: the block `discovery` of `summary.json`.

mod summary;

pub use summary::DiscoverySummary;

use job::effect_name;
use record::{Discovery, Extension, Verdict};

/// A finished search of a study.
#[derive(Debug, Clone)]
pub struct Round {
    /// The calibration whose model was searched.
    pub calibration: i64,
    /// What was found.
    pub record: Discovery,
}

/// A verdict as `summary.json` has it.
pub(crate) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingDetectable => "nothing_detectable",
        Verdict::Named => "named",
        Verdict::Class => "class",
        Verdict::NotInLibrary => "not_in_library",
        Verdict::Undecided => "undecided",
    }
}

/// The effect file that a search has written, if it has: name and text.
pub fn effect_file(record: &Discovery) -> Option<(String, String)> {
    let text = match (&record.extension, &record.outside) {
        (Some(Extension::File { text, .. }), _) => text,
        (_, Some(outside)) => &outside.effect_file,
        _ => return None,
    };
    Some((format!("{}.toml", effect_name(text)?), text.clone()))
}

/// The arguments of the command that adds what a search names; `folder` is where its effect file lies.
pub(crate) fn arguments(record: &Discovery, folder: &std::path::Path) -> Option<String> {
    Some(match record.extension.as_ref()? {
        Extension::Effect(effect) => format!("--effect {effect}"),
        Extension::OnWheel { effect, wheel } => format!("--effect {effect} --wheel {wheel}"),
        Extension::File { .. } => {
            let (name, _) = effect_file(record)?;
            format!("--effect-file {}", folder.join(name).display())
        }
    })
}

//! A finished search of a study, its words and its command.

use job::effect_name;
use record::{Discovery, Extension, Verdict};

/// A finished search of a study.
#[derive(Debug, Clone)]
pub struct DiscoveryRound {
    /// The calibration whose model was searched.
    pub calibration: i64,
    /// Its result.
    pub record: Discovery,
}

/// A verdict as `summary.json` has it.
pub fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingDetectable => "nothing_detectable",
        Verdict::Named => "named",
        Verdict::Class => "class",
        Verdict::NotInLibrary => "not_in_library",
        Verdict::Undecided => "undecided",
    }
}

/// Name and text of a search's effect file, if it has one.
pub fn effect_file(record: &Discovery) -> Option<(String, String)> {
    let text = match (&record.extension, &record.outside) {
        (Some(Extension::File { text, .. }), _) => text,
        (_, Some(outside)) => &outside.effect_file,
        _ => return None,
    };
    Some((format!("{}.toml", effect_name(text)?), text.clone()))
}

/// The arguments of the command that adds the named effect; `folder` is that of its effect file.
pub fn arguments(record: &Discovery, folder: &std::path::Path) -> Option<String> {
    Some(match record.extension.as_ref()? {
        Extension::Effect(effect) => format!("--effect {effect}"),
        Extension::OnWheel { effect, wheel } => format!("--effect {effect} --wheel {wheel}"),
        Extension::File { .. } => {
            let (name, _) = effect_file(record)?;
            format!("--effect-file {}", folder.join(name).display())
        }
    })
}

//! A finished search of a study: its verdict's name, its effect file, and the arguments of its command.

use job::effect_name;
use record::{Discovery, Extension, Outside, Verdict};

/// A finished search of a study.
#[derive(Debug, Clone)]
pub struct DiscoveryRound {
    /// The calibration whose model was searched.
    pub calibration: i64,
    /// Record of its result.
    pub record: Discovery,
}

/// Returns the name of a verdict in `summary.json`.
pub fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingDetectable => "nothing_detectable",
        Verdict::Named => "named",
        Verdict::Class => "class",
        Verdict::NotInLibrary => "not_in_library",
        Verdict::Undecided => "undecided",
    }
}

/// Returns the name and the text of a search's effect file, if it has one.
pub fn effect_file(record: &Discovery) -> Option<(String, String)> {
    let text = match (&record.extension, &record.outside) {
        (Some(Extension::File { text, .. }), _) => text,
        (_, Some(outside)) => &outside.effect_file,
        _ => return None,
    };
    named_file(text)
}

/// Returns the names and the texts of a search's effect files: that of the effect to add, and of the formulas of a law.
pub fn effect_files(record: &Discovery) -> Vec<(String, String)> {
    let formulas = record.outside.iter().flat_map(formula_files);
    effect_file(record).into_iter().chain(formulas).collect()
}

/// Returns the names and the texts of the effect files of the law outside the library that a search found: its curve or form, then its
/// formulas.
pub fn law_files(record: &Discovery) -> Vec<(String, String)> {
    let file = |outside: &Outside| named_file(&outside.effect_file);
    let law = record.outside.iter().filter_map(file);
    law.chain(record.outside.iter().flat_map(formula_files)).collect()
}

fn formula_files(outside: &Outside) -> impl Iterator<Item = (String, String)> {
    let classes = outside.formulas.iter().flat_map(|formulas| &formulas.classes);
    classes.filter_map(|class| named_file(&class.effect_file))
}

fn named_file(text: &str) -> Option<(String, String)> {
    Some((format!("{}.toml", effect_name(text)?), text.to_owned()))
}

/// Returns the arguments of the command that adds the named effect; `folder` contains its effect file.
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

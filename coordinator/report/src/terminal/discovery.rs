//! A search for a missing effect as text.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use job::effect_name;
use record::{ChiSquare, Discovery, FittedForm, FormulaClass, JudgedEffect, JudgedSet, LawFormulas};

use super::column::{cell, width};
use super::table::Table;
use result::discovery::{arguments, effect_file, numerical_noise, word};
use result::words::probability::p_words;

/// Maximum number of explanations that are shown.
const SHOWN: usize = 8;
/// Maximum number of forms of a law that are shown.
const FORMS: usize = 3;
/// Maximum number of names in a list of effects.
const LISTED: usize = 20;

/// Describes the result of a search, with the command that adds it to the model.
///
/// # Arguments
/// - `calibration`: the searched calibration. `place`: the argument that locates it. `folder`: the folder of effect files.
pub fn text(record: &Discovery, calibration: i64, place: &str, folder: &Path) -> String {
    let mut text = format!("discovery: {}\n{}\n\n", word(record.verdict), record.text);
    let width = width(record.effects.iter().map(|e| &e.name));
    text += &Table::<&JudgedEffect>::new()
        .left(width, "explanation", |effect| &effect.name)
        .right(9, "ln BF", |effect| format!("{:.2}", effect.log_bayes_factor))
        .right(11, "probability", |effect| format!("{:.4}", effect.probability))
        .right(6, "class", |effect| effect.class)
        .right(
            9,
            "95 % set",
            |effect| if effect.in_credible_set { "in" } else { "-" },
        )
        .right(9, "prior sds", |effect| {
            cell(effect.prior_sds, |sds| format!("{sds:.1}"))
        })
        .apart(0, "strength prior", |effect| {
            effect.strength_prior.as_deref().unwrap_or("-")
        })
        .text(record.effects.iter().take(SHOWN));
    if let Some(more) = record.effects.len().checked_sub(SHOWN).filter(|&more| more > 0) {
        let _ = writeln!(text, "and {more} less probable ones");
    }
    text += &sets(record);
    let _ = writeln!(
        text,
        "\nchi-square {} as the model is, {} with the best explanation",
        chi_square(record.chi2),
        chi_square(record.chi2_best)
    );
    if let Some(sentence) = numerical_noise(record) {
        let _ = writeln!(text, "{sentence}");
    }
    if let Some(outside) = &record.outside {
        let _ = writeln!(
            text,
            "outside the library: {} depends on {} ({}), ln BF {:.2}",
            outside.acts_on, outside.depends_on, outside.form, outside.log_bayes_factor
        );
        text += &forms(&outside.forms);
        text += &outside.formulas.as_ref().map_or(String::new(), formulas);
    }
    if let Some((name, _)) = effect_file(record) {
        let _ = writeln!(text, "its effect file: {}", folder.join(name).display());
    }
    for replacement in &record.replacements {
        let _ = writeln!(
            text,
            "{} in the place of {}: ln BF {:.2}, probability {:.3}",
            replacement.effect,
            replacement.in_place_of,
            replacement.log_bayes_factor,
            replacement.probability
        );
    }
    for (words, effects) in [
        ("no longer improves the evidence", &record.drop),
        ("not detectable at the usual strength", &record.cannot_exclude),
        ("rejected by the model at every strength", &record.refused),
    ] {
        if !effects.is_empty() {
            let effects = folded(effects);
            let more = effects.len().saturating_sub(LISTED);
            let shown = effects[..effects.len() - more].join(", ");
            let rest = if more > 0 {
                format!(" and {more} more")
            } else {
                String::new()
            };
            let _ = writeln!(text, "{words}: {shown}{rest}");
        }
    }
    let mut untried: BTreeMap<(&str, &str), Vec<String>> = BTreeMap::new();
    for effect in &record.not_tried {
        let same = untried.entry((&effect.needs, &effect.why)).or_default();
        same.push(effect.name.clone());
    }
    for ((needs, why), effects) in untried {
        let effects = folded(&effects).join(", ");
        let _ = writeln!(
            text,
            "not tried as the experiment is: {effects}: {why} (needs {needs})"
        );
    }
    for (place, run) in record.next_runs.iter().enumerate() {
        let _ = writeln!(
            text,
            "{}: slip {:.2}, {:.1} N, {:.4} m/s distinguishes {} ({} {:.2} nats)",
            if place == 0 { "next run" } else { "and then" },
            run.slip,
            run.wheel_load_n,
            run.sled_speed_m_s,
            run.separates.join(", "),
            if place == 0 { "tells" } else { "adds" },
            run.information_nats
        );
    }
    for test in &record.other_tests {
        let _ = writeln!(text, "other test: {test}");
    }
    let _ = writeln!(
        text,
        "{} evaluations, {} until the verdict",
        record.evaluations, record.evaluations_to_name
    );
    if let Some(arguments) = arguments(record, folder) {
        let _ = writeln!(
            text,
            "\nto add it: coordinator extend {calibration} {arguments} {place}"
        );
    }
    text
}

/// Tabulates the sets behind the probabilities, if a set has several effects or left-out levels were predicted.
fn sets(record: &Discovery) -> String {
    let is_shown = |set: &JudgedSet| set.members.len() > 1 || set.predictive.is_some();
    if !record.sets.iter().any(is_shown) {
        return String::new();
    }
    let shown = || record.sets.iter().take(SHOWN);
    let names: Vec<String> = shown().map(|set| set.members.join(" + ")).collect();
    let width = width(names.iter());
    let table = Table::<(&String, &JudgedSet)>::new()
        .left(width, "set", |(name, _)| name)
        .right(9, "ln BF", |(_, set)| format!("{:.2}", set.log_bayes_factor))
        .right(9, "prior", |(_, set)| format!("{:.4}", set.prior))
        .right(11, "probability", |(_, set)| format!("{:.4}", set.probability))
        .right(20, "prediction, nats", |(_, set)| {
            cell(set.predictive, |nats| format!("{nats:+.1}"))
        });
    format!("\n{}", table.text(names.iter().zip(shown())))
}

/// Tabulates the leading forms of a law, if several were fitted.
fn forms(forms: &[FittedForm]) -> String {
    if forms.len() < 2 {
        return String::new();
    }
    Table::<&FittedForm>::new()
        .left(15, "form of the law", |form| &form.form)
        .right(9, "ln BF", |form| format!("{:.2}", form.log_bayes_factor))
        .right(11, "probability", |form| format!("{:.4}", form.probability))
        .right(6, "class", |form| form.class)
        .apart(0, "formula", |form| &form.formula)
        .text(forms.iter().take(FORMS))
}

/// Tabulates the classes of formulas of a law, each by its simplest member, with its effect file.
fn formulas(formulas: &LawFormulas) -> String {
    let file = |class: &FormulaClass| {
        effect_name(&class.effect_file).map_or("-".into(), |name| format!("{name}.toml"))
    };
    let width = formulas.classes.iter().map(|class| file(class).len()).max();
    Table::<&FormulaClass>::new()
        .left(width.unwrap_or(0), "formula in the file", file)
        .right(11, "probability", |class| format!("{:.4}", class.probability))
        .right(6, "alike", |class| class.members.len().saturating_sub(1))
        .apart(0, "simplest member", |class| {
            class
                .members
                .first()
                .map_or(String::new(), |member| member.formula.clone())
        })
        .text(formulas.classes.iter())
}

/// Removes each `EFFECT.WHEEL` from a list that contains `EFFECT`.
fn folded(names: &[String]) -> Vec<&str> {
    let is_own = |name: &&String| match name.split_once('.') {
        Some((effect, _)) => !names.iter().any(|other| other == effect),
        None => true,
    };
    names.iter().filter(is_own).map(String::as_str).collect()
}

/// Returns, for example, `210.0 with 68 degrees of freedom (p 1e-9)`.
fn chi_square(chi2: ChiSquare) -> String {
    let value = chi2.value.map_or("unknown".into(), |value| format!("{value:.1}"));
    let p = chi2.p.map_or(String::new(), |p| format!(" ({})", p_words(p)));
    format!(
        "{value} with {:.0} degrees of freedom{p}",
        chi2.degrees_of_freedom
    )
}

#[cfg(test)]
mod tests {
    use record::{Extension, Outside};

    use super::*;

    fn record() -> Discovery {
        serde_json::from_str(include_str!("../../../record/discovery.json")).unwrap()
    }

    #[test]
    fn the_text_of_a_search_has_its_result_and_the_command_that_adds_it() {
        let text = text(&record(), 7, "--out out/sand", Path::new("out/sand"));
        for words in [
            "discovery: named\nThe data name slip_sinkage.",
            "slip_sinkage                     40.00      0.9600      1        in       1.2  half_normal 0.2",
            "slip_sinkage + bulldozing        40.00    0.0030      0.0600                +28.0",
            "not detectable at the usual strength: moisture",
            "next run: slip 0.60, 80.0 N, 0.0200 m/s distinguishes slip_sinkage, bulldozing (tells 0.40 nats)",
            "other test: plate test at 80 N",
            "to add it: coordinator extend 7 --effect slip_sinkage --out out/sand",
        ] {
            assert!(text.contains(words), "{words} in\n{text}");
        }
    }

    #[test]
    fn the_leading_forms_of_a_law_have_their_formulas() {
        let mut record = record();
        let form = |form: &str, log_bayes_factor: f64| FittedForm {
            form: form.into(),
            formula: format!("tau * {form}(j)"),
            log_bayes_factor,
            probability: 0.25,
            class: 1,
        };
        record.outside = Some(Outside {
            acts_on: "shear".into(),
            depends_on: "j".into(),
            places: Vec::new(),
            form: "log".into(),
            log_bayes_factor: 12.0,
            effect_file: "name = \"shear_j_log\"\n".into(),
            curve: Vec::new(),
            left_out_nats: [8.0, 3.0],
            formulas: None,
            forms: vec![
                form("log", 12.0),
                form("decay", 11.0),
                form("spline", 8.5),
                form("step", 2.0),
            ],
        });
        let text = text(&record, 1, "--out o", Path::new("o"));
        assert!(
            text.contains("decay               11.00      0.2500      1  tau * decay(j)\n"),
            "{text}"
        );
        assert!(
            text.contains("tau * spline(j)") && !text.contains("tau * step(j)"),
            "{text}"
        );
        let alike = record.outside.as_ref().and_then(Outside::forms_alike);
        assert_eq!(alike.as_deref(), Some("log (12.0) and decay (11.0)"));
    }

    #[test]
    fn a_file_is_added_by_its_path_and_without_an_extension_there_is_no_command() {
        let mut record = record();
        record.extension = Some(Extension::File {
            name: "anything.toml".into(),
            text: "name = \"shear_slip_step\"\n".into(),
        });
        let with = |record: &Discovery| text(record, 1, "--out o", Path::new("o"));
        assert!(with(&record).contains("extend 1 --effect-file o/shear_slip_step.toml --out o"));
        record.extension = None;
        assert!(!with(&record).contains("to add it"));
    }
}

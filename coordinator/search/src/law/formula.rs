//! The formula of a law outside the library with its fitted values, as a reader would write it.

use std::collections::BTreeMap;

use formula::Hook;

use super::range::rounded;

/// Returns the formula of an effect file with its definitions and the values of its parameters in place of their names; `None` if the
/// text has no formula for the hook.
///
/// # Arguments
/// - `values`: by the names of the parameters in a job, `EFFECT.PARAMETER`; they are rounded to four digits.
///
/// Checked by `tests::a_formula_gives_the_curve_of_its_file`.
pub(crate) fn formula(effect_text: &str, hook: Hook, values: &BTreeMap<String, f64>) -> Option<String> {
    let file: toml::Table = effect_text.parse().ok()?;
    let values = values.iter().filter_map(|(name, value)| {
        let parameter = name.rsplit('.').next()?;
        Some((parameter.to_owned(), format!("{:?}", rounded(*value, 4))))
    });
    let mut words: BTreeMap<String, String> = values.collect();
    // A definition is written out once all that it uses are.
    let definitions = file.get("definitions").and_then(toml::Value::as_table);
    let mut left: Vec<(&String, &str)> = definitions
        .into_iter()
        .flatten()
        .filter_map(|(name, text)| Some((name, text.as_str()?)))
        .collect();
    let mut in_parentheses = Vec::new();
    while let Some(next) = (0..left.len()).find(|&i| !left.iter().any(|(name, _)| has_word(left[i].1, name)))
    {
        let (name, text) = left.remove(next);
        let definition = format!("({})", replaced(text, &words));
        words.insert(name.clone(), definition.clone());
        in_parentheses.push(definition);
    }
    let text = replaced(file.get(hook.name())?.as_str()?, &words);
    let text = in_parentheses.iter().fold(text, |text, definition| {
        text.replace(&format!("({definition})"), definition)
    });
    Some(with_differences(&text))
}

fn has_word(text: &str, word: &str) -> bool {
    split(text).any(|part| part == word)
}

/// Replaces words of a formula by others.
fn replaced(text: &str, words: &BTreeMap<String, String>) -> String {
    let part = |part: &'_ str| words.get(part).map_or_else(|| part.to_owned(), Clone::clone);
    split(text).map(part).collect()
}

/// Splits a formula into its names, its numbers and what stands between them.
fn split(text: &str) -> impl Iterator<Item = &str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
    let mut rest = text;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let end = rest
            .find(|c: char| is_word(c) != is_word(first))
            .unwrap_or(rest.len());
        let (part, after) = rest.split_at(end);
        rest = after;
        Some(part)
    })
}

/// Writes a sum with a negative value as a difference.
fn with_differences(text: &str) -> String {
    text.replace("+ -", "- ").replace("- -", "+ ").replace("--", "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{read, text};
    use crate::law::curve::curve;
    use crate::law::dependence::{Dependence, dependences};
    use crate::law::form::LawForm;

    /// The curve of a file without parameters that has this formula.
    fn curve_of(formula: &str, dependence: &Dependence) -> Vec<[f64; 2]> {
        let hook = dependence.acts_on.name();
        let text =
            format!("name = \"law\"\nsummary = \"a law\"\nsource = \"a test\"\n{hook} = \"{formula}\"\n");
        curve(&text, &BTreeMap::new(), dependence).unwrap_or_else(|e| panic!("{formula}: {e}"))
    }

    #[test]
    fn a_formula_gives_the_curve_of_its_file() {
        let (_, _, experiment) = read("examples/cmu-sand");
        for dependence in dependences(&experiment) {
            let forms = LawForm::ALL.into_iter().filter(|form| form.suits(&dependence));
            let forms = forms.map(|form| form.effect(&dependence));
            for candidate in forms.chain([dependence.curve()]) {
                let (text, effect) = text(&candidate);
                for sign in [1.0, -1.0] {
                    let value = |k: usize| match k {
                        0 => sign * 0.25,
                        k => 0.5 * dependence.range.highest / (k as f64 + 1.0),
                    };
                    let names = effect.parameters.iter().enumerate();
                    let values: BTreeMap<String, f64> = names
                        .map(|(k, p)| (format!("{}.{}", effect.name, p.name), rounded(value(k), 4)))
                        .collect();
                    let written = formula(text, dependence.acts_on.hook(), &values).unwrap();
                    let expected = curve(text, &values, &dependence).unwrap();
                    for (found, expected) in curve_of(&written, &dependence).iter().zip(&expected) {
                        let apart = (found[1] - expected[1]).abs();
                        assert!(
                            apart <= 1e-9 * expected[1].abs().max(1.0),
                            "{written}: {found:?} {expected:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_formula_reads_as_one_would_write_it() {
        let (_, _, experiment) = read("tests/data/shear-mobilisation");
        let written = |name: &str, form: LawForm, values: &[f64]| {
            let mut all = dependences(&experiment).into_iter();
            let dependence = all.find(|dependence| dependence.name() == name).unwrap();
            let candidate = form.effect(&dependence);
            let (text, effect) = text(&candidate);
            let names = effect
                .parameters
                .iter()
                .map(|p| format!("{}.{}", effect.name, p.name));
            let values = names.zip(values.iter().copied()).collect();
            formula(text, dependence.acts_on.hook(), &values).unwrap()
        };
        assert_eq!(
            written("shear_j", LawForm::Saturation, &[-0.312_34, 0.008_123_4]),
            "tau * (1 - 0.3123 * (1 - exp(-j / 0.008123)))"
        );
        assert_eq!(
            written("shear_v_t", LawForm::InversePower, &[0.2, 0.0002]),
            "tau * (1 + v_t / 0.0002)^(-0.2)"
        );
        assert_eq!(
            written("torque_slip", LawForm::Decay, &[-1.5, 0.1]),
            "torque - 1.5 * exp(-slip / 0.1)"
        );
    }
}

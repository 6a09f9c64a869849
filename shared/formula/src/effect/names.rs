//! Say which names an effect file may give.

use super::Mechanism;
use crate::hook::Hook;
use crate::parse::reserved;
use crate::variable::Variable;

/// Longest name.
const LONGEST: usize = 60;

/// Checks the form of a name: lower-case letters, digits and underscores, a letter first.
pub(super) fn check_form(what: &str, name: &str) -> Result<(), String> {
    let mut characters = name.chars();
    let begins = characters.next().is_some_and(|c| c.is_ascii_lowercase());
    if !begins || !characters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_') {
        let form = "lower-case letters, digits and _, a letter first";
        return Err(format!("{what} {name:?} must have {form}"));
    }
    if name.len() > LONGEST {
        return Err(format!(
            "a {what} of {} characters must have at most {LONGEST}",
            name.len()
        ));
    }
    Ok(())
}

/// Checks that a parameter or definition does not take a name that means something already.
pub(super) fn check_free(what: &str, name: &str) -> Result<(), String> {
    check_form(what, name)?;
    let taken = |by: &str| Err(format!("{what} {name} has the name of a {by}"));
    if reserved().any(|word| word == name) {
        taken("function or constant")
    } else if Variable::ALL.iter().any(|v| v.name() == name) {
        taken("variable")
    } else if Hook::ALL.iter().any(|h| h.name() == name) {
        taken("hook")
    } else {
        Ok(())
    }
}

/// The mechanism of a name.
pub(super) fn mechanism(name: &str) -> Result<Mechanism, String> {
    let known = Mechanism::ALL.map(Mechanism::name);
    let found = Mechanism::ALL.into_iter().find(|m| m.name() == name);
    found.ok_or_else(|| crate::word::unknown_word("mechanism", name, known))
}

//! The names that an effect file may give.

use super::Mechanism;
use crate::hook::Hook;
use crate::syntax::parse::reserved;
use crate::variable::Variable;
use crate::word::unknown_word;

/// Why a name cannot be used.
#[derive(Debug, thiserror::Error)]
pub(super) enum NameError {
    #[error("{what} {name:?} must have lower-case letters, digits and _, a letter first")]
    Form { what: &'static str, name: String },
    #[error("a {what} of {length} characters must have at most {LONGEST}")]
    TooLong { what: &'static str, length: usize },
    #[error("{what} {name} has the name of a {owner}")]
    Taken {
        what: &'static str,
        name: String,
        owner: &'static str,
    },
    #[error("{0}")]
    Unknown(String),
}

/// The maximum length of a name.
const LONGEST: usize = 60;

/// Checks the form of a name: lower-case letters, digits and underscores, a letter first.
pub(super) fn check_form(what: &'static str, name: &str) -> Result<(), NameError> {
    let mut characters = name.chars();
    let begins = characters.next().is_some_and(|c| c.is_ascii_lowercase());
    if !begins || !characters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_') {
        let name = name.to_owned();
        return Err(NameError::Form { what, name });
    }
    if name.len() > LONGEST {
        let length = name.len();
        return Err(NameError::TooLong { what, length });
    }
    Ok(())
}

/// Checks that a parameter or definition does not take a name that already has a meaning.
pub(super) fn check_free(what: &'static str, name: &str) -> Result<(), NameError> {
    check_form(what, name)?;
    let taken = |owner| {
        let name = name.to_owned();
        Err(NameError::Taken { what, name, owner })
    };
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

/// Finds the mechanism of a name.
pub(super) fn mechanism(name: &str) -> Result<Mechanism, NameError> {
    let names = Mechanism::ALL.iter().map(|mechanism| mechanism.name());
    name.parse()
        .map_err(|_| NameError::Unknown(unknown_word("mechanism", name, names)))
}

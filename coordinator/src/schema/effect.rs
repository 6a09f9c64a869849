//! A file of an effect.

use formula::Hook;
use serde_json::{Value, json};

use super::prior;
use super::shape::{named, needing, one_of, table, text};

const MECHANISMS: [&str; 5] = ["rebound", "flat_patch", "digging", "end_wall", "side_wall"];

/// The whole file.
pub(super) fn effect() -> Value {
    let formula = |hook: Hook| {
        let words = format!(
            "formula of {} in {}, {}",
            hook.name(),
            hook.target().unit_name(),
            hook.bound()
        );
        (hook.name(), text(&words))
    };
    let keys = [
        (
            "name",
            text("name in jobs and results: lower-case letters, digits and _, a letter first"),
        ),
        ("summary", text("what it is, in one line")),
        ("source", text("where it comes from")),
        ("mechanism", one_of("in the catalogue alone", MECHANISMS)),
        ("definitions", named("named parts of formulas", text("a formula"))),
        (
            "parameters",
            named("parameters of the formulas", prior::of_own_effect()),
        ),
    ];
    let table = table("an effect", keys.into_iter().chain(Hook::ALL.map(formula)));
    let mut effect = needing(table, &["name", "summary", "source"]);
    effect["definitions"] = json!({ "prior": prior::definition() });
    effect
}

//! Words for the reasons why a model rejects parameters.

use std::collections::BTreeMap;

/// Returns what a kind of rejection means; a kind that is not known, as an external model may have it, stands for itself.
fn clause(kind: &str) -> &str {
    match kind {
        "no_support" => "the soil does not carry the load",
        "no_convergence" => "the forces find no balance",
        "not_finite" => "a value is not finite",
        "energy_gained" => "the soil seems to drive the wheel",
        "protocol" => "the protocol does not fit the run",
        "formula" => "a formula of an effect leaves its bounds",
        "invalid_parameter" => "a parameter leaves the bounds of the model",
        "time_limit" => "the model exceeds its time",
        kind => kind,
    }
}

/// Counts rejections by kind, the most frequent first: `the soil does not carry the load (no_support, 990)`.
pub fn rejection_counts(counts: &BTreeMap<String, u64>) -> Vec<String> {
    let mut kinds: Vec<(&String, &u64)> = counts.iter().collect();
    kinds.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let words = kinds.into_iter().map(|(kind, count)| match clause(kind) {
        unknown if unknown == kind => format!("{kind} ({count})"),
        known => format!("{known} ({kind}, {count})"),
    });
    words.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_said_in_words_with_their_names_and_counts() {
        let counts = [("model", 3), ("no_support", 990), ("not_finite", 10)];
        let counts = counts.map(|(kind, count)| (kind.to_owned(), count)).into();
        assert_eq!(
            rejection_counts(&counts),
            [
                "the soil does not carry the load (no_support, 990)",
                "a value is not finite (not_finite, 10)",
                "model (3)"
            ]
        );
    }
}

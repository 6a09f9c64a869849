//! Probabilities of tests in words, and the level that raises a flag.

use super::number;

/// Probability of a test below which it raises a flag.
pub const LEVEL: f64 = 0.01;

/// Formats a probability: `0.012`, `3e-7`, `< 1e-12`.
pub fn probability(p: f64) -> String {
    if p < 1e-12 {
        "< 1e-12".into()
    } else if p < 1e-3 {
        format!("{p:.0e}")
    } else {
        number::significant(p, 2)
    }
}

/// Formats a probability for a sentence: `p = 0.012`, `p < 1e-12`.
pub fn p_words(p: f64) -> String {
    let value = probability(p);
    let relation = if value.starts_with('<') { "p" } else { "p =" };
    format!("{relation} {value}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_in_words() {
        let words = [0.0123, 3.4e-7, 0.0].map(p_words);
        assert_eq!(words, ["p = 0.012", "p = 3e-7", "p < 1e-12"]);
    }
}

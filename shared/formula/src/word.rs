//! The known word nearest to an unknown one.

/// The length above which a word is no misspelling: it is shown by its beginning and not compared, so that a very long
/// text costs nothing.
const LONGEST: usize = 60;

/// Returns `unknown key "radus_m"; the nearest known is "radius_m"`, or the list if no word is near.
pub fn unknown_word<'a>(what: &str, unknown: &str, known_words: impl IntoIterator<Item = &'a str>) -> String {
    let known_words: Vec<&str> = known_words.into_iter().collect();
    let long = |word: &str| word.chars().nth(LONGEST).is_some();
    let compared: &[&str] = if long(unknown) { &[] } else { &known_words };
    let nearest = compared
        .iter()
        .filter(|k| !long(k))
        .map(|&k| {
            (
                strsim::damerau_levenshtein(&unknown.to_lowercase(), &k.to_lowercase()),
                k,
            )
        })
        .filter(|&(distance, k)| distance <= unknown.len().min(k.len()) / 2)
        .min();
    let beginning = unknown.chars().take(LONGEST);
    let unknown: String = beginning.chain(long(unknown).then_some('…')).collect();
    match nearest {
        Some((_, near)) => format!("unknown {what} \"{unknown}\"; the nearest known is \"{near}\""),
        None if known_words.is_empty() => format!("unknown {what} \"{unknown}\"; none is expected here"),
        None => format!(
            "unknown {what} \"{unknown}\"; known are {}",
            known_words.join(", ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_is_too_long_is_shown_by_its_beginning_and_compared_with_nothing() {
        let near = format!("{}b", "a".repeat(59));
        assert_eq!(
            unknown_word("name", &"a".repeat(60), [near.as_str()]),
            format!(
                "unknown name \"{}\"; the nearest known is \"{near}\"",
                "a".repeat(60)
            )
        );
        assert_eq!(
            unknown_word("name", &"ä".repeat(5_000_000), [near.as_str()]),
            format!("unknown name \"{}…\"; known are {near}", "ä".repeat(60))
        );
    }
}

//! Name what was probably meant.

/// `unknown key "radus_m"; the nearest known is "radius_m"`, or the list where nothing is near.
pub fn unknown_word<'a>(what: &str, unknown: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = known
        .iter()
        .map(|&k| {
            (
                strsim::damerau_levenshtein(&unknown.to_lowercase(), &k.to_lowercase()),
                k,
            )
        })
        .filter(|&(distance, k)| distance <= unknown.len().min(k.len()) / 2)
        .min();
    match nearest {
        Some((_, near)) => format!("unknown {what} \"{unknown}\"; the nearest known is \"{near}\""),
        None if known.is_empty() => format!("unknown {what} \"{unknown}\"; none is expected here"),
        None => format!("unknown {what} \"{unknown}\"; known are {}", known.join(", ")),
    }
}

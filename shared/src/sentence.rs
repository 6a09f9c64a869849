//! An error and its causes in one sentence.

/// Joins an error and its causes, from the outermost in; a cause that the text already contains is not repeated.
pub fn of_causes(causes: impl Iterator<Item = impl ToString>) -> String {
    causes
        .map(|cause| cause.to_string())
        .reduce(|text, cause| {
            if text.contains(&cause) {
                text
            } else {
                format!("{text}: {cause}")
            }
        })
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::of_causes;

    #[test]
    fn every_cause_is_said_once() {
        let causes = ["store: file is locked", "file is locked", "code 5"];
        assert_eq!(of_causes(causes.into_iter()), "store: file is locked: code 5");
        assert_eq!(of_causes(std::iter::empty::<&str>()), "");
    }
}

//! Statements that an experiment lacks, in words and by their keys.

/// The keys of an experiment that searches ask for, with the words for what they state. `{}` stands for the name of the table.
const KEYS: [(&str, &str); 3] = [
    ("density_kg_m3 ", "the density of soil {}"),
    (
        "grouser_count ",
        "the grousers of wheel {} (none for a smooth rim)",
    ),
    ("bin_length_m ", "the length of the bin"),
];

/// A statement that an experiment lacks.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Statement {
    /// What would be stated: `the density of soil sand`.
    pub(super) words: String,
    /// Where it would be stated: `density_kg_m3 under [soil.sand]`.
    pub(super) place: String,
}

/// Lists the statements that a record of a search asks for: `density_kg_m3 under [soil.sand], bin_length_m under [rig]`. It is empty if
/// something else than a statement is needed.
pub(super) fn statements(needs: &str) -> Vec<Statement> {
    needs.split(", ").filter_map(statement).collect()
}

fn statement(place: &str) -> Option<Statement> {
    let (_, words) = KEYS.iter().find(|(key, _)| place.starts_with(key))?;
    let table = place.split(['[', ']']).nth(1)?;
    let name = table.split_once('.').map_or(table, |(_, name)| name);
    Some(Statement {
        words: words.replace("{}", name),
        place: place.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_said_in_words() {
        let needs = "density_kg_m3 under [soil.sand], grouser_count and grouser_height_m under [wheel.a] (grouser_count = 0: a smooth rim), \
            bin_length_m under [rig]";
        let words: Vec<String> = statements(needs).into_iter().map(|s| s.words).collect();
        assert_eq!(
            words,
            [
                "the density of soil sand",
                "the grousers of wheel a (none for a smooth rim)",
                "the length of the bin"
            ]
        );
        assert!(statements("a job that is valid with contact = \"node\" as well").is_empty());
    }
}

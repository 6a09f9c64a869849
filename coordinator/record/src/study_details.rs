//! What people say of a study: its name, author, tags and a note.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The greatest length of a name, an author or a tag, in characters.
const LONGEST_LINE: usize = 200;
/// The greatest number of tags.
const MOST_TAGS: usize = 30;
/// The greatest length of a note, in characters.
const LONGEST_NOTE: usize = 10_000;

/// What people say of a study. It changes no result.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StudyDetails {
    /// Name in the place of the submitted one; null: the submitted one.
    pub name: Option<String>,
    /// Who answers questions about the study; null: nobody is named.
    pub author: Option<String>,
    /// Words by which it is found.
    pub tags: Vec<String>,
    /// Remark of at most 10,000 characters; null: none.
    pub note: Option<String>,
}

impl StudyDetails {
    /// Returns what is wrong: a line that is too long, blank or has control characters, or too many tags.
    pub fn fault(&self) -> Option<String> {
        let named = [("name", &self.name), ("author", &self.author)];
        let mut lines = named
            .into_iter()
            .filter_map(|(what, line)| Some((what, line.as_ref()?)));
        let tags = self.tags.iter().map(|tag| ("tag", tag));
        let note = self.note.as_ref().map_or(0, |note| note.chars().count());
        lines
            .by_ref()
            .chain(tags)
            .find_map(|(what, line)| line_fault(what, line))
            .or_else(|| {
                let count = self.tags.len();
                (count > MOST_TAGS).then(|| format!("{count} tags: at most {MOST_TAGS} are kept"))
            })
            .or_else(|| {
                (note > LONGEST_NOTE)
                    .then(|| format!("note has {note} characters: at most {LONGEST_NOTE} are kept"))
            })
    }
}

fn line_fault(what: &str, line: &str) -> Option<String> {
    let length = line.chars().count();
    match () {
        () if line.trim().is_empty() => Some(format!("{what} is blank")),
        () if line.chars().any(char::is_control) => Some(format!("{what} {line:?} has control characters")),
        () if length > LONGEST_LINE => Some(format!(
            "{what} has {length} characters: at most {LONGEST_LINE} are kept"
        )),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_names_what_is_wrong_with_its_bound() {
        let tagged = |tags: Vec<String>| StudyDetails {
            tags,
            ..StudyDetails::default()
        };
        let fault = |details: StudyDetails| details.fault().unwrap_or_default();
        assert_eq!(StudyDetails::default().fault(), None);
        assert_eq!(tagged(vec!["Rad 3, trocken".into(); 30]).fault(), None);
        assert_eq!(
            fault(tagged(vec!["a".into(); 31])),
            "31 tags: at most 30 are kept"
        );
        assert_eq!(fault(tagged(vec![" ".into()])), "tag is blank");
        let author = StudyDetails {
            author: Some("Zoë\n".into()),
            ..StudyDetails::default()
        };
        assert_eq!(fault(author), "author \"Zoë\\n\" has control characters");
        let name = StudyDetails {
            name: Some("x".repeat(201)),
            ..StudyDetails::default()
        };
        assert_eq!(fault(name), "name has 201 characters: at most 200 are kept");
        let note = StudyDetails {
            note: Some("two\nlines".into()),
            ..StudyDetails::default()
        };
        assert_eq!(note.fault(), None);
    }
}

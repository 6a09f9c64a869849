//! Comments cite documents that a reader can open.

use farm_tests::workspace::{files, root, text};

use super::{CRATES, relative};

/// Returns the documents that a line cites by name and section in brackets or parentheses, as in `(DESIGN 4.4)`.
fn cited(line: &str) -> Vec<&str> {
    let inside = line.split(['(', ')', '[', ']', '\\']);
    let citation = |part: &'_ str| {
        let (name, section) = part.split_once(' ')?;
        let is_name = name.len() > 3 && name.chars().all(|c| c.is_ascii_uppercase());
        let is_section = !section.is_empty() && section.chars().all(|c| c.is_ascii_digit() || c == '.');
        (is_name && is_section).then_some(part.len() - section.len() - 1)
    };
    inside.filter_map(|part| Some(&part[..citation(part)?])).collect()
}

#[test]
fn a_citation_is_told_from_other_words() {
    assert_eq!(cited("/// Effects (PLANS 4.4), and the rest."), ["PLANS"]);
    assert_eq!(cited("//! A target \\[PLANS 4\\]."), ["PLANS"]);
    assert!(cited("(IEEE) [ISO 8601] (SELECT 1 FROM t) (MATLAB files)").is_empty());
}

#[test]
fn what_a_comment_cites_is_a_document_of_the_repository() {
    let mut dangling = Vec::new();
    for path in CRATES.iter().flat_map(|(krate, _)| files(krate, ".rs")) {
        if path.ends_with("architecture/citation.rs") {
            continue;
        }
        let source = text(&path);
        for (i, line) in source.lines().enumerate().filter(|(_, line)| line.contains("//")) {
            let is_missing = |name: &&str| {
                let file = format!("{name}.md");
                !root().join(&file).exists() && !root().join("docs").join(&file).exists()
            };
            let missing = cited(line).into_iter().filter(is_missing);
            dangling.extend(missing.map(|name| format!("{}:{}: {name}", relative(&path), i + 1)));
        }
    }
    assert_eq!(dangling, Vec::<String>::new());
}

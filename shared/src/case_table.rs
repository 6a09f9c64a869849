//! Tables of cases for tests.

/// Returns the cases of a table of lines `input => message`.
pub(crate) fn cases(table: &str) -> impl Iterator<Item = (&str, &str)> {
    let lines = table.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.map(|line| line.split_once(" => ").expect("an input and a message"))
}

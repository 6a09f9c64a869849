//! A file as its user sent it, and what the map states about it as a whole.

/// A file as its user sent it.
#[derive(Debug, Clone, Copy)]
pub struct SourceFile<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its content.
    pub bytes: &'a [u8],
    /// Whether whoever sent it runs this program: a reader of old Excel files takes as much memory as a damaged one asks for.
    pub is_own: bool,
}

/// What the map states about the file as a whole.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hints {
    pub(crate) sheet: Option<String>,
    pub(crate) encoding: Option<String>,
    pub(crate) separator: Option<String>,
    /// Takes the sheet with the most rows where none is stated, as for a guess.
    pub(crate) takes_largest: bool,
}

//! A file of a user, and the map's statements about it as a whole.

/// A file of a user.
#[derive(Debug, Clone, Copy)]
pub struct SourceFile<'a> {
    /// Name of the file.
    pub name: &'a str,
    /// Content of the file.
    pub bytes: &'a [u8],
    /// Whether the user runs this program. The reader of old Excel files allocates as much memory as a damaged file asks for.
    pub is_own: bool,
}

/// The map's statements about the file as a whole.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hints {
    pub(crate) sheet: Option<String>,
    pub(crate) encoding: Option<String>,
    pub(crate) separator: Option<String>,
    /// Whether the sheet with the most cells is taken if none is stated, for a proposal.
    pub(crate) takes_largest: bool,
}

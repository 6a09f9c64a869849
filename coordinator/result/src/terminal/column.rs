//! Widths and cells of columns.

/// The width of a column of names.
pub(super) fn width<'a>(names: impl Iterator<Item = &'a String>) -> usize {
    names.map(String::len).fold(28, usize::max)
}

/// A value that may be missing.
pub(super) fn cell<T>(value: Option<T>, words: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| "-".into(), words)
}

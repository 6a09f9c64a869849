//! Widths of columns.

/// The width of a column of names.
pub(super) fn width<'a>(names: impl Iterator<Item = &'a String>) -> usize {
    names.map(String::len).fold(28, usize::max)
}

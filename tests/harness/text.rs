//! Comparing long texts.

/// Two texts must be equal, byte by byte; where they are not, the first line that differs is shown.
///
/// # Panics
/// They differ.
#[track_caller]
pub fn same(got: &str, expected: &str) {
    if got == expected {
        return;
    }
    let (mut a, mut b) = (got.lines(), expected.lines());
    for number in 1.. {
        let (a, b) = (a.next(), b.next());
        assert_eq!(a, b, "line {number}, got and expected");
        assert!(a.is_some(), "the texts differ in how their lines end");
    }
}

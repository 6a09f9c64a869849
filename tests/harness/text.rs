//! Checks of long texts.

/// Asserts that two texts are equal, byte by byte, and shows the first line that differs.
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

/// Asserts that a text contains every one of some passages.
#[macro_export]
macro_rules! assert_contains {
    ($text:expr, $($passage:expr),+ $(,)?) => {
        $crate::text::contains_all(AsRef::<str>::as_ref(&$text), &[$(AsRef::<str>::as_ref(&$passage)),+])
    };
}

/// The check of [`assert_contains`].
#[track_caller]
pub fn contains_all(text: &str, passages: &[&str]) {
    for passage in passages {
        assert!(text.contains(passage), "{passage:?} is not in\n{text}");
    }
}

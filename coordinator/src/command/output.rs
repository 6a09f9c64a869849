//! Output on the terminal; a closed pipe is not an error.

use std::io::{ErrorKind, Write};

use console::Term;
use report::terminal::{WIDTH, labelled_to};

/// The narrowest and the widest line, whatever the width of the terminal: beyond these, sentences are hard to read.
const WIDTHS: (usize, usize) = (60, 120);

/// Returns the number of characters in a line of a terminal; that of a usual one where the output goes elsewhere.
fn width_of(terminal: &Term) -> usize {
    let (least, most) = WIDTHS;
    let found = terminal.size_checked().map(|(_, columns)| usize::from(columns));
    found.map_or(WIDTH, |columns| columns.clamp(least, most))
}

/// Returns the number of characters in a line of standard output.
pub(super) fn width() -> usize {
    width_of(&Term::stdout())
}

/// Writes a result to standard output.
pub(super) fn say(text: &str) -> std::io::Result<()> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Writes a labelled sentence to standard error, in lines of the terminal's width.
pub(super) fn remark(label: &str, sentence: &str) {
    note(labelled_to(width_of(&Term::stderr()), label, sentence).trim_end());
}

/// Writes a line to standard error.
pub(super) fn note(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

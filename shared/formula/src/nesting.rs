//! Depth of the brackets of a TOML file, found before it is parsed.
//!
//! The TOML parser recurses, and an untrusted file must not exhaust the stack: the parser limits brackets to 80, but allows a
//! dotted key of 80 tables within each of them.

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Returns the byte of the first bracket that is nested more than `max_depth` deep.
///
/// A bracket that closes a different kind than was opened is ignored, so that no malformed file seems flatter than it is.
pub fn too_deep(text: &str, max_depth: usize) -> Option<usize> {
    let mut open = Vec::new();
    for token in Source::new(text).lex() {
        match token.kind() {
            kind @ (TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket) => open.push(kind),
            TokenKind::RightSquareBracket if open.last() == Some(&TokenKind::LeftSquareBracket) => {
                open.pop();
            }
            TokenKind::RightCurlyBracket if open.last() == Some(&TokenKind::LeftCurlyBracket) => {
                open.pop();
            }
            _ => {}
        }
        if open.len() > max_depth {
            return Some(token.span().start());
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_count_outside_texts_and_comments() {
        assert_eq!(too_deep("[a]\nb = [[{ c = 1 }]] # [[[[\nd = \"[[[[\"\n", 3), None);
        assert_eq!(too_deep("b = [[{ c = [] }]]", 3), Some(12));
        assert_eq!(too_deep("b = [}[}[}[", 3), Some(10));
    }
}

//! The tokens of a formula.

/// A token of a formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    /// `+ - * / ^ ( ) ,` or a comparison `< <= > >= == !=`.
    Sign(&'a str),
    End,
}

impl core::fmt::Display for Token<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Token::Number(value) => write!(f, "{value}"),
            Token::Name(name) => write!(f, "\"{name}\""),
            Token::Sign(sign) => write!(f, "\"{sign}\""),
            Token::End => f.write_str("the end"),
        }
    }
}

/// A mistake in a formula, and its place: characters from the beginning, counted from 0.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mistake {
    pub(crate) at: usize,
    pub(crate) message: String,
}

impl Mistake {
    pub(crate) fn new(at: usize, message: impl Into<String>) -> Self {
        Self {
            at,
            message: message.into(),
        }
    }
}

/// The tokens of a formula, one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Tokens<'a> {
    text: &'a str,
    /// The number of bytes read.
    read: usize,
    /// The byte at which the last token begins.
    begin: usize,
}

impl<'a> Tokens<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        Self {
            text,
            read: 0,
            begin: 0,
        }
    }

    /// Returns the character at which the last token begins.
    pub(crate) fn place(&self) -> usize {
        self.text[..self.begin].chars().count()
    }

    /// Takes the next token.
    pub(crate) fn take(&mut self) -> Result<Token<'a>, Mistake> {
        let rest = self.text[self.read..].trim_start();
        self.begin = self.text.len() - rest.len();
        let Some(first) = rest.chars().next() else {
            self.read = self.text.len();
            return Ok(Token::End);
        };
        let length_while = |accept: fn(char) -> bool| rest.find(|c| !accept(c)).unwrap_or(rest.len());
        let (token, length) = if first.is_ascii_digit() || first == '.' {
            let length = number_length(rest);
            let value: f64 = rest[..length].parse().map_err(|_| {
                self.wrong(format!(
                    "\"{}\" is not a number: expected digits before or after the point",
                    &rest[..length]
                ))
            })?;
            if !value.is_finite() {
                return Err(self.wrong(format!("number {} must be at most 1.8e308", &rest[..length])));
            }
            let mantissa = rest[..length].split(['e', 'E']).next().unwrap_or_default();
            if value <= 0.0 && mantissa.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) {
                let message = format!("number {} is nearer to 0 than 5e-324", &rest[..length]);
                return Err(self.wrong(message));
            }
            (Token::Number(value), length)
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = length_while(|c| c.is_ascii_alphanumeric() || c == '_');
            (Token::Name(&rest[..length]), length)
        } else if "<>=!".contains(first) {
            let length = if rest[1..].starts_with('=') { 2 } else { 1 };
            if matches!(&rest[..length], "=" | "!") {
                return Err(self.wrong(format!(
                    "\"{first}\" is not a comparison: use <, <=, >, >=, == or !="
                )));
            }
            (Token::Sign(&rest[..length]), length)
        } else if "+-*/^(),".contains(first) {
            (Token::Sign(&rest[..1]), 1)
        } else {
            return Err(self.wrong(format!(
                "{first:?} is not allowed in a formula: expected a number, a name, + - * / ^ ( ) , or a comparison"
            )));
        };
        self.read = self.begin + length;
        Ok(token)
    }

    fn wrong(&self, message: String) -> Mistake {
        Mistake::new(self.place(), message)
    }
}

/// Returns the length of a number in bytes: digits, a point, an exponent.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    end = digits(end);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

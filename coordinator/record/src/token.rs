//! Bearer tokens: their secrets, the records that the store keeps of them, and the rights of each role.

use sha2::{Digest, Sha256};

/// The rights of the holder of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenRole {
    /// Look at everything: every GET of a user.
    Read,
    /// Look, submit and control: every route of a user.
    Submit,
    /// Compute: the routes of workers alone.
    Work,
}

impl TokenRole {
    /// Every role, in the order of the enumeration.
    pub const ALL: [TokenRole; 3] = [TokenRole::Read, TokenRole::Submit, TokenRole::Work];

    /// Returns the word on the command line and in the store.
    pub fn name(self) -> &'static str {
        ["read", "submit", "work"][self as usize]
    }

    /// Returns the role of a word.
    pub fn from_name(name: &str) -> Option<TokenRole> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }

    /// Returns whether its rights include those of `needed`.
    pub fn includes(self, needed: TokenRole) -> bool {
        self == needed || (self, needed) == (TokenRole::Submit, TokenRole::Read)
    }
}

/// SHA-256 of a token. The token has 256 random bits, so no salt and no slow hash is needed.
#[derive(Debug, Clone, Copy)]
pub struct TokenHash(pub [u8; 32]);

impl TokenHash {
    /// Returns the hash of a token.
    pub fn new(token: &str) -> TokenHash {
        TokenHash(Sha256::digest(token.as_bytes()).into())
    }

    /// Returns whether both are equal, in a time that does not depend on where they differ.
    pub fn is(&self, other: &TokenHash) -> bool {
        let differing = self.0.iter().zip(&other.0).fold(0, |bits, (a, b)| bits | (a ^ b));
        std::hint::black_box(differing) == 0
    }
}

/// The record of a token in the store.
#[derive(Debug, Clone)]
pub struct Token {
    /// Name, unique among the tokens in use.
    pub name: String,
    /// The rights of its holder.
    pub role: TokenRole,
    /// Hash of the token.
    pub hash: TokenHash,
    /// When it was made, in time since 1970 `[ms]`.
    pub created_at_ms: i64,
    /// Whether it was revoked.
    pub is_revoked: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_that_of_its_token_alone() {
        assert!(TokenHash::new("abc").is(&TokenHash::new("abc")));
        assert!(!TokenHash::new("abc").is(&TokenHash::new("abd")));
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        let hex: String = TokenHash::new("abc")
            .0
            .iter()
            .map(|b| format!("{b:02x}"))
            .collect();
        assert_eq!(hex, known, "SHA-256 of FIPS 180-4, appendix B.1");
    }

    #[test]
    fn submitters_read_and_nobody_else_does_what_others_do() {
        for role in TokenRole::ALL {
            assert_eq!(TokenRole::from_name(role.name()), Some(role));
            for needed in TokenRole::ALL {
                let expected = role == needed || (role == TokenRole::Submit && needed == TokenRole::Read);
                assert_eq!(role.includes(needed), expected, "{role:?} {needed:?}");
            }
        }
    }
}

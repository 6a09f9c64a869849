//! Bearer tokens: what is told to their holder, what is kept of them, and what each role includes.

use sha2::{Digest, Sha256};

/// What the holder of a token may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Role {
    /// Look at everything: every GET of a user.
    Read,
    /// Look, submit and control: every route of a user.
    Submit,
    /// Compute: the routes of workers alone.
    Work,
}

impl Role {
    /// Every role.
    pub const ALL: [Role; 3] = [Role::Read, Role::Submit, Role::Work];

    /// The word for it, on the command line and in the store.
    pub fn name(self) -> &'static str {
        ["read", "submit", "work"][self as usize]
    }

    /// The role of a word.
    pub fn from_name(name: &str) -> Option<Role> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }

    /// Whether its holder may do what `needed` is for.
    pub fn includes(self, needed: Role) -> bool {
        self == needed || (self, needed) == (Role::Submit, Role::Read)
    }
}

/// SHA-256 of a token. The token has 256 random bits, so no salt and no slow hash is needed.
#[derive(Debug, Clone, Copy)]
pub struct TokenHash(pub [u8; 32]);

impl TokenHash {
    /// The hash of a token.
    pub fn of(token: &str) -> TokenHash {
        TokenHash(Sha256::digest(token.as_bytes()).into())
    }

    /// Whether both are the same; the time that this takes does not depend on where they differ.
    pub fn is(&self, other: &TokenHash) -> bool {
        let differing = self.0.iter().zip(&other.0).fold(0, |bits, (a, b)| bits | (a ^ b));
        std::hint::black_box(differing) == 0
    }
}

/// What the store keeps of a token.
#[derive(Debug, Clone)]
pub struct Token {
    /// Its name, unique among those in use.
    pub name: String,
    /// What its holder may do.
    pub role: Role,
    /// Its hash.
    pub hash: TokenHash,
    /// When it was made, in time since 1970 `[ms]`.
    pub created_at_ms: i64,
    /// Whether it is no longer accepted.
    pub is_revoked: bool,
}

/// A new token: `grouser-` and 64 hexadecimal digits, random bits of the operating system.
///
/// # Errors
/// The operating system has no random bits.
pub fn new_token() -> Result<String, getrandom::Error> {
    let mut bits = [0; 32];
    getrandom::fill(&mut bits)?;
    let digits: String = bits.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(format!("grouser-{digits}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_that_of_its_token_alone() {
        let token = new_token().unwrap();
        assert_eq!(token.len(), "grouser-".len() + 64);
        assert!(TokenHash::of(&token).is(&TokenHash::of(&token)));
        assert!(!TokenHash::of(&token).is(&TokenHash::of(&new_token().unwrap())));
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        let hex: String = TokenHash::of("abc")
            .0
            .iter()
            .map(|b| format!("{b:02x}"))
            .collect();
        assert_eq!(hex, known, "SHA-256 of FIPS 180-4, appendix B.1");
    }

    #[test]
    fn submitters_read_and_nobody_else_does_what_others_do() {
        for role in Role::ALL {
            assert_eq!(Role::from_name(role.name()), Some(role));
            for needed in Role::ALL {
                let expected = role == needed || (role == Role::Submit && needed == Role::Read);
                assert_eq!(role.includes(needed), expected, "{role:?} {needed:?}");
            }
        }
    }
}

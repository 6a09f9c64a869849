//! The choice of the evaluations that a second worker computes as well.

use record::SealKey;
use sha2::{Digest, Sha256};

/// The share of verified evaluations, and the key that selects them.
///
/// The choice depends on the calibration's key, which only the coordinator knows. Thus no worker can tell which of its answers are
/// compared, and a restart chooses the same ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verification {
    /// The share of the evaluations, in [0, 1]; 0 verifies nothing.
    pub share: f64,
    /// The key of the calibration.
    pub key: SealKey,
}

impl Verification {
    /// Verifies nothing.
    pub const OFF: Verification = Verification {
        share: 0.0,
        key: SealKey([0; 16]),
    };

    /// Returns whether anything is verified.
    pub fn is_on(self) -> bool {
        self.share > 0.0
    }

    /// Returns whether an evaluation is selected for verification.
    pub fn selects(self, evaluation: u64) -> bool {
        if !self.is_on() {
            return false;
        }
        let mut hash = Sha256::new();
        hash.update(b"verification");
        hash.update(self.key.0);
        hash.update(evaluation.to_le_bytes());
        let digits = hash.finalize()[..4]
            .iter()
            .fold(0_u32, |digits, &byte| digits << 8 | u32::from(byte));
        f64::from(digits) < self.share * (f64::from(u32::MAX) + 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_is_kept_and_the_choice_is_the_key_s() {
        let verification = |share, key| Verification {
            share,
            key: SealKey([key; 16]),
        };
        let chosen = |v: Verification| (0..20_000).filter(|&e| v.selects(e)).collect::<Vec<u64>>();
        assert!(chosen(Verification::OFF).is_empty());
        assert_eq!(chosen(verification(1.0, 1)).len(), 20_000);
        let one = chosen(verification(0.01, 1));
        // Four standard deviations of a binomial count.
        assert!((144..=256).contains(&one.len()), "{}", one.len());
        assert_eq!(one, chosen(verification(0.01, 1)));
        assert_ne!(one, chosen(verification(0.01, 2)));
    }
}

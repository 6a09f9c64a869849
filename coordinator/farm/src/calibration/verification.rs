//! The choice of the evaluations that a second worker computes as well.

use std::sync::Arc;

use record::SealKey;
use sha2::{Digest, Sha256};

use crate::voting::Voting;

/// The operator's choice of what is verified, and by whom.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct VerificationRule {
    /// The share of the evaluations, in [0, 1]; 0 verifies nothing.
    pub share: f64,
    /// Who counts as one in comparisons, and whose answer settles them.
    pub voting: Arc<Voting>,
}

impl VerificationRule {
    /// Makes the rule that verifies a share of the evaluations, where each worker counts.
    pub fn with_share(share: f64) -> Self {
        VerificationRule {
            share,
            ..VerificationRule::default()
        }
    }
}

/// The rule of verification, and the key that selects the verified evaluations of a calibration.
///
/// The choice depends on the calibration's key, which only the coordinator knows. Thus no worker can tell which of its answers are
/// compared, and a restart chooses the same ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// The rule that says which evaluations are verified, and who may confirm them.
    pub rule: VerificationRule,
    /// The key of the calibration.
    pub key: SealKey,
}

impl Default for Verification {
    fn default() -> Self {
        Verification {
            rule: VerificationRule::default(),
            key: SealKey([0; 16]),
        }
    }
}

impl Verification {
    /// Returns whether anything is verified.
    pub fn is_on(&self) -> bool {
        self.rule.share > 0.0
    }

    /// Returns whether an evaluation is selected for verification.
    pub fn selects(&self, evaluation: u64) -> bool {
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
        f64::from(digits) < self.rule.share * (f64::from(u32::MAX) + 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_is_kept_and_the_choice_is_the_key_s() {
        let verification = |share, key| Verification {
            rule: VerificationRule::with_share(share),
            key: SealKey([key; 16]),
        };
        let chosen = |v: Verification| (0..20_000).filter(|&e| v.selects(e)).collect::<Vec<u64>>();
        assert!(chosen(Verification::default()).is_empty());
        assert_eq!(chosen(verification(1.0, 1)).len(), 20_000);
        let one = chosen(verification(0.01, 1));
        // Four standard deviations of a binomial count.
        assert!((144..=256).contains(&one.len()), "{}", one.len());
        assert_eq!(one, chosen(verification(0.01, 1)));
        assert_ne!(one, chosen(verification(0.01, 2)));
    }
}

//! The seal of a lease. It proves that a result answers the question that this calibration asked this worker.
//!
//! A seal has two halves of 64 bits, in hexadecimal digits. The first is a digest of the question: variant and parameter vector. The
//! second is a digest of the calibration's key, the terms of the lease and the first half. Only the coordinator knows the key, so no other
//! program can make a seal, and a seal can be checked after a restart, when the lease is forgotten. The digest is SHA-256, cut to 64 bits.

use record::SealKey;
use sha2::{Digest, Sha256};

use crate::calibration::Question;

/// The terms of a lease.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeaseTerms<'a> {
    pub lease: u64,
    pub worker: &'a str,
    pub calibration: i64,
    pub evaluation: u64,
    /// The version of the model that the calibration is pinned to.
    pub model_version: &'a str,
}

/// Returns the seal of a lease with a question.
pub(super) fn seal(key: SealKey, terms: LeaseTerms, question: Question) -> String {
    sealed(key, terms, &question_digest(question))
}

/// Returns whether a seal matches the terms of a lease and, where the question is known, also the question.
pub(super) fn proves(seal: &str, key: SealKey, terms: LeaseTerms, question: Option<Question>) -> bool {
    match question {
        Some(question) => seal == self::seal(key, terms, question),
        None => seal
            .get(..16)
            .is_some_and(|digest| seal == sealed(key, terms, digest)),
    }
}

fn question_digest(question: Question) -> String {
    let mut hash = Sha256::new();
    text(&mut hash, question.variant);
    for value in question.theta {
        hash.update(value.to_bits().to_le_bytes());
    }
    half(hash)
}

fn sealed(key: SealKey, terms: LeaseTerms, question: &str) -> String {
    let mut hash = Sha256::new();
    hash.update(key.0);
    hash.update(terms.lease.to_le_bytes());
    hash.update(terms.calibration.to_le_bytes());
    hash.update(terms.evaluation.to_le_bytes());
    for part in [terms.worker, terms.model_version, question] {
        text(&mut hash, part);
    }
    format!("{question}{}", half(hash))
}

/// Hashes a text after its length, so that no two lists of texts give the same bytes.
fn text(hash: &mut Sha256, text: &str) {
    hash.update((text.len() as u64).to_le_bytes());
    hash.update(text);
}

fn half(hash: Sha256) -> String {
    let first = hash.finalize()[..8]
        .iter()
        .fold(0, |digits, &byte| digits << 8 | u64::from(byte));
    format!("{first:016x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: SealKey = SealKey([7; 16]);
    const TERMS: LeaseTerms = LeaseTerms {
        lease: 5,
        worker: "a",
        calibration: 1,
        evaluation: 3,
        model_version: "scm-7",
    };
    const QUESTION: Question = Question {
        variant: "00ff",
        theta: &[0.0, 1.5],
    };

    #[test]
    fn a_seal_proves_its_own_question_and_terms_and_nothing_else() {
        let seal = seal(KEY, TERMS, QUESTION);
        assert_eq!(seal.len(), 32);
        for question in [Some(QUESTION), None] {
            assert!(proves(&seal, KEY, TERMS, question));
            assert!(
                !proves(&seal, SealKey([8; 16]), TERMS, question),
                "another calibration"
            );
            for other in [
                LeaseTerms { lease: 6, ..TERMS },
                LeaseTerms { worker: "b", ..TERMS },
                LeaseTerms {
                    calibration: 2,
                    ..TERMS
                },
                LeaseTerms {
                    evaluation: 4,
                    ..TERMS
                },
                LeaseTerms {
                    model_version: "scm-8",
                    ..TERMS
                },
            ] {
                assert!(!proves(&seal, KEY, other, question), "{other:?}");
            }
        }
        let theta: &[f64] = &[-0.0, 1.5];
        let variant = "00fe";
        assert!(
            !proves(&seal, KEY, TERMS, Some(Question { theta, ..QUESTION })),
            "another bit"
        );
        assert!(!proves(&seal, KEY, TERMS, Some(Question { variant, ..QUESTION })));
        for damaged in ["", "0", "ä", &seal[..31], &seal[16..], &seal.to_uppercase()] {
            assert!(!proves(damaged, KEY, TERMS, None), "{damaged}");
        }
    }
}

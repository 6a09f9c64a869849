//! Verification: how many results a second worker confirmed.

use record::Verified;

use crate::words::number;

/// How many results a second worker confirmed by computing them again with the same bits.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct VerificationDiagnostics {
    /// Number of results.
    pub results: u64,
    /// Number of results that a second worker confirmed.
    pub confirmed: u64,
    /// Number of workers that computed the results.
    pub workers: u64,
}

impl From<&Verified> for VerificationDiagnostics {
    fn from(verified: &Verified) -> Self {
        VerificationDiagnostics {
            results: verified.results,
            confirmed: verified.confirmed,
            workers: verified.workers,
        }
    }
}

impl VerificationDiagnostics {
    /// Says how many results were verified.
    pub fn words(&self) -> String {
        match (self.confirmed, self.workers) {
            (0, 0 | 1) => "no result was verified: there was one worker".into(),
            (0, _) => "no result was verified by a second worker".into(),
            (confirmed, workers) => format!(
                "{confirmed} of {} verified: a second worker gave the same bits; one of {workers} workers that is wrong in 1 % of its results would have stayed unseen with a probability of {:.0} %",
                number::count(usize::try_from(self.results).unwrap_or(usize::MAX), "result"),
                100.0 * self.unseen(0.01)
            ),
        }
    }

    /// Returns the probability that a worker whose results are wrong in a share of all cases has met no comparison there.
    ///
    /// Each worker is taken to have computed the same number of results, so that k = confirmed/workers of them were compared: (1 −
    /// share)^k. It says nothing of workers that give the same wrong answers, which may confirm each other. Test:
    /// `what_is_not_verified_is_said`.
    fn unseen(&self, share: f64) -> f64 {
        let compared = self.confirmed as f64 / self.workers.max(1) as f64;
        libm::pow(1.0 - share, compared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_verified_is_said() {
        let words = |confirmed, workers| {
            let results = 3641;
            VerificationDiagnostics {
                results,
                confirmed,
                workers,
            }
            .words()
        };
        assert_eq!(words(0, 1), "no result was verified: there was one worker");
        assert_eq!(words(0, 2), "no result was verified by a second worker");
        assert_eq!(
            words(41, 2),
            "41 of 3641 results verified: a second worker gave the same bits; one of 2 workers that is wrong in 1 % of its results would have stayed unseen with a probability of 81 %"
        );
    }
}

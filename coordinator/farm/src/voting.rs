//! Identities in comparisons of answers: who counts as one, and whose answer settles a comparison.

use std::collections::{BTreeMap, BTreeSet};

/// The rule by which workers are counted in comparisons of answers.
///
/// The farm calls a worker that has stated a token `TOKEN/NAME`, and no token contains a slash. The workers of a token are together called
/// `TOKEN/`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Voting {
    /// Whether all workers of a token count as one, and are quarantined together. Otherwise each worker counts.
    pub is_by_token: bool,
    /// The tokens whose workers' answers settle a comparison.
    pub trusted: BTreeSet<String>,
}

impl Voting {
    /// Returns the identity that a worker counts as.
    pub fn voter<'a>(&self, worker: &'a str) -> &'a str {
        match self.is_by_token {
            true => token_of(worker).unwrap_or(worker),
            false => worker,
        }
    }

    /// Returns whether the answer of a worker settles a comparison.
    pub fn trusts(&self, worker: &str) -> bool {
        worker
            .split_once('/')
            .is_some_and(|(token, _)| self.trusted.contains(token))
    }
}

/// Returns the common name of all workers that have the token of this one.
pub(crate) fn token_of(worker: &str) -> Option<&str> {
    worker.find('/').map(|end| &worker[..=end])
}

/// Returns the reason of a worker's quarantine: its own, or that of all workers of its token. A name without a token in the list of a
/// worker with one was stored by a version that knew workers by their names alone, and holds for that name under every token.
pub(crate) fn quarantined<'a>(quarantine: &'a BTreeMap<String, String>, worker: &str) -> Option<&'a String> {
    let of_token = || quarantine.get(token_of(worker)?);
    let of_name = || quarantine.get(worker.split_once('/')?.1);
    quarantine.get(worker).or_else(of_token).or_else(of_name)
}

/// Returns whether a name is that of a worker, or of all workers of its token.
pub(crate) fn includes(name: &str, worker: &str) -> bool {
    name == worker || token_of(worker) == Some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarantine_holds_for_a_worker_all_of_its_token_and_a_name_of_before_tokens() {
        let names = ["lab/a", "other/", "old"];
        let quarantine = names.map(|name| (name.to_owned(), "wrong".to_owned())).into();
        let is_out = |worker: &str| quarantined(&quarantine, worker).is_some();
        assert!(["lab/a", "other/x", "old", "lab/old"].into_iter().all(is_out));
        assert!(!["lab/b", "a", "other", "old/b"].into_iter().any(is_out));
    }

    #[test]
    fn workers_of_a_token_count_as_one_where_the_operator_says_so() {
        let by_token = Voting {
            is_by_token: true,
            trusted: ["mine".to_owned()].into(),
        };
        assert_eq!(by_token.voter("lab/a"), by_token.voter("lab/b/c"));
        assert_ne!(by_token.voter("lab/a"), by_token.voter("lab-2/a"));
        assert_eq!(by_token.voter("local-1"), "local-1");
        let by_worker = Voting::default();
        assert_ne!(by_worker.voter("lab/a"), by_worker.voter("lab/b"));
        assert!(by_token.trusts("mine/a") && !by_token.trusts("mine") && !by_token.trusts("lab/mine"));
        assert!(includes("lab/", "lab/a") && includes("lab/a", "lab/a"));
        assert!(!includes("lab/", "lab-2/a") && !includes("lab", "lab/a"));
    }
}

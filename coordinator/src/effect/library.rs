//! Laws that joined the library, and what the studies since then say of them.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A law is held in a study with at least this log Bayes factor \[nats\], and not seen in one with at most [`NOT_SEEN`].
const HELD: f64 = 3.0;
const NOT_SEEN: f64 = -1.0;

/// A law that joined the library: every later search tries it.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct LibraryLaw {
    /// Name of its effect.
    pub name: String,
    /// Version of the effect file that searches try: the last one.
    pub version: i64,
    /// The law in a line.
    pub summary: String,
    /// Where it comes from: the search that found it, or what its author states.
    pub source: String,
    /// Quantities that its formulas replace.
    pub hooks: Vec<String>,
    /// Time at which it joined, in milliseconds since 1970.
    pub added_at_ms: i64,
    /// The name of the token with which it was added; null if no token was required.
    pub added_by: Option<String>,
    /// The study whose search found it; null for a law that a user wrote.
    pub found_in: Option<i64>,
    /// The studies whose searches tried it, oldest first.
    pub studies: Vec<LawInStudy>,
    /// Number of studies that count as evidence.
    pub counted: usize,
    /// Sum of the log Bayes factors of the studies that count \[nats\]: the law is the same in all, its parameters are each study's.
    pub log_bayes_factor: f64,
}

/// What a study says of a law.
#[derive(Debug, Clone, Serialize, Deserialize, ToSchema)]
pub struct LawInStudy {
    /// Number of the study.
    pub study: i64,
    /// Its name.
    pub name: String,
    /// The calibration whose search tried the law last.
    pub calibration: i64,
    /// Effects of the model that was searched.
    pub given: Vec<String>,
    /// Log evidence with the law over that without it \[nats\].
    pub log_bayes_factor: f64,
    /// Probability of the law among all explanations of the search.
    pub probability: f64,
    /// The fitted parameters of the law, SI.
    pub parameters: std::collections::BTreeMap<String, f64>,
    /// Their units, by name.
    pub units: std::collections::BTreeMap<String, String>,
    /// What the study says of the law.
    pub standing: Standing,
    /// Whether it counts as evidence: neither the study that found the law nor measurements that another study counts.
    pub counts: bool,
}

/// What a study says of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Its log Bayes factor is at least 3 nats.
    Held,
    /// Between both.
    Undecided,
    /// Its log Bayes factor is at most -1 nat.
    NotSeen,
}

impl Standing {
    /// Returns what a log Bayes factor \[nats\] says.
    pub fn new(log_bayes_factor: f64) -> Self {
        match log_bayes_factor {
            factor if factor >= HELD => Standing::Held,
            factor if factor <= NOT_SEEN => Standing::NotSeen,
            _ => Standing::Undecided,
        }
    }

    /// Returns its words in a table.
    pub fn words(self) -> &'static str {
        match self {
            Standing::Held => "held",
            Standing::Undecided => "undecided",
            Standing::NotSeen => "not seen",
        }
    }
}

impl LibraryLaw {
    /// Returns the law with its studies, and their evidence together. Checked by `tests::the_study_that_found_a_law_does_not_count`.
    #[must_use]
    pub fn with_studies(self, studies: Vec<LawInStudy>) -> Self {
        let counted = || studies.iter().filter(|study| study.counts);
        LibraryLaw {
            counted: counted().count(),
            log_bayes_factor: counted().map(|study| study.log_bayes_factor).sum(),
            studies,
            ..self
        }
    }

    /// Returns, for example, `held in 2 of 3 studies that count (41.2 nats together)`.
    pub fn evidence_words(&self) -> String {
        let held = self
            .studies
            .iter()
            .filter(|s| s.counts && s.standing == Standing::Held);
        match self.counted {
            0 => "no study counts as evidence yet".to_owned(),
            counted => format!(
                "held in {} of {counted} {} ({:.1} nats together)",
                held.count(),
                if counted == 1 {
                    "study that counts"
                } else {
                    "studies that count"
                },
                self.log_bayes_factor
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(study: i64, log_bayes_factor: f64, counts: bool) -> LawInStudy {
        LawInStudy {
            study,
            name: format!("study {study}"),
            calibration: 10 * study,
            given: Vec::new(),
            log_bayes_factor,
            probability: 0.5,
            parameters: Default::default(),
            units: Default::default(),
            standing: Standing::new(log_bayes_factor),
            counts,
        }
    }

    #[test]
    fn the_study_that_found_a_law_does_not_count() {
        let law = LibraryLaw {
            name: "mine".into(),
            version: 1,
            summary: String::new(),
            source: String::new(),
            hooks: vec!["shear".into()],
            added_at_ms: 0,
            added_by: None,
            found_in: Some(1),
            studies: Vec::new(),
            counted: 0,
            log_bayes_factor: 0.0,
        };
        assert_eq!(law.evidence_words(), "no study counts as evidence yet");
        let law = law.with_studies(vec![
            study(1, 90.0, false),
            study(2, 12.5, true),
            study(3, -1.5, true),
            study(4, 2.0, true),
        ]);
        assert_eq!(
            law.evidence_words(),
            "held in 1 of 3 studies that count (13.0 nats together)"
        );
        let standings: Vec<Standing> = law.studies.iter().map(|study| study.standing).collect();
        use Standing::{Held, NotSeen, Undecided};
        assert_eq!(standings, [Held, Held, NotSeen, Undecided]);
    }
}

//! The block `discovery` of `summary.json`: all searches of a study in one summary.

use record::{
    ChiSquare, Discovery, Extension, JudgedEffect, JudgedSet, NextRun, NotTried, Outside, RemainingMisfit,
    Verdict, effect_of, parts_of,
};

use super::round::DiscoveryRound;

/// The effects that a study's model misses.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct DiscoverySummary {
    /// Verdict of the search that named an added effect; without one, of the last search with a detection, else of the first search.
    pub verdict: Verdict,
    /// The added effects; if none was added, the one that a search proposes.
    pub chosen: Vec<String>,
    /// Every explanation of the first search.
    pub effects: Vec<JudgedEffect>,
    /// Every model that the first search compared.
    pub sets: Vec<JudgedSet>,
    /// Whether the best explanation of the last search leaves no significant misfit; null if the noise is unknown.
    pub complete: Option<bool>,
    /// Share of the excess chi-square of the first searched model that the last search's best explanation removes, 0 to 1.
    pub explained: Option<f64>,
    /// The channels that the last search's best explanation leaves unexplained, the worst first.
    pub remaining: Vec<RemainingMisfit>,
    /// The law outside the library, if one was found.
    pub outside: Option<Outside>,
    /// Effects that the last search could not detect.
    pub cannot_exclude: Vec<String>,
    /// Effects that the last search could not try, with the information that the experiment lacks.
    pub not_tried: Vec<NotTried>,
    /// Test runs that would distinguish the open explanations of the last search.
    pub next_runs: Vec<NextRun>,
    /// Tests without a rolling wheel that would distinguish the open explanations.
    pub other_tests: Vec<String>,
    /// Number of evaluations in all searches.
    pub evaluations: u64,
    /// The records of all searches, without their curves.
    pub rounds: Vec<RoundSummary>,
}

/// A search in the block.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct RoundSummary {
    /// The calibration whose model was searched.
    pub calibration: i64,
    /// Its result.
    #[serde(flatten)]
    pub record: Discovery,
}

impl DiscoverySummary {
    /// Summarises the searches of a study; `None` without a search. `added` are the effects of its best calibration that the submitted
    /// job does not have.
    pub fn new(rounds: &[DiscoveryRound], added: Vec<String>) -> Option<DiscoverySummary> {
        let records: Vec<Discovery> = rounds
            .iter()
            .map(|round| round.record.clone().without_curves())
            .collect();
        let (first, last) = (records.first()?, records.last()?);
        let has = |extension: Option<&Extension>, part: &String| {
            extension.is_some_and(|e| parts_of(e).contains(part))
        };
        let is_named = |part: &String| records.iter().any(|r| has(r.extension.as_ref(), part));
        let is_leading = |part: &String| records.iter().any(|r| has(r.leading.as_ref(), part));
        // An effect that was added for the sake of predictions is no name that the study chose.
        let added: Vec<String> = added
            .into_iter()
            .filter(|part| is_named(part) || !is_leading(part))
            .collect();
        // Take the last search with a detection, because further runs may have added information since the first.
        let named = records.iter().find(|record| {
            record
                .extension
                .as_ref()
                .is_some_and(|e| parts_of(e).iter().all(|part| added.contains(part)))
        });
        let seeing = || {
            records
                .iter()
                .rev()
                .find(|r| r.verdict != Verdict::NothingDetectable)
        };
        let verdict = named.or_else(seeing).unwrap_or(first).verdict;
        let chosen = match added.is_empty() {
            true => seeing()
                .and_then(|r| r.extension.as_ref())
                .map(effect_of)
                .into_iter()
                .collect(),
            false => added,
        };
        Some(DiscoverySummary {
            verdict,
            chosen,
            effects: first.effects.clone(),
            sets: first.sets.clone(),
            complete: last.complete,
            explained: explained(first, last),
            remaining: last.remaining.clone(),
            outside: records.iter().find_map(|record| record.outside.clone()),
            cannot_exclude: last.cannot_exclude.clone(),
            not_tried: last.not_tried.clone(),
            next_runs: last.next_runs.clone(),
            other_tests: last.other_tests.clone(),
            evaluations: records.iter().map(|record| record.evaluations).sum(),
            rounds: rounds
                .iter()
                .zip(records)
                .map(|(round, record)| RoundSummary {
                    calibration: round.calibration,
                    record,
                })
                .collect(),
        })
    }
}

fn explained(first: &Discovery, last: &Discovery) -> Option<f64> {
    let excess = |chi: &ChiSquare| Some(chi.value? - chi.degrees_of_freedom);
    let (before, after) = (excess(&first.chi2)?, excess(&last.chi2_best)?);
    (before > 0.0).then(|| (1.0 - after.max(0.0) / before).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> Discovery {
        serde_json::from_str(include_str!("../../../record/discovery.json")).unwrap()
    }

    fn rounds() -> Vec<DiscoveryRound> {
        let round = |calibration, record| DiscoveryRound { calibration, record };
        let last = Discovery {
            given: vec!["slip_sinkage".into()],
            verdict: Verdict::NothingDetectable,
            extension: None,
            cannot_exclude: vec!["adhesion".into()],
            next_runs: Vec::new(),
            ..record()
        };
        vec![round(1, record()), round(3, last)]
    }

    #[test]
    fn a_study_without_searches_says_nothing() {
        assert!(DiscoverySummary::new(&[], vec!["slip_sinkage".into()]).is_none());
    }

    #[test]
    fn what_was_added_is_the_verdict_of_the_study() {
        let verdict = |added: &[&str]| {
            let added = added.iter().map(|&e| e.to_owned()).collect();
            let summary = DiscoverySummary::new(&rounds(), added).unwrap();
            (summary.verdict, summary.chosen)
        };
        assert_eq!(verdict(&[]), (Verdict::Named, vec!["slip_sinkage".to_owned()]));
        assert_eq!(
            verdict(&["adhesion"]),
            (Verdict::Named, vec!["adhesion".to_owned()])
        );
        // An effect file that the user added does not change the verdict of a search.
        let file = ["shear_slip_step"];
        assert_eq!(verdict(&file), (Verdict::Named, file.map(String::from).to_vec()));
    }

    #[test]
    fn explanations_are_the_first_search_s_and_open_questions_the_last_one_s() {
        let summary = DiscoverySummary::new(&rounds(), vec!["slip_sinkage".into()]).unwrap();
        assert_eq!(summary.effects, record().effects);
        assert_eq!(summary.cannot_exclude, ["adhesion"]);
        assert!(summary.next_runs.is_empty());
        assert_eq!(summary.evaluations, 8000);
        let searched: Vec<i64> = summary.rounds.iter().map(|round| round.calibration).collect();
        assert_eq!(searched, [1, 3]);
    }
}

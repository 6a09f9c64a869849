//! An experiment that gets further runs.

use std::fmt;

use discovery::{Conclusion, QueriedModel, Query, SearchVerdict};
use shared::model::RunCondition;
use statistics::rng::Stream;

use crate::hidden_effect::study::case::{SyntheticCase, run as run_truth};
use crate::hidden_effect::study::design::{CHANNELS, Plan, PlannedRun};
use crate::hidden_effect::study::error::StudyError;
use crate::hidden_effect::study::local_search::LocalSearch;
use crate::hidden_effect::study::trial::draw_detectable;

/// The truths are others than those of the other kinds.
const FIRST: u64 = 1_000_000;
/// Streams of the noise of further runs.
const STAGE: u64 = 1 << 45;
/// Streams of random orders of runs.
const ORDERS: u64 = 1 << 46;

/// An experiment that gets further runs.
#[derive(Debug, Clone)]
pub struct Campaign {
    case: SyntheticCase,
    seed: u64,
    number: u64,
}

/// What a search says about the campaign so far.
pub struct Answer {
    conclusion: Conclusion,
    /// The runs that the rig could make.
    pub possible: Vec<RunCondition>,
    /// Log Bayes factor, probability and class of the truth.
    truth: Option<(f64, f64, usize)>,
}

impl Campaign {
    /// One detectable effect at one load and one speed.
    pub fn new(seed: u64, number: u64) -> Result<Self, StudyError> {
        let case = draw_detectable(Plan::Narrow, 1, seed, FIRST + number)?;
        Ok(Self { case, seed, number })
    }

    pub fn hidden(&self) -> &str {
        &self.case.hidden[0]
    }

    /// The conditions of the runs made.
    pub fn made(&self) -> &[PlannedRun] {
        &self.case.rows
    }

    /// Searches what is missing.
    pub fn search(&self) -> Result<Answer, StudyError> {
        let mut local = LocalSearch::new(&self.case.plan.job(), &self.case.experiment(), 1)?;
        let conclusion = local.run()?;
        let proposed = Query {
            model: QueriedModel::With(Vec::new()),
            is_proposed: true,
            is_low_fidelity: false,
            theta: Vec::new(),
        };
        let task = local.models.task();
        let is_truth =
            |candidate: Option<usize>| candidate.is_some_and(|k| task.library[k].name == self.case.hidden[0]);
        let effects = &conclusion.ranking.effects;
        let truth = effects.iter().find(|effect| is_truth(effect.candidate));
        Ok(Answer {
            truth: truth.map(|own| (own.log_bayes_factor, own.probability, own.class)),
            possible: local.models.variant(&proposed)?.1.conditions.clone(),
            conclusion,
        })
    }

    /// The possible runs in a random order.
    ///
    /// # Arguments
    /// - `which`: of several orders.
    pub fn at_random(&self, possible: &[RunCondition], which: u64) -> Vec<RunCondition> {
        let stage = ORDERS + which;
        let mut stream = Stream::new(self.seed, stage, self.number, self.case.rows.len() as u64);
        let mut left = possible.to_vec();
        let mut order = Vec::new();
        while !left.is_empty() {
            order.push(left.swap_remove(stream.below(left.len())));
        }
        order
    }

    /// Makes and measures one more run; `false` where the truth refuses it. Further runs of the same number share their noise.
    pub fn measure(&mut self, condition: &RunCondition) -> Result<bool, StudyError> {
        let case = &mut self.case;
        let row = PlannedRun {
            wheel: "wide",
            slip: condition.slip,
            wheel_load_n: condition.wheel_load_n,
            sled_speed_m_s: condition.sled_speed_m_s,
            pass: condition.pass,
            is_holdout: false,
            order: None,
            prepared: None,
        };
        let made = run_truth(&case.truth_job, std::slice::from_ref(&row), &case.theta)?;
        let Some(&[noise_free]) = made.as_deref() else {
            return Ok(false);
        };
        let noise = Stream::new(self.seed, STAGE, self.number, case.rows.len() as u64).normals(CHANNELS);
        let mut measured = noise_free;
        for (k, x) in measured.iter_mut().enumerate() {
            *x += case.sds[k] * noise[k];
        }
        case.rows.push(row);
        case.noise_free.push(noise_free);
        case.measured.push(measured);
        Ok(true)
    }
}

impl Answer {
    /// Something is missing, and the data do not decide what.
    pub fn is_open(&self) -> bool {
        self.conclusion.verdict == SearchVerdict::Undecided && !self.conclusion.next_runs.is_empty()
    }

    /// The runs that the search proposes.
    pub fn proposed(&self) -> Vec<RunCondition> {
        let runs = self.conclusion.next_runs.iter();
        runs.map(|run| self.possible[run.run].clone()).collect()
    }

    /// Whether the truth's class is claimed, or something else; `None` without a claim.
    pub fn is_right(&self) -> Option<bool> {
        let class = |k: usize| self.conclusion.ranking.effect(Some(k)).map(|own| own.class);
        let truth = self.truth.map(|(_, _, class)| class);
        match self.conclusion.verdict {
            SearchVerdict::Named(k) => Some(truth.is_some() && class(k) == truth),
            SearchVerdict::Class(class) => Some(truth == Some(class)),
            SearchVerdict::NotInLibrary => Some(false),
            SearchVerdict::NothingDetectable | SearchVerdict::Undecided => None,
        }
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (factor, probability, _) = self.truth.unwrap_or((f64::NAN, 0.0, 0));
        let said = match self.is_right() {
            Some(true) => "right",
            Some(false) => "WRONG",
            None => "open",
        };
        write!(f, "{said} (truth {factor:.1} P {probability:.3})")
    }
}

//! An experiment that gets further runs.

use std::fmt;

use discovery::{Conclusion, QueriedModel, Query, SearchVerdict};
use shared::model::RunCondition;
use statistics::rng::Stream;

use crate::error::StudyError;
use crate::hidden_effect::study::case::{SyntheticCase, run as run_truth};
use crate::hidden_effect::study::design::{Plan, PlannedRun};
use crate::hidden_effect::study::draw::draw_detectable;
use crate::hidden_effect::study::local_search::LocalSearch;
use crate::hidden_effect::study::noise::add_noise;
use crate::hidden_effect::study::record::word;

/// The number of the first truth, which no other kind uses.
const FIRST: u64 = 1_000_000;
/// The number of the first truth of the factorial.
const FACTORIAL: u64 = 2_000_000;
/// The random stream of the noise of further runs.
const STAGE: u64 = 1 << 45;
/// The first random stream of orders of runs.
const ORDERS: u64 = 1 << 46;

/// An experiment that gets further runs.
#[derive(Debug, Clone)]
pub struct Campaign {
    case: SyntheticCase,
    seed: u64,
    number: u64,
}

/// The conclusion of a search of the campaign so far.
pub struct Answer {
    conclusion: Conclusion,
    /// The runs that the rig could make.
    pub possible: Vec<RunCondition>,
    /// Log Bayes factor, probability and class of the truth.
    truth: Option<(f64, f64, usize)>,
}

impl Campaign {
    /// Draws a detectable effect at one load and one speed.
    pub fn new(seed: u64, number: u64) -> Result<Self, StudyError> {
        let case = draw_detectable(Plan::Narrow, 1, seed, FIRST + number)?;
        Ok(Self { case, seed, number })
    }

    /// Draws an effect that the 24 runs of the factorial can show, and measures these.
    pub fn factorial(seed: u64, number: u64) -> Result<Self, StudyError> {
        let case = draw_detectable(Plan::Factorial, 1, seed, FACTORIAL + number)?;
        Ok(Self { case, seed, number })
    }

    /// Returns the campaign with those runs of the factorial alone that a campaign begins with: three slips, two loads, one speed.
    pub fn first_runs(&self) -> Self {
        let is_first = |row: &PlannedRun| {
            let rim = row.sled_speed_m_s / (1.0 - row.slip);
            (rim - 0.03).abs() < 1e-9 && (row.slip - 0.4).abs() > 1e-9
        };
        let mut first = self.clone();
        let case = &mut first.case;
        let kept: Vec<usize> = (0..case.rows.len())
            .filter(|&i| is_first(&case.rows[i]))
            .collect();
        case.rows = kept.iter().map(|&i| self.case.rows[i].clone()).collect();
        case.noise_free = kept.iter().map(|&i| self.case.noise_free[i]).collect();
        case.measured = kept.iter().map(|&i| self.case.measured[i]).collect();
        first
    }

    /// Makes the first of these runs that the model does not reject; returns `false` if it rejects all.
    pub fn make_one(&mut self, order: &[RunCondition]) -> Result<bool, StudyError> {
        for condition in order {
            if self.measure(condition)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    pub fn hidden(&self) -> &str {
        &self.case.hidden[0]
    }

    /// Returns the runs so far.
    pub fn made(&self) -> &[PlannedRun] {
        &self.case.rows
    }

    /// Searches for the effects that the model is missing.
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
        let truth = task
            .library
            .iter()
            .position(|effect| effect.name == self.case.hidden[0]);
        let truth = truth.and_then(|k| conclusion.ranking.effect(Some(k)));
        Ok(Answer {
            truth: truth.map(|effect| (effect.log_bayes_factor, effect.probability, effect.class)),
            possible: local.models.variant(&proposed)?.1.conditions.to_vec(),
            conclusion,
        })
    }

    /// Returns the possible runs in one of several random orders.
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

    /// Makes and measures one more run; returns `false` if the model rejects it. The noise depends on the number of the run alone.
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
            session: None,
            zero: None,
            operator: None,
        };
        let made = run_truth(&case.truth_job, std::slice::from_ref(&row), &case.theta)?;
        let Some(&[noise_free]) = made.as_deref() else {
            return Ok(false);
        };
        let mut measured = noise_free;
        let mut stream = Stream::new(self.seed, STAGE, self.number, case.rows.len() as u64);
        add_noise(std::slice::from_mut(&mut measured), case.sds, &mut stream);
        case.rows.push(row);
        case.noise_free.push(noise_free);
        case.measured.push(measured);
        Ok(true)
    }
}

impl Answer {
    /// Returns whether something is missing and the data do not decide what.
    pub fn is_open(&self) -> bool {
        self.conclusion.verdict == SearchVerdict::Undecided && !self.conclusion.next_runs.is_empty()
    }

    /// Returns the runs that the search proposes.
    pub fn proposed(&self) -> Vec<RunCondition> {
        let runs = self.conclusion.next_runs.iter();
        runs.map(|run| self.possible[run.run].clone()).collect()
    }

    /// Returns whether the class of the truth is claimed; `None` without a claim.
    pub fn is_right(&self) -> Option<bool> {
        let class = |k: usize| self.conclusion.ranking.effect(Some(k)).map(|effect| effect.class);
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
        let answer = word(self.is_right());
        write!(f, "{answer} (truth {factor:.1} P {probability:.3})")
    }
}

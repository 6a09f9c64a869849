//! Prediction of holdout runs by the search's result.

use std::fmt;

use discovery::{Conclusion, PosteriorModel};
use shared::model::RunCondition;

use super::case::{SyntheticCase, spec, values};
use super::design::CHANNELS;
use super::local_search::LocalSearch;
use super::noise::RunValues;
use super::rate::Rate;
use crate::error::StudyError;

/// Half of the two-sided 90 % interval of a standard normal distribution.
const Z90: f64 = 1.644_853_626_951_473;

/// Errors on holdout runs.
#[derive(Debug, Clone, Copy)]
pub struct HeldOut {
    /// Root mean square error of the most probable prediction of the base against the noise-free truth, in noise sds. It is infinite if
    /// the model rejects a run.
    pub before: f64,
    /// The same error of the best model.
    pub after: f64,
    /// The share of the measurements within the 90 % interval of the best model.
    pub covered: Rate,
}

impl HeldOut {
    pub fn new(
        case: &SyntheticCase,
        local: &mut LocalSearch,
        conclusion: &Conclusion,
    ) -> Result<Self, StudyError> {
        let Some(variant) = spec(&case.plan.job(), &case.experiment())?.holdout_variant else {
            return Ok(Self {
                before: 0.0,
                after: 0.0,
                covered: Rate::default(),
            });
        };
        let conditions = &variant.conditions;
        let first = PosteriorModel {
            effects: conclusion.base.effects.clone(),
            draws: conclusion.base.draws[..1].to_vec(),
        };
        let before = predicted(local, &first, conditions)?;
        let after = predicted(local, &conclusion.best, conditions)?;
        let held_out = case.rows.iter().zip(case.noise_free.iter().zip(&case.measured));
        let held_out = held_out.filter(|(row, _)| row.is_holdout);
        let (truth, measured): (Vec<RunValues>, Vec<RunValues>) =
            held_out.map(|(_, (t, m))| (*t, *m)).unzip();
        let error = |draws: &[Option<Vec<RunValues>>]| -> f64 {
            let Some(Some(mode)) = draws.first() else {
                return f64::INFINITY;
            };
            let mut squares = 0.0;
            for (p, t) in mode.iter().zip(&truth) {
                for (k, sd) in case.sds.iter().enumerate() {
                    squares += ((p[k] - t[k]) / sd).powi(2);
                }
            }
            (squares / (CHANNELS * truth.len()) as f64).sqrt()
        };
        let mut covered = Vec::new();
        let drawn: Vec<&Vec<RunValues>> = after.iter().flatten().collect();
        for (run, measured) in measured.iter().enumerate() {
            for (k, sd) in case.sds.iter().enumerate() {
                let mean = drawn.iter().map(|p| p[run][k]).sum::<f64>() / drawn.len() as f64;
                let squares = drawn.iter().map(|p| (p[run][k] - mean) * (p[run][k] - mean));
                let variance = squares.sum::<f64>() / (drawn.len() as f64 - 1.0).max(1.0);
                covered.push((measured[k] - mean).abs() <= Z90 * (variance + sd * sd).sqrt());
            }
        }
        Ok(Self {
            before: error(&before),
            after: error(&after),
            covered: Rate::new(covered),
        })
    }
}

fn predicted(
    local: &mut LocalSearch,
    fitted: &PosteriorModel,
    conditions: &[RunCondition],
) -> Result<Vec<Option<Vec<RunValues>>>, StudyError> {
    let seen = local
        .predict(&fitted.effects, conditions, &fitted.draws)?
        .into_iter();
    Ok(seen
        .map(|seen| seen.map(|s| values(&s, conditions.len())))
        .collect())
}

impl fmt::Display for HeldOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.2} to {:.2}", self.before, self.after)
    }
}

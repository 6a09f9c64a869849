//! The table of a validation: the prediction of every level, and the total.

use std::collections::BTreeMap;

use job::AlgorithmName;
use shared::channel::Channel;

use super::factor::Factor;
use super::judgement::Judgement;
use super::left_out_level::LeftOutLevel;
use crate::finished_calibration::FinishedCalibration;
use crate::table::fixed_sigma::{FixedSigma, FixedSigmas};
use crate::table::row::ComparisonRow;

/// The levels of a factor, each predicted by a calibration on the other levels.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct Validation {
    /// The calibration whose model predicts.
    pub calibration: i64,
    /// Name of the validated calibration.
    pub name: String,
    /// The effects of the calibration's model.
    pub effects: Vec<String>,
    /// Factor whose levels are left out.
    pub leave_out: Factor,
    /// Algorithm that calibrates on the other levels.
    pub algorithm: AlgorithmName,
    /// Noise standard deviation of `rmse_fixed_sigma` by channel, from the calibration on all fitted runs.
    pub fixed_sigma: BTreeMap<String, FixedSigma>,
    /// The levels, ascending.
    pub levels: Vec<ValidatedLevel>,
    /// All of them together.
    pub total: Judgement,
}

/// A level with its prediction by a calibration on the other levels.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct ValidatedLevel {
    /// The level.
    pub level: LeftOutLevel,
    /// The calibration on the other levels, in the folder of the validation.
    pub calibration: Option<i64>,
    /// Errors and coverage on this level; null without a calibration.
    pub judgement: Option<Judgement>,
    /// Reason why there is no calibration.
    pub refused: Option<String>,
    /// Reasons why measurements are not interpolated, with their numbers.
    pub not_interpolated: BTreeMap<String, usize>,
    /// Comparison of model and interpolation with the measurements of this level.
    pub rows: Vec<ComparisonRow>,
}

impl ValidatedLevel {
    /// Judges the prediction of a level by a calibration on the other levels.
    ///
    /// # Arguments
    /// - `whole`: the calibration on all fitted runs. `rest`: the one on the other levels.
    pub fn predicted(level: LeftOutLevel, whole: &FinishedCalibration, rest: &FinishedCalibration) -> Self {
        let mut rows = rest.comparison().rows.clone();
        rows.retain(|row| level.runs.contains(&row.run));
        let mut not_interpolated = BTreeMap::new();
        let runs = rest.spec.experiment.runs.iter().enumerate();
        for (i, _) in runs.filter(|(_, run)| level.runs.contains(&run.name)) {
            let missing = |channel: Channel| rest.interpolations().missing_at(i, channel);
            for reason in Channel::ALL.into_iter().filter_map(missing) {
                *not_interpolated.entry(reason.to_owned()).or_default() += 1;
            }
        }
        ValidatedLevel {
            level,
            calibration: Some(rest.row.id),
            judgement: Some(Judgement::new(&rows, &FixedSigmas::new(whole))),
            refused: None,
            not_interpolated,
            rows,
        }
    }

    /// Makes a level for which there is no calibration on the other levels.
    pub fn refused(level: LeftOutLevel, reason: String) -> Self {
        ValidatedLevel {
            level,
            calibration: None,
            judgement: None,
            refused: Some(reason),
            not_interpolated: BTreeMap::new(),
            rows: Vec::new(),
        }
    }
}

impl Validation {
    /// Collects the levels of a calibration and judges all of them together.
    pub fn new(
        whole: &FinishedCalibration,
        leave_out: Factor,
        algorithm: AlgorithmName,
        levels: Vec<ValidatedLevel>,
    ) -> Self {
        let sigmas = FixedSigmas::new(whole);
        let rows: Vec<ComparisonRow> = levels
            .iter()
            .flat_map(|level| level.rows.iter().cloned())
            .collect();
        Validation {
            calibration: whole.row.id,
            name: whole.row.name.clone(),
            effects: whole.effects(),
            leave_out,
            algorithm,
            fixed_sigma: sigmas.by_name(),
            total: Judgement::new(&rows, &sigmas),
            levels,
        }
    }
}

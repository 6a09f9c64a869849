//! What is predicted of every level from the others.

use std::collections::BTreeMap;

use job::AlgorithmName;

use super::factor::Factor;
use super::judgement::Judgement;
use super::left_out_level::LeftOutLevel;
use crate::finished_calibration::FinishedCalibration;
use crate::table::fixed_sigma::{FixedSigma, FixedSigmas};
use crate::table::row::ComparisonRow;

/// The levels of a factor, each predicted from the others.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct Validation {
    /// The calibration whose model predicts.
    pub calibration: i64,
    /// Its name.
    pub name: String,
    /// The effects of its model.
    pub effects: Vec<String>,
    /// What is left out.
    pub leave_out: Factor,
    /// What calibrates on the rest.
    pub algorithm: AlgorithmName,
    /// By channel the noise sd that `rmse_fixed_sigma` is in, of the calibration on all fitted runs.
    pub fixed_sigma: BTreeMap<String, FixedSigma>,
    /// The levels, ascending.
    pub levels: Vec<ValidatedLevel>,
    /// All of them together.
    pub total: Judgement,
}

/// A level, predicted from the others.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct ValidatedLevel {
    /// The level.
    pub level: LeftOutLevel,
    /// The calibration on the other levels, in the folder of the validation.
    pub calibration: Option<i64>,
    /// How well it predicts this level; null where there is no calibration.
    pub judgement: Option<Judgement>,
    /// Why there is none.
    pub refused: Option<String>,
    /// Model and interpolation against the measurements of this level.
    pub rows: Vec<ComparisonRow>,
}

impl ValidatedLevel {
    /// By a calibration on the other levels.
    ///
    /// # Arguments
    /// - `of`: the calibration on all fitted runs.
    pub fn predicted(level: LeftOutLevel, of: &FinishedCalibration, others: &FinishedCalibration) -> Self {
        let mut rows = others.comparison().rows.clone();
        rows.retain(|row| level.runs.contains(&row.run));
        ValidatedLevel {
            level,
            calibration: Some(others.row.id),
            judgement: Some(Judgement::of(&rows, &FixedSigmas::of(of))),
            refused: None,
            rows,
        }
    }

    /// Without a calibration on the other levels.
    pub fn refused(level: LeftOutLevel, reason: String) -> Self {
        ValidatedLevel {
            level,
            calibration: None,
            judgement: None,
            refused: Some(reason),
            rows: Vec::new(),
        }
    }
}

impl Validation {
    /// Of a calibration on all fitted runs.
    pub fn new(
        of: &FinishedCalibration,
        leave_out: Factor,
        algorithm: AlgorithmName,
        levels: Vec<ValidatedLevel>,
    ) -> Self {
        let sigmas = FixedSigmas::of(of);
        let rows: Vec<ComparisonRow> = levels
            .iter()
            .flat_map(|level| level.rows.iter().cloned())
            .collect();
        Validation {
            calibration: of.row.id,
            name: of.row.name.clone(),
            effects: of.effects(),
            leave_out,
            algorithm,
            fixed_sigma: sigmas.by_name(),
            total: Judgement::of(&rows, &sigmas),
            levels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_level_is_judged_by_its_own_rows_and_the_total_by_all() {
        let (of, others) = (fixture::without_holdout(), fixture::calibration());
        let level = |run: &str| LeftOutLevel {
            name: format!("slip of {run}"),
            from: Some(0.4),
            to: Some(0.4),
            runs: vec![run.to_owned()],
        };
        let judged = ValidatedLevel::predicted(level("e"), &of, &others);
        let judgement = judged.judgement.clone().unwrap();
        let model = judgement.model.clone().unwrap();
        assert_eq!(
            (model.drawbar_pull.unwrap().runs, model.sinkage.unwrap().runs),
            (1, 1)
        );
        assert_eq!(judged.rows.len(), 2);
        assert!(model.all.rmse_fixed_sigma.is_some() && judgement.with_interval == 2);
        let pull = judgement.interpolation.clone().unwrap().drawbar_pull.unwrap();
        // Between 0.5 N at slip 0.2 and 1.5 N at 0.5; measured are 1.2 N.
        assert!(pull.rmse < 0.5 && judgement.extrapolated < 2, "{judgement:?}");
        let levels = vec![
            judged,
            ValidatedLevel::refused(level("d"), "too few repeats".into()),
        ];
        let validation = Validation::new(&of, Factor::Slip, AlgorithmName::Lm, levels);
        assert_eq!(validation.total, judgement);
        let text = crate::terminal::validation(&validation);
        for words in ["slip of e", "slip of d", "too few repeats", "all", "2 of 2"] {
            assert!(text.contains(words), "{words} in {text}");
        }
        let json = serde_json::to_string(&validation).unwrap();
        let again: Validation = serde_json::from_str(&json).unwrap();
        assert_eq!(again.total, judgement);
    }
}

//! What is predicted of every level from the others.

use std::collections::BTreeMap;

use job::AlgorithmName;
use shared::channel::Channel;

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
    /// Why some of its measurements are not interpolated, with their number.
    pub not_interpolated: BTreeMap<String, usize>,
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
        let mut not_interpolated = BTreeMap::new();
        let runs = others.spec.experiment.runs.iter().enumerate();
        for (i, _) in runs.filter(|(_, run)| level.runs.contains(&run.name)) {
            let missing = |channel: Channel| others.interpolations().missing_at(i, channel);
            for reason in Channel::ALL.into_iter().filter_map(missing) {
                *not_interpolated.entry(reason.to_owned()).or_default() += 1;
            }
        }
        ValidatedLevel {
            level,
            calibration: Some(others.row.id),
            judgement: Some(Judgement::of(&rows, &FixedSigmas::of(of))),
            refused: None,
            not_interpolated,
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
            not_interpolated: BTreeMap::new(),
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
    use crate::table::errors::ErrorTable;

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

    #[test]
    fn model_and_interpolation_are_compared_on_the_rows_of_both_and_the_rest_is_counted_with_its_reason() {
        let (of, mut others) = (fixture::without_holdout(), fixture::with_refused_runs());
        // h0 is of a wheel that was never fitted.
        let place = |run: &str| others.spec.experiment.runs.iter().position(|own| own.name == run);
        let (h0, runs) = (place("h0").unwrap(), ["h0", "h1", "h2", "h3"]);
        let mut wheels = others.spec.experiment.wheels.clone();
        wheels.insert("b".into(), wheels["a"].clone());
        others.spec.experiment.wheels = wheels;
        others.spec.experiment.runs[h0].wheel = "b".into();
        let level = LeftOutLevel {
            name: "load 25.0 N".into(),
            from: Some(25.0),
            to: Some(25.0),
            runs: runs.map(str::to_owned).into(),
        };
        let judged = ValidatedLevel::predicted(level, &of, &others);
        let judgement = judged.judgement.clone().unwrap();
        let rows = |table: &Option<ErrorTable>| table.as_ref().map(|own| own.drawbar_pull.unwrap().runs);
        // Predicted are h0 and h3, interpolated h1, h2 and h3.
        assert_eq!(
            (
                rows(&judgement.model),
                rows(&judgement.interpolation),
                rows(&judgement.model_beside)
            ),
            (Some(2), Some(1), Some(1))
        );
        assert_eq!(
            judged.not_interpolated,
            [("wheel b on soil sand has no fitted drawbar pull".to_owned(), 1)].into()
        );
        let text = crate::terminal::validation(&Validation::new(
            &of,
            Factor::Load,
            AlgorithmName::Lm,
            vec![judged],
        ));
        for words in [
            "both errors are over the 1 of 4 measurements that model and interpolation predict",
            "without 2 measurements of runs that the model refuses at half of the draws or more",
            "1 measurement not interpolated: wheel b on soil sand has no fitted drawbar pull",
        ] {
            assert!(text.contains(words), "{words} in {text}");
        }
    }
}

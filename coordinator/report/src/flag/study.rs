//! All flags of a study: those of its calibrations, and flags that compare them, such as a missed mode.

use crate::diagnosis::diagnostics;
use crate::flag::interpolation::interpolation_beats;
use job::conditions_in_row_order;
use result::finished_calibration::FinishedCalibration;
use result::flag::{Flag, FlagKind};
use result::study::Study;
use result::words::number;
use result::words::probability::p_words;

/// Difference of log-posteriors above which a calibration missed a mode `[nats]`. The best of a thousand draws lies a few nats below the
/// mode, more in many dimensions.
const MISSED_NATS: f64 = 15.0;

/// Returns all flags; those of a point estimate begin with the name of its algorithm, those of an extension with its name.
pub fn flags(study: &Study) -> Vec<Flag> {
    flags_by_calibration(study)
        .into_iter()
        .map(|(_, flag)| flag)
        .collect()
}

/// Returns the flags of a study, each with the calibration that it is about; `None` if it is about several.
pub(crate) fn flags_by_calibration(study: &Study) -> Vec<(Option<i64>, Flag)> {
    let flags_of =
        |calibration: &FinishedCalibration| diagnostics(calibration, calibration.comparison()).flags;
    let mut flags: Vec<_> = missed_modes(study).into_iter().map(|flag| (None, flag)).collect();
    let lead = Some(study.lead.row.id);
    flags.extend(flags_of(&study.lead).into_iter().map(|flag| (lead, flag)));
    let beside = study.point_estimates.iter().map(|o| (o.spec.algorithm.name(), o));
    let extensions = study.extensions.iter().map(|o| (o.experiment.as_str(), o));
    for (name, calibration) in beside.chain(extensions) {
        let named = |flag: Flag| Flag {
            text: format!("{name}: {}", flag.text),
            ..flag
        };
        let found = flags_of(calibration).into_iter();
        flags.extend(found.map(|flag| (Some(calibration.row.id), named(flag))));
    }
    let current = study.current().map(|calibration| calibration.row.id);
    flags.extend(interpolation_beats(study).into_iter().map(|flag| (current, flag)));
    let searched = study.rounds.last().map(|round| round.calibration);
    flags.extend(incomplete(study).map(|flag| (searched, flag)));
    flags.extend(
        laws_or_drifts(study)
            .into_iter()
            .map(|(of, flag)| (Some(of), flag)),
    );
    flags
}

/// Returns a flag for each law outside the catalogue that was found to change with a condition which the rows of the file follow, if no
/// run states its order: a drift over the rows would predict the same.
fn laws_or_drifts(study: &Study) -> Vec<(i64, Flag)> {
    let in_row_order = conditions_in_row_order(&study.lead.spec.experiment, &study.lead.spec.fit_runs);
    let claimed = study.rounds.iter().filter_map(|round| {
        let law = round.record.outside.as_ref()?;
        let condition = in_row_order
            .iter()
            .map(|rows| rows.condition)
            .find(|condition| condition.law_variables().contains(&law.depends_on.as_str()))?;
        let words = condition.words();
        let text = format!(
            "the rows of the runs follow their {words}, and no run states its order: if the runs were made in the order of the rows, a drift of soil or sensors explains the misfit as well as a law of {} does; state the column order, and repeat runs of several levels late and early in the series",
            law.depends_on
        );
        Some((round.calibration, Flag::plain(FlagKind::Order, text)))
    });
    claimed.collect()
}

/// Returns a flag if the best explanation of the last search still contradicts the data.
fn incomplete(study: &Study) -> Option<Flag> {
    let record = &study.rounds.last()?.record;
    let chi2 = record.chi2_best;
    let value = chi2.value.filter(|_| record.complete == Some(false))?;
    let text = format!(
        "the search is incomplete: with the best explanation the residuals are still {} times as large as expected from the assumed errors (chi-square {} with {} degrees of freedom, {}): more is missing, or the assumed errors are too small",
        number::significant((value / chi2.degrees_of_freedom).sqrt(), 2),
        number::significant(value, 3),
        number::significant(chi2.degrees_of_freedom, 3),
        number::or_none(chi2.p, p_words)
    );
    Some(Flag {
        p: chi2.p,
        ..Flag::plain(FlagKind::Incomplete, text)
    })
}

/// Returns a flag for each calibration whose best parameters are far less probable than those of another calibration of the study.
pub(crate) fn missed_modes(study: &Study) -> Vec<Flag> {
    let best = |calibration: &FinishedCalibration| match calibration.estimate() {
        Some(estimate) => Some(estimate.log_likelihood + estimate.log_prior),
        None => {
            let particle = calibration.most_probable()?;
            let log_posterior = particle.log_likelihood.value() + particle.log_prior;
            (!particle.log_likelihood.is_impossible()).then_some(log_posterior)
        }
    };
    let found: Vec<(&str, f64)> = study
        .submitted()
        .filter_map(|calibration| Some((calibration.spec.algorithm.name(), best(calibration)?)))
        .collect();
    let Some(&(winner, highest)) = found.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Vec::new();
    };
    found
        .iter()
        .filter(|(_, log_posterior)| highest - log_posterior > MISSED_NATS)
        .map(|(name, log_posterior)| {
            let text = format!(
                "{name} missed a mode that {winner} found, with a log-posterior {:.0} nats higher: do not use the result of {name}",
                highest - log_posterior
            );
            Flag::plain(FlagKind::NotEquilibrated, text)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use result::Outcome;

    #[test]
    fn a_search_that_leaves_misfit_is_flagged() {
        let record = |complete: bool| {
            let mut record: record::Discovery =
                serde_json::from_str(include_str!("../../../record/discovery.json")).unwrap();
            record.complete = Some(complete);
            record
        };
        let flagged = |complete: bool| {
            let study = result::study::Study {
                rounds: vec![result::discovery::DiscoveryRound {
                    calibration: 1,
                    record: record(complete),
                }],
                ..fixture::study()
            };
            let flags = flags(&study);
            flags
                .iter()
                .filter(|f| f.kind == super::FlagKind::Incomplete)
                .count()
        };
        assert_eq!((flagged(true), flagged(false)), (0, 1));
    }

    #[test]
    fn a_law_of_a_condition_that_the_rows_follow_may_be_a_drift() {
        let flagged = |depends_on: &str, has_order: bool| {
            let mut study = fixture::study();
            let spec = &mut study.lead.spec;
            let experiment = std::sync::Arc::make_mut(&mut spec.experiment);
            for (row, &run) in spec.fit_runs.iter().enumerate() {
                experiment.runs[run].slip = 0.05 * (row + 1) as f64;
                experiment.runs[run].order = has_order.then_some(row as i32 + 1);
            }
            let mut record: record::Discovery =
                serde_json::from_str(include_str!("../../../record/discovery.json")).unwrap();
            record.outside = Some(record::Outside {
                acts_on: "pressure".into(),
                depends_on: depends_on.into(),
                places: Vec::new(),
                form: "power".into(),
                log_bayes_factor: 30.0,
                effect_file: String::new(),
                curve: Vec::new(),
                left_out_nats: [0.0; 2],
                formulas: None,
                forms: Vec::new(),
            });
            study.rounds = vec![result::discovery::DiscoveryRound {
                calibration: 1,
                record,
            }];
            super::laws_or_drifts(&study).len()
        };
        assert_eq!((flagged("slip", false), flagged("j", false)), (1, 1));
        assert_eq!(flagged("slip", true), 0, "a stated order is flagged by itself");
        assert_eq!(flagged("wheel_load", false), 0);
    }

    #[test]
    fn a_calibration_that_missed_a_mode_found_by_another_is_flagged() {
        let mut study = fixture::study();
        let missed = |study: &super::Study| {
            let flags = flags(study);
            let found = flags.iter().filter(|f| f.text.contains("missed a mode that"));
            found.map(|f| f.text.clone()).collect::<Vec<String>>()
        };
        assert_eq!(missed(&study), Vec::<String>::new());
        if let Outcome::Estimated(estimate) = &mut study.point_estimates[0].outcome {
            estimate.log_likelihood += 100.0;
        }
        let texts = missed(&study);
        assert!(
            texts.len() == 1 && texts[0].starts_with("tmcmc missed a mode that ga found"),
            "{texts:?}"
        );
        assert_eq!(
            flags(&study)[0].text,
            texts[0],
            "it stands before what it casts doubt on"
        );
    }
}

//! What all models of a study predict together.

use statistics::ErrorLaw;

use super::mixture::{Component, quantile};
use super::row::ComparisonRow;
use crate::study::Study;

/// Standard deviations from the mean of a normal law to its 95 % quantile.
const TO_Q95: f64 = 1.644_853_626_951_472_7;

/// The corrected predictions of the models of a ledger, averaged.
///
/// `p(y) = (1/K) sum_k N(y; m_k, s_k)`: `m_k` the corrected prediction of model k, `s_k` from its 90 % interval. All models count alike:
/// weights from so few conditions as a rig has are noise, and cost more than they gain.
///
/// # Source
/// Clemen 1989, doi:10.1016/0169-2070(89)90012-5; Bates & Granger 1969, doi:10.1057/jors.1969.103. Checked by
/// `models_that_err_to_both_sides_are_better_together` and others below.
#[derive(Debug, Clone)]
pub(crate) struct CombinedRow {
    /// The run and channel, with the prediction of the current model.
    pub(crate) row: ComparisonRow,
    /// Mean of the corrected predictions [channel's unit]; `None` where no model has one.
    pub(crate) mean: Option<f64>,
    /// 5 % and 95 % quantile of a new measurement; `None` without intervals of all.
    pub(crate) interval: Option<[f64; 2]>,
    /// How many models it averages.
    pub(crate) models: usize,
}

impl CombinedRow {
    /// Whether the measurement lies in its 90 % interval.
    pub(crate) fn covered(&self) -> Option<bool> {
        let [q05, q95] = self.interval?;
        Some((q05..=q95).contains(&self.row.measured))
    }
}

impl Study {
    /// The measurements that the current model is compared with, as the ledger's models of the same measurements predict them
    /// together; none without a ledger.
    pub(crate) fn combined(&self) -> Vec<CombinedRow> {
        let Some(current) = self.current() else {
            return Vec::new();
        };
        // The rows of two comparisons of one experiment are those of its runs and channels, in the same order.
        let models = self
            .ledger()
            .filter(|own| own.row.experiment == current.row.experiment);
        let models: Vec<&[ComparisonRow]> = models.map(|own| own.comparison().rows.as_slice()).collect();
        let rows = current.comparison().rows.iter().enumerate();
        rows.map(|(i, row)| combine(row, models.iter().filter_map(|own| own.get(i))))
            .collect()
    }
}

fn combine<'a>(row: &ComparisonRow, of_models: impl Iterator<Item = &'a ComparisonRow>) -> CombinedRow {
    let corrected =
        of_models.filter_map(|own| Some((own.corrected?, own.corrected_q05.zip(own.corrected_q95))));
    let corrected: Vec<(f64, Option<(f64, f64)>)> = corrected.collect();
    let models = corrected.len();
    let component = |&(mean, interval): &(f64, Option<(f64, f64)>)| {
        let (q05, q95) = interval?;
        Some(Component {
            mean,
            scale: Some((q95 - q05) / (2.0 * TO_Q95)),
            weight: 1.0,
        })
    };
    let components: Option<Vec<Component>> = corrected.iter().map(component).collect();
    let components = components.filter(|all| !all.is_empty());
    CombinedRow {
        row: row.clone(),
        mean: (models > 0).then(|| corrected.iter().map(|(mean, _)| mean).sum::<f64>() / models as f64),
        interval: components.map(|all| [0.05, 0.95].map(|p| quantile(&all, ErrorLaw::Gaussian, p))),
        models,
    }
}

/// A line of `predictions.csv`.
#[derive(serde::Serialize)]
struct Line<'a> {
    run: &'a str,
    r#use: &'static str,
    wheel: &'a str,
    slip: f64,
    slip_angle_deg: f64,
    wheel_load_n: f64,
    sled_speed_m_s: f64,
    channel: &'static str,
    unit: &'a str,
    measured: f64,
    model: Option<f64>,
    model_q05: Option<f64>,
    model_q95: Option<f64>,
    corrected: Option<f64>,
    corrected_q05: Option<f64>,
    corrected_q95: Option<f64>,
    combined: Option<f64>,
    combined_q05: Option<f64>,
    combined_q95: Option<f64>,
    models: usize,
}

/// Every run and channel as CSV: measured, by the current model, by that model corrected, and combined.
pub(crate) fn predictions_csv(rows: &[CombinedRow]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for own in rows {
        let row = &own.row;
        writer.serialize(Line {
            run: &row.run,
            r#use: row.usage.name(),
            wheel: &row.wheel,
            slip: row.slip,
            slip_angle_deg: row.slip_angle_deg,
            wheel_load_n: row.wheel_load_n,
            sled_speed_m_s: row.sled_speed_m_s,
            channel: row.channel.name(),
            unit: &row.unit,
            measured: row.measured,
            model: row.predicted,
            model_q05: row.q05,
            model_q95: row.q95,
            corrected: row.corrected,
            corrected_q05: row.corrected_q05,
            corrected_q95: row.corrected_q95,
            combined: own.mean,
            combined_q05: own.interval.map(|[q05, _]| q05),
            combined_q95: own.interval.map(|[_, q95]| q95),
            models: own.models,
        })?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|e| csv::Error::from(e.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// A row of the pull, measured as 0 N, that models correct to these values with a sd of 1 N.
    fn combined(corrected: &[Option<f64>]) -> CombinedRow {
        let rows = fixture::calibration().comparison().rows.clone();
        let row = ComparisonRow {
            measured: 0.0,
            ..rows[0].clone()
        };
        let of_models = corrected.iter().map(|&corrected| ComparisonRow {
            corrected,
            corrected_q05: corrected.map(|mean| mean - TO_Q95),
            corrected_q95: corrected.map(|mean| mean + TO_Q95),
            ..row.clone()
        });
        let of_models: Vec<ComparisonRow> = of_models.collect();
        combine(&row, of_models.iter())
    }

    #[test]
    fn models_that_err_to_both_sides_are_better_together() {
        let own = combined(&[Some(2.0), None, Some(-2.0)]);
        assert_eq!((own.mean, own.models), (Some(0.0), 2));
        assert_eq!(combined(&[Some(2.0)]).covered(), Some(false));
        assert_eq!(own.covered(), Some(true));
    }

    #[test]
    fn an_interval_holds_the_models_spread_too() {
        let [q05, q95] = combined(&[Some(0.3)]).interval.unwrap();
        assert!((q05 - 0.3 + TO_Q95).abs() < 1e-9 && (q95 - 0.3 - TO_Q95).abs() < 1e-9);
        // Half of the mixture lies below 0: a tenth of a half of each component lies beyond the outer quantile.
        let [q05, q95] = combined(&[Some(10.0), Some(-10.0)]).interval.unwrap();
        let outer = 10.0 + 1.281_551_565_544_600_5;
        assert!(
            (q05 + outer).abs() < 1e-6 && (q95 - outer).abs() < 1e-6,
            "{q05} {q95}"
        );
    }

    #[test]
    fn without_a_correction_there_is_nothing_to_combine() {
        let own = combined(&[None]);
        assert_eq!((own.mean, own.interval, own.models), (None, None, 0));
    }

    #[test]
    fn a_file_has_a_line_for_each_run_and_channel_of_the_current_model() {
        let study = Study::from(fixture::with_smooth_misfit());
        let rows = study.combined();
        let csv = predictions_csv(&rows).unwrap();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 1 + study.lead.comparison().rows.len());
        let column = |name: &str| lines[0].split(',').position(|own| own == name).unwrap();
        let h1 = lines
            .iter()
            .find(|line| line.starts_with("h1,holdout") && line.contains("pull"));
        let cells: Vec<&str> = h1.unwrap().split(',').collect();
        // Of one model the combined prediction is the corrected one.
        assert_eq!(cells[column("combined")], cells[column("corrected")]);
        assert_eq!(cells[column("models")], "1");
        let fast = lines.iter().find(|line| line.starts_with("fast,")).unwrap();
        assert_eq!(fast.split(',').nth(column("combined")), Some(""));
    }
}

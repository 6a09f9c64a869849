//! Prediction rows: every run and channel with the predictions of the models of a study, also as CSV.

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::combined_row::CombinedRow;
use crate::study::Study;

/// The measurement of a run and channel with its predictions: by the current model, corrected, by all models combined, and interpolated.
///
/// Values are in the channel's SI unit; `None` if there is no prediction.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PredictionRow {
    /// Name of the run.
    pub run: String,
    /// Use of the run: `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Name of the wheel.
    pub wheel: String,
    /// Slip of the run.
    pub slip: f64,
    /// Slip angle `[deg]`.
    pub slip_angle_deg: f64,
    /// Wheel load `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed `[m/s]`.
    pub sled_speed_m_s: f64,
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Unit of the following values.
    pub unit: String,
    /// Measured value.
    pub measured: f64,
    /// Posterior mean of the current model.
    pub model: Option<f64>,
    /// 5 % quantile of a new measurement.
    pub model_q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub model_q95: Option<f64>,
    /// Corrected prediction: the model plus its discrepancy, which is estimated from the fitted conditions; for a fitted run from the
    /// other conditions.
    pub corrected: Option<f64>,
    /// 5 % quantile of a new measurement.
    pub corrected_q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub corrected_q95: Option<f64>,
    /// Weighted mean of the corrected predictions of the ledger's models and of the prediction by the measurements alone.
    pub combined: Option<f64>,
    /// 5 % quantile of a new measurement.
    pub combined_q05: Option<f64>,
    /// 95 % quantile of a new measurement.
    pub combined_q95: Option<f64>,
    /// Number of models in the average, the measurements alone not counted.
    pub models: usize,
    /// Interpolation of the fitted measurements, without a model.
    pub interpolated: Option<f64>,
}

impl PredictionRow {
    fn new(combined: &CombinedRow) -> Self {
        let row = combined.row.clone();
        PredictionRow {
            run: row.run,
            usage: row.usage,
            wheel: row.wheel,
            slip: row.slip,
            slip_angle_deg: row.slip_angle_deg,
            wheel_load_n: row.wheel_load_n,
            sled_speed_m_s: row.sled_speed_m_s,
            channel: row.channel,
            unit: row.unit,
            measured: row.measured,
            model: row.predicted,
            model_q05: row.q05,
            model_q95: row.q95,
            corrected: row.corrected,
            corrected_q05: row.corrected_q05,
            corrected_q95: row.corrected_q95,
            combined: combined.mean,
            combined_q05: combined.interval.map(|[q05, _]| q05),
            combined_q95: combined.interval.map(|[_, q95]| q95),
            models: combined.models,
            interpolated: row.interpolated,
        }
    }
}

impl Study {
    /// Returns a row for each measurement that the current model is compared with.
    pub fn predictions(&self) -> Vec<PredictionRow> {
        self.combined().iter().map(PredictionRow::new).collect()
    }
}

/// The line of titles of `predictions.csv`, in the order of the fields of a row.
const TITLES: &str = "run,use,wheel,slip,slip_angle_deg,wheel_load_n,sled_speed_m_s,channel,unit,measured,model,model_q05,model_q95,corrected,corrected_q05,corrected_q95,combined,combined_q05,combined_q95,models,interpolated\n";

/// Returns the content of `predictions.csv`; without rows, the line of titles only.
pub fn to_csv(rows: &[PredictionRow]) -> String {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(TITLES.as_bytes().to_vec());
    for row in rows {
        writer.serialize(row).expect("a row has a CSV form");
    }
    let bytes = writer.into_inner().expect("memory can be written");
    String::from_utf8(bytes).expect("names are text")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_fit_without_draws_has_its_own_predictions() {
        let study = Study::from(fixture::search());
        let rows = study.combined();
        assert!(rows.iter().any(|row| row.row.predicted.is_some()));
        let csv = to_csv(&study.predictions());
        assert_eq!(csv.lines().count(), 1 + rows.len());
    }

    #[test]
    fn a_file_has_a_line_for_each_run_and_channel_of_the_current_model() {
        let study = Study::from(fixture::with_smooth_misfit());
        let csv = to_csv(&study.predictions());
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 1 + study.lead.comparison().rows.len());
        let column = |name: &str| lines[0].split(',').position(|title| title == name).unwrap();
        let h1 = lines
            .iter()
            .find(|line| line.starts_with("h1,holdout") && line.contains("pull"));
        let cells: Vec<&str> = h1.unwrap().split(',').collect();
        // The measurements alone count beside the one model.
        let rows = study.combined().iter();
        let of_run = |row: &&CombinedRow| row.row.run == "h1" && row.row.channel == Channel::DrawbarPull;
        let mean = rows.filter(of_run).find_map(|row| row.mean).unwrap();
        assert_eq!(cells[column("combined")].parse(), Ok(mean));
        assert_ne!(cells[column("combined")], cells[column("corrected")]);
        assert_eq!(cells[column("models")], "1");
        let fast = lines.iter().find(|line| line.starts_with("fast,")).unwrap();
        assert_eq!(fast.split(',').nth(column("combined")), Some(""));
    }

    #[test]
    fn the_title_line_names_the_fields_of_a_row() {
        let study = Study::from(fixture::with_smooth_misfit());
        // A writer with default settings takes the titles from the names of the fields.
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.serialize(&study.predictions()[0]).unwrap();
        let titled = String::from_utf8(writer.into_inner().unwrap()).unwrap();
        assert_eq!(titled.lines().next(), to_csv(&[]).lines().next());
    }
}

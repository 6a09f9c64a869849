//! The posterior draws as a table with names of columns, and as CSV.

use crate::finished_calibration::FinishedCalibration;

/// The equally weighted draws.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct PosteriorTable {
    /// `log_likelihood`, `log_prior`, then the parameters.
    pub columns: Vec<String>,
    /// One row for each draw; empty for a fit.
    pub rows: Vec<Vec<f64>>,
}

impl FinishedCalibration {
    /// Returns the equally weighted draws as a table.
    pub fn posterior_table(&self) -> PosteriorTable {
        let parameters = self.spec.parameters.iter().map(|p| p.name.clone());
        let columns = ["log_likelihood".to_owned(), "log_prior".to_owned()]
            .into_iter()
            .chain(parameters)
            .collect();
        let rows = self
            .posterior()
            .iter()
            .map(|s| {
                let head = [s.log_likelihood.value(), s.log_prior];
                head.into_iter().chain(s.theta.iter().copied()).collect()
            })
            .collect();
        PosteriorTable { columns, rows }
    }
}

impl PosteriorTable {
    /// Returns the table as CSV, in which every number keeps all its bits.
    pub fn to_csv(&self) -> String {
        let mut text = self.columns.join(",");
        text.push('\n');
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(f64::to_string).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
    }
}

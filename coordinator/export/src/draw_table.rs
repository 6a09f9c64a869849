//! The draws of the posterior as a table, which Arrow and Parquet files contain.

use crate::error::ExportError;
use crate::inference_data::InferenceData;
use crate::variable::{Values, Variable};

/// The draws of the posterior, one row each.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawTable {
    /// `chain` and `draw`.
    pub numbers: [(String, Vec<i64>); 2],
    /// `log_likelihood`, `log_prior`, then the parameters, with their units.
    pub columns: Vec<DrawColumn>,
}

/// A column of real numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawColumn {
    /// Name of the column.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// One value for each draw.
    pub values: Vec<f64>,
}

impl DrawTable {
    /// Tabulates the draws of inference data.
    ///
    /// # Errors
    /// [`ExportError::Group`] if there is no posterior.
    pub fn from_data(data: &InferenceData) -> Result<DrawTable, ExportError> {
        let stats = data.group("sample_stats")?.data_vars.iter();
        let stats =
            stats.filter(|variable| ["log_likelihood", "log_prior"].contains(&variable.name.as_str()));
        let variables = stats.chain(&data.group("posterior")?.data_vars);
        let column = |variable: &Variable| match &variable.values {
            Values::Real(values) => Some(DrawColumn {
                name: variable.name.clone(),
                unit: variable.unit.clone(),
                values: values.clone(),
            }),
            Values::Whole(_) | Values::Text(_) => None,
        };
        let columns: Vec<DrawColumn> = variables.filter_map(column).collect();
        let rows = columns.first().map_or(0, |column| column.values.len());
        Ok(DrawTable {
            numbers: [
                ("chain".to_owned(), vec![0; rows]),
                ("draw".to_owned(), (0_i64..).take(rows).collect()),
            ],
            columns,
        })
    }
}

//! A finished calibration for other programs: as the inference data of ArviZ, and as a table of draws.
//!
//! Everything here is a pure function of a [`result::FinishedCalibration`]; files are bytes, which the caller writes.
//!
//! # Layout
//! - `inference_data`: groups of variables with named dimensions; also the form of the REST answer.
//! - `variable`: one of these variables, its values and their checks.
//! - `content`: the content of an export, group by group.
//! - `draw_table`: the draws of the posterior, one row each.
//! - [`format`](mod@format): inference data as Zarr and NetCDF, the table as Arrow and Parquet.
//! - [`simulator`]: the model for programs that simulate vehicles: a unit by FMI, files of Project Chrono, lookup tables.
//! - `error`: the reasons for which nothing is written.

mod content;
mod draw_table;
mod error;
pub mod format;
mod inference_data;
pub mod simulator;
mod variable;

pub use content::inference_data;
pub use draw_table::DrawTable;
pub use error::ExportError;
pub use inference_data::{InferenceData, VariableGroup};
pub use variable::{Values, Variable};

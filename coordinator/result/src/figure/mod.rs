//! The numbers of the figures: the source paper's Fig. 5 to 8 of a study.
//!
//! Everything is in SI and carries its unit; the page draws it, and so can any other program.
//!
//! # Layout
//! - `figures`: all of them, of a study or of a calibration. `marginal`: densities of single parameters.
//! - `convergence`: convergence of the searches and the sampler (Fig. 5).
//! - `posterior`: joint densities of two parameters, with point estimates and reference values (Fig. 6).
//! - `history`: measurement and model over time (Fig. 7).
//! - `error`: prediction errors over the posterior (Fig. 8).
//! - `thinned`: a part of many draws. `axis_parameter`: a parameter on an axis. `mark`: single points; `optimum`: point estimates as such points,
//!   `reference`: independent tests.

mod axis_parameter;
mod convergence;
mod error;
mod figures;
mod history;
mod marginal;
mod mark;
mod optimum;
mod posterior;
mod reference;
mod thinned;

pub use axis_parameter::AxisParameter;
pub use convergence::{Populations, SearchConvergence, StageConvergence};
pub use error::ErrorDensity;
pub use figures::CalibrationFigures;
pub use history::{ChannelHistory, MeasuredSeries, ModelSeries};
pub use marginal::MarginalDensity;
pub use mark::{Mark, MarkKind, PlanePoint};
pub use posterior::{JointPosterior, LabelledLine};

//! Figures: the numbers behind the source paper's Fig. 5 to 8, for any calibration.
//!
//! All values are in SI and have units, so that the page or any other program can draw them.
//!
//! # Layout
//! - `figures`: all figures of a calibration. `marginal`: densities of single parameters.
//! - `convergence`: convergence of the searches and the sampler (Fig. 5).
//! - `joint_posterior`: joint densities of two parameters (Fig. 6). `stiffness_line`: the bevameter's line in that of the moduli.
//! - `history`: measurement and model over time (Fig. 7).
//! - `error`: prediction errors over the posterior (Fig. 8).
//! - `mark`: labelled points. `optimum`: point estimates, and `reference`: values of independent tests, which are shown as marks.
//! - `axis_parameter`: name and unit for an axis. `log_axis`: the choice of a logarithmic one. `thinned`: fewer draws and digits.

mod axis_parameter;
mod convergence;
mod error;
mod figures;
mod history;
mod joint_posterior;
mod log_axis;
mod marginal;
mod mark;
mod optimum;
mod reference;
mod stiffness_line;
mod thinned;

pub use axis_parameter::AxisParameter;
pub use convergence::{Populations, SearchConvergence, StageConvergence};
pub use error::ErrorDensity;
pub use figures::CalibrationFigures;
pub use history::{ChannelHistory, MeasuredSeries, ModelSeries};
pub use joint_posterior::JointPosterior;
pub use log_axis::is_logarithmic;
pub use marginal::MarginalDensity;
pub use mark::{Mark, MarkKind, PlanePoint};
pub use stiffness_line::LabelledLine;

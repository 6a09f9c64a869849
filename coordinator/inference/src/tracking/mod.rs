//! Parameters that vary in time, followed through a recording: a bank of Gaussian filters in the normal scores of the prior.
//!
//! # Model
//! Between two blocks of samples the parameters that may vary walk, or they are drawn anew from their prior. The scores `x` of those that
//! vary walk by `x' = sqrt(1 - q^2 dt) x + q sqrt(dt) e`, so that the prior stays their distribution however long nothing is measured. The
//! bank holds a filter for each size `q` of the walk and each time of the last new draw that is still probable; Bayes' rule weighs them.
//! Weights of the sizes are forgotten slowly, so that a walk that begins late is found. A change is the new draw itself.
//!
//! # Layout
//! - [`tracker`]: the bank. `hypothesis`: filters that share the time of the last new draw. `gaussian`: one filter's distribution.
//! - `linearisation`: the model as a linear one over a distribution, with its error.
//! - [`change`]: from weights to changes. [`noise`]: size and correlation of the noise of samples.
//!
//! # Source
//! Adams & `MacKay` 2007, arXiv:0710.3742 (times of change); Raftery, Kárný & Ettler 2010, Technometrics 52:52,
//! doi:10.1198/TECH.2009.08104 (weights that are forgotten); Nørgaard, Poulsen & Ravn 2000, Automatica 36:1627,
//! doi:10.1016/S0005-1098(00)00089-3 (linearisation by differences); García-Fernández et al. 2015, IEEE Trans. Signal Process. 63:5561,
//! doi:10.1109/TSP.2015.2454485 (linearisation over the posterior).

pub mod change;
mod gaussian;
mod hypothesis;
mod linearisation;
pub mod noise;
pub mod tracker;

pub use change::Change;
pub use noise::NoiseEstimate;
pub use tracker::{Block, Tracker, TrackerSettings};

//! Fit the most probable parameters by Levenberg and Marquardt's method, asked and told from outside.
//!
//! Minimised is the negative log-posterior
//!
//! ```text
//! f(theta) = sum_i [ (y_i - m_i(theta))^2 / (2 sd_i^2) + ln(sqrt(2 pi) sd_i) ] - sum_k ln p_k(theta_k)
//! ```
//!
//! with `p_k` the density of the parameter as the job declares it, not of the coordinate in which the fit moves:
//! another way to write down the same prior (a lognormal x, a normal ln x) has another maximum.
//!
//! [`LmFit`] never runs the model. It lists [`Proposal`](crate::Proposal)s of a round, which can be evaluated
//! at the same time, and is told their predicted values in any order:
//! 1. Starts: the prior mean and some prior draws; the fit goes on from the best.
//! 2. Differences: the columns of the Jacobian, one parameter moved in each.
//! 3. Trials: steps of several dampings; the best is taken if it is an improvement, else they grow shorter.
//!
//! Before it ends, a fit takes differences to both sides and over longer steps, because noise of the model looks like
//! information over short ones.
//!
//! Noise standard deviations cost no evaluation: given the residuals, each has a one-dimensional problem of its
//! own, which is solved for every point before points are compared. A bound is a bound of every step, and a
//! parameter that ends at one is reported so.
//!
//! # Layout
//! - `settings`: starts, budget, step of the differences.
//! - `fit`: the rounds. `iteration`: what each leads to.
//! - `noise`: one noise sd.
//! - `objective`: f at a point, and its parabola there. `quadratic_model`: the least of a damped parabola in a box.
//! - `stencil`: the differences. `damping`: how far to trust the parabola.
//! - `laplace`: the result, with its covariance.
//!
//! # Source
//! Marquardt 1963, J. SIAM 11:431; the control of the damping after Nielsen 1999, IMM-REP-1999-05.

mod damping;
mod fit;
mod iteration;
mod laplace;
mod noise;
mod objective;
mod quadratic_model;
mod settings;
mod stencil;

pub use fit::LmFit;
pub use quadratic_model::QuadraticModel;
pub use settings::{LmSettings, LmSettingsError};

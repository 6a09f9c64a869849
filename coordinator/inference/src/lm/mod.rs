//! The Levenberg-Marquardt fit of the most probable parameters, by ask and tell.
//!
//! Minimised is the negative log-posterior
//!
//! ```text
//! f(theta) = sum_i [ (y_i - m_i(theta))^2 / (2 sd_i^2) + ln(sqrt(2 pi) sd_i) ] - sum_k ln p_k(theta_k)
//! ```
//!
//! with `p_k` the density of the parameter as the job declares it, not of the coordinate in which the fit moves:
//! another parametrisation of the same prior (a lognormal x, a normal ln x) has another maximum.
//!
//! [`LmFit`] never runs the model. It lists [`Proposal`](crate::Proposal)s of a round, which can be evaluated
//! at the same time, and is told their predicted values in any order:
//! 1. Starts: the prior mean and some prior draws; the fit continues from the best.
//! 2. Differences: the columns of the Jacobian, one parameter moved in each.
//! 3. Trials: steps of several dampings; the best is accepted if it is an improvement, else the damping grows.
//!
//! Before it ends, a fit takes differences to both sides and over longer steps, because over short ones the numerical
//! noise of the model looks like information.
//!
//! Noise standard deviations cost no evaluation: given the residuals, each is the solution of a one-dimensional problem, solved
//! at every point before points are compared (profiling). Every step keeps to the bounds, and a parameter that ends at one is
//! reported so. Sds that depend on each other (of common errors, of heavy tails) are searched one after the other.
//!
//! # Layout
//! - `settings`: starts, budget, step of the differences.
//! - `fit`: the rounds. `iteration`: the step from one round to the next.
//! - `noise_profile`: the profiled sds; `noise`: one of independent normal errors.
//! - `objective`: f at a point, and its parabola there. `quadratic_model`: the minimum of a damped parabola in a box.
//! - `stencil`: the differences. `damping`: the damping of the steps.
//! - `laplace`: the result, with its covariance. `normal_approximation`: draws about it, and the evidence.
//!
//! # Source
//! Levenberg 1944, Q. Appl. Math. 2:164, doi:10.1090/qam/10666; Marquardt 1963, J. SIAM 11:431, doi:10.1137/0111030; the
//! control of the damping after Nielsen 1999, IMM-REP-1999-05.

mod damping;
mod fit;
mod iteration;
mod laplace;
mod noise;
mod noise_profile;
mod normal_approximation;
mod objective;
mod quadratic_model;
mod settings;
mod stencil;

pub use fit::LmFit;
pub use quadratic_model::QuadraticModel;
pub use settings::{LmSettings, LmSettingsError};

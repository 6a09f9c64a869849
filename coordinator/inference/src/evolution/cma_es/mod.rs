//! Search the most probable parameters by covariance matrix adaptation (CMA-ES).
//!
//! A generation is drawn from a normal distribution, in units of the prior's width along every axis. Its better half
//! moves the mean, shapes the covariance (rank-mu), and the way of the mean does so, too (rank-one); the length of
//! that way rules the step size. It needs no derivative, and neither stretching nor turning of the parameters
//! matters, so a thin ridge is learnt, not lost.
//!
//! - **Bounds**: an individual beyond a bound is evaluated on it, and ranked as worse by its distance.
//! - **Rejections**: an individual that the model rejected ranks last and moves nothing. When the model rejects
//!   whole generations, the run is given up.
//! - **Restarts** (IPOP): a run that has settled is followed by one from a prior draw with twice the population, until
//!   restarts or budget are used up. The first run begins at the prior mean, as wide as the prior.
//!
//! [`crate::evolution::Evolution`] asks for the individuals and is told their log-likelihoods.
//!
//! # Layout
//! - `settings`: population, budget, restarts. `rates`: weights and learning rates.
//! - `search_distribution`: the normal distribution and its update. `run`: one search to its end, and when that is.
//! - `restarts`: one run after the other.
//!
//! # Source
//! Hansen 2016, The CMA evolution strategy: a tutorial, arXiv:1604.00772; Auger & Hansen 2005, CEC 2:1769 (restarts).

mod rates;
mod restarts;
mod run;
mod search_distribution;
mod settings;

pub(crate) use restarts::Restarts;
pub use settings::CmaEsSettings;

//! Covariance matrix adaptation (CMA-ES).
//!
//! A generation is drawn from a normal distribution, in units of the prior's width along every axis. Its better half moves the
//! mean and shapes the covariance (rank-mu update), as does the path of the mean (rank-one update); the length of that path
//! controls the step size. It needs no derivative and is invariant to scaling and rotation of the parameters, so it learns thin
//! ridges.
//!
//! - **Bounds**: an individual beyond a bound is evaluated on it, with a penalty for its distance.
//! - **Rejections**: an individual that the model rejected ranks last and moves nothing. When the model rejects
//!   several whole generations, the run ends.
//! - **Restarts** (IPOP): a converged run is followed by one from a prior draw with twice the population, until
//!   restarts or budget are used up. The first run begins at the prior mean, as wide as the prior.
//!
//! # Layout
//! - `settings`: population, budget, restarts. `rates`: weights and learning rates.
//! - `search_distribution`: the normal distribution and its update. `run`: one run and when it ends.
//! - `restarts`: the sequence of runs.
//!
//! # Source
//! Hansen 2016, The CMA evolution strategy: a tutorial, arXiv:1604.00772; Auger & Hansen 2005, CEC 2:1769,
//! doi:10.1109/CEC.2005.1554902 (restarts).

mod rates;
mod restarts;
mod run;
mod search_distribution;
mod settings;

pub(crate) use restarts::Restarts;
pub use settings::CmaEsSettings;

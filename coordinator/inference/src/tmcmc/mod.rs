//! Sample a posterior by transitional Markov chain Monte Carlo, asked and told from outside.
//!
//! Prior draws are weighted by a growing power of the likelihood, resampled, and moved by Metropolis-Hastings
//! steps at each power (Ching & Chen 2007, J. Eng. Mech. 133:816). [`Sampler`] never calls the likelihood: it
//! lists [`Proposal`]s and waits until each has been told, in any order.

mod bridge;
mod ching_chen;
mod covariance;
mod equilibrium;
mod evidence;
mod population;
mod proposal;
mod record;
mod resample;
mod sampler;
mod schedule;
mod settings;
mod stage;
mod transition;
mod weights;

pub use population::{Particle, Proposal};
pub use record::{Current, Failure, Posterior, Progress, StageRecord, TellError};
pub use sampler::Sampler;
pub use settings::{Algorithm, Settings, SettingsError};

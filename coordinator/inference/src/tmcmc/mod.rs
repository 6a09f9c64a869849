//! Sample a posterior by transitional Markov chain Monte Carlo, asked and told from outside.
//!
//! Prior draws are weighted by a growing power of the likelihood, resampled, and moved by Metropolis-Hastings
//! steps at each power (Ching & Chen 2007, J. Eng. Mech. 133:816). [`Sampler`] never calls the likelihood: it
//! lists [`Proposal`](crate::Proposal)s and waits until each has been told, in any order.
//!
//! # Departures from the paper
//! - Every particle moves, by several steps; [`Algorithm::ChingChen2007`] keeps the paper's moves, and
//!   [`Algorithm::Basis`] those of its unbiased version.
//! - Every state that a chain visits is weighted for the next stage, not its last one alone: the evaluations
//!   are paid for (Dau & Chopin 2022, J. R. Stat. Soc. B 84:114).
//! - The evidence bridges the states of neighbouring stages both ways instead of averaging weights one way.
//! - Prior draws that the model rejects are always dropped, and the evidence multiplied by the surviving
//!   fraction.
//! - A stage ends when its particles have forgotten their start; one that cannot is flagged, and the result
//!   with it.

mod bridge;
mod ching_chen;
mod equilibrium;
mod evaluation;
mod evidence;
mod particle;
mod record;
mod resample;
mod sampler;
mod scale;
mod schedule;
mod settings;
mod stage;
mod stage_sequence;
mod transition;
mod weights;

pub use evaluation::EvaluationResult;
pub use particle::Particle;
pub use record::{PosteriorSample, StageProgress, StageRecord};
pub use sampler::Sampler;
pub use settings::{Algorithm, TmcmcSettings, TmcmcSettingsError};

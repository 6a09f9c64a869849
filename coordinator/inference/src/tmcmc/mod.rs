//! Transitional Markov chain Monte Carlo (TMCMC) by ask and tell.
//!
//! Prior draws are weighted by a growing power of the likelihood. At each power the particles of a stage are drawn independently
//! from a mixture fitted to the weighted draws of the last ([`StageMethod::Draws`]), or resampled and moved by
//! Metropolis-Hastings steps ([`StageMethod::Moves`]). A stage whose draws miss their target falls back to moves, and the stages
//! after it keep to them. [`Sampler`] never calls the likelihood: it lists [`Proposal`](crate::Proposal)s and waits until each
//! has been told, in any order.
//!
//! # Departures from the paper
//! - Draws instead of moves, see `draws`; the other departures concern moves.
//! - Every particle moves, by several steps; [`Algorithm::ChingChen2007`] keeps the paper's moves, and
//!   [`Algorithm::Basis`] those of its unbiased version.
//! - Every state that a chain visits is weighted for the next stage, not its last one alone (Dau & Chopin 2022).
//! - The evidence is a bridge estimate between neighbouring stages instead of a mean of the weights of the earlier one.
//! - Prior draws that the model rejects are always dropped, and the evidence multiplied by the surviving fraction.
//! - A stage ends when its particles have forgotten their start; a stage that does not reach this is flagged, and the result with
//!   it.
//!
//! # Layout
//! - `sampler`: the rounds. `stage_sequence`: from the prior draws through the stages to the posterior sample.
//! - `settings`, `record`, `particle`: inputs and outputs. `pool`: the states that a stage has visited.
//! - `transition`: from the pool of a stage to the chains of the next.
//! - `draws`, `draw_sequence`: stages of independent draws. `stage`, `scale`: the moves of the chains. `proposal_mixture`,
//!   `covariance`: the candidates of a move. `equilibrium`: when the moves end.
//! - `update`: the posterior after more data.
//! - `evidence`: the log-evidence and its standard error.
//!
//! # Source
//! Ching & Chen 2007, J. Eng. Mech. 133:816, doi:10.1061/(ASCE)0733-9399(2007)133:7(816); Dau & Chopin 2022, J. R. Stat.
//! Soc. B 84:114, doi:10.1111/rssb.12475.

mod covariance;
mod draw_sequence;
pub(crate) mod draws;
mod equilibrium;
mod evidence;
mod particle;
pub(crate) mod pool;
mod proposal_mixture;
mod record;
mod sampler;
mod scale;
mod settings;
mod stage;
mod stage_sequence;
pub(crate) mod transition;
mod update;

pub use particle::Particle;
pub use record::{PosteriorSample, StageProgress, StageRecord};
pub use sampler::Sampler;
pub use settings::{Algorithm, MAX_PARTICLES, StageMethod, TmcmcSettings, TmcmcSettingsError};
pub use update::{PosteriorUpdate, UpdateMethod, UpdateProgress, UpdatedPosterior};

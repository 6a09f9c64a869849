//! Delayed acceptance: chains move by a cheap model, and the expensive one is evaluated only where they end.
//!
//! The *fine* (high-fidelity) model is the target; the *coarse* (low-fidelity) one is cheap. At the start of a stage
//! the coarse model is corrected towards the fine one by the pairs of predictions in the stage's region, and frozen:
//! the [`Metamodel`]. A subchain of some moves is reversible for `prior * metamodel^exponent`; accepting its end with
//! probability `(L(end) / L(start) * M(start) / M(end))^exponent`, L the fine likelihood and M the metamodel's, keeps
//! the stage's target invariant for any metamodel. A subchain cannot reach parameters that the coarse model rejects, so
//! one step in five is a plain one.
//!
//! # Source
//! Christen & Fox 2005, J. Comput. Graph. Stat. 14:795, doi:10.1198/106186005X76983; Lykkegaard et al. 2023, SIAM/ASA J.
//! Uncertain. Quantif. 11:1, doi:10.1137/22M1476770.
//!
//! # Layout
//! - `mixture`: the proposals of a stage. `covariance`: the factor for drawing them.
//! - `pool`: evaluated states, with the predictions of both models.
//! - `correction`: the regression of the difference between the models on the parameters.
//! - `stage_metamodel`: the corrected coarse model of a stage.
//! - `subchain`: its request, moves and result.

mod correction;
mod covariance;
mod mixture;
mod pool;
mod stage_metamodel;
mod subchain;

pub use covariance::CovarianceFactor;
pub use mixture::{ProposalMixture, ProposedMove};
pub use pool::{ChainState, ModelPair, Pool};
pub use stage_metamodel::{Metamodel, MetamodelStage};
pub use subchain::{Subchain, SubchainEnd};

/// Share of plain steps, without a subchain.
pub const PLAIN_STEPS: f64 = 0.2;

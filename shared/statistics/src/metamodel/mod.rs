//! Move chains by a cheap model, and ask the one that counts only where they end: delayed acceptance.
//!
//! The *fine* model counts; the *coarse* one is cheap. At the start of a stage the coarse model is corrected towards the
//! fine one by what both said of the stage's region, and frozen: the [`Metamodel`]. A subchain of some moves is
//! reversible for `prior * metamodel^exponent`; accepting its end by
//! `(L(end) / L(start) * M(start) / M(end))^exponent`, L the fine likelihood and M the metamodel's, leaves the stage's
//! target as it is, however bad the metamodel (Christen & Fox 2005, J. Comput. Graph. Stat. 14:795; Lykkegaard et al.
//! 2023, SIAM/ASA J. Uncertain. Quantif. 11:1). Where the coarse model has no answer no subchain can go, so one step in
//! five is a plain one.
//!
//! # Layout
//! - `mixture`: the proposals of a stage. `covariance`: the factor that they are drawn by.
//! - `pool`: evaluated states, with what both models say there.
//! - `correction`: the regression of the fine model on the coarse one.
//! - `stage_metamodel`: the corrected coarse model of a stage.
//! - `subchain`: the moves, and what a worker is told and answers.

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

/// Share of the steps that ask the fine model without a subchain.
pub const PLAIN_STEPS: f64 = 0.2;

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
//! - here: [`Metamodel`].
//! - `mixture`: the proposals of a stage. `covariance`: the factor that they are drawn by.
//! - `pool`: evaluated states, with what both models say there.
//! - `correction`: the regression of the fine model on the coarse one.
//! - `subchain`: the moves, and what a worker is told and answers.

mod correction;
mod covariance;
mod mixture;
mod pool;
mod subchain;

use serde::{Deserialize, Serialize};

pub use covariance::CovarianceFactor;
pub use mixture::{ProposalMixture, ProposedMove};
pub use pool::{ChainState, ModelPair, Pool};
pub use subchain::{Subchain, SubchainEnd};

use crate::likelihood::{Datum, ErrorSd, Likelihood, LikelihoodError};
use crate::prior::Prior;
use correction::Correction;

/// Share of the steps that ask the fine model without a subchain.
pub const PLAIN_STEPS: f64 = 0.2;

/// All that a subchain needs but the coarse model itself, frozen for a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Metamodel {
    seed: u64,
    stage: usize,
    exponent: f64,
    moves: usize,
    prior: Prior,
    likelihood: Likelihood,
    correction: Correction,
    mixture: ProposalMixture,
}

/// The stage that a metamodel is made for, and its target.
#[derive(Debug, Clone, Copy)]
pub struct MetamodelStage<'a> {
    /// Seed of the calibration.
    pub seed: u64,
    /// Number of the stage.
    pub stage: usize,
    /// Its tempering exponent.
    pub exponent: f64,
    /// Moves of a subchain.
    pub moves: usize,
    /// The prior.
    pub prior: &'a Prior,
    /// The likelihood of the fine model.
    pub likelihood: &'a Likelihood,
}

impl Metamodel {
    /// Learns from a pool with weights that sum to one; `None` where it holds too few pairs.
    ///
    /// What the regression leaves open is noise of the metamodel: its variance is added to that of the data whose noise
    /// is known.
    ///
    /// # Errors
    /// [`LikelihoodError`] where the data cannot be scored with the wider noise.
    pub fn learn(
        purpose: &MetamodelStage,
        pool: &Pool,
        weights: &[f64],
        mixture: &ProposalMixture,
    ) -> Result<Option<Self>, LikelihoodError> {
        let Some(correction) = Correction::fit(pool, weights, &mixture.factor) else {
            return Ok(None);
        };
        let exact = purpose.likelihood;
        let data: Vec<Datum> = exact
            .data()
            .iter()
            .zip(correction.residual_sd())
            .map(|(datum, &left)| Datum {
                sd: match datum.sd {
                    ErrorSd::Known(sd) => ErrorSd::Known(libm::hypot(sd, left)),
                    inferred @ ErrorSd::Inferred { .. } => inferred,
                },
                ..*datum
            })
            .collect();
        let likelihood =
            Likelihood::with_common(data, exact.law(), exact.common().to_vec(), exact.discrepancy())?;
        Ok(Some(Self {
            seed: purpose.seed,
            stage: purpose.stage,
            exponent: purpose.exponent,
            moves: purpose.moves,
            prior: purpose.prior.clone(),
            likelihood,
            correction,
            mixture: mixture.clone(),
        }))
    }

    /// The stage it is frozen for.
    #[must_use]
    pub fn stage(&self) -> usize {
        self.stage
    }

    /// Log-likelihood of the corrected coarse model; minus infinity where the coarse model has no answer.
    fn log_likelihood(
        &self,
        theta: &[f64],
        coordinates: &[f64],
        coarse: Option<Vec<f64>>,
    ) -> Result<f64, LikelihoodError> {
        let Some(mut values) = coarse else {
            return Ok(f64::NEG_INFINITY);
        };
        self.correction
            .apply(&self.mixture.factor, coordinates, &mut values);
        Ok(self.likelihood.log_likelihood(&values, theta)?.value())
    }
}

//! The metamodel of a stage: the low-fidelity (coarse) model, corrected towards the high-fidelity (fine) one, and then
//! frozen.

use serde::{Deserialize, Serialize};

use super::correction::Correction;
use super::mixture::ProposalMixture;
use super::pool::Pool;
use crate::likelihood::{Datum, ErrorSd, Likelihood, LikelihoodError};
use crate::prior::Prior;

/// Everything that a subchain needs except the coarse model itself, frozen for a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Metamodel {
    pub(super) seed: u64,
    pub(super) stage: usize,
    pub(super) exponent: f64,
    pub(super) moves: usize,
    pub(super) prior: Prior,
    likelihood: Likelihood,
    correction: Correction,
    pub(super) mixture: ProposalMixture,
}

/// The stage of a metamodel, and its target.
#[derive(Debug, Clone, Copy)]
pub struct MetamodelStage<'a> {
    /// Seed of the calibration.
    pub seed: u64,
    /// Number of the stage.
    pub stage: usize,
    /// Tempering exponent of the stage.
    pub exponent: f64,
    /// Number of moves of a subchain.
    pub moves: usize,
    /// The prior of the calibration.
    pub prior: &'a Prior,
    /// The likelihood of the fine model.
    pub likelihood: &'a Likelihood,
}

impl Metamodel {
    /// Fits the correction to a pool with weights that sum to one; `None` if the pool holds too few pairs.
    ///
    /// The residual variance of the regression is added to the variance of the data with known noise.
    ///
    /// # Errors
    /// [`LikelihoodError`] if the data cannot be scored with the larger noise.
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
        let likelihood = Likelihood::with_common(
            data,
            exact.law(),
            exact.common().to_vec(),
            exact.discrepancies().to_vec(),
        )?;
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

    /// Returns the stage that it is frozen for.
    #[must_use]
    pub fn stage(&self) -> usize {
        self.stage
    }

    /// Returns the log-likelihood of the corrected coarse model; minus infinity if the coarse model rejects the
    /// parameters.
    pub(super) fn log_likelihood(
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

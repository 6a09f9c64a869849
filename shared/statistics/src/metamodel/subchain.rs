//! The moves of a subchain.

use serde::{Deserialize, Serialize};

use super::stage_metamodel::Metamodel;
use crate::likelihood::LikelihoodError;
use crate::rng::Stream;

/// Offset that separates the random streams of subchains from those of the accepting steps.
const SUBCHAINS: u64 = 1 << 32;

/// The request for a subchain; the metamodel of the stage holds its other inputs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Subchain {
    /// The chain that it belongs to.
    pub chain: u64,
    /// Number of the step of this chain.
    pub step: u64,
    /// Scale of the proposals.
    pub scale: f64,
}

/// The result of a subchain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SubchainEnd {
    /// The parameters; those of the start if no move was accepted.
    pub theta: Vec<f64>,
    /// ln M(end) - ln M(start), M the metamodel's likelihood.
    pub log_gain: f64,
    /// Number of moves proposed.
    pub moves: u32,
    /// Number of moves accepted.
    pub accepted: u32,
    /// Number of proposed moves whose length is proportional to the scale.
    pub scaled: u32,
    /// Number of accepted moves whose length is proportional to the scale.
    pub scaled_accepted: u32,
}

impl Metamodel {
    /// Runs the moves of a subchain that starts at `theta`.
    ///
    /// # Arguments
    /// - `coarse`: the coarse model's predicted values at some parameters; `None` if it rejects them.
    ///
    /// # Returns
    /// The end; the start if the metamodel excludes it.
    ///
    /// # Errors
    /// [`LikelihoodError`] for predicted values that cannot be scored.
    ///
    /// Checked by `metamodel::the_posterior_is_that_of_the_fine_model`.
    pub fn run(
        &self,
        subchain: &Subchain,
        theta: &[f64],
        mut coarse: impl FnMut(&[f64]) -> Option<Vec<f64>>,
    ) -> Result<SubchainEnd, LikelihoodError> {
        let mut end = SubchainEnd {
            theta: theta.to_vec(),
            log_gain: 0.0,
            moves: 0,
            accepted: 0,
            scaled: 0,
            scaled_accepted: 0,
        };
        let mut coordinates = self.prior.coordinates(theta);
        let mut log_prior = self.prior.log_density_of_coordinates(&coordinates);
        let start = self.log_likelihood(theta, &coordinates, coarse(theta))?;
        if !(start.is_finite() && log_prior.is_finite()) {
            return Ok(end);
        }
        let mut log_likelihood = start;
        let stage = SUBCHAINS | self.stage as u64;
        let mut stream = Stream::new(self.seed, stage, subchain.chain, subchain.step);
        for _ in 0..self.moves {
            let log_uniform = libm::log(stream.uniform());
            let candidate = self.mixture.candidate(&coordinates, subchain.scale, &mut stream);
            end.moves += 1;
            end.scaled += u32::from(candidate.scaled);
            let its_prior = self.prior.log_density_of_coordinates(&candidate.coordinates);
            if its_prior == f64::NEG_INFINITY {
                continue;
            }
            let its_theta = self.prior.theta(&candidate.coordinates);
            let its = self.log_likelihood(&its_theta, &candidate.coordinates, coarse(&its_theta))?;
            let ratio =
                self.exponent * (its - log_likelihood) + (its_prior - log_prior) + candidate.log_correction;
            if log_uniform < ratio {
                end.accepted += 1;
                end.scaled_accepted += u32::from(candidate.scaled);
                (coordinates, end.theta) = (candidate.coordinates, its_theta);
                (log_prior, log_likelihood) = (its_prior, its);
            }
        }
        end.log_gain = log_likelihood - start;
        Ok(end)
    }
}

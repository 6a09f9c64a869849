//! The settings of the sampler, and their errors.

/// The algorithm that moves the population at an exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Algorithm {
    /// Every particle moves by several steps of a mixed, self-scaling proposal; the default.
    Tmcmc,
    /// The original sampler: each particle is one step of a chain that is as long as its leader's multiplicity.
    ///
    /// Ching & Chen 2007, doi:10.1061/(ASCE)0733-9399(2007)133:7(816). Kept because published calibrations used it. Its
    /// chains are too short to forget their start, so its runs are reported as not equilibrated.
    ChingChen2007,
    /// BASIS: every resampled particle takes one step of the original sampler's random walk.
    ///
    /// Wu, Angelikopoulos, Papadimitriou & Koumoutsakos 2018, ASCE-ASME J. Risk Uncertainty B 4:011008, doi:10.1115/1.4037450,
    /// with their chain length of 1. All chains are equally long, which removes the bias of the original sampler, and a stage
    /// takes one round. One step forgets even less than the original sampler's chains, so its runs are reported as not
    /// equilibrated.
    Basis,
}

impl Algorithm {
    /// Returns whether the population is every state of the chains, not their last states alone.
    pub(super) fn keeps_every_step(self) -> bool {
        matches!(self, Self::ChingChen2007 | Self::Basis)
    }
}

/// The method by which a stage of [`Algorithm::Tmcmc`] gets its particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StageMethod {
    /// Independent draws from a mixture fitted to the weighted draws of the last stage; the default.
    Draws,
    /// Metropolis-Hastings moves of the resampled particles.
    Moves,
    /// Draws on an emulator of the model's outputs, corrected by evaluations: [`EmulatedSampler`](crate::EmulatedSampler). A
    /// [`Sampler`](crate::Sampler), which knows log-likelihoods alone, draws from the model instead.
    Emulated,
}

/// Settings of a sampler.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TmcmcSettings {
    /// The algorithm of the stages.
    pub algorithm: Algorithm,
    /// The method by which a stage gets its particles ([`Algorithm::Tmcmc`] only).
    pub stages: StageMethod,
    /// Size of the population, and the number of draws in a stage.
    pub particles: usize,
    /// Maximum number of components of the mixture that proposes draws.
    pub components: usize,
    /// Minimum and maximum number of steps per particle and stage of moves ([`Algorithm::Tmcmc`] only).
    pub moves: [usize; 2],
    /// Seed of all random numbers.
    pub seed: u64,
    /// Coefficient of variation of the incremental weights by which moves choose the next exponent.
    pub target_cov: f64,
    /// Number of evaluations of a round that refines an emulator ([`StageMethod::Emulated`] only).
    pub batch: usize,
}

impl Default for TmcmcSettings {
    /// Returns TMCMC by draws, 1000 particles, at most 32 components, 10 to 60 moves, seed 1, coefficient of variation 1.
    fn default() -> Self {
        Self {
            algorithm: Algorithm::Tmcmc,
            stages: StageMethod::Draws,
            particles: 1000,
            components: 32,
            moves: [10, 60],
            seed: 1,
            target_cov: 1.0,
            batch: 12,
        }
    }
}

/// Maximum number of particles of a sample, and of draws of a normal approximation: at 310 bytes each, they take 31 MB.
pub const MAX_PARTICLES: usize = 100_000;
/// Minimum number of particles of a stage of draws, for each of d + 1 numbers: a fifth of them is the smallest effective sample
/// for a fit.
const DRAWN_PARTICLES: usize = 8;

/// A setting outside its bounds.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TmcmcSettingsError {
    /// The prior has no parameters.
    #[error("the prior has no parameters")]
    NoParameters,
    /// The population cannot span the parameter space.
    #[error("{particles} particles are too few for {dimension} parameters, which need at least {min}")]
    TooFewParticles {
        /// The particles as given.
        particles: usize,
        /// Number of parameters.
        dimension: usize,
        /// The smallest possible population.
        min: usize,
    },
    /// The population does not fit into memory.
    #[error("particles = {particles} must be at most {MAX_PARTICLES}")]
    TooManyParticles {
        /// The particles as given.
        particles: usize,
    },
    /// The moves are not 1 <= least <= most <= 10,000.
    #[error(
        "moves [{min}, {max}] are not 1 <= least <= most <= {}",
        TmcmcSettings::MAX_MOVES
    )]
    Moves {
        /// The minimum number of moves as given.
        min: usize,
        /// The maximum number of moves as given.
        max: usize,
    },
    /// The mixture has no components, or too many.
    #[error("components {value} is not 1 to {}", TmcmcSettings::MAX_COMPONENTS)]
    Components {
        /// The components as given.
        value: usize,
    },
    /// A round of evaluations has none, or too many.
    #[error("batch {value} is not 1 to {}", TmcmcSettings::MAX_BATCH)]
    Batch {
        /// The batch as given.
        value: usize,
    },
    /// The target coefficient of variation is not a finite number above 0.
    #[error("target_cov {value} is not a finite number above 0")]
    TargetCov {
        /// The coefficient as given.
        value: f64,
    },
}

impl TmcmcSettings {
    /// Largest number of components of a mixture: a fit takes time in proportion.
    pub const MAX_COMPONENTS: usize = 256;
    /// Largest number of evaluations of a round that refines an emulator.
    pub const MAX_BATCH: usize = 10_000;
    /// Largest number of moves in a stage.
    pub const MAX_MOVES: usize = 10_000;

    /// Returns whether the stages are drawn on an emulator.
    #[must_use]
    pub fn is_emulated(&self) -> bool {
        self.stages == StageMethod::Emulated
    }

    /// Returns whether stages of a problem of `dimension` parameters are drawn: small populations move from the start.
    pub(crate) fn draws(&self, dimension: usize) -> bool {
        self.stages != StageMethod::Moves
            && self.algorithm == Algorithm::Tmcmc
            && self.particles >= DRAWN_PARTICLES * (dimension + 1)
    }

    /// Checks the settings for a prior of `dimension` parameters; at least `2 dimension + 2` particles and at most
    /// [`MAX_PARTICLES`].
    ///
    /// # Errors
    /// [`TmcmcSettingsError`] with the setting and its bound.
    pub fn check(&self, dimension: usize) -> Result<(), TmcmcSettingsError> {
        let min = 2 * dimension + 2;
        let [min_moves, max_moves] = self.moves;
        if dimension == 0 {
            Err(TmcmcSettingsError::NoParameters)
        } else if self.particles < min {
            Err(TmcmcSettingsError::TooFewParticles {
                particles: self.particles,
                dimension,
                min,
            })
        } else if self.particles > MAX_PARTICLES {
            Err(TmcmcSettingsError::TooManyParticles {
                particles: self.particles,
            })
        } else if min_moves == 0 || min_moves > max_moves || max_moves > Self::MAX_MOVES {
            Err(TmcmcSettingsError::Moves {
                min: min_moves,
                max: max_moves,
            })
        } else if self.components == 0 || self.components > Self::MAX_COMPONENTS {
            Err(TmcmcSettingsError::Components {
                value: self.components,
            })
        } else if self.batch == 0 || self.batch > Self::MAX_BATCH {
            Err(TmcmcSettingsError::Batch { value: self.batch })
        } else if !(self.target_cov.is_finite() && self.target_cov > 0.0) {
            Err(TmcmcSettingsError::TargetCov {
                value: self.target_cov,
            })
        } else {
            Ok(())
        }
    }
}

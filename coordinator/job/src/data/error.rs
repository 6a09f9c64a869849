//! The error of measurements that cannot be fitted as the job and the experiment state.

use statistics::{LikelihoodError, PriorError};

/// Minimum number of repeats that a scatter is estimated from.
pub(crate) const MIN_FREEDOM: usize = 3;

/// A reason why measurements cannot be fitted as the job and the experiment state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum DataError {
    /// An inferred standard deviation has no parameter.
    #[error("{0} has no prior")]
    NoPrior(String),
    /// A prior for a noise sd that the experiment states.
    #[error("{name} has a prior, but the experiment does not say {key} = \"unknown\" under [noise]")]
    NotUnknown {
        /// Name of the parameter.
        name: String,
        /// The key of the experiment.
        key: String,
    },
    /// A prior for a noise sd that no fitted measurement has.
    #[error("{name} has a prior, but {nothing} needs it")]
    NotNeeded {
        /// Name of the parameter.
        name: String,
        /// The measurements that would need it.
        nothing: &'static str,
    },
    /// A measurement without a standard deviation.
    #[error(
        "[noise] {column} is missing: {column} of run \"{run}\" is measured, so its sd in {unit}, \"replicates\" or \"unknown\" must be given there"
    )]
    NoNoise {
        /// Column of the channel.
        column: &'static str,
        /// Name of the run.
        run: String,
        /// Unit of the channel.
        unit: &'static str,
    },
    /// A scatter from too few repeats.
    #[error(
        "[noise] {column} = \"replicates\": the fit runs repeat conditions only {freedom} times, at least {MIN_FREEDOM} repeats are needed"
    )]
    FewRepeats {
        /// Column of the channel.
        column: &'static str,
        /// Repeats beyond the first of each condition.
        freedom: usize,
    },
    /// A scatter of zero.
    #[error("[noise] {0} = \"replicates\": all repeats are equal")]
    EqualRepeats(&'static str),
    /// No measurement to fit.
    #[error("no fit run has a measured channel: there is nothing to fit")]
    NothingToFit,
    /// The job fits histories, but no fitted run has a recorded transient.
    #[error(
        "[likelihood] histories = true, but no fit run has a recorded sinkage above 0 m and travels at least 1.5 lengths of its contact between [protocol] slip_begins_m and measured_transient_s"
    )]
    NoTransients,
    /// The readings of plates or rings have no scatter.
    #[error("readings without noise")]
    NoScatter,
    /// A reading of zero.
    #[error(
        "test \"{test}\": {stress} {stress_pa} Pa at {displacement} {displacement_m} m has no logarithm: both must be > 0, or leave the reading blank"
    )]
    NoLogarithm {
        /// Name of the test.
        test: String,
        /// Column of the stress.
        stress: &'static str,
        /// The stress `[Pa]`.
        stress_pa: f64,
        /// Column of the sinkage or shear displacement.
        displacement: &'static str,
        /// The displacement `[m]`.
        displacement_m: f64,
    },
    /// A transfer from rings without rings.
    #[error("{0} is given, but the experiment has no measured reading of a ring")]
    NoRing(&'static str),
    /// A shear modulus of one wheel beside a ring.
    #[error("{0} belongs to one wheel: a ring feels janosi_hanamoto.shear_modulus_m, which all share")]
    ModulusOfOneWheel(String),
    /// The prior of the transfer from rings.
    #[error(transparent)]
    Prior(#[from] PriorError),
    /// The likelihood refuses its data.
    #[error(transparent)]
    Likelihood(#[from] LikelihoodError),
}

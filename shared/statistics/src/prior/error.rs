//! Errors of priors.

/// Why a marginal or a correlation is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PriorError {
    /// A number of the distribution or of the bounds is NaN or infinite.
    #[error("{name} {value} is not a finite number")]
    NotFinite {
        /// Name of the number.
        name: &'static str,
        /// The refused value.
        value: f64,
    },
    /// A number must lie above a bound and does not.
    #[error("{name} {value} is not above {bound}")]
    TooSmall {
        /// Name of the number.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// The bound that the number must exceed.
        bound: f64,
    },
    /// A lower end is not below its upper end.
    #[error("lower bound {lower} is not below upper bound {upper}")]
    EmptyInterval {
        /// Lower end.
        lower: f64,
        /// Upper end.
        upper: f64,
    },
    /// The bounds reach outside the distribution's support.
    #[error("bounds [{lower}, {upper}] reach outside the support [{support_lower}, {support_upper}]")]
    OutsideSupport {
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
        /// Lower end of the support.
        support_lower: f64,
        /// Upper end of the support.
        support_upper: f64,
    },
    /// A correlated parameter is not normal, or truncated.
    #[error(
        "parameter {parameter} has a correlation: its marginal must be normal in its sampling coordinate, without bounds"
    )]
    NotNormal {
        /// Position of the parameter.
        parameter: usize,
    },
    /// The correlations are not a positive definite matrix with ones on the diagonal and a row for each parameter.
    #[error("the correlations are not a positive definite, symmetric matrix with ones on its diagonal")]
    NotACorrelation,
    /// The distribution has no probability between the bounds.
    #[error("bounds [{lower}, {upper}] hold no probability")]
    NoMass {
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
    },
}

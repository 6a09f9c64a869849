//! `ResponseSurfaceError`: reasons why draws do not determine a response surface.

/// The reason why draws do not determine a response surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ResponseSurfaceError {
    /// There are fewer draws than the polynomial needs.
    #[error(
        "response surface of {parameters} parameters: {draws} draws with outputs, at least {needed} are needed"
    )]
    TooFewDraws {
        /// Number of parameters.
        parameters: usize,
        /// Number of distinct draws with outputs.
        draws: usize,
        /// Smallest number of draws.
        needed: usize,
    },
    /// The draws lie in a plane, or too few of them differ.
    #[error("response surface: the draws do not vary independently in all of the {parameters} parameters")]
    Dependent {
        /// Number of parameters.
        parameters: usize,
    },
}

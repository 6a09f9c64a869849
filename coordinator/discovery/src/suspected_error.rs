//! Errors that runs may share beyond those of the likelihood.

/// An error that runs may share, which is not part of the likelihood.
#[derive(Debug, Clone, PartialEq)]
pub struct SuspectedError {
    /// The data of each group that shares an error, ascending.
    pub groups: Vec<Vec<usize>>,
    /// What the error does to its data.
    pub shift: SuspectedShift,
    /// Scale of the half-normal prior of its sd: relative, or in the unit of the data.
    pub prior_scale: f64,
}

/// What a suspected error does to its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SuspectedShift {
    /// It shifts them by an offset.
    Offset,
    /// It multiplies them.
    Factor,
}

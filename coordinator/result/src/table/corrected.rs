//! A prediction corrected by what the model misses.

/// A prediction with the discrepancy that the fitted conditions show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corrected {
    /// Mean of the model, and of the discrepancy [channel's unit].
    pub mean: f64,
    /// 5 % and 95 % quantile of a new measurement; `None` of a fit, which has no distribution.
    pub interval: Option<[f64; 2]>,
}

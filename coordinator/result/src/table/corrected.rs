//! A corrected prediction: the model's value plus its discrepancy.

/// A prediction plus the discrepancy that is interpolated from the fitted conditions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corrected {
    /// Mean of model plus discrepancy [channel's unit].
    pub mean: f64,
    /// 5 % and 95 % quantile of a new measurement; `None` for a fit, which has no distribution.
    pub interval: Option<[f64; 2]>,
}

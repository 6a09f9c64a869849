//! An interpolated measurement, and the conditions that it is interpolated over.

/// A holdout measurement interpolated from the fitted ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpolated {
    /// The value [channel's unit].
    pub value: f64,
    /// Conditions that it is interpolated over.
    pub over: InterpolatedOver,
}

/// Conditions that a measurement is interpolated over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InterpolatedOver {
    /// Slip, between runs that differ in slip only.
    Slip,
    /// All conditions that vary, within their ranges.
    Conditions,
    /// All conditions that vary, beyond the range of one of them.
    Extrapolation,
}

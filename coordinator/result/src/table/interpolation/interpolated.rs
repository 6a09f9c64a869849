//! A measurement as interpolated from others.

/// A held-out measurement as interpolated from the fitted ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpolated {
    /// The value [channel's unit].
    pub value: f64,
    /// What it is interpolated over.
    pub over: InterpolatedOver,
}

/// What a measurement is interpolated over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InterpolatedOver {
    /// Slip, between runs that differ in slip alone.
    Slip,
    /// All conditions that vary, within their ranges.
    Conditions,
    /// The same beyond the range of one of them.
    Extrapolation,
}

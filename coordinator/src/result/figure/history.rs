//! Measurement and model over time: the source paper's Fig. 7.

/// A channel of a run over time.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct History {
    /// Name of the run.
    pub run: String,
    /// Channel without unit.
    pub channel: String,
    /// Unit of the values.
    pub unit: String,
    /// Measured.
    pub measured: Series,
    /// Computed, at one or more points.
    pub model: Vec<ModelHistory>,
}

/// What the model gives over time at one point.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct ModelHistory {
    /// The point: `maximum likelihood`, `GA optimum`.
    pub label: String,
    /// Times `[s]`.
    pub t_s: Vec<f64>,
    /// Values at these times.
    pub value: Vec<f64>,
}

/// Values over time.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Series {
    /// Times `[s]`.
    pub t_s: Vec<f64>,
    /// Values at these times.
    pub value: Vec<f64>,
}

//! Marks: single labelled points in the figures of distributions.

/// Kind of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum MarkKind {
    /// Posterior mean.
    Mean,
    /// Draw with the highest likelihood.
    MaximumLikelihood,
    /// Result of a fit or a search.
    PointEstimate,
    /// Reference value of an independent test.
    Reference,
}

/// A labelled point.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Mark<T> {
    /// Kind of the mark.
    pub kind: MarkKind,
    /// Label in the figure.
    pub label: String,
    /// Coordinates of the mark.
    pub at: T,
}

/// A point in the plane of two parameters; a coordinate is null if only the other is known.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct PlanePoint {
    /// Horizontal coordinate.
    pub x: Option<f64>,
    /// Vertical coordinate.
    pub y: Option<f64>,
}

impl From<[Option<f64>; 2]> for PlanePoint {
    fn from([x, y]: [Option<f64>; 2]) -> Self {
        PlanePoint { x, y }
    }
}

impl<T> Mark<T> {
    pub(super) fn new(kind: MarkKind, label: impl Into<String>, at: T) -> Self {
        let label = label.into();
        Mark { kind, label, at }
    }
}

//! Single points in pictures of distributions.

/// Kind of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum MarkKind {
    /// Mean over the posterior.
    Mean,
    /// The draw of the highest likelihood.
    MaximumLikelihood,
    /// Result of a fit or a search.
    PointEstimate,
    /// Reference value of an independent test.
    Reference,
}

/// A point with its name.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Mark<T> {
    /// Its kind.
    pub kind: MarkKind,
    /// Its name for people.
    pub label: String,
    /// Its coordinates.
    pub at: T,
}

/// A place in a plane; a coordinate is null where only the other is known.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct PlanePoint {
    /// Horizontal.
    pub x: Option<f64>,
    /// Vertical.
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

//! The pose of the wheel: its place, and the columns of the terrain that it may touch.

/// The place of the wheel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose {
    /// x and y of the hub `[m]`.
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Angle by which the wheel has turned forwards `[rad]`.
    pub(crate) turned: f64,
}

/// Columns that may touch soil: from the rearmost to beyond the foremost.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    pub(crate) start: usize,
    pub(crate) end: usize,
}

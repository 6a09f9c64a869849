//! Dimensions of the wheel and the rig.

/// The dimensions of the wide wheel, and the radius with which the rig turns rim speed into slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelSize {
    pub radius_m: f64,
    pub width_m: f64,
    pub rig_radius_m: f64,
}

impl WheelSize {
    /// The size of the wheel in every simulation.
    pub const TRUE: Self = Self {
        radius_m: 0.125,
        width_m: 0.112,
        rig_radius_m: 0.125,
    };
}

//! Velocity of the wheel's surface against the soil, and direction of the shear stress.

use super::super::pack::{Pack, splat};
use super::envelope::Facet;
use crate::shear::ShearVelocity;
use crate::{Condition, Wheel};

/// Motion of the hub over the soil and rotation of the wheel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    /// Velocity along the heading, v cos(beta) `[m/s]`.
    pub(crate) forward: f64,
    /// Velocity across the heading, v sin(beta) `[m/s]`.
    pub(crate) lateral: f64,
    /// Angular velocity omega `[rad/s]`, from the rig's radius.
    pub(crate) rotation: f64,
}

/// Force on the wheel per projected area, for unit pressure and for unit mobilised strength.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Traction {
    /// Height of the hub above the point `[m]`.
    pub(crate) rise: f64,
    pub(crate) pressure_x: f64,
    pub(crate) pressure_y: f64,
    pub(crate) shear_x: f64,
    pub(crate) shear_y: f64,
    pub(crate) shear_z: f64,
    /// Slip velocity `|v_t|` `[m/s]`.
    pub(crate) slip_speed: f64,
}

impl Traction {
    /// Packs one number of four lanes.
    #[inline]
    pub(crate) fn from_lanes(lanes: &[Traction], field: fn(&Traction) -> f64) -> Pack {
        Pack::new([
            field(&lanes[0]),
            field(&lanes[1]),
            field(&lanes[2]),
            field(&lanes[3]),
        ])
    }
}

impl Motion {
    pub(crate) fn new(wheel: &Wheel, condition: &Condition) -> Self {
        let v = condition.sled_speed_m_s;
        Self {
            forward: v * libm::cos(condition.slip_angle_rad),
            lateral: v * libm::sin(condition.slip_angle_rad),
            rotation: condition.rig_rim_speed_m_s() / wheel.rig_radius_m,
        }
    }

    /// Returns the velocity of a point of the wheel's surface over the soil, with the hub at constant height `[m/s]`.
    #[inline]
    pub(crate) fn surface_velocity(&self, ahead: f64, rise: f64) -> [f64; 3] {
        [
            self.forward - self.rotation * rise,
            self.lateral,
            -self.rotation * ahead,
        ]
    }

    /// Returns the velocity into the soil along the normal of four lanes of the wheel's surface, with the hub at
    /// constant height; negative if the surface leaves the soil `[m/s]`.
    pub(crate) fn entry_velocity(&self, ahead: f64, facet: &Facet) -> Pack {
        let (rise, one) = (facet.rise, splat(1.0));
        let x = splat(self.forward) - splat(self.rotation) * rise;
        let stretch = (one + facet.slope_x * facet.slope_x + facet.slope_y * facet.slope_y).sqrt();
        let out = splat(-self.rotation * ahead) - facet.slope_x * x - facet.slope_y * splat(self.lateral);
        -out / stretch
    }

    /// Returns the directions of pressure and shear at a point `ahead` of the hub and `rise` below it, where the
    /// wheel's surface has slopes (dh/dx, dh/dy).
    #[inline]
    pub(crate) fn traction(&self, law: &ShearVelocity, ahead: f64, rise: f64, slope: [f64; 2]) -> Traction {
        let [slope_x, slope_y] = slope;
        let velocity = self.surface_velocity(ahead, rise);
        let stretch_squared = 1.0 + slope_x * slope_x + slope_y * slope_y; // surface per projected area, squared
        // velocity along the upward normal (−dh/dx, −dh/dy, 1), times the normal's length
        let normal = (velocity[2] - slope_x * velocity[0] - slope_y * velocity[1]) / stretch_squared;
        let along = [
            velocity[0] + normal * slope_x,
            velocity[1] + normal * slope_y,
            velocity[2] - normal,
        ];
        let speed = (along[0] * along[0] + along[1] * along[1] + along[2] * along[2]).sqrt();
        let against = -law.mobilised_per_velocity(speed) * stretch_squared.sqrt();
        Traction {
            rise,
            pressure_x: -slope_x,
            pressure_y: -slope_y,
            shear_x: against * along[0],
            shear_y: against * along[1],
            shear_z: against * along[2],
            slip_speed: speed,
        }
    }
}

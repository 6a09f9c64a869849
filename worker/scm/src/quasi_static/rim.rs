//! Integrate the soil's stresses over the rim.

use super::kinematics::RimMotion;
use crate::elementary::fraction_pow;
use crate::footprint::rectangle_effective_width;
use crate::pressure_distribution::{PressureDistribution, RectangleDistribution};
use crate::pressure_sinkage::{k_star, pressure};
use crate::quadrature::{NODES, PLACE, WEIGHT, place_from_end};
use crate::shear::{ShearVelocity, strength};
use crate::{Condition, Soil, Wheel};

/// Everything about a run that does not depend on how deep the wheel stands.
#[derive(Debug, Clone)]
pub(super) struct Rim {
    pub(super) soil: Soil,
    pub(super) radius: f64,
    pub(super) width: f64,
    pub(super) tan_friction_angle: f64,
    pub(super) motion: RimMotion,
    law: PressureDistribution,
    shear: ShearVelocity,
    /// x at which the slip velocity changes sign; infinite if it does not.
    sign_change: f64,
}

/// Force and torque of the soil on the rim at one contact length, with the contact that caused them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reaction {
    pub(super) load_from_pressure: f64,
    pub(super) load_from_shear: f64,
    pub(super) drawbar_pull: f64,
    pub(super) torque: f64,
    pub(super) lateral_force: f64,
    pub(super) sinkage: f64,
    pub(super) contact_length: f64,
    pub(super) b_eff: f64,
    pub(super) k_star: f64,
    pub(super) nodes: u32,
}

impl Reaction {
    /// Vertical force of the soil on the wheel `[N]`.
    pub(super) fn load(&self) -> f64 {
        self.load_from_pressure + self.load_from_shear
    }
}

/// The contact at one length: what its panels share.
struct Contact {
    length: f64,
    /// Height of the hub above the undisturbed surface, R − z.
    hub_height: f64,
    /// Pressure that gamma = 1 would give at the lowest point.
    pressure_at_bottom: f64,
    gamma: RectangleDistribution,
}

impl Rim {
    pub(super) fn new(soil: &Soil, wheel: &Wheel, condition: &Condition) -> Self {
        let motion = RimMotion::new(wheel, condition);
        Self {
            soil: *soil,
            radius: wheel.radius_m,
            width: wheel.width_m,
            tan_friction_angle: libm::tan(soil.friction_angle_rad),
            motion,
            law: PressureDistribution::new(soil.gamma_exponent),
            shear: ShearVelocity::new(soil.shear_velocity_m_s),
            sign_change: motion
                .sign_change()
                .map_or(f64::INFINITY, |sin_theta| wheel.radius_m * sin_theta),
        }
    }

    /// The soil's force on the rim when the contact reaches a length of 0 < l ≤ R ahead of the axle.
    ///
    /// Where k* ≤ 0 there is no support: all forces are zero, and so can balance no load.
    pub(super) fn react(&self, contact_length: f64) -> Reaction {
        let (radius, length) = (self.radius, contact_length);
        let hub_height = ((radius - length) * (radius + length)).sqrt();
        let sinkage = length * length / (radius + hub_height); // R − hub_height without cancellation
        let b_eff = rectangle_effective_width(length, self.width);
        let mut reaction = Reaction {
            load_from_pressure: 0.0,
            load_from_shear: 0.0,
            drawbar_pull: 0.0,
            torque: 0.0,
            lateral_force: 0.0,
            sinkage,
            contact_length,
            b_eff,
            k_star: k_star(&self.soil, b_eff),
            nodes: 0,
        };
        if reaction.k_star <= 0.0 {
            return reaction;
        }
        let contact = Contact {
            length,
            hub_height,
            pressure_at_bottom: pressure(reaction.k_star, sinkage, self.soil.n),
            gamma: RectangleDistribution::new(self.law, length, 0.5 * self.width),
        };
        let (ends, panels) = self.panel_ends(length);
        for panel in 0..panels {
            self.add_panel(&contact, ends[panel], ends[panel + 1], &mut reaction);
        }
        reaction
    }

    /// Ends of the panels from rear to front, and how many panels there are.
    fn panel_ends(&self, length: f64) -> ([f64; 5], usize) {
        let mut ends = [0.0; 5];
        let mut panels = if length <= self.width {
            ends[1] = 0.5 * length; // gamma has a ridge halfway
            2
        } else {
            ends[1] = 0.5 * self.width; // gamma has a plateau where the sides are nearer than the ends
            ends[2] = length - 0.5 * self.width;
            3
        };
        ends[panels] = length;
        if self.sign_change < length {
            let mut place = panels;
            while ends[place] > self.sign_change {
                ends[place + 1] = ends[place];
                place -= 1;
            }
            ends[place + 1] = self.sign_change;
            panels += 1;
        }
        (ends, panels)
    }

    /// Add the forces on one panel. Stages are loops over the panel's nodes, so that each vectorises.
    #[inline]
    fn add_panel(&self, contact: &Contact, start: f64, end: f64, sum: &mut Reaction) {
        let (radius, extent, ahead) = (self.radius, end - start, contact.length - end);
        let (per_length, per_radius) = (1.0 / contact.length, 1.0 / radius);

        // Place on the rim, and sinkage there relative to that of the lowest point.
        let mut cos_theta = [0.0; NODES];
        let mut secant = [0.0; NODES];
        let mut tan_theta = [0.0; NODES];
        let mut relative_sinkage = [0.0; NODES];
        let mut from_end = [0.0; NODES];
        for i in 0..NODES {
            let x = start + extent * PLACE[i];
            let to_front = ahead + extent * place_from_end(i);
            let height = ((radius - x) * (radius + x)).sqrt();
            let per_height = 1.0 / height;
            cos_theta[i] = height * per_radius;
            secant[i] = radius * per_height;
            tan_theta[i] = x * per_height;
            from_end[i] = if x < to_front { x } else { to_front };
            // (height − hub_height) / z as a product: exact where the sinkage goes to zero
            let parabola = to_front * per_length * (1.0 + x * per_length);
            relative_sinkage[i] = parabola * (radius + contact.hub_height) / (height + contact.hub_height);
        }

        // Normal pressure.
        let mut pressure = contact.gamma.gamma(from_end);
        for i in 0..NODES {
            pressure[i] *= contact.pressure_at_bottom * fraction_pow(relative_sinkage[i], self.soil.n);
        }

        // Shear stress along and across the rim.
        let mut along = [0.0; NODES];
        let mut across = [0.0; NODES];
        for i in 0..NODES {
            let tangential = self.motion.tangential(cos_theta[i]);
            let lateral = self.motion.lateral;
            let speed = (tangential * tangential + lateral * lateral).sqrt();
            let limit = strength(self.soil.cohesion_pa, self.tan_friction_angle, pressure[i]);
            let per_velocity = limit * self.shear.mobilised_per_velocity(speed);
            along[i] = per_velocity * tangential;
            across[i] = per_velocity * lateral;
        }

        // Forces, from rear to front.
        let scale = self.width * extent;
        for i in 0..NODES {
            let area = scale * WEIGHT[i];
            let surface = area * secant[i];
            sum.load_from_pressure += pressure[i] * area;
            sum.load_from_shear += along[i] * tan_theta[i] * area;
            sum.drawbar_pull += (along[i] - pressure[i] * tan_theta[i]) * area;
            sum.torque += along[i] * radius * surface;
            sum.lateral_force += across[i] * surface;
        }
        sum.nodes += NODES as u32;
    }
}

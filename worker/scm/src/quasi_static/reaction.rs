//! The soil's stresses, integrated over the rim.

use super::panel::{Contact, Panel};
use super::rim::Rim;
use crate::footprint::rectangle_effective_width;
use crate::pressure_distribution::RectangleDistribution;
use crate::pressure_sinkage::{k_star, pressure};
use crate::quadrature::NODES;
use crate::shear::strength;

/// Force and torque of the soil on the rim at one contact length, with the contact that caused them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Reaction {
    pub(super) load_from_pressure: f64,
    pub(super) load_from_shear: f64,
    pub(super) drawbar_pull: f64,
    pub(super) torque: f64,
    pub(super) lateral_force: f64,
    pub(super) sinkage: f64,
    /// Length of the contact ahead of the axle, and its whole length.
    pub(super) contact_length: f64,
    pub(super) footprint_length: f64,
    pub(super) b_eff: f64,
    pub(super) k_star: f64,
    pub(super) nodes: u32,
    /// Excess of the load that the soil must carry over the nominal one, if it depends on the reaction.
    pub(super) extra_load: f64,
}

impl Reaction {
    /// Returns the vertical force of the soil on the wheel, less the extra load `[N]`.
    pub(super) fn load(&self) -> f64 {
        self.load_from_pressure + self.load_from_shear - self.extra_load
    }

    /// Adds the forces on one panel, from rear to front.
    #[inline(always)]
    pub(super) fn add(&mut self, rim: &Rim, panel: &Panel, along: &[f64; NODES], across: &[f64; NODES]) {
        for i in 0..NODES {
            let area = panel.area(rim, i);
            let surface = area * panel.secant[i];
            let pressure = panel.pressure[i];
            self.load_from_pressure += pressure * area;
            self.load_from_shear += along[i] * panel.tan_theta[i] * area;
            self.drawbar_pull += (along[i] - pressure * panel.tan_theta[i]) * area;
            self.torque += along[i] * panel.arm * surface;
            self.lateral_force += across[i] * surface;
        }
        self.nodes += NODES as u32;
    }

    /// Returns the contact without any force of the soil.
    pub(super) fn unloaded(&self) -> Self {
        Self {
            load_from_pressure: 0.0,
            load_from_shear: 0.0,
            drawbar_pull: 0.0,
            torque: 0.0,
            lateral_force: 0.0,
            extra_load: 0.0,
            ..*self
        }
    }

    /// Interpolates the reaction in balance between two that carry less and more than the load at the same contact: a law
    /// jumps within the weight of one node of the quadrature.
    pub(super) fn shared_with(&self, above: &Self, load: f64) -> Self {
        let share = (load - self.load()) / (above.load() - self.load());
        let between = |a: f64, b: f64| a + share * (b - a);
        Self {
            load_from_pressure: between(self.load_from_pressure, above.load_from_pressure),
            load_from_shear: between(self.load_from_shear, above.load_from_shear),
            drawbar_pull: between(self.drawbar_pull, above.drawbar_pull),
            torque: between(self.torque, above.torque),
            lateral_force: between(self.lateral_force, above.lateral_force),
            extra_load: between(self.extra_load, above.extra_load),
            ..*self
        }
    }
}

impl Rim {
    /// Returns the soil's force on the base's rim when the contact reaches a length of 0 < l ≤ R ahead of the axle.
    ///
    /// If k* ≤ 0 there is no support: all forces are zero and cannot balance a load.
    pub(super) fn react(&self, contact_length: f64) -> Reaction {
        let (radius, length) = (self.radius, contact_length);
        let hub_height = ((radius - length) * (radius + length)).sqrt();
        let sinkage = length * length / (radius + hub_height); // R − hub_height without cancellation
        let b_eff = rectangle_effective_width(length, self.width);
        let mut reaction = Reaction {
            sinkage,
            contact_length,
            footprint_length: contact_length,
            b_eff,
            k_star: k_star(&self.soil, b_eff),
            ..Reaction::default()
        };
        if reaction.k_star <= 0.0 {
            return reaction;
        }
        let contact = Contact {
            front: length,
            rear: 0.0,
            hub_height,
            sinkage,
            round_to_lowest: 1.0,
            pressure_at_bottom: pressure(reaction.k_star, sinkage, self.soil.n),
            gamma: RectangleDistribution::new(self.law, length, 0.5 * self.width),
        };
        let (ends, panels) = self.panel_ends(length);
        for panel in 0..panels {
            self.add_panel(&contact, ends[panel], ends[panel + 1], &mut reaction);
        }
        reaction
    }

    /// Returns the ends of the panels from rear to front, and how many panels there are.
    pub(super) fn panel_ends(&self, length: f64) -> ([f64; 5], usize) {
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

    /// Adds the forces on one panel.
    #[inline]
    fn add_panel(&self, contact: &Contact, start: f64, end: f64, sum: &mut Reaction) {
        let mut panel = Panel::default();
        panel.on_arc(self, contact, start, end);
        // Shear stress along and across the rim.
        let mut along = [0.0; NODES];
        let mut across = [0.0; NODES];
        for i in 0..NODES {
            let limit = strength(self.soil.cohesion_pa, self.tan_friction_angle, panel.pressure[i]);
            let per_velocity = limit * self.shear.mobilised_per_velocity(panel.speed[i]);
            along[i] = per_velocity * panel.tangential[i];
            across[i] = per_velocity * self.motion.lateral;
        }
        sum.add(self, &panel, &along, &across);
    }
}

//! Nodes of the quadrature on a piece of the rim: their places, motion and pressure.

use super::rim::Rim;
use crate::elementary::fraction_pow;
use crate::pressure_distribution::RectangleDistribution;
use crate::quadrature::{NODES, PLACE, WEIGHT, place_from_end};
use crate::wong_reece::Peak;

/// The contact at one trial, shared by its panels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// x of the front end, and of the rear end with its sign changed `[m]`.
    pub(super) front: f64,
    pub(super) rear: f64,
    /// Height of the hub above the undisturbed surface `[m]`.
    pub(super) hub_height: f64,
    /// Sinkage of the lowest part of the rim `[m]`, and the sinkage of a round rim's lowest point relative to it.
    pub(super) sinkage: f64,
    pub(super) round_to_lowest: f64,
    /// Pressure at the lowest part for gamma = 1 `[Pa]`.
    pub(super) pressure_at_bottom: f64,
    pub(super) gamma: RectangleDistribution,
}

/// The nodes of one panel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Panel {
    /// Place ahead of the axle `[m]`.
    pub(super) x: [f64; NODES],
    /// Length of the panel along the ground `[m]`.
    pub(super) extent: f64,
    /// Distance from the axle at which shear stress turns the wheel `[m]`.
    pub(super) arm: f64,
    /// Ratio of surface to projected area, and slope of the rim.
    pub(super) secant: [f64; NODES],
    pub(super) tan_theta: [f64; NODES],
    /// Sinkage relative to that of the lowest part.
    pub(super) relative_sinkage: [f64; NODES],
    /// Slip velocity along the rim, and its magnitude with the lateral part `[m/s]`.
    pub(super) tangential: [f64; NODES],
    pub(super) speed: [f64; NODES],
    /// Normal pressure `[Pa]`.
    pub(super) pressure: [f64; NODES],
    /// Working memory for the shear stress `[Pa]`.
    pub(super) shear: [f64; NODES],
}

impl Panel {
    /// Lays the nodes on a piece of the round rim ahead of the lowest part. Stages are loops over the nodes, so that
    /// each vectorises.
    #[inline(always)]
    pub(super) fn on_arc(&mut self, rim: &Rim, contact: &Contact, start: f64, end: f64) {
        self.place(rim, contact, start, end);
        for i in 0..NODES {
            self.pressure[i] *=
                contact.pressure_at_bottom * fraction_pow(self.relative_sinkage[i], rim.soil.n);
        }
    }

    /// Lays the nodes on a piece of the round rim with the pressure peak ahead of the axle: behind the peak the
    /// effective depth differs.
    pub(super) fn about(&mut self, rim: &Rim, contact: &Contact, start: f64, end: f64, peak: &Peak) {
        self.place(rim, contact, start, end);
        for i in 0..NODES {
            let depth = if self.x[i] < peak.x {
                peak.relative_depth(self.x[i])
            } else {
                self.relative_sinkage[i]
            };
            self.pressure[i] *= contact.pressure_at_bottom * fraction_pow(depth, rim.soil.n);
        }
    }

    /// Lays the nodes on a piece of the round rim behind the lowest part, where the soil springs back by a height `[m]`
    /// and unloads linearly.
    pub(super) fn behind(&mut self, rim: &Rim, contact: &Contact, start: f64, end: f64, recovered: f64) {
        self.place(rim, contact, start, end);
        for i in 0..NODES {
            let risen = contact.sinkage * (1.0 - self.relative_sinkage[i]);
            self.pressure[i] *= contact.pressure_at_bottom * (1.0 - risen / recovered).max(0.0);
        }
    }

    /// Lays the nodes on a piece of the rim that is flat at a distance from the axle `[m]`.
    pub(super) fn on_flat(&mut self, rim: &Rim, contact: &Contact, start: f64, end: f64, distance: f64) {
        self.place(rim, contact, start, end);
        let tangential = rim.motion.rim_speed * (distance / rim.radius) - rim.motion.forward;
        let speed = (tangential * tangential + rim.motion.lateral * rim.motion.lateral).sqrt();
        for i in 0..NODES {
            self.pressure[i] *= contact.pressure_at_bottom;
        }
        self.arm = distance;
        self.secant = [1.0; NODES];
        self.tan_theta = [0.0; NODES];
        self.relative_sinkage = [1.0; NODES];
        self.tangential = [tangential; NODES];
        self.speed = [speed; NODES];
    }

    /// Places nodes on the round rim, with gamma in place of the pressure.
    #[inline(always)]
    pub(super) fn place(&mut self, rim: &Rim, contact: &Contact, start: f64, end: f64) {
        let (radius, extent, ahead) = (rim.radius, end - start, contact.front - end);
        let (per_length, per_radius) = (1.0 / contact.front, 1.0 / radius);
        (self.extent, self.arm) = (extent, radius);
        let mut from_end = [0.0; NODES];
        for i in 0..NODES {
            let x = start + extent * PLACE[i];
            let to_front = ahead + extent * place_from_end(i);
            let to_rear = x + contact.rear;
            let height = ((radius - x) * (radius + x)).sqrt();
            let per_height = 1.0 / height;
            self.x[i] = x;
            self.secant[i] = radius * per_height;
            self.tan_theta[i] = x * per_height;
            from_end[i] = if to_rear < to_front { to_rear } else { to_front };
            // (height − hub_height) / z is written as a product, which is exact where the sinkage goes to zero.
            let parabola = to_front * per_length * (1.0 + x * per_length) * contact.round_to_lowest;
            self.relative_sinkage[i] =
                parabola * (radius + contact.hub_height) / (height + contact.hub_height);
            let tangential = rim.motion.tangential(height * per_radius);
            let lateral = rim.motion.lateral;
            self.tangential[i] = tangential;
            self.speed[i] = (tangential * tangential + lateral * lateral).sqrt();
        }
        self.pressure = contact.gamma.gamma(from_end);
    }

    /// Returns the projected area of a node `[m²]`.
    #[inline(always)]
    pub(super) fn area(&self, rim: &Rim, node: usize) -> f64 {
        rim.width * self.extent * WEIGHT[node]
    }
}

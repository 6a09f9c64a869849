//! Formulas that only scale the shear stress, evaluated once per step.

use formula::block::BLOCK;
use formula::{Hook, Variable};

use super::super::super::pack::{PACK, load, splat, store};
use super::super::super::wheel::motion::Traction;
use super::super::Contact;
use super::{NodeFormulas, Point};

impl NodeFormulas<'_> {
    /// Scales the tractions of the strips that touch at a height and are not scaled yet; returns whether that is possible
    /// wherever a node may carry load.
    pub(super) fn scale_down_to(&mut self, contact: &mut Contact, hub: f64) -> bool {
        let packs = contact.across.packs();
        // if lanes are alike, one pack represents the strip
        let distinct = contact.lanes_differ || self.laws.use_variable(Variable::J);
        let (each, alike) = if distinct { (packs, 1) } else { (1, packs) };
        let above = self.scaled_down_to;
        self.scaled_down_to = hub.min(above);
        let mut fine = true;
        for row in 0..contact.strips.len() {
            if contact.highest[row] <= hub || contact.highest[row] > above {
                continue;
            }
            for pack in 0..each {
                let (quad, at) = (row * packs + pack, self.points.len() * PACK);
                self.see_motion(quad, at);
                store(self.laws.block.column_mut(Variable::Tau), at, splat(1.0));
                self.points.push(Point { quad, bears: 0 });
                if at + PACK == BLOCK {
                    fine &= self.scale(contact, alike);
                }
            }
        }
        fine & self.scale(contact, alike)
    }

    /// Scales the tractions of the current quads, each of which represents a number of identical ones.
    fn scale(&mut self, contact: &mut Contact, alike: usize) -> bool {
        let points = core::mem::take(&mut self.points);
        let mut fine = self.apply(Hook::Shear, &points).is_ok(); // the loaded nodes are not known yet
        let column = self.laws.block.column(Variable::Tau);
        for (i, point) in points.iter().enumerate() {
            let scales = &column[i * PACK..][..PACK];
            fine &= scales.iter().all(|scale| (0.0..=f64::MAX).contains(scale));
            let scale = load(scales, 0);
            for quad in point.quad..point.quad + alike {
                self.nodes[quad].scale = scale;
                contact.quads[quad].shear_z *= scale;
            }
        }
        self.points = points;
        self.points.clear();
        fine
    }
}

impl Contact {
    /// Computes the vertical shear forces from the base's tractions.
    pub(super) fn find_vertical_shears(&mut self) {
        let packs = self.across.packs();
        for (place, quad) in self.quads.iter_mut().enumerate() {
            quad.shear_z = if self.lanes_differ {
                Traction::from_lanes(&self.tractions[place * PACK..][..PACK], |t| t.shear_z)
            } else {
                splat(self.tractions[place / packs].shear_z)
            };
        }
    }
}

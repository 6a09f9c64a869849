//! Slip digging: the sliding wheel carries soil away from under itself.

use super::super::contact::Contact;
use super::super::pack::{PACK, load, splat, store};
use super::Terrain;

impl Terrain {
    /// Allocates the dug depths.
    pub(crate) fn make_diggable(&mut self) {
        self.dug = vec![0.0; self.surface.len()];
    }

    /// Returns whether the wheel digs here.
    #[inline]
    pub(crate) fn is_dug(&self) -> bool {
        !self.dug.is_empty()
    }
}

impl Contact {
    /// Lowers the reference surface of the nodes in contact while the wheel slides over them for a time.
    ///
    /// `dz_ref = (d / l) |v_t| dt`: over one passage of a contact of length l at the sled's speed v that is `d |v_t| / v`,
    /// the quasi-static model's added sinkage `d s / (1 − s)`, which thus builds up from the front of the contact to its
    /// rear. Only the depth in Bekker's law changes here. The surface follows because softer soil yields: it is lowered, and
    /// a share flows away, as for all yielding soil, so that volume is conserved. Checked by
    /// `rolling::tests::the_soil_that_does_not_compact_is_all_there` and `spatial::effects::digging_deepens_…`.
    ///
    /// # Arguments
    /// - `depth`: d `[m]`, ≥ 0; `contact_length`: l `[m]`, > 0; `time` `[s]`.
    pub(crate) fn dig(&self, terrain: &mut Terrain, depth: f64, contact_length: f64, time: f64) {
        let per_way = depth / contact_length;
        if !per_way.is_finite() {
            return; // nothing is in contact
        }
        let packs = self.across.packs();
        let rows = (self.first..self.end).filter(|&row| self.masks[row] != 0);
        for row in rows.filter(|&row| self.strips[row].holds_node) {
            let start = self.strips[row].column * terrain.lanes + self.across.first_lane;
            for pack in 0..packs {
                let place = row * packs + pack;
                let touching = self.quads[place].touching(self.hub);
                let sunk = self.slip_speed(place, row) * splat(per_way * time);
                let at = start + pack * PACK;
                let dug = load(&terrain.dug, at) + touching.select(sunk, splat(0.0));
                store(&mut terrain.dug, at, dug);
            }
        }
    }

    /// Lowers the reference surfaces under the wheel by the dug depths.
    pub(crate) fn lower_references(&mut self, terrain: &Terrain) {
        let packs = self.across.packs();
        for (quads, strip) in self.quads.chunks_exact_mut(packs).zip(&self.strips) {
            let start = strip.column * terrain.lanes + self.across.first_lane;
            for (pack, quad) in quads.iter_mut().enumerate() {
                quad.reference -= load(&terrain.dug, start + pack * PACK);
            }
        }
    }
}

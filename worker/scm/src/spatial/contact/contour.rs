//! The contour of each patch of a footprint.

use super::super::pack::PACK;
use super::super::terrain::Terrain;
use super::Contact;

impl Contact {
    /// Adds the contour lengths L of the patches; of the modelled half if the terrain is mirrored.
    ///
    /// Ends along the travel are straight lines from lane to lane through the sub-cell ends, as marching squares
    /// draws them; sides run along the lanes' edges. A rectangle has its exact contour.
    pub(crate) fn add_contours(&mut self, terrain: &Terrain) {
        for patch in &mut self.patches.patches {
            patch.contour = 0.0;
        }
        for run in 0..self.patches.runs.len() {
            let run = self.patches.runs[run];
            let lanes = (u64::MAX >> (64 - (run.end - run.start))) << run.start;
            let rear = lanes & !self.masks[run.strip - 1];
            let front = lanes & !self.masks[run.strip + 1];
            let mut length = self.ends(terrain, run.strip, rear, run.strip - 1)
                + self.ends(terrain, run.strip, front, run.strip + 1);
            if run.start > 0 || !terrain.mirrored {
                length += self.covered_length(run.strip, run.start);
            }
            length += self.covered_length(run.strip, run.end - 1);
            self.patches.patches[run.patch].contour += length;
        }
    }

    /// Returns the length of the ends of a strip's lanes towards a neighbouring strip in which these lanes are not in
    /// contact.
    fn ends(&self, terrain: &Terrain, row: usize, mut ending: u64, neighbour: usize) -> f64 {
        let mut length = 0.0;
        while ending != 0 {
            let lane = ending.trailing_zeros() as usize;
            ending &= ending - 1;
            let end = self.end_of(row, lane, neighbour);
            let half_width = 0.5 * self.across.width[lane / PACK].to_array()[lane % PACK];
            for beside in [lane.checked_sub(1), Some(lane + 1)] {
                let joined = beside.filter(|&b| b < self.across.lanes && self.masks[row] >> b & 1 == 1);
                length += joined.map_or(half_width, |beside| {
                    let its_end = if self.masks[neighbour] >> beside & 1 == 0 {
                        self.end_of(row, beside, neighbour)
                    } else {
                        // the contact of this lane ends one strip further
                        let gap = (self.strips[neighbour].middle - self.strips[row].middle).abs();
                        let beyond = if neighbour > row {
                            neighbour + 1
                        } else {
                            neighbour.wrapping_sub(1)
                        };
                        match self.masks.get(beyond) {
                            Some(mask) if mask >> beside & 1 == 0 => {
                                gap + self.end_of(neighbour, beside, beyond)
                            }
                            _ => gap,
                        }
                    };
                    let half_rise = 0.5 * (its_end - end);
                    (0.25 * terrain.dy * terrain.dy + half_rise * half_rise).sqrt()
                });
            }
        }
        length
    }

    /// Returns the distance from a strip's middle to the end of a lane's contact towards a neighbouring strip `[m]`.
    fn end_of(&self, row: usize, lane: usize, neighbour: usize) -> f64 {
        let quad = self.quad(row, lane);
        let end = if neighbour > row {
            quad.front_end
        } else {
            quad.rear_end
        };
        (end.to_array()[lane % PACK] - self.strips[row].middle).abs()
    }

    fn covered_length(&self, row: usize, lane: usize) -> f64 {
        let area = self.quad(row, lane).area.to_array()[lane % PACK];
        let width = self.across.width[lane / PACK].to_array()[lane % PACK];
        if width > 0.0 { area / width } else { 0.0 }
    }
}

//! The hull of a footprint: the rectangle that its patches span together.

use super::super::pack::{PACK, Pack, lanes_of, max, max_lane, min, splat, sum};
use super::super::terrain::Terrain;
use super::Contact;
use super::laws::Laws;
use super::span::Span;
use crate::footprint::rectangle_effective_width;

/// A run of nodes counts in full if its pressure reaches this share of the footprint's largest pressure `[–]`.
const SHARE: f64 = 0.05;

impl Contact {
    /// Returns the effective width of the hull `[m]`, 0 without contact.
    ///
    /// The hull is a rectangle along the heading. Its width b is that of the lanes in contact. Its area A extends, lane by
    /// lane, from the rear end of the contact to its front end, with the gaps between patches; its length is l = A / b, and
    /// `b_eff = 2 A / L` with `L = 2 (l + b)`. Without gaps, A is the area in contact.
    ///
    /// A run of nodes in a lane counts by `w = min(1, p / (SHARE p_max))`, where p is its largest pressure under
    /// `k* = k_phi`, and a gap by the smaller of the largest w before and behind it: a grouser's tip that begins or ends to
    /// touch must not change the hull by a pitch at once.
    pub(crate) fn hull_width(&mut self, terrain: &Terrain, laws: &Laws) -> f64 {
        let packs = self.across.packs();
        let max_pressure = self.find_spans(laws);
        let weight = |pressure: Pack| {
            if max_pressure > 0.0 {
                min(pressure / splat(SHARE * max_pressure), splat(1.0))
            } else {
                // without pressure all runs have equal weight
                splat(1.0)
            }
        };
        let (mut area, mut width) = (splat(0.0), splat(0.0));
        for pack in 0..packs {
            let (mut gaps, mut ahead, mut run) = (splat(0.0), splat(0.0), splat(0.0));
            for row in (self.first..self.end).rev() {
                let place = row * packs + pack;
                let span = &self.spans[place - self.first * packs];
                let ends = self.masks[row] & !self.masks[row + 1];
                run = lanes_of(ends >> (pack * PACK)).select(weight(span.run), run);
                let counted = lanes_of(self.masks[row] >> (pack * PACK)).select(run, splat(0.0));
                area += counted * self.quads[place].area;
                ahead = max(ahead, counted);
                gaps += span.gap * min(weight(span.behind), ahead);
            }
            area += gaps * self.across.width[pack];
            width += ahead * self.across.width[pack];
        }
        let width = sum(width);
        if width > 0.0 {
            let sides = if terrain.mirrored { 2.0 } else { 1.0 };
            rectangle_effective_width(sum(area) / width, sides * width)
        } else {
            0.0
        }
    }

    /// Follows the lanes from the rear, and returns the largest pressure `[Pa]`.
    fn find_spans(&mut self, laws: &Laws) -> f64 {
        let (zero, packs) = (splat(0.0), self.across.packs());
        let blank = Span {
            gap: zero,
            behind: zero,
            run: zero,
        };
        self.spans.resize((self.end - self.first) * packs, blank);
        // only the ratios of the pressures matter
        let modulus = splat(if laws.soil.k_phi > 0.0 {
            laws.soil.k_phi
        } else {
            1.0
        });
        let mut max_pressure = zero;
        for pack in 0..packs {
            let (mut ended, mut behind, mut run) = (zero, zero, zero);
            let mut met = 0;
            for row in self.first..self.end {
                let quad = &self.quads[row * packs + pack];
                let mask = self.masks[row] >> (pack * PACK);
                let begins = mask & !(self.masks[row - 1] >> (pack * PACK));
                let touching = lanes_of(mask);
                let pressure = touching.select(laws.bounded(modulus * quad.depth_power, quad.pressed), zero);
                run = max(lanes_of(begins).select(zero, run), pressure);
                self.spans[(row - self.first) * packs + pack] = Span {
                    gap: lanes_of(begins & met).select(quad.rear_end - ended, zero),
                    behind,
                    run,
                };
                ended = touching.select(quad.front_end, ended);
                behind = max(behind, pressure);
                met |= mask;
            }
            max_pressure = max(max_pressure, behind);
        }
        max_lane(max_pressure)
    }
}

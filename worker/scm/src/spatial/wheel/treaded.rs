//! An analytic wheel whose grousers differ from lane to lane, over the columns of the terrain.

use super::super::pack::{PACK, Pack};
use super::super::terrain::Terrain;
use super::super::tread::Tread;
use super::across::Across;
use super::cylinder::{Cylinder, Piece, Row};
use super::envelope::{Envelope, Facet, NOWHERE, Strip};
use super::pose::{Pose, Range};

/// Distance of two borders that differ by rounding `[m]`.
const SAME: f64 = 1e-12;
/// Share of a lane below which a cover is due to rounding.
const NOTHING: f64 = 1e-9;

/// A rim with the grousers of a [`Tread`].
///
/// Every lane has separate grousers: their shift belongs to the lane's middle, and they are thinner where they cover the
/// lane in part. Strips end at the ends of the grousers of any lane. In a lane without a grouser, the rim is evaluated at
/// the column's node, as on a [`Cylinder`].
#[derive(Debug, Clone)]
pub(crate) struct Treaded {
    cylinder: Cylinder,
    tread: Tread,
    /// The grousers' places in the lanes under the wheel.
    places: Vec<Place>,
    /// The pieces of all lanes, lane by lane, from rear to front; and the first piece of each lane.
    pieces: Vec<Piece>,
    starts: Vec<usize>,
    borders: Vec<f64>,
    /// Rise of grousers over each strip and lane, [`NOWHERE`] without one `[m]`.
    rises: Vec<f64>,
}

/// Grousers in a lane, with a thickness proportional to the share of the lane that they cover.
#[derive(Debug, Clone, Copy)]
struct Place {
    lane: usize,
    row: Row,
}

impl Treaded {
    pub(crate) fn new(radius: f64, tread: Tread, deflection: f64) -> Self {
        Self {
            cylinder: Cylinder::new(radius, &tread.grousers, deflection),
            tread,
            places: Vec::new(),
            pieces: Vec::new(),
            starts: Vec::new(),
            borders: Vec::new(),
            rises: Vec::new(),
        }
    }

    /// Returns the rim with one row of its grousers.
    pub(crate) fn one_row(&self) -> &Cylinder {
        &self.cylinder
    }

    /// Returns whether left and right are alike.
    pub(crate) fn is_symmetric(&self) -> bool {
        self.tread.is_symmetric()
    }

    /// Fills the envelope over the columns of `range`, widened to hold every grouser whose rise exceeds `min_rise`.
    pub(crate) fn lay(
        &mut self,
        terrain: &Terrain,
        pose: Pose,
        range: Range,
        min_rise: f64,
        across: &Across,
        out: &mut Envelope,
    ) {
        self.find_places(across);
        self.collect_pieces(terrain, pose, min_rise, across);
        let ends = self.borders.first().zip(self.borders.last());
        let ends = ends.map(|(first, last)| [*first, *last]);
        let range = self.cylinder.widen(terrain, pose, range, ends, min_rise, across);
        self.cut(terrain, pose, range, out);
        self.fill(terrain, pose, across, out);
    }

    /// Finds the grousers of every lane under the wheel.
    fn find_places(&mut self, across: &Across) {
        self.places.clear();
        let (radius, width) = (self.cylinder.radius(), across.wheel_width());
        let pitch = self.cylinder.pitch();
        for lane in 0..across.lanes {
            let [right, left] = across.covered(lane);
            let first = self.places.len();
            for row in 0..self.tread.rows {
                let [from, to] = self.tread.covers(row, width);
                let (from, to) = (from.max(right), to.min(left));
                let share = (to - from) / (left - right);
                if share <= NOTHING {
                    continue;
                }
                let shift = self.tread.shift(row);
                let bend = self.tread.bend(0.5 * (from + to), width);
                let angle = bend / radius + shift * pitch;
                match self.places[first..].last_mut() {
                    // Bars that continue from row to row are one grouser, with its middle between them.
                    Some(last) if (shift - self.tread.shift(row - 1)).abs() < NOTHING => {
                        let whole = last.row.share + share;
                        last.row.angle += share / whole * (angle - last.row.angle);
                        last.row.share = whole;
                    }
                    _ => self.places.push(Place {
                        lane,
                        row: Row { angle, share },
                    }),
                }
            }
        }
    }

    /// Collects the undersides of grousers that reach below `min_rise`, and all their ends in order.
    fn collect_pieces(&mut self, terrain: &Terrain, pose: Pose, min_rise: f64, across: &Across) {
        self.pieces.clear();
        self.starts.clear();
        for place in &self.places {
            while self.starts.len() <= place.lane {
                self.starts.push(self.pieces.len());
            }
            let lane = across.first_lane + place.lane;
            let highest = |column: usize| terrain.surface[column * terrain.lanes + lane];
            self.cylinder
                .collect_grousers(terrain, pose, min_rise, place.row, highest, &mut self.pieces);
        }
        self.starts.resize(across.lanes + 1, self.pieces.len());
        self.borders.clear();
        self.borders
            .extend(self.pieces.iter().flat_map(|p| [p.rear, p.front]));
        self.borders.sort_by(f64::total_cmp);
        self.borders.dedup_by(|next, before| *next - *before < SAME);
    }

    /// Cuts the columns of a range into strips at the grousers' ends.
    fn cut(&self, terrain: &Terrain, pose: Pose, range: Range, out: &mut Envelope) {
        out.strips.clear();
        let mut next = 0;
        for column in range.start..range.end {
            let node = terrain.x(column) - pose.x;
            let (rear, front) = (node - 0.5 * terrain.dx, node + 0.5 * terrain.dx);
            let mut at = rear;
            while let Some(&border) = self.borders.get(next).filter(|&&border| border < front) {
                if border > at {
                    out.strips.push(blank(column, node, at, border));
                    at = border;
                }
                next += 1;
            }
            if front > at {
                let whole = at <= rear;
                out.strips.push(Strip {
                    smooth: whole,
                    ..blank(column, node, at, front)
                });
            }
        }
    }

    /// Computes rises and slopes of every strip and lane.
    fn fill(&mut self, terrain: &Terrain, pose: Pose, across: &Across, out: &mut Envelope) {
        self.cover(across, &mut out.strips);
        let (packs, rows) = (across.packs(), out.strips.len());
        out.facets.clear();
        out.facets.resize(packs * rows, Facet::none());
        for (row, strip) in out.strips.iter_mut().enumerate() {
            let rim = self.cylinder.rim(terrain.x(strip.column) - pose.x);
            (strip.rise, strip.slope) = rim;
            let rises = &self.rises[row * packs * PACK..][..packs * PACK];
            for (pack, rises) in rises.as_chunks::<PACK>().0.iter().enumerate() {
                let lanes = rises.map(|rise| {
                    if rise > NOWHERE {
                        self.cylinder.surface(strip.middle, rise)
                    } else {
                        rim
                    }
                });
                let deepest = lanes.iter().fold(rim, |a, &b| if b.0 > a.0 { b } else { a });
                if deepest.0 > strip.rise {
                    (strip.rise, strip.slope) = deepest;
                }
                out.facets[pack * rows + row] = Facet {
                    rise: Pack::new(lanes.map(|(rise, _)| rise)),
                    slope_x: Pack::new(lanes.map(|(_, slope)| slope)),
                    slope_y: Pack::splat(0.0),
                };
            }
        }
    }

    /// Computes the rises of the grousers over every strip; a strip with one is evaluated at its middle, and is not smooth.
    fn cover(&mut self, across: &Across, strips: &mut [Strip]) {
        let stride = across.packs() * PACK;
        self.rises.clear();
        self.rises.resize(strips.len() * stride, NOWHERE);
        for (lane, pieces) in self.starts.windows(2).enumerate() {
            for piece in &self.pieces[pieces[0]..pieces[1]] {
                let first = strips.partition_point(|strip| strip.middle <= piece.rear);
                let under = strips.iter_mut().enumerate().skip(first);
                for (row, strip) in under.take_while(|(_, strip)| strip.middle < piece.front) {
                    let rise = &mut self.rises[row * stride + lane];
                    *rise = rise.max(piece.rise(strip.middle));
                    (strip.ahead, strip.smooth) = (strip.middle, false);
                }
            }
        }
    }
}

fn blank(column: usize, node: f64, rear: f64, front: f64) -> Strip {
    Strip {
        column,
        rear,
        middle: 0.5 * (rear + front),
        front,
        ahead: node,
        rise: NOWHERE,
        slope: 0.0,
        holds_node: rear <= node && node < front,
        smooth: false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fixture::BARS;
    use super::*;

    const WIDTH: f64 = 0.112;

    /// Returns a number of lanes under a wheel in the middle of a terrain.
    fn under(lanes: u32) -> (Terrain, Across) {
        let dy = WIDTH / f64::from(lanes);
        let terrain = Terrain::new(0.004, dy, -0.5 * WIDTH - 6.5 * dy, 100, 60, false);
        let mut across = Across::default();
        across.lay(&terrain, 0.0, WIDTH);
        (terrain, across)
    }

    #[test]
    fn tips_have_their_whole_area_wherever_lanes_cut_them() {
        for rows in 1..=5 {
            for width_m in [None, Some(0.3 * WIDTH / f64::from(rows))] {
                let tread = Tread {
                    rows,
                    stagger: 0.3,
                    width_m,
                    chevron_rad: 0.2,
                    ..Tread::straight(BARS)
                };
                for lanes in [4, 26, 28] {
                    let across = under(lanes).1;
                    let mut wheel = Treaded::new(0.125, tread, 0.0);
                    wheel.find_places(&across);
                    let width = |place: &Place| {
                        let [right, left] = across.covered(place.lane);
                        place.row.share * (left - right)
                    };
                    let covered: f64 = wheel.places.iter().map(width).sum();
                    let expected = width_m.map_or(WIDTH, |width| width * f64::from(rows));
                    assert!((covered - expected).abs() < 1e-12, "{rows} rows: {covered}");
                }
            }
        }
    }

    #[test]
    fn lane_by_lane_straight_grousers_are_those_of_the_cylinder() {
        let (terrain, across) = under(28);
        let (x, y, turned) = (0.2013, 0.0, 0.37);
        let pose = Pose { x, y, turned };
        let range = Range { start: 35, end: 66 };
        let (mut expected, mut got) = (Envelope::default(), Envelope::default());
        Cylinder::new(0.125, &BARS, 0.0).lay(&terrain, pose, range, 0.1, &across, &mut expected);
        Treaded::new(0.125, Tread::straight(BARS), 0.0).lay(&terrain, pose, range, 0.1, &across, &mut got);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert_eq!(got.strips.len(), expected.strips.len());
        for (row, (strip, reference)) in expected.strips.iter().zip(&got.strips).enumerate() {
            assert_eq!((reference.column, reference.smooth), (strip.column, strip.smooth));
            assert!(near(reference.rear, strip.rear) && near(reference.front, strip.front));
            assert!(near(reference.ahead, strip.ahead));
            assert!(near(reference.rise, strip.rise) && near(reference.slope, strip.slope));
            for facet in got.facets[row..].iter().step_by(got.strips.len()) {
                assert!(facet.rise.to_array().iter().all(|&rise| near(rise, strip.rise)));
            }
        }
    }
}

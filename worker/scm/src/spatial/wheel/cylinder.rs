//! An analytic wheel, a rim with straight grousers, over the columns of the terrain.

use super::super::grousers::Grousers;
use super::super::terrain::Terrain;
use super::across::Across;
use super::envelope::{Envelope, NOWHERE, Strip};
use super::pose::{Pose, Range};

/// A rim with straight grousers: rectangles on the rim along its whole width.
///
/// A load may flatten the rim by a deflection d: below `R − d` it is cut off, `h = R − d` wherever `√(R² − x²)` is more, and
/// grousers there are pushed in with it. The flat is horizontal, and its material moves with `omega (R − d)`.
#[derive(Debug, Clone)]
pub(crate) struct Cylinder {
    radius: f64,
    /// Height of the hub above the flat part of the rim `[m]`; the radius if there is none.
    loaded_radius: f64,
    grouser_count: u32,
    grouser_height: f64,
    grouser_thickness: f64,
    pieces: Vec<Piece>,
}

/// A straight piece of a grouser's underside: from one end to the other, with heights below the hub.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) rear: f64,
    pub(super) front: f64,
    rear_rise: f64,
    front_rise: f64,
}

impl Piece {
    /// Returns the rise at a place between its ends `[m]`.
    pub(super) fn rise(&self, ahead: f64) -> f64 {
        let share = (ahead - self.rear) / (self.front - self.rear);
        self.rear_rise + share * (self.front_rise - self.rear_rise)
    }
}

/// The place of a row of grousers, and the thickness of its grousers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    /// Angle by which they stand further forward at the bottom `[rad]`.
    pub(super) angle: f64,
    /// Thickness of the grousers, relative to the nominal one.
    pub(super) share: f64,
}

impl Cylinder {
    pub(crate) fn new(radius: f64, grousers: &Grousers, deflection: f64) -> Self {
        Self {
            radius,
            loaded_radius: radius - deflection,
            grouser_count: grousers.count,
            grouser_height: grousers.height_m,
            grouser_thickness: grousers.thickness_m,
            pieces: Vec::new(),
        }
    }

    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the angle from one grouser to the next `[rad]`.
    pub(super) fn pitch(&self) -> f64 {
        core::f64::consts::TAU / f64::from(self.grouser_count)
    }

    /// Returns the number of grousers, if there are any.
    pub(crate) fn grousers(&self) -> Option<u32> {
        (self.grouser_count > 0).then_some(self.grouser_count)
    }

    /// Returns the largest distance of a point from the axle `[m]`.
    pub(crate) fn reach(&self) -> f64 {
        if self.grouser_count == 0 {
            self.radius
        } else {
            libm::hypot(self.radius + self.grouser_height, 0.5 * self.grouser_thickness)
        }
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
        let mut pieces = core::mem::take(&mut self.pieces);
        pieces.clear();
        let row = Row {
            angle: 0.0,
            share: 1.0,
        };
        let highest = |column| across.highest(terrain, column);
        self.collect_grousers(terrain, pose, min_rise, row, highest, &mut pieces);
        self.pieces = pieces;
        let ends = self.pieces.first().zip(self.pieces.last());
        let ends = ends.map(|(first, last)| [first.rear, last.front]);
        let range = self.widen(terrain, pose, range, ends, min_rise, across);
        out.facets.clear();
        out.strips.clear();
        let mut next_piece = 0;
        for column in range.start..range.end {
            let node = terrain.x(column) - pose.x;
            let (rear, front) = (node - 0.5 * terrain.dx, node + 0.5 * terrain.dx);
            let mut at = rear;
            let mut place = next_piece;
            while let Some(piece) = self.pieces.get(place).filter(|p| p.rear < front) {
                if piece.rear > at {
                    push(out, column, node, at, piece.rear, false);
                    at = piece.rear;
                }
                let end = piece.front.min(front);
                if end > at {
                    push(out, column, node, at, end, false);
                    at = end;
                }
                if piece.front > front {
                    break;
                }
                place += 1;
            }
            next_piece = place;
            if front > at {
                push(out, column, node, at, front, at <= rear);
            }
        }
        self.fill(terrain, pose, out);
    }

    /// Widens `range` by the columns from the rear end of grousers to their front end, by those where the rim may touch
    /// soil, and by one more on either side: if the last contact ended at a grouser, the rim beyond it may touch again.
    pub(super) fn widen(
        &self,
        terrain: &Terrain,
        pose: Pose,
        range: Range,
        grousers: Option<[f64; 2]>,
        min_rise: f64,
        across: &Across,
    ) -> Range {
        let mut range = range;
        if let Some([rear, front]) = grousers {
            let column = |ahead: f64| ((pose.x + ahead) / terrain.dx) as usize;
            range.start = range.start.min(column(rear).saturating_sub(1));
            range.end = range.end.max(column(front) + 2);
        }
        let min_rise = min_rise.max(0.0);
        let half = (self.radius * self.radius - min_rise * min_rise).max(0.0).sqrt();
        let column = |ahead: f64| (((pose.x + ahead) / terrain.dx) as usize).min(terrain.columns - 1);
        let touches = |c: &usize| {
            let ahead = ((terrain.x(*c) - pose.x).abs() - 0.5 * terrain.dx).max(0.0);
            let rise = (self.radius * self.radius - ahead * ahead).max(0.0).sqrt();
            rise + across.highest(terrain, *c) > min_rise + terrain.top
        };
        let rearmost = (column(-half)..range.start).find(touches);
        let foremost = (range.end..column(half) + 1).rev().find(touches);
        Range {
            start: rearmost.map_or(range.start, |c| c.saturating_sub(1)),
            end: foremost.map_or(range.end, |c| c + 2).min(terrain.columns),
        }
    }

    /// Computes rise and slope of every strip.
    fn fill(&self, terrain: &Terrain, pose: Pose, out: &mut Envelope) {
        let mut place = 0;
        for strip in &mut out.strips {
            while self.pieces.get(place).is_some_and(|p| p.front <= strip.rear) {
                place += 1;
            }
            if let Some(piece) = self.pieces.get(place).filter(|p| p.rear < strip.middle) {
                strip.ahead = strip.middle;
                (strip.rise, strip.slope) = self.surface(strip.ahead, piece.rise(strip.middle));
            } else {
                // the rim is evaluated at the node, because it shaped the soil there
                strip.ahead = terrain.x(strip.column) - pose.x;
                (strip.rise, strip.slope) = self.rim(strip.ahead);
            }
        }
    }

    /// Returns the rise and slope of the rim at a place.
    pub(super) fn rim(&self, ahead: f64) -> (f64, f64) {
        let square = self.radius * self.radius;
        let square_rise = square - ahead * ahead;
        let rise = if square_rise > STEEPEST * square {
            square_rise.sqrt()
        } else {
            NOWHERE
        };
        self.surface(ahead, rise)
    }

    /// Returns the rise and slope at a place, from the rise of the unloaded wheel less the part of the rim that the
    /// load cuts off there.
    pub(super) fn surface(&self, ahead: f64, rise: f64) -> (f64, f64) {
        if self.loaded_radius < self.radius {
            let square_rise = self.radius * self.radius - ahead * ahead;
            let cut = square_rise.max(0.0).sqrt() - self.loaded_radius;
            if cut > 0.0 {
                return (rise - cut, 0.0);
            }
        }
        // the normal points to the hub, on grousers too, because a height field cannot show their flanks
        let slope = if rise > 0.0 { ahead / rise } else { 0.0 };
        (rise, slope)
    }

    /// Collects the undersides of a row's grousers that reach below `min_rise` and may touch soil, from rear to front.
    ///
    /// `highest` gives the highest soil under the row in a column `[m]`.
    pub(super) fn collect_grousers(
        &self,
        terrain: &Terrain,
        pose: Pose,
        min_rise: f64,
        row: Row,
        highest: impl Fn(usize) -> f64,
        out: &mut Vec<Piece>,
    ) {
        if self.grouser_count == 0 {
            return;
        }
        let pitch = self.pitch();
        let reach = self.reach();
        if min_rise >= reach {
            return;
        }
        // angles from straight down, positive forward; the wheel turns them backwards
        let widest = libm::acos((min_rise / reach).max(-1.0)).min(0.5 * core::f64::consts::PI);
        let phase = (pose.turned - row.angle) / pitch;
        let phase = phase - libm::floor(phase); // of a pitch
        let last = libm::floor(widest / pitch + phase) as i64;
        let first = libm::ceil(-widest / pitch + phase) as i64;
        for number in first..=last {
            let angle = (number as f64 - phase) * pitch;
            let deepest = reach * libm::cos(angle);
            let tip = pose.x + reach * libm::sin(angle);
            let extent = self.grouser_thickness + self.grouser_height * libm::sin(angle).abs();
            let columns = ((tip - extent) / terrain.dx) as usize..=((tip + extent) / terrain.dx) as usize;
            let on_track = columns.take_while(|&column| column < terrain.columns);
            let highest = on_track.fold(f64::MIN, |high, column| high.max(highest(column)));
            if deepest + highest > min_rise + terrain.top {
                self.push_grouser(angle, row.share * self.grouser_thickness, out);
            }
        }
    }

    fn push_grouser(&self, angle: f64, thickness: f64, out: &mut Vec<Piece>) {
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let half = 0.5 * thickness;
        let (foot, tip) = (self.radius, self.radius + self.grouser_height);
        // The flank that looks down is the one towards the lowest point of the wheel.
        let side = if angle >= 0.0 { -half } else { half };
        let at = |radius: f64, offset: f64| (radius * sin + offset * cos, radius * cos - offset * sin);
        let (foot_x, foot_rise) = at(foot, side);
        let (near_x, near_rise) = at(tip, side);
        let (far_x, far_rise) = at(tip, -side);
        let pieces = if angle >= 0.0 {
            [
                (foot_x, foot_rise, near_x, near_rise),
                (near_x, near_rise, far_x, far_rise),
            ]
        } else {
            [
                (far_x, far_rise, near_x, near_rise),
                (near_x, near_rise, foot_x, foot_rise),
            ]
        };
        for (rear, rear_rise, front, front_rise) in pieces {
            if front > rear {
                out.push(Piece {
                    rear,
                    front,
                    rear_rise,
                    front_rise,
                });
            }
        }
    }
}

/// Square of the minimum rise of the rim, relative to its radius, at which it counts as an underside.
const STEEPEST: f64 = 1e-4;

fn push(out: &mut Envelope, column: usize, node: f64, rear: f64, front: f64, whole: bool) {
    out.strips.push(Strip {
        column,
        rear,
        middle: 0.5 * (rear + front),
        front,
        ahead: 0.0,
        rise: NOWHERE,
        slope: 0.0,
        holds_node: rear <= node && node < front,
        smooth: whole,
    });
}

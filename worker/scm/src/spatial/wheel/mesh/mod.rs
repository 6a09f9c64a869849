//! A wheel given as triangles, over the columns of the terrain.
//!
//! # Layout
//! - This file: the triangles and columns that a step uses.
//! - `triangle`: one triangle, and its place after a rotation of the wheel.
//! - `raster`: the lowest point above each of a grid of samples, with its slopes.
//! - `strips`: samples in a row that lie on one smooth surface become a strip of the envelope.
//! - `symmetry`: the number of identical sectors in one turn, and whether left mirrors right.

mod raster;
mod strips;
mod symmetry;
mod triangle;

use self::raster::Raster;
use self::triangle::{Placed, Triangle};
use super::super::surface::{Normals, SurfaceMesh};
use super::super::terrain::Terrain;
use super::across::Across;
use super::envelope::Envelope;
use super::pose::{Pose, Range};
use core::f64::consts::{FRAC_PI_2, TAU};

/// Half the angle about the axle within which a triangle must lie to be found by angle `[rad]`; triangles wider than this are always
/// examined.
const WIDEST: f64 = 0.2;
/// Number of sectors of a turn with a stored distance of the surface from the axle.
const SECTORS: usize = 240;
/// Longest distance from sample to sample along travel `[m]`: half a thin grouser.
const COARSEST: f64 = 1e-3;
/// Number of columns searched beyond the deepest column that may touch, because the ends of the contact lie between columns.
const COLUMNS_BEYOND: f64 = 3.0;

/// A surface of triangles about the axle.
#[derive(Debug, Clone)]
pub(crate) struct Mesh {
    /// The triangles, sorted by angle about the axle.
    triangles: Vec<Triangle>,
    /// The triangles that span too great an angle.
    wide: Vec<Triangle>,
    /// Largest half angle of one of `triangles` `[rad]`.
    half_span: f64,
    /// Largest distance from the axle in each sector `[m]`; see [`sectors`].
    sectors: Vec<f64>,
    reach: f64,
    width: f64,
    repeats: u32,
    symmetric: bool,
    normals: Normals,
    /// Triangles that may be lowest in this step.
    placed: Vec<Placed>,
    raster: Raster,
    buffers: strips::Buffers,
}

impl Mesh {
    /// Creates a mesh from a checked surface. Triangles that never face down, such as those of a disc, are left out.
    pub(crate) fn new(surface: &SurfaceMesh, repeats_per_turn: Option<u32>, normals: Normals) -> Self {
        let corner = |index: u32| surface.vertices_m[index as usize];
        let all = surface.triangles.iter();
        let all: Vec<Triangle> = all.filter_map(|t| Triangle::new(t.map(corner))).collect();
        let points: Vec<[f64; 3]> = all.iter().flat_map(|t| t.corners).collect();
        let reach = all.iter().fold(0.0_f64, |far, t| far.max(t.reach));
        let aside = surface.triangles.iter().flatten().map(|&i| corner(i)[1].abs());
        let sectors = sectors(&all);
        let (wide, mut triangles): (Vec<_>, Vec<_>) = all.into_iter().partition(|t| t.half_span > WIDEST);
        triangles.sort_by(|a, b| a.angle.total_cmp(&b.angle)); // the sort is stable, so equal angles keep the order of the surface
        Self {
            half_span: triangles
                .iter()
                .fold(0.0_f64, |largest, t| largest.max(t.half_span)),
            triangles,
            wide,
            sectors,
            reach,
            width: 2.0 * aside.fold(0.0_f64, f64::max),
            repeats: repeats_per_turn.unwrap_or_else(|| symmetry::repeats_per_turn(&points, reach)),
            symmetric: symmetry::mirrors(&points, reach),
            normals,
            placed: Vec::new(),
            raster: Raster::default(),
            buffers: strips::Buffers::default(),
        }
    }

    /// Returns the largest distance of a point from the axle `[m]`.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns the width about the plane y = 0 that holds the surface `[m]`.
    pub(crate) fn width(&self) -> f64 {
        self.width
    }

    /// Returns the number of identical sectors in one turn.
    pub(crate) fn repeats_per_turn(&self) -> u32 {
        self.repeats
    }

    /// Returns whether every vertex has its mirror image at −y. The triangulation may differ: left and right are then alike
    /// only to the fineness of the facets, and the left half represents both.
    pub(crate) fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Fills the envelope over the columns of `range`, widened to hold every part that may touch soil.
    ///
    /// Each lane is sampled in the middle of its covered part, each column at an odd number of places no farther than 1 mm
    /// apart, the middle one at the node. At a sample the surface is exact: the plane of the lowest triangle. A part of the
    /// wheel thinner than the distance of samples is hit with the probability that makes its mean area right.
    pub(crate) fn lay(
        &mut self,
        terrain: &Terrain,
        pose: Pose,
        range: Range,
        min_rise: f64,
        across: &Across,
        out: &mut Envelope,
    ) {
        let range = self.widen(terrain, pose, range, min_rise, across);
        let lowest = (min_rise - COLUMNS_BEYOND * terrain.dx).max(0.0);
        self.place(terrain, pose, range, lowest);
        let samples = 2 * libm::ceil(0.5 * (terrain.dx / COARSEST - 1.0)).max(1.0) as usize + 1;
        self.raster.clear(terrain, pose, range, samples, across);
        for placed in &self.placed {
            self.raster.draw(placed);
        }
        strips::fill(
            &self.raster,
            terrain,
            pose,
            range,
            self.normals == Normals::Radial,
            &mut self.buffers,
            out,
        );
    }

    /// Turns the triangles that may be lowest somewhere over the columns of a range, with a rise of more than `min_rise`.
    fn place(&mut self, terrain: &Terrain, pose: Pose, range: Range, min_rise: f64) {
        self.placed.clear();
        if min_rise >= self.reach {
            return;
        }
        let rear = terrain.x(range.start) - pose.x - terrain.dx;
        let front = terrain.x(range.end) - pose.x;
        // among points less than `rear` behind the hub, the highest lies at the largest angle; likewise in front
        let widest = libm::acos(min_rise / self.reach).min(FRAC_PI_2);
        let from = libm::atan2(rear, if rear < 0.0 { min_rise } else { self.reach }).max(-widest);
        let to = libm::atan2(front, if front > 0.0 { min_rise } else { self.reach }).min(widest);
        let from = from - self.half_span + pose.turned;
        let length = (to + self.half_span + pose.turned - from).clamp(0.0, TAU);
        let from = from - TAU * libm::floor(from / TAU);
        let to = from + length;
        let at = |angle: f64| self.triangles.partition_point(|t| t.angle < angle);
        let (first, second) = (at(from)..at(to), 0..at(to - TAU).min(at(from)));
        let near = self.triangles[first].iter().chain(&self.triangles[second]);
        let modelled = |t: &&Triangle| t.reach > min_rise && (t.left > 0.0 || !terrain.mirrored);
        let (sin, cos) = (libm::sin(pose.turned), libm::cos(pose.turned));
        let placed = near.chain(&self.wide).filter(modelled);
        let placed = placed.filter_map(|t| t.turn(sin, cos));
        self.placed
            .extend(placed.filter(|p| p.max_rise > min_rise && p.rear() <= front && p.front() >= rear));
    }

    /// Widens `range` by the columns where some part of the wheel may touch the soil, and by one more on either side.
    fn widen(&self, terrain: &Terrain, pose: Pose, range: Range, min_rise: f64, across: &Across) -> Range {
        let mut widened = range;
        let min_rise = min_rise.max(0.0);
        if min_rise < self.reach {
            let widest = libm::acos(min_rise / self.reach).min(FRAC_PI_2);
            let sector = TAU / SECTORS as f64;
            let number = |angle: f64| libm::floor((angle + pose.turned) / sector) as i64;
            let column = |ahead: f64| {
                let place = ((pose.x + ahead) / terrain.dx).max(0.0) as usize;
                place.min(terrain.columns - 1)
            };
            for i in number(-widest)..=number(widest) {
                let far = self.sectors[i.rem_euclid(SECTORS as i64) as usize];
                let begin = i as f64 * sector - pose.turned;
                let end = begin + sector;
                let nearest = 0.0_f64.max(begin).min(end);
                let deepest = far * libm::cos(nearest);
                if deepest <= min_rise {
                    continue;
                }
                let (rear, front) = (
                    column(self.min_ahead(begin, min_rise, far)),
                    column(-self.min_ahead(-end, min_rise, far)),
                );
                if rear >= widened.start && front < widened.end {
                    continue;
                }
                let highest = (rear..=front).fold(f64::MIN, |z, c| z.max(across.highest(terrain, c)));
                if deepest + highest > min_rise + terrain.top {
                    widened.start = widened.start.min(rear.saturating_sub(1));
                    widened.end = widened.end.max(front + 2);
                }
            }
        }
        widened.end = widened.end.min(terrain.columns);
        widened
    }

    /// Returns the rearmost possible place `[m]` of a point at an angle or in front of it, with a rise of at least
    /// `min_rise` and at most `far` from the axle.
    fn min_ahead(&self, angle: f64, min_rise: f64, far: f64) -> f64 {
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        if sin < 0.0 {
            far * sin
        } else {
            min_rise * sin / cos.max(min_rise / far)
        }
    }
}

/// Returns the largest distance from the axle in each of [`SECTORS`] equal sectors, from straight down forwards.
fn sectors(triangles: &[Triangle]) -> Vec<f64> {
    let mut sectors = vec![0.0_f64; SECTORS];
    let per_angle = SECTORS as f64 / TAU;
    for triangle in triangles {
        let number = |angle: f64| libm::floor(angle * per_angle) as i64;
        let first = number(triangle.angle - triangle.half_span);
        let last = number(triangle.angle + triangle.half_span);
        for i in first..=last.min(first + SECTORS as i64) {
            let sector = &mut sectors[i.rem_euclid(SECTORS as i64) as usize];
            *sector = sector.max(triangle.reach);
        }
    }
    sectors
}

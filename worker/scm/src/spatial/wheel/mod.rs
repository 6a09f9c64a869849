//! The wheel in contact with the soil: its underside, its lanes, its motion.
//!
//! # Layout
//! - `envelope`: the underside over the columns of the terrain, strip by strip.
//! - `cylinder`: lays an analytic rim with straight grousers.
//! - `treaded`: lays the rim with grousers in rows, staggered, oblique or bent.
//! - `mesh`: lays any surface of triangles.
//! - `across`: the lanes that the wheel covers.
//! - `pose`: the place of the wheel, and the columns that it may touch.
//! - `motion`: velocity of the surface over the soil, directions of pressure and shear.

pub(super) mod across;
pub(super) mod cylinder;
pub(super) mod envelope;
pub(super) mod mesh;
pub(super) mod motion;
pub(super) mod pose;
pub(super) mod treaded;

use self::across::Across;
use self::cylinder::Cylinder;
use self::envelope::Envelope;
use self::mesh::Mesh;
use self::pose::{Pose, Range};
use self::treaded::Treaded;
use super::settings::Shape;
use super::terrain::Terrain;
use crate::Wheel;

/// The underside of the wheel.
#[derive(Debug, Clone)]
pub(crate) enum Underside {
    Cylinder(Cylinder),
    Treaded(Box<Treaded>),
    Mesh(Box<Mesh>),
}

impl Underside {
    /// Returns a wheel whose rim is flattened by a deflection `[m]`; a mesh stays rigid.
    pub(crate) fn new(wheel: &Wheel, shape: &Shape, deflection: f64) -> Self {
        match shape {
            Shape::Rim(grousers) => Self::Cylinder(Cylinder::new(wheel.radius_m, grousers, deflection)),
            Shape::Tread(tread) if tread.is_straight(wheel) => {
                Self::Cylinder(Cylinder::new(wheel.radius_m, &tread.grousers, deflection))
            }
            Shape::Tread(tread) => Self::Treaded(Box::new(Treaded::new(wheel.radius_m, *tread, deflection))),
            Shape::Mesh {
                surface,
                repeats_per_turn,
                normals,
            } => Self::Mesh(Box::new(Mesh::new(surface, *repeats_per_turn, *normals))),
        }
    }

    /// Returns the largest distance of a point from the axle `[m]`.
    pub(crate) fn reach(&self) -> f64 {
        match self {
            Self::Cylinder(cylinder) => cylinder.reach(),
            Self::Treaded(treaded) => treaded.one_row().reach(),
            Self::Mesh(mesh) => mesh.reach(),
        }
    }

    /// Returns the width about the middle plane that holds the whole wheel `[m]`; nominally that of `wheel`.
    pub(crate) fn width(&self, wheel: &Wheel) -> f64 {
        match self {
            Self::Cylinder(_) | Self::Treaded(_) => wheel.width_m,
            Self::Mesh(mesh) => mesh.width(),
        }
    }

    /// Returns the number of identical sectors in one turn; `None` if turning changes nothing.
    pub(crate) fn repeats_per_turn(&self) -> Option<u32> {
        match self {
            Self::Cylinder(cylinder) => cylinder.grousers(),
            Self::Treaded(treaded) => treaded.one_row().grousers(),
            Self::Mesh(mesh) => Some(mesh.repeats_per_turn()),
        }
    }

    /// Returns whether left and right are alike.
    pub(crate) fn is_symmetric(&self) -> bool {
        match self {
            Self::Cylinder(_) => true,
            Self::Treaded(treaded) => treaded.is_symmetric(),
            Self::Mesh(mesh) => mesh.is_symmetric(),
        }
    }

    /// Fills the envelope over the columns of `range` and all others that may touch soil. `min_rise` is the height of the
    /// hub above the highest soil, less the possible sinking of the hub in this step.
    pub(crate) fn lay(
        &mut self,
        terrain: &Terrain,
        pose: Pose,
        range: Range,
        min_rise: f64,
        across: &Across,
        out: &mut Envelope,
    ) {
        match self {
            Self::Cylinder(cylinder) => cylinder.lay(terrain, pose, range, min_rise, across, out),
            Self::Treaded(treaded) => treaded.lay(terrain, pose, range, min_rise, across, out),
            Self::Mesh(mesh) => mesh.lay(terrain, pose, range, min_rise, across, out),
        }
    }
}

//! The equations that simulate a variant's wheel, with the sources of their parameters.

use scm::effects::{Active, Site};
use scm::quasi_static::{self, StraightGrousers};
use scm::rft::{self, RftShape, RftSoil};
use scm::spatial::{Grousers, SpatialRun, SurfaceMesh};
use scm::{Averages, Condition, Rejection, Soil, Wheel, WongReece};
use shared::experiment::WheelGeometry;
use shared::model::{ModelKind, ModelVariant};

use super::error::CompileError;
use super::parameters::{RftMap, SoilMap, WongReeceMap};
use super::spatial::SpatialModel;

/// The equations of a variant.
#[derive(Debug)]
pub(super) enum Physics {
    /// The quasi-static model, with the rolled grousers of each wheel, in the variant's order.
    QuasiStatic(SoilMap, Vec<StraightGrousers>),
    WongReece(SoilMap, WongReeceMap),
    Scm(SoilMap, Box<SpatialModel>),
    /// Resistive force theory, with the shape of each wheel, in the variant's order.
    Rft(RftMap, Vec<RftShape>),
}

/// The equations at one parameter vector.
#[derive(Debug, Clone, Copy)]
pub(super) enum PhysicsAt<'p> {
    QuasiStatic(Soil, &'p [StraightGrousers]),
    WongReece(Soil, WongReece),
    Scm(Soil, &'p SpatialModel),
    Rft(RftSoil, &'p [RftShape]),
}

/// The result of simulating one condition.
pub(super) enum Simulated {
    Steady(Averages),
    Rolled(Box<SpatialRun>),
}

/// One condition to simulate.
pub(super) struct Run<'r> {
    pub(super) theta: &'r [f64],
    /// Index of the condition in the variant.
    pub(super) position: usize,
    /// Index of the condition's wheel in the variant.
    pub(super) wheel_index: usize,
    pub(super) wheel: &'r Wheel,
    pub(super) condition: &'r Condition,
    pub(super) site: &'r Site,
}

impl Physics {
    /// Resolves the names of a variant; [`CompileError`] names what is missing or cannot be expressed.
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, CompileError> {
        Ok(match variant.kind {
            ModelKind::QuasiStatic => {
                let grousers = |wheel| straight_grousers(wheel, variant.rolls_grousers);
                Physics::QuasiStatic(
                    SoilMap::new(variant)?,
                    variant.wheels.values().map(grousers).collect(),
                )
            }
            ModelKind::Command | ModelKind::Umbridge => return Err(CompileError::NoDescription),
            ModelKind::WongReece => Physics::WongReece(SoilMap::new(variant)?, WongReeceMap::new(variant)?),
            ModelKind::Scm => Physics::Scm(SoilMap::new(variant)?, Box::new(SpatialModel::new(variant)?)),
            ModelKind::Rft => {
                let shapes = variant.wheels.values().map(rft_shape).collect::<Result<_, _>>()?;
                Physics::Rft(RftMap::new(variant)?, shapes)
            }
        })
    }

    /// Returns the equations at a parameter vector; [`Rejection::InvalidParameter`] if a number is outside its bounds.
    pub(super) fn at(&self, theta: &[f64]) -> Result<PhysicsAt<'_>, Rejection> {
        Ok(match self {
            Physics::QuasiStatic(soil, grousers) => {
                PhysicsAt::QuasiStatic(soil.soil(theta).checked()?, grousers)
            }
            Physics::WongReece(soil, law) => {
                PhysicsAt::WongReece(soil.soil(theta).checked()?, law.law(theta))
            }
            Physics::Scm(soil, model) => PhysicsAt::Scm(soil.soil(theta).checked()?, model),
            Physics::Rft(soil, shapes) => PhysicsAt::Rft(soil.soil(theta).checked()?, shapes),
        })
    }
}

impl PhysicsAt<'_> {
    /// Simulates one condition; a [`Rejection`] if the model has no answer for these parameters.
    pub(super) fn simulate(&self, run: &Run, effects: &mut Active) -> Result<Simulated, Rejection> {
        let (wheel, condition, site) = (run.wheel, run.condition, run.site);
        let averages = match self {
            PhysicsAt::QuasiStatic(soil, grousers) => {
                let grousers = &grousers[run.wheel_index];
                quasi_static::simulate_with_grousers(soil, wheel, grousers, condition, effects, site)
            }
            PhysicsAt::WongReece(soil, law) => {
                quasi_static::simulate_wong_reece(soil, wheel, condition, law, effects, site)
            }
            PhysicsAt::Rft(soil, shapes) => {
                rft::simulate(soil, wheel, &shapes[run.wheel_index], condition, effects, site)
            }
            PhysicsAt::Scm(soil, model) => {
                let (on, with) = ((run.wheel_index, wheel), (&*effects, site));
                let rolled = model.run(run.theta, run.position, soil, on, condition, with)?;
                return Ok(Simulated::Rolled(Box::new(rolled)));
            }
        };
        averages.map(Simulated::Steady)
    }

    /// Returns the equations on a soil whose pressure at the same depth is `factor` times as large.
    pub(super) fn stiffer(&self, factor: f64) -> Self {
        let stiffer = |soil: &Soil| Soil {
            k_c: soil.k_c * factor,
            k_phi: soil.k_phi * factor,
            ..*soil
        };
        match *self {
            PhysicsAt::QuasiStatic(ref soil, grousers) => PhysicsAt::QuasiStatic(stiffer(soil), grousers),
            PhysicsAt::WongReece(ref soil, law) => PhysicsAt::WongReece(stiffer(soil), law),
            PhysicsAt::Scm(ref soil, model) => PhysicsAt::Scm(stiffer(soil), model),
            PhysicsAt::Rft(soil, shapes) => {
                let xi_n_pa_m = soil.xi_n_pa_m * factor;
                PhysicsAt::Rft(RftSoil { xi_n_pa_m, ..soil }, shapes)
            }
        }
    }
}

/// Returns the grousers of a wheel if they roll, else none.
fn straight_grousers(wheel: &WheelGeometry, roll: bool) -> StraightGrousers {
    StraightGrousers {
        count: if roll { wheel.grouser_count } else { 0 },
        height_m: wheel.grouser_height_m,
        thickness_m: wheel.grouser_thickness_m,
    }
}

fn rft_shape(wheel: &WheelGeometry) -> Result<RftShape, Rejection> {
    match &wheel.mesh {
        Some(mesh) => RftShape::mesh(&SurfaceMesh {
            vertices_m: mesh.vertices_m.clone(),
            triangles: mesh.triangles.clone(),
        }),
        None => Ok(RftShape::rim(Grousers {
            count: wheel.grouser_count,
            height_m: wheel.grouser_height_m,
            thickness_m: wheel.grouser_thickness_m,
        })),
    }
}

//! The equations that simulate a variant's wheel, with the sources of their parameters.

use scm::effects::{Active, Site};
use scm::quasi_static::{self, StraightGrousers, Way};
use scm::rft::{self, RftShape, RftSoil};
use scm::spatial::{Grousers, SpatialRun, SurfaceMesh};
use scm::{Averages, Condition, Rejection, Soil, Wheel, WongReece};
use shared::experiment::WheelGeometry;
use shared::model::{ModelKind, ModelVariant, TransientCondition};

use super::error::CompileError;
use super::parameters::{RftMap, SoilMap, WongReeceMap};
use super::spatial::SpatialModel;

/// The smallest settlement of a rolled wheel of which shares are compared with a recording `[m]`.
const MIN_SETTLEMENT_M: f64 = 1e-6;

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
    /// Returns whether a run takes milliseconds.
    pub(super) fn is_expensive(&self) -> bool {
        matches!(self, PhysicsAt::Scm(..))
    }

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

    /// Returns the sinkage at each point of the transient of a simulated condition `[m]`.
    ///
    /// The three-dimensional model has rolled to the points itself; a point beyond the end of its run has the average. Where a steady
    /// sinkage is stated, the share of the settlement that it predicts is that from the stated start to the stated steady sinkage. The
    /// other models settle from the start that the transient states.
    ///
    /// # Errors
    /// [`quasi_static::transient_sinkage`] states the errors of a settling wheel. A rolled wheel that settles by less than
    /// [`MIN_SETTLEMENT_M`] is refused where a steady sinkage is stated.
    pub(super) fn transient_sinkage(
        &self,
        run: &Run,
        effects: &Active,
        simulated: &Simulated,
        transient: &TransientCondition,
    ) -> Result<Vec<f64>, Rejection> {
        let (soil, averages) = match (self, simulated) {
            (PhysicsAt::Scm(..), Simulated::Rolled(rolled)) => {
                let step_m = run.condition.sled_speed_m_s * rolled.history.step_s;
                let own_steady_m = rolled.averages.sinkage_m;
                let rolled_to = |travel_m: f64| {
                    let sinkage_m = rolled.history.sinkage_at(travel_m / step_m);
                    sinkage_m.unwrap_or(own_steady_m)
                };
                let Some(steady_m) = transient.steady_sinkage_m else {
                    return Ok(transient
                        .travel_m
                        .iter()
                        .map(|travel_m| rolled_to(*travel_m))
                        .collect());
                };
                let own_start_m = rolled_to(0.0);
                let settlement_m = own_steady_m - own_start_m;
                if settlement_m.abs() < MIN_SETTLEMENT_M {
                    return Err(Rejection::InvalidParameter {
                        name: "settlement of the rolled wheel",
                        value: settlement_m,
                        unit: "m",
                        bound: "at least 1e-6 m, up or down, to be compared with a recording",
                    });
                }
                let at = |travel_m: &f64| {
                    let left = (own_steady_m - rolled_to(*travel_m)) / settlement_m;
                    steady_m - left * (steady_m - transient.start_sinkage_m)
                };
                return Ok(transient.travel_m.iter().map(at).collect());
            }
            (
                PhysicsAt::QuasiStatic(soil, _) | PhysicsAt::WongReece(soil, _),
                Simulated::Steady(averages),
            ) => (soil, averages),
            (_, Simulated::Rolled(_)) | (PhysicsAt::Scm(..) | PhysicsAt::Rft(..), Simulated::Steady(_)) => {
                unreachable!("a variant with transients compiles only for models that have them")
            }
        };
        let way = Way {
            steady_sinkage_m: transient.steady_sinkage_m.unwrap_or(averages.sinkage_m),
            start_sinkage_m: transient.start_sinkage_m,
            travel_m: &transient.travel_m,
        };
        quasi_static::transient_sinkage(soil, run.wheel, run.condition, effects, run.site, &way)
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

//! The three-dimensional model of a variant: shared settings are converted to the physics' types.

use scm::effects::{Active, Site};
use scm::spatial::{self, Grousers, RunSettings, Scene, Shape, SpatialRun, SurfaceMesh, Tread};
use scm::{Condition, Rejection, Soil, Wheel};
use shared::experiment::{ProtocolKind, WheelGeometry};
use shared::model::ModelVariant;
use shared::model::spatial::{DisplacementFrame, FootprintWidth, HubMotion, PAPER_DURATION_S, PressureAxis};

use super::error::CompileError;
use super::parameters::GroundMap;

/// The inputs of a run besides soil, wheel and condition.
#[derive(Debug)]
pub(super) struct SpatialModel {
    settings: RunSettings,
    ground: GroundMap,
    /// The shape of each wheel, in the variant's order.
    shapes: Vec<Shape>,
    /// The angle of repose of each condition `[deg]`.
    repose_angles: Vec<Option<f64>>,
}

impl SpatialModel {
    /// Resolves the names of a variant of kind `scm`; [`CompileError`] names what is missing or cannot be expressed.
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, CompileError> {
        let choices = variant.spatial.ok_or(CompileError::NoSettings)?;
        let protocol = &variant.protocol;
        let settings = RunSettings {
            dem_spacing_m: choices.dem_spacing_m,
            travel_step_m: choices.travel_step_m,
            displacement: match choices.displacement {
                DisplacementFrame::Rim => spatial::Displacement::Rim,
                DisplacementFrame::Node => spatial::Displacement::Node,
            },
            pressure_direction: match choices.pressure_direction {
                PressureAxis::WheelNormal => spatial::PressureDirection::WheelNormal,
                PressureAxis::Vertical => spatial::PressureDirection::Vertical,
            },
            footprint: match choices.footprint {
                FootprintWidth::Hull => spatial::Footprint::Hull,
                FootprintWidth::Patches => spatial::Footprint::Patches,
            },
            vertical: match choices.vertical {
                HubMotion::Balance => spatial::Vertical::Balance,
                HubMotion::Dynamic => spatial::Vertical::Dynamic {
                    damping_n_s_m: choices.damping_n_s_m,
                    gravity_m_s2: variant.gravity_m_s2,
                },
            },
            protocol: match protocol.kind {
                ProtocolKind::Steady => spatial::Protocol::Steady {
                    tolerance: choices.steady_tolerance,
                    most_travel_m: choices.steady_travel_m,
                },
                ProtocolKind::Paper => spatial::Protocol::Fixed {
                    duration_s: PAPER_DURATION_S,
                    transient_force_s: protocol.simulated_transient_force_s,
                    transient_sinkage_s: protocol.simulated_transient_sinkage_s,
                    lowpass_hz: protocol.lowpass_hz,
                },
            },
            both_halves: false,
        };
        Ok(SpatialModel {
            settings,
            ground: GroundMap::new(variant)?,
            shapes: variant.wheels.values().map(shape).collect(),
            repose_angles: variant.conditions.iter().map(|c| c.repose_angle_deg).collect(),
        })
    }

    /// Simulates a wheel under the condition at a position of the variant.
    pub(super) fn run(
        &self,
        theta: &[f64],
        position: usize,
        soil: &Soil,
        (place, wheel): (usize, &Wheel),
        condition: &Condition,
        (effects, site): (&Active, &Site),
    ) -> Result<SpatialRun, Rejection> {
        let scene = Scene {
            soil,
            ground: &self.ground.ground(theta, self.repose_angles[position]),
            wheel,
            shape: &self.shapes[place],
            effects,
            site: *site,
        };
        spatial::simulate(&scene, condition, &self.settings)
    }
}

fn shape(wheel: &WheelGeometry) -> Shape {
    match &wheel.mesh {
        Some(mesh) => Shape::from(SurfaceMesh {
            vertices_m: mesh.vertices_m.clone(),
            triangles: mesh.triangles.clone(),
        }),
        None => {
            let grousers = Grousers {
                count: wheel.grouser_count,
                height_m: wheel.grouser_height_m,
                thickness_m: wheel.grouser_thickness_m,
            };
            wheel.tread.map_or(Shape::Rim(grousers), |tread| {
                Shape::Tread(Tread {
                    grousers,
                    rows: tread.rows,
                    stagger: tread.stagger,
                    width_m: tread.width_m,
                    angle_rad: tread.angle_deg.to_radians(),
                    chevron_rad: tread.chevron_deg.to_radians(),
                    bow_m: tread.bow_m,
                })
            })
        }
    }
}

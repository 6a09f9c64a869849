//! A wheel that rolls over a deformable terrain, in three dimensions.
//!
//! # Layout
//! - [`Scene`], [`RunSettings`], [`Ground`], [`Shape`], [`Tread`], [`SurfaceMesh`]: the inputs of a run.
//! - `run`: the wheel along its track, and the averages of force, torque and sinkage.
//! - `wheel`: the underside that the soil meets, and its motion.
//! - `contact`: the nodes in contact at a height, their pressure, force and torque.
//! - `side_wall`: soil that the side of the wheel pushes at a slip angle.
//! - `displacement`: the displacement between wheel and soil, if a formula uses it.
//! - `terrain`: the soil as a height field, its flow and its slopes.
//! - `pack`: four lanes at a time.

mod contact;
mod displacement;
#[cfg(test)]
mod fixture;
mod grousers;
mod pack;
mod run;
mod scene;
mod settings;
mod side_wall;
mod surface;
mod terrain;
mod tread;
mod wheel;

pub use grousers::Grousers;
pub use run::{History, SpatialRun};
pub use scene::Scene;
pub use settings::{
    Displacement, Footprint, Ground, PressureDirection, Protocol, RunSettings, Shape, Vertical,
};
pub use surface::{Normals, SurfaceMesh};
pub use tread::Tread;

use crate::rejection::require;
use crate::{Condition, Rejection};

/// Range of sled speeds for which the time and length of a step stay representable `[m/s]`.
const SPEEDS_M_S: [f64; 2] = [1e-6, 1e3];

/// Rolls a rigid wheel over deformable soil at prescribed speeds of sled and rim.
///
/// The soil is a height field of columns (spacing dx along the heading) and lanes (dy across). A step moves the wheel
/// on, then finds the height of the hub at which the soil carries the load. At a trial height, for every node under the
/// wheel with its surface h below the soil's surface `z_s`, per projected area dA:
///
/// - `p = min(gamma k* z^n, K_e (z_s − h))`, z below the reference `beta loose`, `k* = k_c / b_eff + k_phi`,
///   `b_eff = 2 A / L` of the hull of the whole footprint (area A, contour L), or of the node's patch: [`Footprint`]
/// - `gamma = d^m / mean(d^m)` over the patch, d the Euclidean distance from its border
/// - `tau = (c + p tan(phi)) (1 − exp(−|v_t| / v0))` against the slip velocity `v_t` of the wheel's surface, which has three
///   components
/// - `dF = (p n + tau t) dA / n_z` with the normal n of the wheel's surface (radial on rim *and* grousers, the facet's own on
///   a mesh), torque about the hub
///
/// Then the yielded nodes are left at `z_s = h + p / K_e`; a share `phi_f` of the displaced soil flows to the borders of the
/// footprint in front, behind and beside, in inverse proportion to their distances and by the direction of motion of the
/// wheel's surface; slopes steeper than the angle of repose slide, never into the wheel.
///
/// # Effects
/// With active effects, the run has the slip, radius, width, exponent and load that their formulas give. A wheel given as a
/// mesh keeps its size: a formula that would change it is rejected. At the nodes formulas replace the plastic pressure
/// before the elastic line bounds it, then the strength, then the magnitude of the shear stress, whose direction stays. The
/// shear displacement j is tracked if a formula uses it. `pass` counts from pass to pass at nodes and channels; for
/// dimensions it is the averaged pass.
///
/// - A load that depends on pull or torque takes those of the preceding step, and is nominal at first.
/// - Histories and averages hold the measured channels. The balance, the power and the energy check use the soil's forces.
///   Channels see the contact length of their step, k* weighted by area over the footprint's patches, and the effective
///   width of the last measured contour.
/// - Mechanisms: rebound `1 / K_e' = 1 / K_e + a`; a flat patch cuts the rim off at `R − a W`, the new reference of sinkage;
///   digging lowers the reference surface by `(d / l) |v_t| dt` under the sliding wheel; end walls multiply k* by
///   `1 + w (exp(−x / l) + exp(−(L − x) / l))`, x from the rear wall to the hub, x = R at the start of each pass; the
///   leading buried side meets passive earth pressure at a slip angle β, `s |sin β| (N (γ h²/2 + γ ζ h) + 2 c h √N)` per
///   length against the lateral motion and friction `tan(δ)` of that along the side, `N = tan²(45° + φ/2)`, h the depth of a
///   disc of radius R, ζ the mean height of the raised soil within `h √N` beside it.
///
/// Without effects none of this is evaluated. Checked by `spatial::effects`, `spatial::signatures`.
///
/// # Arguments
/// - `scene`, `condition`, `settings`: fields carry units and bounds. omega comes from the slip and the *rig's* radius.
///   `condition.pass` = k: the wheel passes k times over the same track under this condition, and the k-th pass is averaged.
///
/// # Returns
/// [`SpatialRun`]: averages by the protocol, and histories step by step.
///
/// # Errors
/// - [`Rejection::InvalidParameter`]: a field is outside its bounds. Nothing is clamped.
/// - [`Rejection::NoSupport`]: no balance before the hub reaches the undisturbed surface; also if k* ≤ 0 everywhere.
/// - [`Rejection::NoConvergence`]: the mean residual of the balance exceeds 2.5 % of the load, over the averaged steps or the run:
///   the load jumps as patches join.
/// - [`Rejection::EnergyGained`]: motor and sled gained work from the soil, on average: `T omega − F v < 0`.
/// - [`Rejection::Formula`]: a formula gives an inadmissible value, at a loaded node or for the run.
/// - [`Rejection::NotFinite`]: forces overflow. [`Rejection::Protocol`]: the protocol does not fit the run.
///
/// # Validity
/// Rigid wheel, dry granular soil, motion slow enough for the vertical balance (or [`Vertical::Dynamic`]). Stresses act on the
/// wheel's surface. A height field cannot represent the flanks of grousers: their thrust beyond the sheared tips, and the sideways
/// thrust of oblique grousers, are not modelled. With a negative `k_c` a footprint carries load only if `b_eff > −k_c / k_phi`: a
/// wheel of 50 mm balances down to kappa = −0.8, with and without grousers and flow, but not at −0.95, where the hull would have to
/// be longer than the wheel's radius; one of 112 mm balances at −0.95. With [`Footprint::Patches`] a single grouser's tip or lip of
/// a berm carries nothing, and the load jumps as patches join: no balance from kappa = −0.3 to −0.66 on. Checked by
/// `spatial::cohesion`. Wheels may be 126 lanes wide straight ahead, 62 at a slip angle.
///
/// # Numerics
/// dx is refined until eight nodes lie in the contact of a smooth wheel, on soil or on its elastic layer; the contact ends
/// between nodes, so that areas and distances do not jump. A grouser counts by its width over a column. Balance to 1.5e-2 of
/// the load, or to 1 µm where patches join; the next step subtracts the excess of a step, so that averages carry the load.
/// Slopes slide four times while the wheel moves by a column. If left and right are alike, half the wheel is modelled.
///
/// # Source
/// Krenn & Hirzinger's soil contact model (2008, 2009; see [Literature](crate#literature)) as the source paper describes it
/// (section 4, Eq. 5–10); gamma, flow, memory of compaction and grousers, which it leaves open, are choices of this crate.
/// Checked by `spatial::*`.
///
/// # Example
/// ```
/// use scm::spatial::{Ground, Grousers, Scene, RunSettings, Shape, simulate};
/// use scm::effects::{Active, Site};
/// use scm::{Condition, Soil, Wheel};
/// let soil = Soil { k_c: 0.0, k_phi: 1e7, n: 1.1, cohesion_pa: 0.0, friction_angle_rad: 30f64.to_radians(),
///     shear_velocity_m_s: 1e-3, gamma_exponent: 0.5 };
/// let wheel = Wheel { radius_m: 0.125, width_m: 0.112, rig_radius_m: 0.125 };
/// let shape = Shape::Rim(Grousers { count: 12, height_m: 0.009, thickness_m: 0.002 });
/// let condition = Condition { slip: 0.2, wheel_load_n: 100.0, sled_speed_m_s: 0.008, slip_angle_rad: 0.0, pass: 1 };
/// let (effects, site) = (Active::default(), Site::default()); // none; a smooth wheel on Earth
/// let scene = Scene { soil: &soil, ground: &Ground::default(), wheel: &wheel, shape: &shape, effects: &effects, site };
/// let run = simulate(&scene, &condition, &RunSettings::default())?;
/// assert!((run.averages.drawbar_pull_n - 39.4).abs() < 0.5 && (run.averages.sinkage_m - 5.24e-3).abs() < 1e-4);
/// # Ok::<(), scm::Rejection>(())
/// ```
pub fn simulate(
    scene: &Scene,
    condition: &Condition,
    settings: &RunSettings,
) -> Result<SpatialRun, Rejection> {
    let (soil, ground, wheel) = (
        scene.soil.checked()?,
        scene.ground.checked()?,
        scene.wheel.checked()?,
    );
    scene.shape.checked(&wheel)?;
    require_speed(condition.sled_speed_m_s)?;
    let (condition, settings) = (condition.checked()?, settings.checked()?);
    let scene = Scene {
        soil: &soil,
        ground: &ground,
        wheel: &wheel,
        ..*scene
    };
    if scene.effects.is_empty() {
        run::roll(&scene, &condition, None, settings)
    } else {
        simulate_with_effects(&scene, &condition, settings)
    }
}

/// Simulates the run with active effects: with the soil, wheel, sled speed and load after them.
fn simulate_with_effects(
    scene: &Scene,
    condition: &Condition,
    settings: RunSettings,
) -> Result<SpatialRun, Rejection> {
    let case = scene
        .effects
        .case(scene.soil, scene.wheel, condition, &scene.site)?;
    let (soil, wheel) = (case.soil.checked()?, case.wheel.checked()?);
    scene.shape.checked(&wheel)?;
    if let Shape::Mesh { .. } = scene.shape {
        let before = scene.wheel;
        for (name, value, original) in [
            ("radius_m", wheel.radius_m, before.radius_m),
            ("width_m", wheel.width_m, before.width_m),
        ] {
            let bound = "unchanged by effects: a wheel given as a mesh has its own size";
            require(value.to_bits() == original.to_bits(), name, value, "m", bound)?;
        }
    }
    let condition = case.condition.checked()?;
    require_speed(condition.sled_speed_m_s)?;
    let scene = Scene {
        soil: &soil,
        wheel: &wheel,
        ..*scene
    };
    run::roll(&scene, &condition, Some(&case), settings)
}

fn require_speed(speed: f64) -> Result<(), Rejection> {
    require(
        (SPEEDS_M_S[0]..=SPEEDS_M_S[1]).contains(&speed),
        "sled_speed_m_s",
        speed,
        "m/s",
        "between 1e-6 and 1000 for a wheel that rolls in time",
    )
}

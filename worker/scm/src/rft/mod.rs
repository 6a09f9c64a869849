//! Three-dimensional resistive force theory: stresses on a wheel that follow from the motion and depth of each of its elements.
//!
//! # Layout
//! - This file: the balance of the wheel load in steady motion, averaged over the turn of the wheel.
//! - `law`: stress on an element.
//! - `body`: the elements of a wheel with grousers, or of any surface.

mod body;
mod law;

use core::f64::consts::TAU;

use body::{Cylinder, Element, mesh_elements};
use formula::Variable;
use law::{dot, stress};

use crate::effects::{Active, Site};
use crate::footprint::rectangle_effective_width;
use crate::rejection::require;
use crate::spatial::{Grousers, SurfaceMesh};
use crate::{Averages, Condition, Rejection, Soil, Wheel};

/// Number of positions of the wheel, per pitch of its grousers, at which the load is balanced.
const POSITIONS: usize = 8;
/// Number of positions of a mesh over a whole turn.
const MESH_POSITIONS: usize = 16;
/// The golden ratio less 1: multiples of a turn by it are spread evenly for any number of grousers.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
/// The maximum number of trials of a load that depends on pull and torque, and its relative tolerance.
const TRIALS: u32 = 60;
const TOLERANCE: f64 = 1e-9;

/// A granular soil, and the roughness of the wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RftSoil {
    /// Scale factor of the stresses `xi_n` `[Pa/m]`, > 0: pressure under a level plate per depth, over 0.875.
    pub xi_n_pa_m: f64,
    /// Friction between the wheel's surface and the soil `[–]`, ≥ 0.
    pub surface_friction: f64,
}

impl RftSoil {
    /// Checks the bounds of the fields, and returns the soil; [`Rejection::InvalidParameter`] names the first field outside
    /// its bounds.
    pub fn checked(self) -> Result<Self, Rejection> {
        require(
            self.xi_n_pa_m > 0.0,
            "xi_n_pa_m",
            self.xi_n_pa_m,
            "Pa/m",
            "above 0",
        )?;
        require(
            self.surface_friction >= 0.0,
            "surface_friction",
            self.surface_friction,
            "(dimensionless)",
            "at least 0",
        )?;
        Ok(self)
    }
}

/// The surface that touches the soil.
#[derive(Debug, Clone)]
pub struct RftShape(Surface);

#[derive(Debug, Clone)]
enum Surface {
    Rim(Grousers),
    /// The elements at each position of the rotation.
    Mesh(Vec<Vec<Element>>),
}

impl RftShape {
    /// Returns the rim of a [`Wheel`], with straight grousers.
    pub fn rim(grousers: Grousers) -> Self {
        RftShape(Surface::Rim(grousers))
    }

    /// Returns a closed surface, with the errors of [`SurfaceMesh::checked`].
    ///
    /// Its triangles name their vertices counter-clockwise as seen from outside, or all clockwise; those with a side longer
    /// than 4 % of the reach are divided.
    pub fn mesh(mesh: &SurfaceMesh) -> Result<Self, Rejection> {
        mesh.checked()?;
        let elements = mesh_elements(mesh);
        let angle = |i: usize| {
            let turns = i as f64 * GOLDEN;
            TAU * (turns - libm::floor(turns))
        };
        let positions = (0..MESH_POSITIONS).map(|i| turned(&elements, angle(i)));
        Ok(RftShape(Surface::Mesh(positions.collect())))
    }
}

/// Computes the steady forces, torque and sinkage of a wheel in granular soil by three-dimensional resistive force
/// theory.
///
/// Every element of the surface that moves towards the soil, `v·n > 0`, at a depth h feels the force
/// `xi_n alpha(n, v / |v|) h dA`, alpha from the published fit (see `law`), `v = V + omega × r` in steady motion; forces add
/// up. The sinkage is the first, from the surface down, at which they carry the wheel load. Because alpha depends on neither
/// depth nor load, the load is piecewise linear in the sinkage and the balance exact. With grousers the wheel is balanced at
/// 8 positions of a pitch, a mesh at 16 of a turn, and the channels are the means.
///
/// # Arguments
/// - `soil`, `wheel`, `condition`: fields carry units and bounds. For a mesh, `wheel` gives the radius that sinkage and slip
///   refer to.
/// - `effects`: compiled for [`ModelForm::Rft`](crate::effects::ModelForm::Rft).
///
/// # Returns
/// [`Averages`]; `b_eff_m` belongs to a rectangle as long as the contact, the simulated travel is 0.
///
/// # Errors
/// - [`Rejection::InvalidParameter`]: a field is outside its bounds.
/// - [`Rejection::NoSupport`]: no balance with the hub above the surface.
/// - [`Rejection::NoConvergence`]: a load that an effect makes depend on pull and torque does not settle.
/// - [`Rejection::Formula`]: a formula gives an inadmissible value.
///
/// # Validity
/// Dry cohesionless soil with a level surface, low speed; no memory: every pass has the answer of the first; no element
/// shields another, as closely spaced grousers do. `xi_n` of a soil of density rho and internal friction mu is about
/// `rho g (894 mu³ − 386 mu² + 89 mu)` according to the paper.
///
/// # Numerics
/// Elements of half a degree along the rim, with the force at the middle of each; a mesh of 360 facets agrees within 0.01 W
/// in the forces and 2 % in the sinkage. The load is carried to rounding error.
///
/// # Source
/// Agarwal, Goldman & Kamrin 2023, <https://doi.org/10.1073/pnas.2214017120>. Checked by `rft::*`.
pub fn simulate(
    soil: &RftSoil,
    wheel: &Wheel,
    shape: &RftShape,
    condition: &Condition,
    effects: &mut Active,
    site: &Site,
) -> Result<Averages, Rejection> {
    let (soil, wheel, condition) = (soil.checked()?, wheel.checked()?, condition.checked()?);
    let case = effects.case(&WITHOUT_LAWS, &wheel, &condition, site)?;
    let (wheel, condition) = (case.wheel.checked()?, case.condition.checked()?);
    let motion = Motion::new(&wheel, &condition);
    let on_rim: Vec<Vec<Element>>;
    let elements = match &shape.0 {
        Surface::Rim(grousers) => {
            on_rim = rim_positions(*grousers, &wheel, motion.across.abs() > 0.0);
            &on_rim
        }
        Surface::Mesh(positions) => positions,
    };
    let positions = Positions {
        elements,
        motion,
        soil,
        radius_m: wheel.radius_m,
        width_m: wheel.width_m,
    };
    let follows = effects.load_follows_reaction();
    let mut load = condition.wheel_load_n;
    let mut averages = positions.balanced(load)?;
    for trial in 0..=TRIALS {
        if !follows {
            break;
        }
        let next = effects.wheel_load(&case, averages.drawbar_pull_n, averages.torque_n_m)?;
        if (next - load).abs() <= TOLERANCE * load {
            break;
        }
        if trial == TRIALS {
            return Err(Rejection::NoConvergence {
                residual_load_n: load - next,
                wheel_load_n: next,
                sinkage_m: averages.sinkage_m,
                evaluations: trial,
            });
        }
        load = next;
        averages = positions.balanced(load)?;
    }
    if effects.change_channels() {
        let mut variables = case.variables;
        variables[Variable::WheelLoad as usize] = load;
        effects.measure_averages(&mut variables, f64::NAN, &mut averages)?;
    }
    Ok(averages)
}

/// Returns the force on a level plate that is pressed into the soil, `xi_n alpha A d` `[N]`: linear in the depth.
///
/// # Arguments
/// - `area_m2`: A `[m²]`; `depth_m`: d `[m]`, ≥ 0.
///
/// [`Rejection::InvalidParameter`] if the soil is outside its bounds.
pub fn plate_force_n(soil: &RftSoil, area_m2: f64, depth_m: f64) -> Result<f64, Rejection> {
    let soil = soil.checked()?;
    let down = [0.0, 0.0, -1.0];
    let alpha = stress(down, down, soil.surface_friction).map_or(0.0, |alpha| alpha[2]);
    Ok(soil.xi_n_pa_m * alpha * area_m2 * depth_m)
}

/// Placeholder for a soil with the laws of Bekker and Mohr-Coulomb: effects that use them are refused at compilation.
const WITHOUT_LAWS: Soil = Soil {
    k_c: f64::NAN,
    k_phi: f64::NAN,
    n: f64::NAN,
    cohesion_pa: f64::NAN,
    friction_angle_rad: f64::NAN,
    shear_velocity_m_s: f64::NAN,
    gamma_exponent: f64::NAN,
};

/// The motion of a rigid body about its axle.
#[derive(Debug, Clone, Copy)]
struct Motion {
    along: f64,
    across: f64,
    /// Angular velocity `[rad/s]`, forwards.
    rotation: f64,
}

impl Motion {
    fn new(wheel: &Wheel, condition: &Condition) -> Self {
        let speed = condition.sled_speed_m_s;
        Motion {
            along: speed * libm::cos(condition.slip_angle_rad),
            across: speed * libm::sin(condition.slip_angle_rad),
            rotation: condition.rig_rim_speed_m_s() / wheel.rig_radius_m,
        }
    }

    /// Returns the direction in which a place moves; `None` at rest.
    fn direction(&self, at: [f64; 3]) -> Option<[f64; 3]> {
        let velocity = [
            self.along + self.rotation * at[2],
            self.across,
            -self.rotation * at[0],
        ];
        let speed = dot(velocity, velocity).sqrt();
        (speed > f64::MIN_POSITIVE).then(|| velocity.map(|component| component / speed))
    }
}

/// Returns the elements below the axle, lowest first, after the wheel has turned by an angle; elements above the axle
/// are never in the soil.
fn turned(elements: &[Element], angle: f64) -> Vec<Element> {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let mut below: Vec<Element> = elements
        .iter()
        .map(|element| element.turned(sin, cos))
        .filter(|element| element.at[2] < 0.0)
        .collect();
    below.sort_by(|a, b| a.at[2].total_cmp(&b.at[2])); // the sort is stable, so equal heights keep the order of the surface
    below
}

/// Returns the elements of a rim at positions evenly spread over the pitch of its grousers; one position if it has none.
fn rim_positions(grousers: Grousers, wheel: &Wheel, with_sides: bool) -> Vec<Vec<Element>> {
    let cylinder = Cylinder {
        radius_m: wheel.radius_m,
        width_m: wheel.width_m,
        grousers: grousers.count,
        grouser_height_m: grousers.height_m,
        grouser_thickness_m: grousers.thickness_m,
    };
    let elements = cylinder.elements(with_sides);
    if grousers.count == 0 {
        return vec![turned(&elements, 0.0)];
    }
    let step = TAU / (f64::from(grousers.count) * POSITIONS as f64);
    (0..POSITIONS)
        .map(|i| turned(&elements, i as f64 * step))
        .collect()
}

/// A moving wheel, at the positions of its rotation over which it is averaged.
#[derive(Debug)]
struct Positions<'a> {
    /// The elements at each position, lowest first.
    elements: &'a [Vec<Element>],
    motion: Motion,
    soil: RftSoil,
    radius_m: f64,
    width_m: f64,
}

/// A surface element that moves into the soil.
#[derive(Debug, Clone, Copy)]
struct Pushed {
    /// Height above the lowest element `[m]`.
    height: f64,
    /// Place ahead of the axle, and above it `[m]`.
    x: f64,
    z: f64,
    /// Force per depth `[N/m]`.
    force: [f64; 3],
}

impl Positions<'_> {
    fn pushed(&self, element: &Element, lowest: f64) -> Option<Pushed> {
        let direction = self.motion.direction(element.at)?;
        let alpha = stress(element.normal, direction, self.soil.surface_friction)?;
        let scale = self.soil.xi_n_pa_m * element.area;
        let [x, _, z] = element.at;
        Some(Pushed {
            height: z - lowest,
            x,
            z,
            force: alpha.map(|component| scale * component),
        })
    }

    /// Returns the elements up to the depth of the lowest one `[m]` at which the load is first carried, and that depth;
    /// else the largest load carried.
    fn sunk(&self, elements: &[Element], load: f64) -> Result<(Vec<Pushed>, f64), f64> {
        let lowest = elements.first().map_or(0.0, |element| element.at[2]);
        let mut pushed = Vec::new();
        // W(d) = S0 d − S1 between the heights of two elements
        let (mut stiffness, mut offset, mut max_carried) = (0.0, 0.0, 0.0_f64);
        for (i, element) in elements.iter().enumerate() {
            if let Some(part) = self.pushed(element, lowest) {
                stiffness += part.force[2];
                offset += part.force[2] * part.height;
                pushed.push(part);
            }
            let next = elements.get(i + 1).map_or(0.0, |next| next.at[2]) - lowest;
            let carried = stiffness * next - offset;
            max_carried = max_carried.max(carried);
            if carried >= load && stiffness > 0.0 {
                return Ok((pushed, (load + offset) / stiffness));
            }
        }
        Err(max_carried)
    }

    /// Returns the means over the positions, each in balance.
    fn balanced(&self, load: f64) -> Result<Averages, Rejection> {
        let mut mean = Averages::default();
        let share = 1.0 / self.elements.len() as f64;
        for elements in self.elements {
            let (pushed, depth) =
                self.sunk(elements, load)
                    .map_err(|max_carried_n| Rejection::NoSupport {
                        max_carried_n,
                        wheel_load_n: load,
                        wheel_radius_m: self.radius_m,
                    })?;
            let lowest = elements.first().map_or(0.0, |element| element.at[2]);
            let (mut carried, mut front, mut rear) = (0.0, 0.0_f64, 0.0_f64);
            for part in &pushed {
                let below = depth - part.height;
                let [x, y, z] = part.force.map(|per_depth| per_depth * below);
                mean.drawbar_pull_n += share * x;
                mean.lateral_force_n -= share * y;
                mean.torque_n_m += share * (part.x * z - part.z * x);
                carried += z;
                front = front.max(part.x);
                rear = rear.min(part.x);
            }
            mean.nodes_in_contact += pushed.len() as u32;
            mean.sinkage_m += share * (self.radius_m + lowest + depth);
            mean.residual_load_n += share * (carried - load);
            mean.contact_length_m += share * (front - rear);
        }
        mean.b_eff_m = rectangle_effective_width(mean.contact_length_m, self.width_m);
        for (quantity, value) in [
            ("drawbar pull", mean.drawbar_pull_n),
            ("torque", mean.torque_n_m),
            ("lateral force", mean.lateral_force_n),
        ] {
            if !value.is_finite() {
                return Err(Rejection::NotFinite { quantity, value });
            }
        }
        Ok(mean)
    }
}

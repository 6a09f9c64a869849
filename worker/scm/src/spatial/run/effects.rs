//! Effects on a run: on the wheel, the soil, the load and the measured channels.

use formula::Variable;
use formula::effect::Mechanism;

use crate::Rejection;
use crate::effects::Active;
use crate::effects::case::Case;
use crate::rejection::require;
use crate::spatial::contact::Contact;
use crate::spatial::contact::formulas::NodeFormulas;
use crate::spatial::contact::laws::Laws;
use crate::spatial::contact::reaction::Reaction;
use crate::spatial::scene::Scene;
use crate::spatial::settings::{Ground, Shape};
use crate::spatial::side_wall::SideWall;

/// The effects of one run.
///
/// Mechanisms, with parameters a, d, w and l:
/// - rebound: the soil unloads and reloads with `1 / (1 / K_e + a)`.
/// - flat patch: the load W cuts the rim off at `R − a W`, see [`Cylinder`](crate::spatial::wheel::cylinder::Cylinder), and
///   sinkage is counted from there.
/// - digging: the reference surface sinks under the sliding wheel, see [`Contact::dig`].
/// - end wall: k* is multiplied by `1 + w (exp(−x/l) + exp(−(L − x)/l))`, where x is the distance of the hub from the rear
///   wall of the bin and L the bin's length. A run, and every pass, starts with the rim at the rear wall, x = R.
/// - side wall: soil beside the wheel pushes against its buried side, see [`SideWall`].
#[derive(Debug)]
pub(super) struct RunEffects<'a> {
    active: &'a Active<'a>,
    case: &'a Case,
    /// The variables that formulas see and all nodes share, as far as known.
    variables: [f64; Variable::COUNT],
    pub(super) nodes: Option<NodeFormulas<'a>>,
    wall: Option<EndWall>,
    pub(super) side: Option<SideWall>,
    /// d `[m]`; 0 without digging.
    digging_m: f64,
    load_follows: bool,
    change_channels: bool,
}

/// The soil near the ends of its bin.
#[derive(Debug, Clone, Copy)]
struct EndWall {
    stiffening: f64,
    reach_m: f64,
    bin_length_m: f64,
}

impl<'a> RunEffects<'a> {
    /// Creates the effects on a run over the case's scene; [`Rejection::InvalidParameter`] if a mechanism's parameter is
    /// outside its bounds, or a quantity that it needs is unknown.
    pub(super) fn new(active: &'a Active<'a>, case: &'a Case, width: f64) -> Result<Self, Rejection> {
        let nodes = active.nodes.clone();
        Ok(Self {
            active,
            case,
            variables: case.variables,
            nodes: nodes.map(|laws| NodeFormulas::new(laws, case.variables, width)),
            wall: EndWall::find(active, case)?,
            side: side_wall(active, case)?,
            digging_m: digging(active)?,
            load_follows: active.load_follows_reaction(),
            change_channels: active.change_channels(),
        })
    }

    /// Changes a variable that formulas see.
    fn set(&mut self, variable: Variable, value: f64) {
        self.variables[variable as usize] = value;
        if let Some(nodes) = &mut self.nodes {
            nodes.set(variable, value);
        }
    }

    /// Begins a step of a pass under a load `[N]`.
    pub(super) fn begin_step(&mut self, pass: u32, load: f64) {
        self.set(Variable::Pass, f64::from(pass));
        // nodes keep seeing the load without the part that depends on the reaction
        self.variables[Variable::WheelLoad as usize] = load;
    }

    /// Sets the stiffness of the soil after a travel `[m]` along the bin; [`Rejection::InvalidParameter`] if the rim would
    /// be beyond the front wall.
    pub(super) fn confine(&self, laws: &mut Laws, travelled: f64) -> Result<(), Rejection> {
        let Some(wall) = self.wall else { return Ok(()) };
        let factor = wall.factor(self.case.wheel.radius_m, travelled)?;
        laws.soil.k_c = factor * self.case.soil.k_c;
        laws.soil.k_phi = factor * self.case.soil.k_phi;
        Ok(())
    }

    /// Returns the load of the next step `[N]`, if it depends on pull and torque of this one.
    pub(super) fn next_load(&self, reaction: &Reaction) -> Result<Option<f64>, Rejection> {
        if !self.load_follows {
            return Ok(None);
        }
        let (pull, torque) = (reaction.force_x, reaction.torque);
        self.active.wheel_load(self.case, pull, torque).map(Some)
    }

    /// Returns the depth that the wheel digs per distance slid over a whole contact `[m]`, if it digs.
    pub(super) fn digging_m(&self) -> Option<f64> {
        (self.digging_m > 0.0).then_some(self.digging_m)
    }

    /// Returns whether an effect changes the measured channels.
    pub(super) fn change_channels(&self) -> bool {
        self.change_channels
    }

    /// Returns the measured drawbar pull, torque, sinkage and lateral force. `b_eff` belongs to the last measured contour
    /// `[m]`; formulas see k* as its mean over the footprint.
    pub(super) fn measure(
        &self,
        channels: [f64; 4],
        contact: &Contact,
        contact_length: f64,
        b_eff: f64,
    ) -> Result<[f64; 4], Rejection> {
        const CHANNELS: [Variable; 4] = [
            Variable::DrawbarPull,
            Variable::Torque,
            Variable::Sinkage,
            Variable::LateralForce,
        ];
        let mut variables = self.variables;
        variables[Variable::ContactLength as usize] = contact_length;
        variables[Variable::BEff as usize] = b_eff;
        variables[Variable::KStar as usize] = contact.modulus();
        for (variable, value) in CHANNELS.into_iter().zip(channels) {
            variables[variable as usize] = value;
        }
        self.active.measure(&mut variables)?;
        Ok(CHANNELS.map(|variable| variables[variable as usize]))
    }
}

impl EndWall {
    fn find(active: &Active, case: &Case) -> Result<Option<Self>, Rejection> {
        let Some(&[stiffening, reach_m]) = active.mechanism(Mechanism::EndWall) else {
            return Ok(None);
        };
        require(
            stiffening >= 0.0,
            "wall_stiffening",
            stiffening,
            "(dimensionless)",
            "at least 0",
        )?;
        require(reach_m > 0.0, "reach_m", reach_m, "m", "above 0")?;
        let bin_length_m = case.variables[Variable::BinLength as usize];
        let min_length = 2.0 * case.wheel.radius_m;
        require(
            bin_length_m > min_length,
            "bin_length_m",
            bin_length_m,
            "m",
            "known where end_wall enters, and longer than the wheel",
        )?;
        Ok(Some(Self {
            stiffening,
            reach_m,
            bin_length_m,
        }))
    }

    /// Returns the factor of the soil's stiffness for a wheel of a radius after a travel from the rear wall `[m]`.
    fn factor(&self, radius: f64, travelled: f64) -> Result<f64, Rejection> {
        let behind = radius + travelled;
        let ahead = self.bin_length_m - behind;
        require(
            ahead >= radius,
            "bin_length_m",
            self.bin_length_m,
            "m",
            "long enough for the run where end_wall enters",
        )?;
        let near = |distance: f64| libm::exp(-distance / self.reach_m);
        Ok(1.0 + self.stiffening * (near(behind) + near(ahead)))
    }
}

fn digging(active: &Active) -> Result<f64, Rejection> {
    let values = active.mechanism(Mechanism::Digging);
    let depth = values.and_then(|values| values.first().copied()).unwrap_or(0.0);
    require(depth >= 0.0, "depth_m", depth, "m", "at least 0")?;
    Ok(depth)
}

fn side_wall(active: &Active, case: &Case) -> Result<Option<SideWall>, Rejection> {
    let Some(&[scale, friction]) = active.mechanism(Mechanism::SideWall) else {
        return Ok(None);
    };
    let value_of = |variable: Variable| case.variables[variable as usize];
    SideWall::new(
        [scale, friction],
        &case.soil,
        case.wheel.radius_m,
        [value_of(Variable::Density), value_of(Variable::Gravity)],
        &case.condition,
    )
}

/// Stiffness of unloading and reloading of rebounding soil `[Pa/m]`.
pub(super) fn elastic_stiffness(active: &Active, ground: &Ground) -> Result<f64, Rejection> {
    let stiffness = ground.elastic_stiffness_pa_m;
    let Some(&[compliance]) = active.mechanism(Mechanism::Rebound) else {
        return Ok(stiffness);
    };
    require(
        compliance >= 0.0,
        "compliance_m_pa",
        compliance,
        "m/Pa",
        "at least 0",
    )?;
    Ok(1.0 / (1.0 / stiffness + compliance))
}

/// Returns the deflection of the rim by the load `[m]`.
pub(super) fn deflection(scene: &Scene, wheel_load_n: f64) -> Result<f64, Rejection> {
    let Some(&[per_load]) = scene.effects.mechanism(Mechanism::FlatPatch) else {
        return Ok(0.0);
    };
    let rigid = matches!(scene.shape, Shape::Mesh { .. });
    let bound = if rigid {
        "0 for a wheel given as a mesh, which is as rigid as it was given"
    } else {
        "at least 0, and the deflection less than the radius"
    };
    let fits = per_load >= 0.0 && per_load * wheel_load_n < scene.wheel.radius_m && !rigid;
    require(fits, "deflection_m_n", per_load, "m/N", bound)?;
    Ok(per_load * wheel_load_n)
}

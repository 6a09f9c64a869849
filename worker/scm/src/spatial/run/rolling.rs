//! The roll of the wheel over the terrain, one step after another.

use super::balance::{Search, balance};
use super::effects::{RunEffects, deflection, elastic_stiffness};
use super::track::{Steps, fit_to_pitch, spacing_along, steps, terrain};
use crate::effects::case::Case;
use crate::rejection::Rejection;
use crate::spatial::contact::Contact;
use crate::spatial::contact::laws::Laws;
use crate::spatial::contact::reaction::Reaction;
use crate::spatial::displacement::ShearPath;
use crate::spatial::scene::Scene;
use crate::spatial::settings::{Ground, PressureDirection, Protocol, RunSettings, Vertical};
use crate::spatial::terrain::Terrain;
use crate::spatial::terrain::flow::Flow;
use crate::spatial::terrain::relaxation::Relaxation;
use crate::spatial::wheel::Underside;
use crate::spatial::wheel::envelope::Envelope;
use crate::spatial::wheel::motion::Motion;
use crate::spatial::wheel::pose::{Pose, Range};
use crate::{Condition, Wheel};
use formula::Variable;

/// Distance below the highest soil that the wheel may sink within a step `[m]`; at the start of a run the wheel sinks from above the
/// soil.
const SINKS_PER_STEP: f64 = 1e-3;
/// Number of columns beyond the last contact over which the wheel is laid.
const MARGIN: usize = 3;
const WIDEST_MARGIN: usize = 48;
/// Longest grouser period, relative to the requested travel.
const SLOWEST_TURN: f64 = 2.0;
/// Largest excess that the next step subtracts, relative to the load; a jump of the load may leave more.
const MAX_SURPLUS: f64 = 0.02;
/// Bounds of the load's slope at the start of a search for a balance, relative to load / radius.
const SLOPES: [f64; 2] = [-5e3, -2.0];

/// The result of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) reaction: Reaction,
    /// Height of the hub above the undisturbed surface `[m]`.
    pub(crate) hub: f64,
    /// Vertical velocity of the hub `[m/s]`.
    pub(crate) rising: f64,
    /// The load to be carried `[N]`.
    pub(crate) load: f64,
    /// Carried load less wheel load, inertia and damping, with the excess taken over from preceding steps `[N]`.
    pub(crate) residual: f64,
}

/// A wheel that rolls along its track.
pub(crate) struct Rolling<'a> {
    wheel: &'a Wheel,
    condition: &'a Condition,
    settings: RunSettings,
    ground: Ground,
    pub(crate) motion: Motion,
    pub(crate) steps: Steps,
    laws: Laws,
    underside: Underside,
    /// The shear displacement; `None` if no formula uses it.
    shear_path: Option<ShearPath>,
    /// The effects; `None` if none is active.
    pub(super) effects: Option<RunEffects<'a>>,
    pass: u32,
    terrain: Terrain,
    envelope: Envelope,
    pub(crate) contact: Contact,
    flow: Flow,
    relaxation: Relaxation,
    start: f64,
    pose: Pose,
    /// Lateral travel of the wheel `[m]`; the pose is rounded to the nearest lane.
    drifted: f64,
    /// The load to be carried now, and the distance of the hub from the rim's bottom under it.
    load: f64,
    /// Excess of the carried loads of the steps so far over their loads, which the next step subtracts: the mean load is
    /// exact, so that the tolerance does not show in averages `[N]`.
    surplus: f64,
    loaded_radius: f64,
    hub: f64,
    rising: f64,
    slope: f64,
    touched: Option<Range>,
    /// Heights of the hub at which, by its slope, each step of this pass would meet the load exactly `[m]`.
    ///
    /// The next step starts from there: if it started from the height itself, whose residual is tolerated, every step would
    /// miss the load on the same side.
    heights: Vec<f64>,
    repeats_after: usize,
    /// Travel that fits on the terrain `[m]`.
    pub(crate) track: f64,
    /// Time from one grouser to the next, if a second one follows within the track `[s]`.
    period: Option<f64>,
}

impl<'a> Rolling<'a> {
    /// Creates a wheel above undisturbed soil, for a travel `[m]`.
    ///
    /// The terrain of a steady run holds at least two grouser periods. A wheel that turns so slowly that they would take
    /// more than [`SLOWEST_TURN`] times the travel counts as locked. `case`: with active effects, soil, wheel and condition
    /// after them, as in scene and condition.
    pub(crate) fn new(
        scene: &Scene<'a>,
        condition: &'a Condition,
        case: Option<&'a Case>,
        settings: RunSettings,
        travel: f64,
    ) -> Result<Self, Rejection> {
        let Scene {
            soil, ground, wheel, ..
        } = scene;
        let motion = Motion::new(wheel, condition);
        let deflection = deflection(scene, condition.wheel_load_n)?;
        let underside = Underside::new(wheel, scene.shape, deflection);
        let mirrored = !settings.both_halves && motion.lateral.abs() == 0.0 && underside.is_symmetric();
        let elastic_stiffness = elastic_stiffness(scene.effects, ground)?;
        let dx = spacing_along(soil, elastic_stiffness, wheel, condition, &settings);
        let rotation = motion.rotation.abs();
        let period = underside
            .repeats_per_turn()
            .filter(|_| rotation > 0.0)
            .map(|count| core::f64::consts::TAU / (f64::from(count) * rotation))
            .filter(|period| period * condition.sled_speed_m_s <= SLOWEST_TURN * travel);
        let dx = match (settings.protocol, period) {
            (Protocol::Steady { .. }, Some(period)) => fit_to_pitch(dx, period * motion.forward.abs()),
            _ => dx,
        };
        let steps = steps(wheel, condition, &motion, &settings, dx);
        let width = underside.width(wheel);
        let travel = match settings.protocol {
            Protocol::Steady { .. } => {
                let room = period.map_or(0.0, |period| {
                    2.0 * period * condition.sled_speed_m_s + steps.travel
                });
                travel.max(room)
            }
            Protocol::Fixed { .. } => travel,
        };
        let (mut terrain, start) =
            terrain(width, &motion, &settings, dx, underside.reach(), travel, mirrored)?;
        let repeats_after = if underside.repeats_per_turn().is_none() {
            steps.to_column
        } else {
            1
        };
        let effects = case
            .map(|case| RunEffects::new(scene.effects, case, width))
            .transpose()?;
        if effects.as_ref().and_then(RunEffects::digging_m).is_some() {
            terrain.make_diggable();
        }
        let nodes = effects.as_ref().and_then(|effects| effects.nodes.as_ref());
        let slides = nodes.is_some_and(|nodes| nodes.use_variable(Variable::J));
        Ok(Self {
            wheel,
            condition,
            settings,
            ground: **ground,
            motion,
            steps,
            laws: Laws::new(soil, elastic_stiffness, ground.bearing_credit),
            shear_path: slides.then(|| ShearPath::new(settings.displacement, wheel.radius_m, dx)),
            effects,
            pass: 1,
            underside,
            terrain,
            envelope: Envelope::default(),
            contact: Contact::new(settings.footprint),
            flow: Flow::default(),
            relaxation: Relaxation::new(ground.repose_angle_rad),
            start,
            pose: Pose {
                x: start,
                y: 0.0,
                turned: 0.0,
            },
            drifted: 0.0,
            load: condition.wheel_load_n,
            surplus: 0.0,
            loaded_radius: wheel.radius_m - deflection,
            hub: wheel.radius_m,
            rising: 0.0,
            slope: 0.0,
            touched: None,
            heights: Vec::new(),
            repeats_after,
            track: travel,
            period,
        })
    }

    /// Puts the wheel back to the start of its track, above its rut.
    pub(crate) fn start_again(&mut self) {
        self.relaxation.relax_everywhere(&mut self.terrain);
        self.terrain.sheared.fill(0.0);
        if let Some(path) = &mut self.shear_path {
            path.clear();
        }
        self.pass += 1;
        (self.load, self.surplus) = (self.condition.wheel_load_n, 0.0);
        self.pose = Pose {
            x: self.start,
            y: 0.0,
            turned: 0.0,
        };
        self.drifted = 0.0;
        self.hub = self.wheel.radius_m + self.terrain.top;
        (self.rising, self.slope, self.touched) = (0.0, 0.0, None);
        self.heights.clear();
    }

    /// Lowers the wheel onto the soil where it stands.
    pub(crate) fn lower(&mut self) -> Result<Step, Rejection> {
        self.slope = -self.condition.wheel_load_n / (0.05 * self.wheel.radius_m);
        self.advance(0.0)
    }

    /// Moves the wheel by one step.
    pub(crate) fn step(&mut self) -> Result<Step, Rejection> {
        let time = self.steps.time;
        self.pose.x += self.motion.forward * time;
        // Lanes fit the width, so a wheel that drifts sideways is placed on the nearest whole lane: a lane covered by a sliver
        // would never be pressed down, and its undisturbed soil would join patches and lengthen contours, however thin it is.
        self.drifted += self.motion.lateral * time;
        self.pose.y = libm::round(self.drifted / self.terrain.dy) * self.terrain.dy;
        self.pose.turned += self.motion.rotation * time;
        self.advance(time)
    }

    fn advance(&mut self, time: f64) -> Result<Step, Rejection> {
        self.contact
            .across
            .lay(&self.terrain, self.pose.y, self.underside.width(self.wheel));
        if let Some(effects) = &mut self.effects {
            effects.begin_step(self.pass, self.load);
            let travelled = libm::hypot(self.pose.x - self.start, self.drifted);
            effects.confine(&mut self.laws, travelled)?;
        }
        let mut margin = MARGIN;
        let balance = loop {
            self.bring_together(margin, time > 0.0);
            let balance = self.find_height(time)?;
            let cramped = self.contact.first < 2 || self.contact.end + 2 > self.contact.strips.len();
            if !cramped || margin >= WIDEST_MARGIN {
                break balance;
            }
            margin *= 2;
        };
        self.rising = if time > 0.0 {
            (balance.height - self.hub) / time
        } else {
            0.0
        };
        self.hub = balance.height;
        let max = MAX_SURPLUS * self.load;
        let missed = balance.residual - self.surplus;
        self.surplus = balance.residual.clamp(-max, max);
        let stiffness = self.condition.wheel_load_n / self.wheel.radius_m;
        let slope = balance
            .slope
            .max(SLOPES[0] * stiffness)
            .min(SLOPES[1] * stiffness);
        self.slope = if time > 0.0 {
            0.5 * (self.slope + slope)
        } else {
            slope
        };
        self.heights.push(balance.height - missed / self.slope);
        let nodes = self.effects.as_mut().and_then(|effects| effects.nodes.as_mut());
        let strengths = nodes.map(|nodes| nodes.strengths(&self.contact, &self.laws));
        let mut reaction = self.contact.react(&self.terrain, &self.laws, strengths);
        if let Some(side) = self.effects.as_ref().and_then(|effects| effects.side) {
            let law = &self.laws.shear_velocity;
            let at = (self.pose, self.hub);
            let push = side.push(&self.contact, &self.terrain, at, &self.motion, law);
            reaction.force_x += push.force_x;
            reaction.force_y += push.force_y;
            reaction.force_z += push.force_z;
            reaction.torque += push.torque;
        }
        if self.contact.end > self.contact.first {
            if let Some(path) = &mut self.shear_path {
                path.slide(&self.contact, &mut self.terrain, self.pose.turned, time);
            }
            if let Some(depth) = self.effects.as_ref().and_then(RunEffects::digging_m) {
                let length = reaction.area / self.width();
                self.contact.dig(&mut self.terrain, depth, length, time);
            }
            let fraction = self.ground.flow_fraction;
            self.flow.deform(
                &self.contact,
                &mut self.terrain,
                &self.laws,
                &self.motion,
                fraction,
            );
            if self.heights.len().is_multiple_of(self.steps.to_slide) {
                self.relaxation.relax(&mut self.terrain, &self.contact, self.hub);
            }
            let strips = &self.contact.strips;
            self.touched = Some(Range {
                start: strips[self.contact.first].column,
                end: strips[self.contact.end - 1].column + 1,
            });
        }
        let step = Step {
            reaction,
            hub: self.hub,
            rising: self.rising,
            load: self.load,
            residual: balance.residual,
        };
        if let Some(effects) = &self.effects {
            self.load = effects.next_load(&reaction)?.unwrap_or(self.load);
        }
        Ok(step)
    }

    /// Lays the wheel over the columns that it may touch.
    fn bring_together(&mut self, margin: usize, rolls: bool) {
        let sinks = if rolls {
            SINKS_PER_STEP
        } else {
            0.2 * self.wheel.radius_m
        };
        let min_rise = (self.hub - self.terrain.top - sinks * (margin / MARGIN) as f64).max(0.0);
        let range = match self.touched {
            Some(touched) if margin < WIDEST_MARGIN => Range {
                start: touched.start.saturating_sub(margin),
                end: touched.end + margin,
            },
            _ => {
                let reach = self.underside.reach();
                let half = (reach * reach - min_rise * min_rise).max(0.0).sqrt();
                let column = |x: f64| (x / self.terrain.dx) as usize;
                Range {
                    start: column(self.pose.x - half).saturating_sub(MARGIN),
                    end: column(self.pose.x + half) + MARGIN + 1,
                }
            }
        };
        self.underside.lay(
            &self.terrain,
            self.pose,
            range,
            min_rise,
            &self.contact.across,
            &mut self.envelope,
        );
        let vertical = self.settings.pressure_direction == PressureDirection::Vertical;
        self.contact
            .prepare(&self.terrain, &self.envelope, &self.laws, &self.motion, vertical);
        if let Some(nodes) = self.effects.as_mut().and_then(|effects| effects.nodes.as_mut()) {
            if let Some(path) = &mut self.shear_path {
                path.measure(&self.contact, &self.terrain, self.pose.turned, &mut nodes.slid);
            }
            nodes.prepare(&mut self.contact, &self.envelope, &self.laws, &self.motion);
        }
    }

    /// Returns the height of the hub in balance with load, inertia and damping.
    fn find_height(&mut self, time: f64) -> Result<super::balance::Balance, Rejection> {
        let (load, surplus) = (self.load, self.surplus);
        let (hub, rising) = (self.hub, self.rising);
        let (mass, damping) = match self.settings.vertical {
            Vertical::Dynamic {
                damping_n_s_m,
                gravity_m_s2,
            } if time > 0.0 => (self.condition.wheel_load_n / gravity_m_s2, damping_n_s_m),
            _ => (0.0, 0.0),
        };
        let trend = self
            .heights
            .len()
            .checked_sub(self.repeats_after + 1)
            .map_or(0.0, |i| self.heights[i + 1] - self.heights[i]);
        let search = Search {
            guess: self.heights.last().copied().unwrap_or(hub) + trend,
            slope: self.slope,
            longest: if time > 0.0 {
                SINKS_PER_STEP
            } else {
                0.02 * self.wheel.radius_m
            },
        };
        let side = self.effects.as_ref().and_then(|effects| effects.side);
        let (pose, motion) = (self.pose, &self.motion);
        let (contact, terrain, laws) = (&mut self.contact, &self.terrain, &self.laws);
        let per_time = if time > 0.0 { 1.0 / time } else { 0.0 };
        let mut max_carried = 0.0_f64;
        let mut nodes = self.effects.as_mut().and_then(|effects| effects.nodes.as_mut());
        let balance = balance(search, load, 0.0, |height| {
            let carried = match &mut nodes {
                None => contact.press(terrain, laws, height),
                Some(nodes) => nodes.press(contact, terrain, laws, height),
            };
            let carried = side.map_or(carried, |side| {
                let law = &laws.shear_velocity;
                carried + side.push(contact, terrain, (pose, height), motion, law).force_z
            });
            max_carried = max_carried.max(carried);
            let velocity = (height - hub) * per_time;
            carried - load + surplus - damping * velocity - mass * (velocity - rising) * per_time
        });
        if let Some(refused) = nodes.and_then(|nodes| nodes.refused.take()) {
            return Err(refused);
        }
        let balance = balance.ok_or(Rejection::NoSupport {
            max_carried_n: max_carried,
            wheel_load_n: load,
            wheel_radius_m: self.wheel.radius_m,
        })?;
        if balance.residual.is_finite() {
            Ok(balance)
        } else {
            Err(Rejection::NotFinite {
                quantity: "load carried by the soil",
                value: balance.residual,
            })
        }
    }

    /// Returns the time from one grouser to the next `[s]`; `None` if nothing repeats.
    pub(crate) fn grouser_period_s(&self) -> Option<f64> {
        self.period
    }

    /// Returns the load of the condition `[N]`.
    pub(crate) fn nominal_load(&self) -> f64 {
        self.condition.wheel_load_n
    }

    pub(crate) fn radius(&self) -> f64 {
        self.wheel.radius_m
    }

    pub(crate) fn width(&self) -> f64 {
        self.underside.width(self.wheel)
    }

    /// Returns the effective width 2 A / L of the footprint at the last height `[m]`.
    pub(crate) fn effective_width(&mut self) -> f64 {
        self.contact.effective_width(&self.terrain, &self.laws)
    }

    /// Returns the sinkage at a hub height, with reference to the rim under its load `[m]`.
    pub(crate) fn sinkage(&self, hub: f64) -> f64 {
        self.loaded_radius - hub
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Active, CompiledEffects, ModelForm};
    use crate::fixture::CONDITION;
    use crate::spatial::fixture::{BARS, scene};
    use crate::spatial::{Grousers, Shape};

    fn condition(slip_angle_rad: f64) -> Condition {
        Condition {
            slip_angle_rad,
            ..CONDITION
        }
    }

    /// Rolls a wheel with grousers for 300 steps, and passes it to `look` after each.
    fn roll(
        flow_fraction: f64,
        slip_angle_rad: f64,
        both_halves: bool,
        effects: &Active,
        mut look: impl FnMut(&Rolling),
    ) {
        let ground = Ground {
            flow_fraction,
            ..Ground::default()
        };
        let shape = Shape::Rim(BARS);
        let scene = scene(&ground, &shape, effects);
        let settings = RunSettings {
            both_halves,
            ..RunSettings::default()
        };
        let condition = condition(slip_angle_rad);
        let case = effects.case(scene.soil, scene.wheel, &condition, &scene.site);
        let case = case.expect("admissible formulas");
        let case = (!effects.is_empty()).then_some(&case);
        let mut rolling = Rolling::new(&scene, &condition, case, settings, 0.2).expect("a track");
        rolling.lower().expect("support");
        look(&rolling);
        for _ in 0..300 {
            rolling.step().expect("support");
            look(&rolling);
        }
    }

    #[test]
    fn the_soil_that_does_not_compact_is_all_there() {
        let digging = formula::catalogue::find("slip_digging").expect("in the catalogue");
        let digging = CompiledEffects::compile(ModelForm::Spatial, [digging]).expect("a mechanism");
        let (none, digging) = (Active::default(), digging.activate([vec![0.01]]));
        for (fraction, slip_angle, both_halves, effects) in [
            (0.0, 0.0, false, &none),
            (0.25, 0.0, false, &none),
            (0.25, 0.0, true, &none),
            (1.0, 0.0, false, &none),
            (0.25, 0.2, true, &none),
            (0.25, 0.0, false, &digging),
            (1.0, 0.2, true, &digging),
        ] {
            let mut pressed = 0.0;
            roll(fraction, slip_angle, both_halves, effects, |rolling| {
                let (terrain, flow) = (&rolling.terrain, &rolling.flow);
                let rounding = 1e-12 * flow.pressed;
                let risen: f64 = terrain.surface.iter().sum();
                let loose: f64 = terrain.loose.iter().sum();
                let compacted = (1.0 - fraction) * flow.pressed;
                assert!((risen + compacted).abs() < rounding, "{risen}");
                assert!((loose - fraction * flow.pressed).abs() < rounding, "{loose}");
                assert!((flow.flowed - fraction * flow.pressed).abs() < rounding);
                pressed = flow.pressed;
            });
            // 300 steps of 0.5 mm over 14 lanes of half the wheel, some 5 mm deep, on nodes of 4 mm by 4 mm
            assert!(
                pressed > 1.0,
                "{pressed} m on all nodes: hardly anything was pressed"
            );
        }
    }

    #[test]
    fn between_passes_the_rut_stays_and_its_slopes_slide() {
        let (ground, shape) = (Ground::default(), Shape::Rim(Grousers::default()));
        let none = Active::default();
        let scene = scene(&ground, &shape, &none);
        let condition = condition(0.0);
        let settings = RunSettings {
            displacement: crate::spatial::Displacement::Node,
            ..RunSettings::default()
        };
        let mut rolling = Rolling::new(&scene, &condition, None, settings, 0.1).expect("a track");
        rolling.lower().expect("support");
        for _ in 0..200 {
            rolling.step().expect("support");
        }
        let steepest = |terrain: &Terrain| {
            let columns = terrain.surface.chunks_exact(terrain.lanes);
            let pairs = columns.flat_map(|column| column.windows(2));
            let slopes = pairs.map(|pair| (pair[1] - pair[0]).abs() / terrain.dy);
            slopes.fold(0.0_f64, f64::max)
        };
        let deepest = |terrain: &Terrain| terrain.surface.iter().fold(0.0_f64, |low, &z| low.min(z));
        let repose = libm::tan(ground.repose_angle_rad);
        let (slope, depth) = (steepest(&rolling.terrain), deepest(&rolling.terrain));
        assert!(slope > 1.2 * repose, "{slope}: nothing to slide");
        rolling.start_again();
        let slope = steepest(&rolling.terrain);
        assert!(slope < 1.02 * repose, "{slope}");
        assert!((deepest(&rolling.terrain) - depth).abs() < 1e-4, "{depth}");
        let mut sheared = rolling.terrain.sheared.iter();
        assert!(sheared.all(|j| j.abs() < f64::MIN_POSITIVE));
    }
}

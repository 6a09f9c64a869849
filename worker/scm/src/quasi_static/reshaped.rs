//! The soil's stresses, integrated over a rim with effects: formulas at its nodes, a flat, rebounding soil.

use formula::effect::Mechanism;
use formula::{Hook, Variable};

use super::displacement::Slide;
use super::grousered::{Grousered, SURFACES};
use super::panel::{Contact, Panel};
use super::reaction::Reaction;
use super::rim::Rim;
use super::straight::StraightGrousers;
use crate::Rejection;
use crate::effects::case::Case;
use crate::effects::{Active, NodeLaws};
use crate::footprint::rectangle_effective_width;
use crate::pressure_distribution::RectangleDistribution;
use crate::pressure_sinkage::{k_star, pressure};
use crate::quadrature::NODES;
use crate::rejection::require;
use crate::shear::strength;
use crate::wong_reece::Peak;

/// Number of parts of a panel if formulas have kinks or jumps between nodes.
const PARTS: usize = 4;
/// The maximum number of panels held together: enough for nearly every contact or the surfaces at one place, and few enough
/// to clear for every run.
const PANELS: usize = SURFACES;
/// Working memory for a contact.
pub(super) type Panels = [Panel; PANELS];
/// The maximum number of ends of panels.
const ENDS: usize = 12;
/// Number of iterations between rebound and footprint, if the modulus depends on the footprint's width.
const PASSES: usize = 3;

/// The effects on a run.
#[derive(Debug)]
pub(super) struct Reshaping<'r, 'e> {
    active: &'r Active<'e>,
    pub(super) case: Case,
    pub(super) laws: Option<NodeLaws<'e>>,
    load_follows: bool,
    load_jumps: bool,
    /// Height by which the load flattens the rim, δ `[m]`.
    deflection: f64,
    /// Rebound of the soil per unit of pressure `[m/Pa]`.
    compliance: f64,
    /// The sliding of the rim; `None` if no law uses it.
    slide: Option<Slide>,
    /// The grousers, if they roll; the rim is then the cylinder of their tips.
    grousers: Option<Grousered>,
    /// Panels of the contact, and the number in use.
    panels: &'r mut Panels,
    used: usize,
}

/// The shape of the contact at one trial.
#[derive(Debug, Clone, Copy)]
struct Shape {
    /// x of the front end, and of the rear end with its sign changed `[m]`.
    front: f64,
    rear: f64,
    /// Half length of the flat, and its distance from the axle `[m]`.
    flat: f64,
    bottom_radius: f64,
    hub_height: f64,
    /// Sinkage of the lowest part of the rim `[m]`.
    sinkage: f64,
    /// Rebound of the soil behind the wheel `[m]`.
    recovered: f64,
    k_star: f64,
    b_eff: f64,
    /// The peak of the pressure, if it lies ahead of the axle.
    peak: Option<Peak>,
}

/// The deformation of the rim by the load, and of the soil by the pressure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mechanics {
    /// Height by which the load flattens the rim, δ `[m]`.
    deflection: f64,
    /// Rebound of the soil per unit of pressure `[m/Pa]`.
    compliance: f64,
}

impl Mechanics {
    /// # Errors
    /// [`Rejection::InvalidParameter`]: a deflection or a compliance outside its bounds.
    pub(super) fn new(active: &Active, case: &Case) -> Result<Self, Rejection> {
        let first = |mechanism| {
            let values = active.mechanism(mechanism);
            values.and_then(|values| values.first().copied()).unwrap_or(0.0)
        };
        let deflection = first(Mechanism::FlatPatch) * case.condition.wheel_load_n;
        let compliance = first(Mechanism::Rebound);
        require(
            (0.0..case.wheel.radius_m).contains(&deflection),
            "deflection of the rim",
            deflection,
            "m",
            "at least 0 and below the radius",
        )?;
        require(
            compliance >= 0.0,
            "compliance of the soil",
            compliance,
            "m/Pa",
            "at least 0",
        )?;
        Ok(Self {
            deflection,
            compliance,
        })
    }

    /// # Errors
    /// [`Rejection::InvalidParameter`]: rebounding soil, or a rim that its load flattens, which this model does not combine
    /// with grousers.
    pub(super) fn require_rigid(&self) -> Result<(), Rejection> {
        let (flat, compliance) = (self.deflection, self.compliance);
        let bound = "0 under a wheel whose grousers count";
        require(flat.abs() <= 0.0, "deflection of the rim", flat, "m", bound)?;
        require(
            compliance.abs() <= 0.0,
            "compliance of the soil",
            compliance,
            "m/Pa",
            bound,
        )
    }

    /// Returns the half length of the flat `[m]`: a contact that reaches less far ahead of the axle carries nothing.
    pub(super) fn flat(&self, radius: f64) -> f64 {
        (self.deflection * (2.0 * radius - self.deflection))
            .max(0.0)
            .sqrt()
    }
}

impl<'r, 'e> Reshaping<'r, 'e> {
    /// # Arguments
    /// - `laws`: the formulas at nodes, with working memory.
    /// - `panels`: working memory for a contact.
    /// - `grousers`: those of the wheel, if they roll.
    pub(super) fn new(
        active: &'r Active<'e>,
        rim: &Rim,
        case: Case,
        mechanics: Mechanics,
        mut laws: Option<NodeLaws<'e>>,
        panels: &'r mut Panels,
        grousers: Option<&StraightGrousers>,
    ) -> Self {
        let Mechanics {
            deflection,
            compliance,
        } = mechanics;
        if let Some(laws) = &mut laws {
            laws.settle(&case.variables);
        }
        let slides = laws.as_ref().is_some_and(|laws| laws.use_variable(Variable::J));
        Self {
            slide: (slides || rim.peaked.is_some())
                .then(|| Slide::new(rim.radius, &rim.motion, rim.flat, rim.radius - deflection)),
            laws,
            load_follows: active.load_follows_reaction(),
            load_jumps: active.load_jumps(),
            deflection,
            compliance,
            panels,
            used: 0,
            active,
            grousers: grousers.map(|grousers| {
                let run = (&case.soil, &case.wheel, &case.condition);
                Grousered::new(run, grousers, rim, slides)
            }),
            case,
        }
    }

    /// Returns whether stresses along the rim differ from the base's.
    pub(super) fn changes_stresses(&self) -> bool {
        let reshapes = self.deflection.abs() > 0.0 || self.compliance.abs() > 0.0;
        reshapes || self.laws.is_some() || self.grousers.is_some()
    }

    /// Returns whether the load may jump: when a jump of a law passes a node, with the contact, or with the reaction that it
    /// follows.
    pub(super) fn may_jump(&self) -> bool {
        self.laws.as_ref().is_some_and(NodeLaws::may_jump) || self.load_jumps
    }

    /// Excess of the load that the soil must carry over the nominal one `[N]`.
    pub(super) fn extra_load(&self, reaction: &Reaction) -> Result<f64, Rejection> {
        if !self.load_follows {
            return Ok(0.0);
        }
        let load = self
            .active
            .wheel_load(&self.case, reaction.drawbar_pull, reaction.torque)?;
        Ok(load - self.case.condition.wheel_load_n)
    }

    /// Returns the soil's force on the rim when the contact reaches a length ahead of the axle; see [`Rim::react`].
    pub(super) fn react(&mut self, rim: &Rim, front: f64) -> Result<Reaction, Rejection> {
        let shape = self.shape(rim, front);
        let length = front + shape.rear;
        let mut reaction = Reaction {
            sinkage: shape.sinkage - self.grousers.as_ref().map_or(0.0, |grousers| grousers.height),
            contact_length: front,
            footprint_length: length,
            b_eff: shape.b_eff,
            k_star: shape.k_star,
            ..Reaction::default()
        };
        if shape.sinkage <= 0.0 || shape.k_star <= 0.0 {
            return Ok(reaction);
        }
        let contact_variables = [
            (Variable::ContactLength, length),
            (Variable::BEff, shape.b_eff),
            (Variable::KStar, shape.k_star),
        ];
        if let Some(laws) = &mut self.laws
            && contact_variables
                .iter()
                .any(|(variable, _)| laws.use_variable(*variable))
        {
            for (variable, value) in contact_variables {
                self.case.variables[variable as usize] = value;
            }
            laws.settle(&self.case.variables);
        }
        let contact = Contact {
            front,
            rear: shape.rear,
            hub_height: shape.hub_height,
            sinkage: shape.sinkage,
            round_to_lowest: (shape.sinkage + self.deflection) / shape.sinkage,
            pressure_at_bottom: pressure(shape.k_star, shape.sinkage, rim.soil.n),
            gamma: RectangleDistribution::new(rim.law, length, 0.5 * rim.width),
        };
        let kinked = self.laws.as_ref().is_some_and(NodeLaws::are_kinked);
        let parts = if kinked { PARTS } else { 1 };
        if self.grousers.is_some() {
            self.react_with_grousers(rim, &shape, &contact, parts, &mut reaction)?;
            return Ok(reaction);
        }
        let mut ends = [0.0; ENDS];
        let count = if shape.rear > 0.0 || shape.peak.is_some() {
            shape.panel_ends(rim, &[], &mut ends)
        } else {
            let (plain, panels) = rim.panel_ends(front);
            ends[..plain.len()].copy_from_slice(&plain);
            panels + 1
        };
        for pair in ends[..count].windows(2) {
            let at = |part: usize| pair[0] + (pair[1] - pair[0]) * (part as f64 / parts as f64);
            for part in 0..parts {
                if self.used == PANELS {
                    self.sum(rim, &shape, &mut reaction)?;
                }
                shape.lay(
                    &mut self.panels[self.used],
                    rim,
                    &contact,
                    [at(part), at(part + 1)],
                );
                self.used += 1;
            }
        }
        self.sum(rim, &shape, &mut reaction)?;
        Ok(reaction)
    }

    /// Adds the forces on tips, flanks and rim.
    fn react_with_grousers(
        &mut self,
        tips: &Rim,
        shape: &Shape,
        contact: &Contact,
        parts: usize,
        sum: &mut Reaction,
    ) -> Result<(), Rejection> {
        let Some(grousers) = &mut self.grousers else {
            return Ok(());
        };
        let front_of_rim = grousers.front_of_rim(shape.hub_height);
        let mut ends = [0.0; ENDS];
        let count = shape.panel_ends(tips, &grousers.kinks(front_of_rim), &mut ends);
        self.used = usize::from(grousers.lay_behind(contact, &mut self.panels[0]));
        self.sum(tips, shape, sum)?;
        for pair in ends[..count].windows(2) {
            let at = |part: usize| pair[0] + (pair[1] - pair[0]) * (part as f64 / parts as f64);
            for part in 0..parts {
                if let Some(grousers) = &mut self.grousers {
                    self.used =
                        grousers.lay(tips, contact, front_of_rim, [at(part), at(part + 1)], self.panels);
                }
                self.sum(tips, shape, sum)?;
            }
        }
        Ok(())
    }

    fn shape(&self, rim: &Rim, front: f64) -> Shape {
        let radius = rim.radius;
        let bottom_radius = radius - self.deflection;
        let flat = rim.flat;
        let hub_height = ((radius - front) * (radius + front)).sqrt();
        let sinkage = (front - flat) * (front + flat) / (bottom_radius + hub_height);
        let mut shape = Shape {
            front,
            rear: flat,
            flat,
            bottom_radius,
            hub_height,
            sinkage,
            recovered: 0.0,
            k_star: 0.0,
            b_eff: 0.0,
            peak: rim.peaked.map(|stresses| stresses.peak(radius, front)),
        };
        let passes = if self.compliance.abs() > 0.0 && sinkage > 0.0 {
            PASSES
        } else {
            0
        };
        for pass in 0..=passes {
            shape.b_eff = rectangle_effective_width(front + shape.rear, rim.width);
            shape.k_star = k_star(&rim.soil, shape.b_eff);
            if pass < passes && shape.k_star > 0.0 {
                let full = self.compliance * pressure(shape.k_star, sinkage, rim.soil.n);
                shape.recovered = full.min(0.5 * sinkage);
                let top = bottom_radius - shape.recovered;
                shape.rear = ((radius - top) * (radius + top)).sqrt();
            }
        }
        shape
    }

    /// Adds the forces on the current panels, from rear to front, and clears the panels.
    fn sum(&mut self, rim: &Rim, shape: &Shape, sum: &mut Reaction) -> Result<(), Rejection> {
        let (panels, variables) = (&mut self.panels[..self.used], &self.case.variables);
        if let Some(laws) = &mut self.laws {
            shape.write(rim, (self.slide.as_ref(), self.grousers.as_ref()), panels, laws);
            if laws.enter(Hook::Pressure) {
                laws.apply(Hook::Pressure, panels.len() * NODES, |_| true, variables)?;
                read(laws, Variable::P, panels, |panel| &mut panel.pressure);
            }
        }
        let strength = |panel: &Panel, i: usize| {
            strength(rim.soil.cohesion_pa, rim.tan_friction_angle, panel.pressure[i])
        };
        let share = |panel: &Panel, i: usize| rim.shear.mobilised(panel.speed[i]);
        if let Some(laws) = &mut self.laws
            && (laws.enter(Hook::ShearLimit) || laws.use_variable(Variable::TauMax))
        {
            write(laws, Variable::TauMax, panels, |panel| {
                core::array::from_fn(|i| strength(panel, i))
            });
            laws.apply(Hook::ShearLimit, panels.len() * NODES, |_| true, variables)?;
            read(laws, Variable::TauMax, panels, |panel| &mut panel.shear);
            for panel in panels.iter_mut() {
                panel.shear = core::array::from_fn(|i| panel.shear[i] * share(panel, i));
            }
        } else {
            for panel in panels.iter_mut() {
                panel.shear = core::array::from_fn(|i| strength(panel, i) * share(panel, i));
            }
        }
        if let (Some(stresses), Some(slide)) = (&rim.peaked, &self.slide) {
            let entry = slide.enter(shape.front);
            for panel in panels.iter_mut() {
                let slid = slide.slid(&entry, panel.x);
                panel.shear =
                    core::array::from_fn(|i| panel.shear[i] * stresses.displacement.mobilised(slid[i]));
            }
        }
        if let Some(laws) = &mut self.laws
            && laws.enter(Hook::Shear)
        {
            write(laws, Variable::Tau, panels, |panel| panel.shear);
            laws.apply(Hook::Shear, panels.len() * NODES, |_| true, variables)?;
            read(laws, Variable::Tau, panels, |panel| &mut panel.shear);
        }
        if let Some(grousers) = &self.grousers {
            for (panel, share) in panels.iter_mut().zip(&grousers.shares) {
                panel.pressure = core::array::from_fn(|i| panel.pressure[i] * share[i]);
                panel.shear = core::array::from_fn(|i| panel.shear[i] * share[i]);
            }
        }
        for panel in panels.iter() {
            let mut along = [0.0; NODES];
            let mut across = [0.0; NODES];
            for i in 0..NODES {
                let speed = panel.speed[i];
                // At rest the stress has no direction, and the velocities are 0.
                let per_speed = panel.shear[i]
                    / if speed > f64::MIN_POSITIVE {
                        speed
                    } else {
                        f64::MAX
                    };
                along[i] = per_speed * panel.tangential[i];
                across[i] = per_speed * rim.motion.lateral;
            }
            sum.add(rim, panel, &along, &across);
        }
        self.used = 0;
        Ok(())
    }
}

/// Writes a quantity of the panels' nodes into a block.
fn write(laws: &mut NodeLaws, variable: Variable, panels: &[Panel], field: impl Fn(&Panel) -> [f64; NODES]) {
    let column = laws.block.column_mut(variable).as_chunks_mut::<NODES>().0;
    for (nodes, panel) in column.iter_mut().zip(panels) {
        *nodes = field(panel);
    }
}

/// Copies a quantity from a block to the panels' nodes.
fn read(
    laws: &mut NodeLaws,
    variable: Variable,
    panels: &mut [Panel],
    field: impl Fn(&mut Panel) -> &mut [f64; NODES],
) {
    let column = laws.block.column(variable).as_chunks::<NODES>().0;
    for (nodes, panel) in column.iter().zip(panels) {
        *field(panel) = *nodes;
    }
}

impl Shape {
    /// Finds the ends of the panels from rear to front; returns their number.
    fn panel_ends(&self, rim: &Rim, kinks: &[f64], ends: &mut [f64; ENDS]) -> usize {
        // gamma has a ridge halfway, or a plateau where the sides are nearer than the ends
        let inner = (0.5 * (self.front + self.rear)).min(0.5 * rim.width);
        let candidates = [
            -self.rear,
            -self.flat, // start of the rebounding soil
            self.flat,
            inner - self.rear,
            self.front - inner,
            -rim.sign_change,
            rim.sign_change,
            self.peak.map_or(self.front, |peak| peak.x),
            self.front,
        ];
        let mut count = 0;
        for candidate in candidates.iter().chain(kinks).copied() {
            if !(-self.rear..=self.front).contains(&candidate) {
                continue;
            }
            let place = ends[..count].partition_point(|end| *end < candidate);
            if place < count && ends[place] <= candidate {
                continue; // a duplicate
            }
            ends.copy_within(place..count, place + 1);
            ends[place] = candidate;
            count += 1;
        }
        count
    }

    fn lay(&self, panel: &mut Panel, rim: &Rim, contact: &Contact, [start, end]: [f64; 2]) {
        let middle = 0.5 * (start + end);
        if let Some(peak) = &self.peak {
            panel.about(rim, contact, start, end, peak);
        } else if middle > self.flat {
            panel.on_arc(rim, contact, start, end);
        } else if middle < -self.flat {
            panel.behind(rim, contact, start, end, self.recovered);
        } else {
            panel.on_flat(rim, contact, start, end, self.bottom_radius);
        }
    }

    /// Writes the variables of the formulas into their block.
    fn write(
        &self,
        rim: &Rim,
        (slide, grousers): (Option<&Slide>, Option<&Grousered>),
        panels: &[Panel],
        laws: &mut NodeLaws,
    ) {
        if laws.enter(Hook::Pressure) || laws.use_variable(Variable::P) {
            write(laws, Variable::P, panels, |panel| panel.pressure);
        }
        if laws.use_variable(Variable::Vt) {
            write(laws, Variable::Vt, panels, |panel| panel.speed);
        }
        if laws.use_variable(Variable::Z) {
            write(laws, Variable::Z, panels, |panel| {
                panel.relative_sinkage.map(|z| z.max(0.0) * self.sinkage)
            });
        }
        if laws.use_variable(Variable::Vn) && grousers.is_some() {
            write(laws, Variable::Vn, panels, |panel| {
                core::array::from_fn(|i| (rim.motion.forward * panel.tan_theta[i] / panel.secant[i]).max(0.0))
            });
        } else if laws.use_variable(Variable::Vn) {
            // the hub keeps its height, so only the front of the round rim moves into the soil
            let per_radius = rim.motion.forward / rim.radius;
            write(laws, Variable::Vn, panels, |panel| {
                let moves = if panel.arm < rim.radius { 0.0 } else { per_radius };
                panel.x.map(|x| (moves * x).max(0.0))
            });
        }
        if laws.use_variable(Variable::Position) {
            let per_length = 1.0 / (self.front + self.rear);
            write(laws, Variable::Position, panels, |panel| {
                // flanks behind the axle count as the rear end of the contact without them
                panel.x.map(|x| (x + self.rear).max(0.0) * per_length)
            });
        }
        if let Some(slide) = slide.filter(|_| laws.use_variable(Variable::J)) {
            let entry = slide.enter(self.front);
            let rim_slide = grousers.and_then(|grousers| grousers.slide_of_rim(self.hub_height));
            write(laws, Variable::J, panels, |panel| match &rim_slide {
                Some((radius, slide, entry)) if panel.arm <= *radius => slide.slid(entry, panel.x),
                _ => slide.slid(&entry, panel.x),
            });
        }
    }
}

//! Give pressure and shear stress at the nodes of a contact as the formulas of effects leave them.

use formula::block::BLOCK;
use formula::variable::Variables;
use formula::{Hook, Variable};

use super::super::pack::{LANES, PACK, Pack, greater, lanes_of, lesser, load, most_of, splat, store, sum};
use super::super::terrain::Terrain;
use super::super::wheel::envelope::Envelope;
use super::super::wheel::motion::{Motion, Traction};
use super::Contact;
use super::laws::Laws;
use super::patch::Patch;
use super::quad::Quad;
use crate::Rejection;
use crate::effects::NodeLaws;
use crate::footprint::effective_width;

/// The least depth that formulas see `[m]`: that of the base's own powers.
const LEAST_DEPTH: f64 = 1e-12;

/// Formulas at nodes, with what a step and a trial height give them to see.
///
/// At every node in contact that bears, p > 0:
///
/// - `p = min(p', K_e (z_s − h))`, where formulas have made p' of the plastic pressure `gamma k* z^n`: the elastic line
///   stays the last word, so that what the terrain remembers of its compaction fits what it carries
/// - `tau_max' ← c + p tan(phi)`, then `tau' ← tau_max' (1 − exp(−|v_t| / v0))`
///
/// A formula gives the size of the stress; its direction stays against the slip velocity. So `tau' / (1 − exp(−|v_t| / v0))`
/// acts as the node's strength, and where nothing slides there is no stress.
///
/// Formulas see `z ≥ 1e-12 m`, the velocity `v_n ≥ 0` into the soil along the wheel's normal with the hub at constant height,
/// `position` along the whole footprint at the place where the pressure is taken, and k* and `b_eff` of the node's patch.
///
/// # Numerics
/// Formulas are evaluated at every trial height. Those that only scale the shear stress, by what no height changes, are
/// evaluated once in a step: the base then runs with its shear tractions scaled. Checked by `spatial::effects`.
#[derive(Debug, Clone)]
pub(crate) struct NodeFormulas<'a> {
    laws: NodeLaws<'a>,
    variables: [f64; Variable::COUNT],
    /// Whether `laws` know the present `variables`.
    settled: bool,
    /// Whether formulas only scale the shear stress, and whether they do so in this step.
    may_scale: bool,
    scales: bool,
    /// Strips that touch at this height of the hub have their tractions scaled `[m]`.
    scaled_down_to: f64,
    /// Width of the wheel `[m]`.
    width: f64,
    /// By quad: what a step knows.
    nodes: Vec<Node>,
    /// By quad: shear displacement j `[m]`.
    pub(crate) slid: Vec<Pack>,
    /// By quad, at the height last tried: the strength that acts `[Pa]`.
    strengths: Vec<Pack>,
    /// Rear end and length of the footprint, ahead of the hub `[m]`.
    footprint: [f64; 2],
    /// The quads at hand.
    points: Vec<Point>,
    /// The first formula value that could not be used, at whichever height it was.
    pub(crate) refused: Option<Rejection>,
}

/// What a step knows of four nodes.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// `|v_t|` and `v_n` `[m/s]`.
    slips: Pack,
    enters: Pack,
    /// `1 − exp(−|v_t| / v0)`, and one over it; 0 where nothing slides.
    share: Pack,
    per_share: Pack,
    /// What formulas that only scale the stress multiply it by.
    scale: Pack,
}

/// Four nodes of a block.
#[derive(Debug, Clone, Copy)]
struct Point {
    quad: usize,
    /// The lanes that bear.
    bears: u64,
}

impl<'a> NodeFormulas<'a> {
    pub(crate) fn new(laws: NodeLaws<'a>, variables: [f64; Variable::COUNT], width: f64) -> Self {
        let of_step = Variables::of(&[Variable::Vn, Variable::Vt, Variable::J]);
        Self {
            may_scale: laws.only_scale_stress_by(of_step),
            scales: false,
            scaled_down_to: f64::INFINITY,
            laws,
            variables,
            settled: false,
            width,
            nodes: Vec::new(),
            slid: Vec::new(),
            strengths: Vec::new(),
            footprint: [0.0; 2],
            points: Vec::new(),
            refused: None,
        }
    }

    /// Whether a formula uses a variable.
    pub(crate) fn use_variable(&self, variable: Variable) -> bool {
        self.laws.use_variable(variable)
    }

    /// Change what all nodes share.
    pub(crate) fn set(&mut self, variable: Variable, value: f64) {
        let known = core::mem::replace(&mut self.variables[variable as usize], value);
        self.settled &= known.to_bits() == value.to_bits() || !self.laws.use_variable(variable);
    }

    fn settle(&mut self) {
        if !self.settled {
            self.laws.settle(&self.variables);
            self.settled = true;
        }
    }

    /// Bring formulas and a prepared contact together: what does not depend on the height of the hub.
    pub(crate) fn prepare(
        &mut self,
        contact: &mut Contact,
        envelope: &Envelope,
        laws: &Laws,
        motion: &Motion,
    ) {
        let (zero, one) = (splat(0.0), splat(1.0));
        let (rows, packs) = (contact.strips.len(), contact.across.packs());
        self.strengths.resize(rows * packs, zero);
        self.nodes.clear();
        for (row, strip) in contact.strips.iter().enumerate() {
            let slope = splat(strip.slope);
            let enters = splat(motion.forward) * slope / (one + slope * slope).sqrt();
            for pack in 0..packs {
                let enters = if contact.lanes_differ {
                    motion.into_soil(strip.ahead, &envelope.facets[pack * rows + row])
                } else {
                    enters
                };
                self.nodes.push(Node {
                    slips: contact.slip_speed(row * packs + pack, row),
                    enters: greater(enters, zero),
                    share: zero,
                    per_share: zero,
                    scale: one,
                });
            }
        }
        (self.scales, self.scaled_down_to) = (self.may_scale, f64::INFINITY);
        if !self.scales {
            self.find_shares(laws, contact);
        }
    }

    /// What the base mobilises of the strength.
    fn find_shares(&mut self, laws: &Laws, contact: &Contact) {
        let share_of = |speed: f64| laws.shear_velocity.mobilised_per_velocity(speed) * speed;
        for nodes in self.nodes.chunks_exact_mut(contact.across.packs()) {
            let alike = (!contact.lanes_differ).then(|| splat(share_of(nodes[0].slips.to_array()[0])));
            for node in nodes {
                node.share = alike.unwrap_or_else(|| Pack::new(node.slips.to_array().map(share_of)));
                let slides = node.share.simd_gt(splat(0.0));
                node.per_share = slides.select(splat(1.0) / node.share, splat(0.0));
            }
        }
    }

    /// Scale the tractions of the strips that touch at a height and were not scaled yet; gives whether that can be done
    /// wherever a node may come to bear.
    fn scale_down_to(&mut self, contact: &mut Contact, hub: f64) -> bool {
        let packs = contact.across.packs();
        // where lanes are alike, one pack stands for the strip
        let own = contact.lanes_differ || self.laws.use_variable(Variable::J);
        let (each, alike) = if own { (packs, 1) } else { (1, packs) };
        let above = self.scaled_down_to;
        self.scaled_down_to = hub.min(above);
        let mut fine = true;
        for row in 0..contact.strips.len() {
            if contact.highest[row] <= hub || contact.highest[row] > above {
                continue;
            }
            for pack in 0..each {
                let (quad, at) = (row * packs + pack, self.points.len() * PACK);
                self.see_motion(quad, at);
                store(self.laws.block.column_mut(Variable::Tau), at, splat(1.0));
                self.points.push(Point { quad, bears: 0 });
                if at + PACK == BLOCK {
                    fine &= self.scale(contact, alike);
                }
            }
        }
        fine & self.scale(contact, alike)
    }

    /// Scale the tractions of the quads at hand, each of which stands for so many that are alike.
    fn scale(&mut self, contact: &mut Contact, alike: usize) -> bool {
        let points = core::mem::take(&mut self.points);
        let mut fine = self.apply(Hook::Shear, &points).is_ok(); // as no node is known to bear
        let column = self.laws.block.column(Variable::Tau);
        for (i, point) in points.iter().enumerate() {
            let scales = &column[i * PACK..][..PACK];
            fine &= scales.iter().all(|scale| (0.0..=f64::MAX).contains(scale));
            let scale = load(scales, 0);
            for quad in point.quad..point.quad + alike {
                self.nodes[quad].scale = scale;
                contact.quads[quad].shear_z *= scale;
            }
        }
        self.points = points;
        self.points.clear();
        fine
    }

    /// Vertical force of the soil on the wheel with its hub at a height `[N]`; no number where a formula is refused.
    pub(crate) fn press(&mut self, contact: &mut Contact, terrain: &Terrain, laws: &Laws, hub: f64) -> f64 {
        self.settle();
        if self.scales {
            if self.scale_down_to(contact, hub) {
                return contact.press(terrain, laws, hub);
            }
            // node by node, with regard to which bear
            self.scales = false;
            contact.find_vertical_shears();
            self.find_shares(laws, contact);
        }
        let contours = laws.soil.k_c.abs() > 0.0 || self.laws.use_variable(Variable::BEff);
        contact.find_patches(terrain, laws, hub, contours);
        self.set(Variable::ContactLength, contact.area(terrain) / self.width);
        self.settle();
        if self.laws.use_variable(Variable::Position) {
            self.footprint = contact.extent();
        }
        match self.sum_forces(contact, laws) {
            Ok(half) if terrain.mirrored => 2.0 * half,
            Ok(force) => force,
            Err(refused) => {
                self.points.clear();
                self.refused.get_or_insert(refused);
                f64::NAN
            }
        }
    }

    /// By quad: the strengths that act at the height last tried `[Pa]`.
    pub(crate) fn strengths(&mut self, contact: &Contact, laws: &Laws) -> &[Pack] {
        if self.scales {
            let packs = contact.across.packs();
            for quad in contact.first * packs..contact.end * packs {
                self.strengths[quad] = strength(laws, &contact.quads[quad]) * self.nodes[quad].scale;
            }
        }
        &self.strengths
    }

    /// Pressures and strengths, and the vertical force they exert.
    fn sum_forces(&mut self, contact: &mut Contact, laws: &Laws) -> Result<f64, Rejection> {
        let mut force = splat(0.0);
        let packs = contact.across.packs();
        for row in contact.first..contact.end {
            for pack in 0..packs {
                let lanes = contact.masks[row] >> (pack * PACK) & LANES;
                if lanes == 0 {
                    contact.quads[row * packs + pack].pressure = splat(0.0);
                    continue;
                }
                self.see(contact, laws, row, pack, lanes);
                if self.points.len() * PACK == BLOCK {
                    force += self.evaluate(&mut contact.quads, laws)?;
                }
            }
        }
        force += self.evaluate(&mut contact.quads, laws)?;
        Ok(sum(force))
    }

    /// Put what four nodes know of their motion into the block.
    fn see_motion(&mut self, quad: usize, at: usize) {
        let node = &self.nodes[quad];
        if self.laws.use_variable(Variable::Vn) {
            store(self.laws.block.column_mut(Variable::Vn), at, node.enters);
        }
        if self.laws.use_variable(Variable::Vt) {
            store(self.laws.block.column_mut(Variable::Vt), at, node.slips);
        }
        if self.laws.use_variable(Variable::J) {
            store(self.laws.block.column_mut(Variable::J), at, self.slid[quad]);
        }
    }

    /// Put four nodes into the block, with the base's pressure.
    fn see(&mut self, contact: &mut Contact, laws: &Laws, row: usize, pack: usize, lanes: u64) {
        let place = row * contact.across.packs() + pack;
        let at = self.points.len() * PACK;
        self.see_motion(place, at);
        let runs = &contact.patches.runs[contact.patches.of_strip[row - contact.first].clone()];
        let patches = &contact.patches.patches;
        let of_patch = |of: fn(&Patch) -> f64| match runs {
            [run] => splat(of(&patches[run.patch])),
            _ => runs.iter().fold(splat(0.0), |others, run| {
                let own = splat(of(&patches[run.patch]));
                run.lanes_of(pack).select(own, others)
            }),
        };
        let quad = &mut contact.quads[place];
        let plastic = laws.plastic(of_patch(|patch| patch.stiffness) * quad.shape, quad.depth);
        quad.pressure = laws.bounded(plastic, quad.pressed);
        let bears = u64::from(quad.pressure.simd_gt(splat(0.0)).to_bitmask()) & lanes;
        self.points.push(Point { quad: place, bears });
        let uses = self.laws.uses();
        let changes_pressure = self.laws.enter(Hook::Pressure);
        let block = &mut self.laws.block;
        if uses.contains(Variable::Z) {
            let depth = greater(quad.depth, splat(LEAST_DEPTH));
            store(block.column_mut(Variable::Z), at, depth);
        }
        if uses.contains(Variable::Position) {
            let width = greater(contact.across.width[pack], splat(f64::MIN_POSITIVE));
            let middle = splat(contact.strips[row].middle) + splat(0.5) * quad.area / width - quad.left;
            let [rear, length] = self.footprint;
            let position = (middle - splat(rear)) / splat(length);
            let position = lesser(greater(position, splat(0.0)), splat(1.0));
            store(block.column_mut(Variable::Position), at, position);
        }
        if uses.contains(Variable::KStar) {
            store(block.column_mut(Variable::KStar), at, of_patch(|patch| patch.modulus));
        }
        if uses.contains(Variable::BEff) {
            let width = of_patch(|patch| effective_width(patch.area, patch.contour));
            store(block.column_mut(Variable::BEff), at, width);
        }
        if changes_pressure {
            store(block.column_mut(Variable::P), at, plastic);
        }
    }

    /// Apply the formulas to the nodes of the block, and give the vertical force upon them, lane by lane.
    fn evaluate(&mut self, quads: &mut [Quad], laws: &Laws) -> Result<Pack, Rejection> {
        let zero = splat(0.0);
        let mut points = core::mem::take(&mut self.points);
        if self.laws.enter(Hook::Pressure) {
            self.apply(Hook::Pressure, &points)?;
            let column = self.laws.block.column(Variable::P);
            for (i, point) in points.iter_mut().enumerate() {
                let quad = &mut quads[point.quad];
                let bounded = laws.bounded(load(column, i * PACK), quad.pressed);
                quad.pressure = lanes_of(point.bears).select(bounded, zero);
                point.bears &= u64::from(quad.pressure.simd_gt(zero).to_bitmask());
            }
        }
        for point in &points {
            self.strengths[point.quad] = strength(laws, &quads[point.quad]);
        }
        if self.laws.enter(Hook::ShearLimit) || self.laws.enter(Hook::Shear) {
            self.change_strengths(quads, &points)?;
        }
        let mut force = zero;
        for point in &points {
            let quad = &quads[point.quad];
            force += quad.area * (quad.pressure + self.strengths[point.quad] * quad.shear_z);
        }
        points.clear();
        self.points = points;
        Ok(force)
    }

    /// Make of the strengths of the block's nodes what the formulas do, where a node bears.
    fn change_strengths(&mut self, quads: &[Quad], points: &[Point]) -> Result<(), Rejection> {
        let sees_pressure = self.laws.use_variable(Variable::P);
        let limits = self.laws.enter(Hook::ShearLimit);
        let sees_limit = limits || self.laws.use_variable(Variable::TauMax);
        if sees_pressure {
            let column = self.laws.block.column_mut(Variable::P);
            for (i, point) in points.iter().enumerate() {
                store(column, i * PACK, quads[point.quad].pressure);
            }
        }
        if sees_limit {
            let column = self.laws.block.column_mut(Variable::TauMax);
            for (i, point) in points.iter().enumerate() {
                store(column, i * PACK, self.strengths[point.quad]);
            }
        }
        if limits {
            self.apply(Hook::ShearLimit, points)?;
            let column = self.laws.block.column(Variable::TauMax);
            for (i, point) in points.iter().enumerate() {
                let strength = &mut self.strengths[point.quad];
                *strength = lanes_of(point.bears).select(load(column, i * PACK), *strength);
            }
        }
        if self.laws.enter(Hook::Shear) {
            let column = self.laws.block.column_mut(Variable::Tau);
            for (i, point) in points.iter().enumerate() {
                let stress = self.strengths[point.quad] * self.nodes[point.quad].share;
                store(column, i * PACK, stress);
            }
            self.apply(Hook::Shear, points)?;
            let column = self.laws.block.column(Variable::Tau);
            for (i, point) in points.iter().enumerate() {
                let strength = &mut self.strengths[point.quad];
                let acts = load(column, i * PACK) * self.nodes[point.quad].per_share;
                *strength = lanes_of(point.bears).select(acts, *strength);
            }
        }
        Ok(())
    }

    fn apply(&mut self, hook: Hook, points: &[Point]) -> Result<(), Rejection> {
        let counts = |point: usize| points[point / PACK].bears >> (point % PACK) & 1 == 1;
        self.laws
            .apply(hook, points.len() * PACK, counts, &self.variables)
    }
}

/// The base's strength of four nodes `[Pa]`.
fn strength(laws: &Laws, quad: &Quad) -> Pack {
    splat(laws.soil.cohesion_pa) + quad.pressure * splat(laws.tan_friction_angle)
}

impl Contact {
    /// Vertical shear forces as the base's tractions have them.
    fn find_vertical_shears(&mut self) {
        let packs = self.across.packs();
        for (place, quad) in self.quads.iter_mut().enumerate() {
            quad.shear_z = if self.lanes_differ {
                Traction::of_lanes(&self.tractions[place * PACK..][..PACK], |t| t.shear_z)
            } else {
                splat(self.tractions[place / packs].shear_z)
            };
        }
    }

    /// Rear end and length of the footprint, ahead of the hub `[m]`.
    fn extent(&self) -> [f64; 2] {
        if self.end == self.first {
            return [0.0, 1.0];
        }
        let packs = self.across.packs();
        let farthest = |row: usize, of: fn(&Quad) -> Pack| {
            let quads = &self.quads[row * packs..(row + 1) * packs];
            let reach = quads.iter().fold(splat(0.0), |most, quad| {
                let touching = quad.penetration.simd_gt(splat(0.0));
                greater(most, touching.select(of(quad), splat(0.0)))
            });
            most_of(reach)
        };
        let rear = self.strips[self.first].middle - farthest(self.first, |quad| quad.to_rear);
        let front = self.strips[self.end - 1].middle + farthest(self.end - 1, |quad| quad.to_front);
        [rear, front - rear]
    }
}

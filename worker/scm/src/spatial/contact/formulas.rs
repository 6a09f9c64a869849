//! Give pressure and shear stress at the nodes of a contact as the formulas of effects leave them.

use formula::block::BLOCK;
use formula::{Hook, Variable};

use super::super::pack::{LANES, PACK, Pack, greater, lanes_of, load, most_of, splat, store, sum};
use super::super::terrain::Terrain;
use super::super::wheel::envelope::Envelope;
use super::super::wheel::motion::Motion;
use super::Contact;
use super::laws::Laws;
use super::patch::Patch;
use super::quad::Quad;
use crate::effects::NodeLaws;
use crate::footprint::effective_width;
use crate::Rejection;

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
/// Checked by `spatial::effects`.
#[derive(Debug, Clone)]
pub(crate) struct NodeFormulas<'a> {
    laws: NodeLaws<'a>,
    variables: [f64; Variable::COUNT],
    /// Whether `laws` know the present `variables`.
    settled: bool,
    /// Width of the wheel `[m]`.
    width: f64,
    /// By quad: what a step knows.
    nodes: Vec<Node>,
    /// By quad: shear displacement j `[m]`.
    pub(crate) slid: Vec<Pack>,
    /// By quad: the strength that acts, at the height last tried `[Pa]`.
    pub(crate) strengths: Vec<Pack>,
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
        Self {
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
        self.settled &= known == value || !self.laws.use_variable(variable);
    }

    /// Bring formulas and a prepared contact together: what does not depend on the height of the hub.
    pub(crate) fn prepare(&mut self, contact: &Contact, envelope: &Envelope, laws: &Laws, motion: &Motion) {
        let zero = splat(0.0);
        let (rows, packs) = (contact.strips.len(), contact.across.packs());
        let enter = self.laws.use_variable(Variable::Vn);
        self.strengths.resize(rows * packs, zero);
        self.nodes.clear();
        let share_of = |speed: f64| laws.shear_velocity.mobilised_per_velocity(speed) * speed;
        for (row, strip) in contact.strips.iter().enumerate() {
            let slope = splat(strip.slope);
            let enters = splat(motion.forward) * slope / (splat(1.0) + slope * slope).sqrt();
            for pack in 0..packs {
                let slips = contact.slip_speed(row * packs + pack, row);
                let known = self.nodes.last().filter(|_| pack > 0 && !contact.lanes_differ);
                self.nodes.push(known.copied().unwrap_or_else(|| {
                    let share = if contact.lanes_differ {
                        Pack::new(slips.to_array().map(share_of))
                    } else {
                        splat(share_of(slips.to_array()[0]))
                    };
                    let enters = if enter && contact.lanes_differ {
                        let facet = &envelope.facets[pack * rows + row];
                        motion.into_soil(strip.ahead, facet)
                    } else {
                        enters
                    };
                    Node {
                        slips,
                        enters: greater(enters, zero),
                        share,
                        per_share: share.simd_gt(zero).select(splat(1.0) / share, zero),
                    }
                }));
            }
        }
    }

    /// Vertical force of the soil on the wheel with its hub at a height `[N]`; no number where a formula is refused.
    pub(crate) fn press(&mut self, contact: &mut Contact, terrain: &Terrain, laws: &Laws, hub: f64) -> f64 {
        let contours = laws.soil.k_c.abs() > 0.0 || self.laws.use_variable(Variable::BEff);
        contact.find_patches(terrain, laws, hub, contours);
        self.set(Variable::ContactLength, contact.area(terrain) / self.width);
        if !self.settled {
            self.laws.settle(&self.variables);
            self.settled = true;
        }
        if self.laws.use_variable(Variable::Position) {
            self.footprint = contact.extent();
        }
        match self.sum_forces(contact, laws) {
            Ok(half) if terrain.mirrored => 2.0 * half,
            Ok(force) => force,
            Err(refused) => {
                self.refused.get_or_insert(refused);
                f64::NAN
            }
        }
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

    /// Put four nodes into the block, with the base's pressure.
    fn see(&mut self, contact: &mut Contact, laws: &Laws, row: usize, pack: usize, lanes: u64) {
        let quad = row * contact.across.packs() + pack;
        let runs = &contact.patches.runs[contact.patches.of_strip[row - contact.first].clone()];
        let patches = &contact.patches.patches;
        let of_patch = |of: fn(&Patch) -> f64| match runs {
            [run] => splat(of(&patches[run.patch])),
            _ => runs.iter().fold(splat(0.0), |others, run| {
                let own = splat(of(&patches[run.patch]));
                run.lanes_of(pack).select(own, others)
            }),
        };
        let node = &mut contact.quads[quad];
        let plastic = laws.plastic(of_patch(|patch| patch.stiffness) * node.shape, node.depth);
        node.pressure = laws.bounded(plastic, node.pressed);
        let at = self.points.len() * PACK;
        let mut see = |variable: Variable, values: &dyn Fn() -> Pack| {
            if self.laws.use_variable(variable) {
                store(self.laws.block.column_mut(variable), at, values());
            }
        };
        let pressed_middle = || {
            let width = greater(contact.across.width[pack], splat(f64::MIN_POSITIVE));
            let middle = splat(contact.strips[row].middle) + splat(0.5) * node.area / width - node.left;
            let [rear, length] = self.footprint;
            let place = (middle - splat(rear)) / splat(length);
            greater(place, splat(0.0)).fast_min(splat(1.0))
        };
        see(Variable::Z, &|| greater(node.depth, splat(LEAST_DEPTH)));
        see(Variable::Vn, &|| self.nodes[quad].enters);
        see(Variable::Vt, &|| self.nodes[quad].slips);
        see(Variable::J, &|| self.slid[quad]);
        see(Variable::Position, &pressed_middle);
        see(Variable::KStar, &|| of_patch(|patch| patch.modulus));
        see(Variable::BEff, &|| {
            of_patch(|patch| effective_width(patch.area, patch.contour))
        });
        if self.laws.enter(Hook::Pressure) {
            store(self.laws.block.column_mut(Variable::P), at, plastic);
        }
        let bears = u64::from(node.pressure.simd_gt(splat(0.0)).to_bitmask()) & lanes;
        self.points.push(Point { quad, bears });
    }

    /// Apply the formulas to the nodes of the block, and give the vertical force upon them, lane by lane.
    fn evaluate(&mut self, quads: &mut [Quad], laws: &Laws) -> Result<Pack, Rejection> {
        let zero = splat(0.0);
        let mut points = core::mem::take(&mut self.points);
        if self.laws.enter(Hook::Pressure) {
            self.apply(Hook::Pressure, &points)?;
            for (i, point) in points.iter_mut().enumerate() {
                let quad = &mut quads[point.quad];
                let plastic = load(self.laws.block.column(Variable::P), i * PACK);
                let bounded = laws.bounded(plastic, quad.pressed);
                quad.pressure = lanes_of(point.bears).select(bounded, zero);
                point.bears &= u64::from(quad.pressure.simd_gt(zero).to_bitmask());
            }
        }
        let (limits, stresses) = (self.laws.enter(Hook::ShearLimit), self.laws.enter(Hook::Shear));
        if limits || stresses {
            self.change_strengths(quads, laws, &points)?;
        }
        let mut force = zero;
        for point in &points {
            let quad = &quads[point.quad];
            let base = strength(laws, quad);
            let strength = &mut self.strengths[point.quad];
            *strength = if limits || stresses {
                lanes_of(point.bears).select(*strength, base)
            } else {
                base
            };
            force += quad.area * (quad.pressure + *strength * quad.shear_z);
        }
        points.clear();
        self.points = points;
        Ok(force)
    }

    /// The strengths of the block's nodes as the formulas leave them; unspecified where a node does not bear.
    fn change_strengths(&mut self, quads: &[Quad], laws: &Laws, points: &[Point]) -> Result<(), Rejection> {
        let share = |nodes: &[Node], point: &Point| nodes[point.quad].share;
        let stresses = self.laws.enter(Hook::Shear);
        let see_pressure = self.laws.use_variable(Variable::P);
        let limits = self.laws.enter(Hook::ShearLimit);
        let see_limit = limits || self.laws.use_variable(Variable::TauMax);
        for (i, point) in points.iter().enumerate() {
            let quad = &quads[point.quad];
            let limit = strength(laws, quad);
            let block = &mut self.laws.block;
            if see_pressure {
                store(block.column_mut(Variable::P), i * PACK, quad.pressure);
            }
            if see_limit {
                store(block.column_mut(Variable::TauMax), i * PACK, limit);
            }
            if !limits {
                let stress = limit * share(&self.nodes, point);
                store(block.column_mut(Variable::Tau), i * PACK, stress);
            }
        }
        if limits {
            self.apply(Hook::ShearLimit, points)?;
            for (i, point) in points.iter().enumerate() {
                let limit = load(self.laws.block.column(Variable::TauMax), i * PACK);
                self.strengths[point.quad] = limit;
                let stress = limit * share(&self.nodes, point);
                store(self.laws.block.column_mut(Variable::Tau), i * PACK, stress);
            }
        }
        if stresses {
            self.apply(Hook::Shear, points)?;
            for (i, point) in points.iter().enumerate() {
                let stress = load(self.laws.block.column(Variable::Tau), i * PACK);
                self.strengths[point.quad] = stress * self.nodes[point.quad].per_share;
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

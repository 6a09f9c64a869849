//! Pressure and shear stress at the nodes of a contact after the formulas of effects.
//!
//! # Layout
//! - This file: the formulas, and the variables of a step.
//! - `scale`: formulas that only scale the shear stress, evaluated once per step.
//! - `trial`: all other formulas, evaluated at every trial height.

mod scale;
mod trial;

use formula::variable::Variables;
use formula::{Hook, Variable};

use super::super::pack::{PACK, Pack, max, splat, store};
use super::super::terrain::Terrain;
use super::super::wheel::envelope::Envelope;
use super::super::wheel::motion::Motion;
use super::Contact;
use super::laws::Laws;
use super::quad::Quad;
use crate::Rejection;
use crate::effects::NodeLaws;

/// Formulas at nodes, with the variables of a step and a trial height.
///
/// At every loaded node in contact, p > 0:
///
/// - `p = min(p', K_e (z_s − h))`, with p' the plastic pressure `gamma k* z^n` after the formulas: the elastic line bounds
///   it afterwards, so that the compaction stored in the terrain agrees with the pressure
/// - `tau_max' ← c + p tan(phi)`, then `tau' ← tau_max' (1 − exp(−|v_t| / v0))`
///
/// A formula gives the magnitude of the stress; its direction stays against the slip velocity. So
/// `tau' / (1 − exp(−|v_t| / v0))` acts as the node's strength, and without sliding there is no stress.
///
/// Formulas see `z ≥ 1e-12 m`, the velocity `v_n ≥ 0` into the soil along the wheel's normal with the hub at constant height,
/// `position` along the whole footprint at the point of the pressure, and k* and `b_eff` of the hull, or of the node's patch.
///
/// # Numerics
/// Formulas are evaluated at every trial height. Formulas that only scale the shear stress, by variables that do not depend on the
/// height, are evaluated once per step: the base then runs with its shear tractions scaled. Checked by `spatial::effects`.
#[derive(Debug, Clone)]
pub(crate) struct NodeFormulas<'a> {
    laws: NodeLaws<'a>,
    variables: [f64; Variable::COUNT],
    /// True if `laws` hold the shared values of the present `variables`.
    settled: bool,
    /// True if formulas only scale the shear stress, and if they do so in this step.
    may_scale: bool,
    scales: bool,
    /// Height of the hub down to which the strips that touch have scaled tractions `[m]`.
    scaled_down_to: f64,
    /// Width of the wheel `[m]`.
    width: f64,
    /// The variables of a step, by quad.
    nodes: Vec<Node>,
    /// Shear displacement j by quad `[m]`.
    pub(crate) slid: Vec<Pack>,
    /// The acting strength at the last trial height, by quad `[Pa]`.
    strengths: Vec<Pack>,
    /// Rear end and length of the footprint, ahead of the hub `[m]`.
    footprint: [f64; 2],
    /// The current quads.
    points: Vec<Point>,
    /// The first inadmissible value of a formula, at any trial height.
    pub(crate) refused: Option<Rejection>,
}

/// The variables of four nodes in a step.
#[derive(Debug, Clone, Copy)]
struct Node {
    /// `|v_t|` and `v_n` `[m/s]`.
    slips: Pack,
    enters: Pack,
    /// `1 − exp(−|v_t| / v0)`, and one over it; 0 where nothing slides.
    share: Pack,
    per_share: Pack,
    /// The factor of formulas that only scale the stress.
    scale: Pack,
}

/// Four nodes of a block.
#[derive(Debug, Clone, Copy)]
struct Point {
    quad: usize,
    /// The lanes that carry load.
    bears: u64,
}

impl<'a> NodeFormulas<'a> {
    pub(crate) fn new(laws: NodeLaws<'a>, variables: [f64; Variable::COUNT], width: f64) -> Self {
        let step_variables = Variables::new(&[Variable::Vn, Variable::Vt, Variable::J]);
        Self {
            may_scale: laws.only_scale_stress_by(step_variables),
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

    /// Returns whether a formula uses a variable.
    pub(crate) fn use_variable(&self, variable: Variable) -> bool {
        self.laws.use_variable(variable)
    }

    /// Changes a variable that all nodes share.
    pub(crate) fn set(&mut self, variable: Variable, value: f64) {
        let previous = core::mem::replace(&mut self.variables[variable as usize], value);
        self.settled &= previous.to_bits() == value.to_bits() || !self.laws.use_variable(variable);
    }

    fn settle(&mut self) {
        if !self.settled {
            self.laws.settle(&self.variables);
            self.settled = true;
        }
    }

    /// Computes everything that does not depend on the height of the hub, for a prepared contact.
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
                    motion.entry_velocity(strip.ahead, &envelope.facets[pack * rows + row])
                } else {
                    enters
                };
                self.nodes.push(Node {
                    slips: contact.slip_speed(row * packs + pack, row),
                    enters: max(enters, zero),
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

    /// Computes the base's mobilised share of the strength.
    fn find_shares(&mut self, laws: &Laws, contact: &Contact) {
        if !self.laws.enter(Hook::Shear) {
            return;
        }
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

    /// Returns the vertical force of the soil on the wheel with its hub at a height `[N]`; NaN if a formula gives an
    /// inadmissible value.
    pub(crate) fn press(&mut self, contact: &mut Contact, terrain: &Terrain, laws: &Laws, hub: f64) -> f64 {
        self.settle();
        if self.scales {
            if self.scale_down_to(contact, hub) {
                return contact.press(terrain, laws, hub);
            }
            // node by node, restricted to loaded nodes
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

    /// Returns the acting strengths at the last trial height, by quad `[Pa]`.
    pub(crate) fn strengths(&mut self, contact: &Contact, laws: &Laws) -> &[Pack] {
        if self.scales {
            let packs = contact.across.packs();
            for quad in contact.first * packs..contact.end * packs {
                self.strengths[quad] = strength(laws, &contact.quads[quad]) * self.nodes[quad].scale;
            }
        }
        &self.strengths
    }

    /// Writes the motion of four nodes into the block.
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

    fn apply(&mut self, hook: Hook, points: &[Point]) -> Result<(), Rejection> {
        let counts = |point: usize| points[point / PACK].bears >> (point % PACK) & 1 == 1;
        self.laws
            .apply(hook, points.len() * PACK, counts, &self.variables)
    }
}

/// Returns the base's strength of four nodes `[Pa]`.
fn strength(laws: &Laws, quad: &Quad) -> Pack {
    splat(laws.soil.cohesion_pa) + quad.pressure * splat(laws.tan_friction_angle)
}

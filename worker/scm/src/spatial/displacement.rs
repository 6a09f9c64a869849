//! Shear displacement between wheel and soil.

use super::contact::Contact;
use super::pack::{PACK, Pack, load, splat, store};
use super::settings::Displacement;
use super::terrain::Terrain;

/// Angle without soil contact after which an element of the rim loses its displacement `[rad]`.
const HALF_TURN: f64 = core::f64::consts::PI;

/// Shear displacement j of the contact, which formulas such as Janosi and Hanamoto's, `1 − exp(−j/K)`, use.
///
/// On the rim, j belongs to elements of the wheel's surface, bins of its angle, and grows by `|v_t| dt` in contact:
/// `j(θ) = R [(θ_1 − θ) − (1 − s)(sin θ_1 − sin θ)]` in steady motion (Wong and Reece). Between a grouser and the rim behind
/// it an element loses contact without losing its displacement. On the soil, j belongs to the terrain's nodes.
#[derive(Debug, Clone)]
pub(super) struct ShearPath {
    /// Number of bins around the wheel; 0 if j belongs to the soil.
    bins: usize,
    /// Number of lanes in a bin's row.
    lanes: usize,
    slid: Vec<f64>,
    /// Angle of the wheel when a bin was last in contact `[rad]`.
    last: Vec<f64>,
    /// The first bin of each strip, and the bin after its last, numbered on from turn to turn.
    spans: Vec<[i64; 2]>,
}

impl ShearPath {
    /// Creates a path without displacement. `dx` is the spacing along travel `[m]`; a bin is half as long.
    pub(super) fn new(keeper: Displacement, radius: f64, dx: f64) -> Self {
        let bins = libm::ceil(core::f64::consts::TAU * radius / (0.5 * dx)) as usize;
        Self {
            bins: if keeper == Displacement::Rim { bins } else { 0 },
            lanes: 0,
            slid: Vec::new(),
            last: Vec::new(),
            spans: Vec::new(),
        }
    }

    /// Resets all displacements to zero.
    pub(super) fn clear(&mut self) {
        self.slid.fill(0.0);
        self.last.fill(f64::MIN);
    }

    fn on_rim(&self) -> bool {
        self.bins > 0
    }

    /// Makes room for the bins' lanes: at a slip angle the number of lanes under the wheel may change by one.
    fn widen(&mut self, packs: usize) {
        if self.lanes == 0 {
            self.lanes = (packs + 1) * PACK;
            self.slid = vec![0.0; self.bins * self.lanes];
            self.last = vec![f64::MIN; self.bins];
        }
    }

    /// Finds the bins of the wheel's surface over every strip; the bin at a strip's front end belongs to the next strip.
    fn find_spans(&mut self, contact: &Contact, turned: f64) {
        let per_angle = self.bins as f64 / core::f64::consts::TAU;
        self.spans.clear();
        self.spans.extend(contact.strips.iter().map(|strip| {
            let place =
                |ahead: f64| libm::floor((libm::atan2(ahead, strip.rise) + turned) * per_angle) as i64;
            let first = place(strip.rear);
            [first, place(strip.front).max(first + 1)]
        }));
    }

    /// Returns the bins over a strip.
    fn bins_of(&self, row: usize) -> impl Iterator<Item = usize> + use<> {
        let ([first, end], bins) = (self.spans[row], self.bins as i64);
        (first..end).map(move |bin| bin.rem_euclid(bins) as usize)
    }

    /// Computes the shear displacement of every quad so far `[m]`; 0 beside the wheel.
    pub(super) fn measure(&mut self, contact: &Contact, terrain: &Terrain, turned: f64, out: &mut Vec<Pack>) {
        let packs = contact.across.packs();
        if self.on_rim() {
            self.widen(packs);
            self.find_spans(contact, turned);
        }
        out.clear();
        for (row, strip) in contact.strips.iter().enumerate() {
            for pack in 0..packs {
                out.push(if strip.rise <= 0.0 {
                    splat(0.0)
                } else if self.on_rim() {
                    self.mean_slid(row, pack, turned)
                } else {
                    let start = strip.column * terrain.lanes + contact.across.first_lane;
                    load(&terrain.sheared, start + pack * PACK)
                });
            }
        }
    }

    fn mean_slid(&self, row: usize, pack: usize, turned: f64) -> Pack {
        let (mut sum, mut bins) = (splat(0.0), 0.0);
        for bin in self.bins_of(row) {
            if turned - self.last[bin] < HALF_TURN {
                sum += load(&self.slid, bin * self.lanes + pack * PACK);
            }
            bins += 1.0;
        }
        sum * splat(1.0 / bins)
    }

    /// Adds the sliding of wheel and soil for a time, at the places last measured.
    pub(super) fn slide(&mut self, contact: &Contact, terrain: &mut Terrain, turned: f64, time: f64) {
        let packs = contact.across.packs();
        for row in (contact.first..contact.end).filter(|&row| contact.masks[row] != 0) {
            let strip = &contact.strips[row];
            for pack in 0..packs {
                let place = row * packs + pack;
                let touching = contact.quads[place].touching(contact.hub);
                let path = touching.select(contact.slip_speed(place, row) * splat(time), splat(0.0));
                if self.on_rim() {
                    for bin in self.bins_of(row) {
                        let at = bin * self.lanes + pack * PACK;
                        let anew = turned - self.last[bin] >= HALF_TURN;
                        let before = if anew { splat(0.0) } else { load(&self.slid, at) };
                        store(&mut self.slid, at, before + path);
                    }
                } else if strip.holds_node {
                    let at = strip.column * terrain.lanes + contact.across.first_lane + pack * PACK;
                    let sheared = load(&terrain.sheared, at) + path;
                    store(&mut terrain.sheared, at, sheared);
                }
            }
            if self.on_rim() {
                for bin in self.bins_of(row) {
                    self.last[bin] = turned;
                }
            }
        }
    }
}

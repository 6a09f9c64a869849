//! The patches of a footprint: connected nodes in contact.

use super::super::pack::{PACK, Pack, lanes_of, splat};

/// A run of neighbouring lanes in contact in one strip.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    pub(crate) strip: usize,
    /// First lane, and the lane after the last.
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// Index of the run's patch; while labelling, of an earlier run in the same patch, or itself.
    pub(crate) patch: usize,
}

impl Run {
    /// Selects the run's lanes among those of a pack.
    #[inline]
    pub(crate) fn lanes_of(&self, pack: usize) -> Pack {
        let lanes = (u64::MAX >> (64 - (self.end - self.start))) << self.start;
        lanes_of(lanes >> (pack * PACK))
    }
}

/// Properties of one patch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    /// A `[m²]`; of the modelled half if mirrored.
    pub(crate) area: f64,
    /// Contour length L `[m]`; of the modelled half if mirrored.
    pub(crate) contour: f64,
    /// Effective width of the patch or of the hull `[m]`.
    pub(crate) b_eff: f64,
    /// Sums of area, and of area times the shape g of the pressure distribution, lane by lane.
    pub(crate) areas: Pack,
    pub(crate) shapes: Pack,
    /// Modulus k* `[N/m^(n+2)]`.
    pub(crate) modulus: f64,
    /// k* over the mean of g; 0 if there is no support.
    pub(crate) stiffness: f64,
}

/// The runs of a footprint, from rear to front, and its patches.
#[derive(Debug, Clone, Default)]
pub(crate) struct Patches {
    pub(crate) runs: Vec<Run>,
    pub(crate) patches: Vec<Patch>,
    /// The runs of each strip, from the first strip in contact on.
    pub(crate) by_strip: Vec<core::ops::Range<usize>>,
    /// The labelled strips: the first strip in contact, and the masks from there on.
    first: usize,
    masks: Vec<u64>,
}

/// Returns the first lanes, and lanes after the last, of a mask's runs.
pub(crate) fn lanes_in_runs(mut mask: u64) -> impl Iterator<Item = (usize, usize)> {
    core::iter::from_fn(move || {
        (mask != 0).then(|| {
            let start = mask.trailing_zeros() as usize;
            let length = (!(mask >> start)).trailing_zeros() as usize;
            // the carry of the lowest bit runs through the run
            mask &= mask.wrapping_add(1 << start);
            (start, start + length)
        })
    })
}

impl Patches {
    /// Labels the runs of the strips `first..first + masks.len()`; bit j of a mask means that lane j is in contact.
    ///
    /// Nodes are connected along strips and lanes, not across corners.
    pub(crate) fn label(&mut self, first: usize, masks: &[u64]) {
        let zero = splat(0.0);
        let blank = Patch {
            area: 0.0,
            contour: 0.0,
            b_eff: 0.0,
            areas: zero,
            shapes: zero,
            modulus: 0.0,
            stiffness: 0.0,
        };
        if self.first == first && self.masks == masks {
            self.patches.fill(blank);
            return;
        }
        self.first = first;
        self.masks.clear();
        self.masks.extend_from_slice(masks);
        self.find_runs();
        self.patches.clear();
        for run in 0..self.runs.len() {
            let before = self.runs[run].patch;
            self.runs[run].patch = if before == run {
                self.patches.push(blank);
                self.patches.len() - 1
            } else {
                self.runs[before].patch
            };
        }
    }

    /// Finds the runs of lanes, and joins each to those of the preceding strip that it touches.
    fn find_runs(&mut self) {
        self.runs.clear();
        self.by_strip.clear();
        let mut before = 0..0;
        for (offset, &mask) in self.masks.iter().enumerate() {
            let begin = self.runs.len();
            for (start, end) in lanes_in_runs(mask) {
                let label = self.runs.len();
                let mut patch = label;
                for neighbour in before.clone() {
                    if self.runs[neighbour].start < end && start < self.runs[neighbour].end {
                        patch = join(&mut self.runs, neighbour, patch);
                    }
                }
                self.runs.push(Run {
                    strip: self.first + offset,
                    start,
                    end,
                    patch,
                });
            }
            before = begin..self.runs.len();
            self.by_strip.push(before.clone());
        }
    }
}

/// Joins the patch of a run with another, whose head is given; returns the foremost run of the joined patch.
fn join(runs: &mut [Run], mut run: usize, head: usize) -> usize {
    while runs[run].patch != run {
        run = runs[run].patch;
    }
    let (low, high) = if run < head { (run, head) } else { (head, run) };
    if let Some(high) = runs.get_mut(high) {
        high.patch = low;
    }
    low
}

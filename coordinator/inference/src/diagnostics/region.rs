//! The region of the prior in which failures concentrate.

use super::tail::ln_hypergeometric_tail;

/// Bins of equal probability in the prior of each parameter.
pub const BINS: usize = 5;

/// One end of a parameter's prior: the bins `from..to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Side {
    /// Position of the parameter.
    pub parameter: usize,
    /// First bin of the region.
    pub from: usize,
    /// The bin after the region's last bin.
    pub to: usize,
}

/// A region of the prior that holds more failures than its share.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// One side, or two that must both hold.
    pub sides: Vec<Side>,
    /// Number of draws in the region.
    pub drawn: usize,
    /// Number of failures among them.
    pub failed: usize,
    /// Probability of this many failures by chance, times the number of regions tested; at most 1.
    pub p: f64,
}

/// Returns the bin of a probability: the prior's distribution function at a draw.
#[must_use]
pub fn bin(probability: f64) -> usize {
    ((probability * BINS as f64) as usize).min(BINS - 1)
}

/// Returns the region with the least probability by chance, among the ends of every parameter and of every pair; `None` where all
/// draws failed or none did.
///
/// Among equal regions the first one is taken; one parameter goes before two.
///
/// # Equation
/// Fisher's exact test: with N draws, R failures and K draws in a region, the failures there are hypergeometric if
/// failure is independent of it. Bonferroni over the `8 d + 64 d (d - 1) / 2` regions of d parameters.
///
/// # Arguments
/// - `draws`: the [`bin`] of every parameter, and whether the draw failed.
///
/// Checked by `diagnostics::failures_of_a_corner_are_found_there`.
#[must_use]
pub fn concentration(draws: &[(Vec<usize>, bool)]) -> Option<Region> {
    let dimension = draws.first()?.0.len();
    let failures = draws.iter().filter(|d| d.1).count();
    if failures == 0 || failures == draws.len() {
        return None;
    }
    let ends = |parameter: usize| {
        let cuts = 1..BINS;
        cuts.flat_map(move |cut| [(0, cut), (cut, BINS)])
            .map(move |(from, to)| Side { parameter, from, to })
    };
    let single = (0..dimension).flat_map(ends).map(|side| vec![side]);
    let pairs = (0..dimension)
        .flat_map(|i| (i + 1..dimension).map(move |j| (i, j)))
        .flat_map(|(i, j)| ends(i).flat_map(move |a| ends(j).map(move |b| vec![a, b])));
    let regions: Vec<Vec<Side>> = single.chain(pairs).collect();
    let tried = libm::log(regions.len() as f64);
    let mut best: Option<(f64, Region)> = None;
    for sides in regions {
        let inside = |bins: &[usize]| sides.iter().all(|s| (s.from..s.to).contains(&bins[s.parameter]));
        let (mut drawn, mut failed) = (0, 0);
        for (_, failure) in draws.iter().filter(|(bins, _)| inside(bins)) {
            drawn += 1;
            failed += usize::from(*failure);
        }
        let chance = ln_hypergeometric_tail(draws.len(), failures, drawn, failed);
        if best.as_ref().is_none_or(|(lowest, _)| chance < *lowest) {
            let p = libm::exp((chance + tried).min(0.0));
            let region = Region {
                sides,
                drawn,
                failed,
                p,
            };
            best = Some((chance, region));
        }
    }
    best.map(|(_, region)| region)
}

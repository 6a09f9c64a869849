//! The posterior of the parameters of the covariance.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::covariance::Covariance;
use super::misfit::Misfit;
use crate::gaussian_process::representative;

/// Standard deviations of the smooth part, over the root mean square of the misfits.
const SDS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// Standard deviations of the local part of each condition, over that of the noise of a mean.
const LOCAL_SDS: [f64; 4] = [0.0, 1.0, 2.0, 4.0];
/// Correlations of two groups.
const BETWEEN: [f64; 4] = [0.0, 0.5, 0.8, 0.95];
/// Length scales over the range of a coordinate.
const LENGTHS: [f64; 6] = [0.1, 0.2, 0.4, 0.8, 1.6, 3.2];
/// Standard deviation of the coefficients of a plane, over the root mean square of the misfits: large, so that the misfits choose it.
const PLANE_SD: f64 = 10.0;
/// Difference of log density from the best parameters beyond which the search does not continue `[nats]`.
const REACH: f64 = 6.0;
/// Maximum number of parameters that are evaluated.
const MAX_PLACES: usize = 2000;
/// Maximum number of misfits that enter: if there are more, this many represent them, because the cost grows with the cube of the number.
const MAX_MISFITS: usize = 100;
/// Share of the probability that the kept parameters hold together.
const KEPT: f64 = 0.99;
/// Maximum number of kept parameters. With more misfits than [`MAX_MISFITS`] fewer are kept, because each takes memory proportional to
/// the square of the number of misfits.
const MAX_KEPT: usize = 64;

/// Places on the grid: sd, local sd, correlation of groups, then the lengths.
type Place = Vec<usize>;

/// Returns the covariances that hold nearly all of the probability, with their shares of it, the most probable first. The prior
/// is equal at all places of the grid. The search begins in the middle; next it evaluates the neighbours of the most probable
/// place that has unevaluated ones.
///
/// # Arguments
/// - `has_plane`: whether the mean of the process is a plane that the misfits determine, or 0.
pub(super) fn posterior(misfits: &[Misfit], has_plane: bool) -> Vec<(Covariance, f64)> {
    let grid = Grid::new(misfits, has_plane);
    let mut open: BTreeMap<Place, f64> = BTreeMap::new();
    let mut opened: BTreeMap<Place, f64> = BTreeMap::new();
    let mut next = Some(grid.middle());
    while let Some(place) = next.filter(|_| open.len() + opened.len() < MAX_PLACES) {
        let nats = open
            .remove(&place)
            .unwrap_or_else(|| grid.log_probability(&place));
        opened.insert(place.clone(), nats);
        for neighbour in grid.neighbours(&place) {
            if !opened.contains_key(&neighbour) && !open.contains_key(&neighbour) {
                let nats = grid.log_probability(&neighbour);
                open.insert(neighbour, nats);
            }
        }
        let best = opened
            .values()
            .chain(open.values())
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let best_open = open.iter().max_by(|a, b| a.1.total_cmp(b.1));
        next = best_open
            .filter(|(_, nats)| **nats >= best - REACH)
            .map(|(place, _)| place.clone());
    }
    opened.extend(open);
    let mut all: Vec<(Place, f64)> = opened.into_iter().collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    let best = all.first().map_or(0.0, |(_, nats)| *nats);
    let weights: Vec<f64> = all.iter().map(|(_, nats)| libm::exp(nats - best)).collect();
    let total: f64 = weights.iter().sum();
    let mut held = 0.0;
    let max_kept = MAX_KEPT * MAX_MISFITS * MAX_MISFITS / (misfits.len() * misfits.len()).max(1);
    let kept = weights
        .iter()
        .take(max_kept.clamp(1, MAX_KEPT))
        .take_while(|weight| {
            let is_short = held < KEPT * total;
            held += **weight;
            is_short
        });
    let kept = kept.count();
    let held: f64 = weights[..kept].iter().sum();
    let shares = all.iter().zip(&weights).take(kept);
    shares
        .map(|((place, _), weight)| (grid.covariance(place), weight / held))
        .collect()
}

/// The grid of covariances, and the misfits that determine the probability of each.
struct Grid {
    misfits: Vec<Misfit>,
    values: DVector<f64>,
    rms: f64,
    noise_sd: f64,
    dimension: usize,
    has_groups: bool,
    has_plane: bool,
}

impl Grid {
    fn new(misfits: &[Misfit], has_plane: bool) -> Self {
        let has_groups = misfits.iter().any(|misfit| misfit.group != misfits[0].group);
        // The group is a coordinate of the selection, so that a group of few misfits is represented.
        let places = misfits
            .iter()
            .map(|misfit| misfit.point.iter().copied().chain([misfit.group as f64]));
        let places: Vec<Vec<f64>> = places.map(Iterator::collect).collect();
        let points: Vec<&[f64]> = places.iter().map(Vec::as_slice).collect();
        let chosen = representative(&points, MAX_MISFITS);
        let misfits: Vec<Misfit> = chosen.into_iter().map(|i| misfits[i].clone()).collect();
        let mean = |value: fn(&Misfit) -> f64| misfits.iter().map(value).sum::<f64>() / misfits.len() as f64;
        Grid {
            values: DVector::from_iterator(misfits.len(), misfits.iter().map(|misfit| misfit.value)),
            rms: mean(|misfit| misfit.value * misfit.value).sqrt(),
            noise_sd: mean(|misfit| misfit.noise_variance).sqrt(),
            dimension: misfits.first().map_or(0, |misfit| misfit.point.len()),
            has_groups,
            has_plane,
            misfits,
        }
    }

    /// Returns the number of values at each place.
    fn sizes(&self) -> Place {
        let between = if self.has_groups { BETWEEN.len() } else { 1 };
        let mut sizes = vec![SDS.len(), LOCAL_SDS.len(), between];
        sizes.extend(vec![LENGTHS.len(); self.dimension]);
        sizes
    }

    fn middle(&self) -> Place {
        self.sizes().into_iter().map(|size| size / 2).collect()
    }

    fn neighbours(&self, place: &Place) -> Vec<Place> {
        let sizes = self.sizes();
        let step = |k: usize, up: bool| {
            let mut near = place.clone();
            near[k] = if up { near[k] + 1 } else { near[k].checked_sub(1)? };
            (near[k] < sizes[k]).then_some(near)
        };
        let steps = (0..place.len()).flat_map(|k| [step(k, false), step(k, true)]);
        steps.flatten().collect()
    }

    fn covariance(&self, place: &Place) -> Covariance {
        Covariance {
            sd: SDS[place[0]] * self.rms,
            local_sd: LOCAL_SDS[place[1]] * self.noise_sd,
            between_groups: BETWEEN[place[2]],
            lengths: place[3..].iter().map(|&length| LENGTHS[length]).collect(),
            plane_sd: if self.has_plane { PLANE_SD * self.rms } else { 0.0 },
        }
    }

    /// Returns the log density of the misfits, up to a constant.
    fn log_probability(&self, place: &Place) -> f64 {
        let Some(factor) = self.covariance(place).factor(&self.misfits) else {
            return f64::NEG_INFINITY;
        };
        let lower = factor.l_dirty();
        let log_root: f64 = (0..self.misfits.len()).map(|i| libm::log(lower[(i, i)])).sum();
        -0.5 * self.values.dot(&factor.solve(&self.values)) - log_root
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Misfits of two groups along one coordinate.
    fn along(value: impl Fn(usize, f64) -> f64) -> Vec<Misfit> {
        let places = (0..2).flat_map(|group| (0..12).map(move |i| (group, f64::from(i) / 11.0)));
        let misfit = |(group, x)| Misfit {
            point: vec![x],
            group,
            value: value(group, x),
            noise_variance: 0.01,
        };
        places.map(misfit).collect()
    }

    /// Mean of a property over the posterior.
    fn mean(misfits: &[Misfit], value: fn(&Covariance) -> f64) -> f64 {
        posterior(misfits, false)
            .iter()
            .map(|(covariance, share)| share * value(covariance))
            .sum()
    }

    #[test]
    fn the_probability_is_that_of_a_normal_density() {
        let misfits = &along(|_, x| 1.0 + x)[..2];
        let grid = Grid::new(misfits, false);
        let place = grid.middle();
        let covariance = grid.covariance(&place);
        let between = covariance.between((&misfits[0].point, 0), (&misfits[1].point, 0));
        let alone = covariance.sd * covariance.sd + covariance.local_sd * covariance.local_sd + 0.01;
        let (a, b) = (misfits[0].value, misfits[1].value);
        let determinant = alone * alone - between * between;
        let square = (alone * (a * a + b * b) - 2.0 * between * a * b) / determinant;
        let expected = -0.5 * (square + libm::log(determinant));
        assert!((grid.log_probability(&place) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_search_finds_what_the_whole_grid_has() {
        let misfits = along(|group, x| libm::sin(5.0 * x) + 0.3 * group as f64);
        let grid = Grid::new(&misfits, false);
        let mut best = (grid.middle(), f64::NEG_INFINITY);
        for (a, b) in (0..SDS.len()).flat_map(|a| (0..LOCAL_SDS.len()).map(move |b| (a, b))) {
            for (c, d) in (0..BETWEEN.len()).flat_map(|c| (0..LENGTHS.len()).map(move |d| (c, d))) {
                let place = vec![a, b, c, d];
                let nats = grid.log_probability(&place);
                if nats > best.1 {
                    best = (place, nats);
                }
            }
        }
        let covariances = posterior(&misfits, false);
        assert_eq!(covariances[0].0, grid.covariance(&best.0));
        assert!((covariances.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn groups_that_miss_alike_are_correlated_and_others_are_not() {
        let alike = along(|_, x| libm::sin(7.0 * x));
        let apart = along(|group, x| libm::sin(7.0 * x + 2.0 * group as f64));
        let correlation = |misfits: &[Misfit]| mean(misfits, |covariance| covariance.between_groups);
        assert!(correlation(&alike) > 0.85, "{}", correlation(&alike));
        assert!(correlation(&apart) < 0.5, "{}", correlation(&apart));
    }

    #[test]
    fn of_many_misfits_a_group_of_few_says_how_alike_the_groups_miss() {
        let wave = |x: f64| libm::sin(7.0 * x);
        let misfit = |(group, i): (usize, u32)| Misfit {
            point: vec![f64::from(i % 60) / 59.0],
            group,
            value: wave(f64::from(i % 60) / 59.0),
            noise_variance: 0.01,
        };
        let many = (0..240).map(|i| (0, i)).chain((0..6).map(|k| (1, 10 * k)));
        let many: Vec<Misfit> = many.map(misfit).collect();
        let covariances = posterior(&many, false);
        assert!(
            covariances.len() <= MAX_KEPT * 100 * 100 / (246 * 246),
            "{}",
            covariances.len()
        );
        let correlation: f64 = covariances
            .iter()
            .map(|(covariance, share)| share * covariance.between_groups)
            .sum();
        assert!(correlation > 0.5, "{correlation}");
    }

    #[test]
    fn a_line_has_a_longer_scale_than_a_wave() {
        let length = |misfits: &[Misfit]| mean(misfits, |covariance| covariance.lengths[0]);
        let (line, wave) = (along(|_, x| x - 0.5), along(|_, x| libm::sin(12.0 * x)));
        assert!(length(&line) > 2.0 * length(&wave));
    }
}

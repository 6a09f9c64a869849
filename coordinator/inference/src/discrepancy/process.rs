//! The discrepancy of a model in the conditions that were tested and between them.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::covariance::Covariance;
use super::misfit::Misfit;
use super::posterior::posterior;
use crate::gaussian_process::UnitRange;

/// The discrepancy of a model as a Gaussian process through its misfits.
///
/// `y_i = d(x_i, g_i) + u_i + e_i`: misfit of condition `x_i` of group `g_i`, smooth discrepancy d, local discrepancy u of the
/// condition and noise e. `cov(d(x, g), d(x', g')) = s^2 c (1 + r + r^2 / 3) exp(-r)`, `r^2 = 5 sum_k ((x_k - x'_k) / l_k)^2`
/// (Matérn, 5/2), coordinates over their range, c = 1 within a group and one correlation between groups. The mean is 0: far from
/// the misfits the model stands as it is. s, the sd of u, c and the `l_k` are averaged over a grid by their posterior
/// probability.
///
/// The model's parameters are those of its calibration, which ignores d (modularisation): a process as flexible as the model would
/// otherwise absorb what the model can explain.
///
/// # Source
/// Kennedy & O'Hagan 2001, doi:10.1111/1467-9868.00294; Liu, Bayarri & Berger 2009, doi:10.1214/09-BA404. Checked by
/// `a_smooth_misfit_is_found_between_the_conditions` and others below.
#[derive(Debug, Clone)]
pub struct DiscrepancyProcess {
    unit: UnitRange,
    misfits: Vec<Misfit>,
    parts: Vec<Part>,
}

/// The process with one covariance.
#[derive(Debug, Clone)]
struct Part {
    probability: f64,
    covariance: Covariance,
    factor: Cholesky<f64, Dyn>,
    inverse: DMatrix<f64>,
}

/// The discrepancy in one condition: a mixture of normal laws.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrepancy {
    /// Weight of each misfit in the mean.
    pub weights: Vec<f64>,
    /// A normal law for each covariance.
    pub components: Vec<DiscrepancyComponent>,
}

/// A component of a mixture: a normal distribution of the discrepancy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscrepancyComponent {
    /// Mean [unit of the channel].
    pub mean: f64,
    /// Variance, without noise [unit squared].
    pub variance: f64,
    /// Probability of this law.
    pub probability: f64,
}

impl Discrepancy {
    /// Returns the mean [unit of the channel].
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.components.iter().map(|law| law.probability * law.mean).sum()
    }
}

impl DiscrepancyProcess {
    /// Returns the minimum number of misfits for this number of coordinates.
    #[must_use]
    pub fn min_misfits(coordinates: usize) -> usize {
        coordinates + 3
    }

    /// Maximum number of misfits: a matrix of the square of their number is inverted.
    pub const MAX_MISFITS: usize = 500;

    /// Returns the process through misfits whose points have the same coordinates, each of which must vary, and whose noise is
    /// above 0; `None` with fewer than [`DiscrepancyProcess::min_misfits`] or more than [`DiscrepancyProcess::MAX_MISFITS`],
    /// where all are 0, or where no covariance is regular to rounding.
    #[must_use]
    pub fn through(misfits: &[Misfit]) -> Option<Self> {
        Self::new(misfits, false)
    }

    /// Returns the same process about a plane in place of 0: `m(x) = a + b'(x - 1/2)` with coordinates over their range, alike for all
    /// groups, and independent normal coefficients of ten times the root mean square of the misfits, so that these determine it. It
    /// predicts measurements without a model: their differences from their mean are the misfits. Checked by
    /// `about_a_plane_a_line_goes_on_beyond_the_misfits`.
    #[must_use]
    pub fn about_a_plane(misfits: &[Misfit]) -> Option<Self> {
        Self::new(misfits, true)
    }

    fn new(misfits: &[Misfit], has_plane: bool) -> Option<Self> {
        let dimension = misfits.first()?.point.len();
        let is_usable = misfits.iter().any(|misfit| misfit.value.abs() > 0.0);
        let numbers = Self::min_misfits(dimension)..=Self::MAX_MISFITS;
        if dimension == 0 || !numbers.contains(&misfits.len()) || !is_usable {
            return None;
        }
        let points: Vec<&[f64]> = misfits.iter().map(|misfit| misfit.point.as_slice()).collect();
        let unit = UnitRange::new(&points);
        let scaled = |misfit: &Misfit| Misfit {
            point: unit.scaled(&misfit.point),
            ..misfit.clone()
        };
        let misfits: Vec<Misfit> = misfits.iter().map(scaled).collect();
        let part = |(covariance, probability): (Covariance, f64)| {
            let factor = covariance.factor(&misfits)?;
            Some(Part {
                probability,
                covariance,
                inverse: factor.inverse(),
                factor,
            })
        };
        let parts: Vec<Part> = posterior(&misfits, has_plane)
            .into_iter()
            .filter_map(part)
            .collect();
        (!parts.is_empty()).then_some(DiscrepancyProcess { unit, misfits, parts })
    }

    /// Returns the discrepancy of a group in a condition. A group without a misfit has only the part that it shares with the
    /// others.
    #[must_use]
    pub fn at(&self, point: &[f64], group: usize) -> Discrepancy {
        let point = self.unit.scaled(point);
        let law = |part: &Part| {
            let place = (point.as_slice(), group);
            let shared = self
                .misfits
                .iter()
                .map(|m| part.covariance.between((&m.point, m.group), place));
            let shared = DVector::from_iterator(self.misfits.len(), shared);
            let weights = part.factor.solve(&shared);
            let covariance = &part.covariance;
            let before = covariance.between(place, place) + covariance.local_sd * covariance.local_sd;
            let variance = before - shared.dot(&weights);
            (weights, variance)
        };
        self.mixture(self.parts.iter().map(law))
    }

    /// Returns the discrepancies in the conditions of some misfits, predicted from all other misfits; the covariance stays the same. `None`
    /// where their precision is singular to rounding.
    ///
    /// With the precision Q of all misfits and `B = Q_SS^-1` of those that are left out, the mean is `-B Q_SR y_R` and the variance of the
    /// misfits `diag(B)`.
    ///
    /// # Arguments
    /// - `left_out`: numbers of the misfits, in the order of the result.
    #[must_use]
    pub fn without(&self, left_out: &[usize]) -> Option<Vec<Discrepancy>> {
        let block = |part: &Part| {
            let rows = part.inverse.select_rows(left_out);
            let covariance = Cholesky::new(rows.select_columns(left_out))?.inverse();
            let mut weights = -(&covariance * rows);
            left_out.iter().for_each(|&k| weights.column_mut(k).fill(0.0));
            Some((weights, covariance))
        };
        let blocks: Option<Vec<(DMatrix<f64>, DMatrix<f64>)>> = self.parts.iter().map(block).collect();
        let blocks = blocks?;
        let discrepancy =
            |(row, &misfit): (usize, &usize)| {
                let noise = self.misfits[misfit].noise_variance;
                self.mixture(blocks.iter().map(|(weights, covariance)| {
                    (weights.row(row).transpose(), covariance[(row, row)] - noise)
                }))
            };
        Some(left_out.iter().enumerate().map(discrepancy).collect())
    }

    /// Returns the mixture of the weights and variances that the covariances give, in the order of the parts.
    fn mixture(&self, laws: impl Iterator<Item = (DVector<f64>, f64)>) -> Discrepancy {
        let values =
            DVector::from_iterator(self.misfits.len(), self.misfits.iter().map(|misfit| misfit.value));
        let mut sum = DVector::zeros(self.misfits.len());
        let mut components = Vec::with_capacity(self.parts.len());
        let total: f64 = self.parts.iter().map(|part| part.probability).sum();
        for (part, (weights, variance)) in self.parts.iter().zip(laws) {
            let probability = part.probability / total;
            components.push(DiscrepancyComponent {
                mean: weights.dot(&values),
                // Rounding may leave a variance slightly below 0.
                variance: variance.max(0.0),
                probability,
            });
            sum += weights * probability;
        }
        Discrepancy {
            weights: sum.iter().copied().collect(),
            components,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Misfits of two wheels over slip and angle, in the units of a rig.
    fn misfits(value: impl Fn(usize, f64, f64) -> f64) -> Vec<Misfit> {
        let angles = [0.0, 20.0, 40.0, 60.0];
        let slips = [-0.7, -0.2, 0.0, 0.5, 0.9];
        let misfit = |group, slip, angle| Misfit {
            point: vec![slip, angle],
            group,
            value: value(group, slip, angle),
            noise_variance: 0.01,
        };
        let group_places = |group| slips.into_iter().flat_map(move |s| angles.map(|a| (group, s, a)));
        let places = [0, 1].into_iter().flat_map(group_places);
        places
            .map(|(group, slip, angle)| misfit(group, slip, angle))
            .collect()
    }

    fn surface(group: usize, slip: f64, angle: f64) -> f64 {
        3.0 * libm::sin(2.0 * slip) + 0.05 * angle * (1.0 - 0.2 * group as f64)
    }

    #[test]
    fn a_smooth_misfit_is_found_between_the_conditions() {
        let process = DiscrepancyProcess::through(&misfits(surface)).unwrap();
        for (group, slip, angle) in [(0, 0.3, 30.0), (1, -0.4, 50.0), (1, 0.1, 10.0)] {
            let discrepancy = process.at(&[slip, angle], group);
            let error = discrepancy.mean() - surface(group, slip, angle);
            // The values have a range of 8.
            assert!(error.abs() < 0.3, "{group} {slip} {angle}: {error}");
            let sd = discrepancy.components[0].variance.sqrt();
            assert!(sd < 1.0 && error.abs() < 3.0 * sd, "{sd}");
        }
    }

    #[test]
    fn far_from_the_misfits_the_model_stands_as_it_is() {
        let process = DiscrepancyProcess::through(&misfits(surface)).unwrap();
        let sd = |discrepancy: &Discrepancy| discrepancy.components[0].variance.sqrt();
        let (near, far) = (process.at(&[0.5, 62.0], 0), process.at(&[30.0, 2000.0], 0));
        assert!(far.mean().abs() < 0.05 && sd(&far) > 5.0 * sd(&near));
    }

    #[test]
    fn about_a_plane_a_line_goes_on_beyond_the_misfits() {
        let line = |slip: f64, angle: f64| 4.0 * slip - 0.2 * angle;
        let all = misfits(|_, slip, angle| line(slip, angle) + 0.05 * libm::sin(9.0 * slip + 7.0 * angle));
        let expected = line(1.5, 100.0);
        let [about_0, about_plane] = [DiscrepancyProcess::through, DiscrepancyProcess::about_a_plane]
            .map(|process| process(&all).unwrap().at(&[1.5, 100.0], 0).mean() - expected);
        assert!(
            about_plane.abs() < 0.3 && about_0.abs() > 1.0,
            "{about_plane} {about_0}"
        );
    }

    #[test]
    fn leaving_misfits_out_by_the_inverse_is_leaving_them_out() {
        let all = misfits(surface);
        let process = DiscrepancyProcess::through(&all).unwrap();
        // One misfit; then the angle of 40 deg, whose misfits have no neighbour at their angle.
        let level = (0..all.len()).filter(|&i| all[i].point[1] > 39.0 && all[i].point[1] < 41.0);
        for left_out in [vec![7], level.collect()] {
            let left = process.without(&left_out).unwrap();
            let part = &process.parts[0];
            let rest: Vec<usize> = (0..all.len()).filter(|i| !left_out.contains(i)).collect();
            let misfits: Vec<Misfit> = rest.iter().map(|&i| process.misfits[i].clone()).collect();
            let factor = part.covariance.factor(&misfits).unwrap();
            let values = DVector::from_iterator(misfits.len(), misfits.iter().map(|m| m.value));
            for (&number, discrepancy) in left_out.iter().zip(&left) {
                let place = &process.misfits[number];
                let shared = misfits.iter().map(|m| {
                    part.covariance
                        .between((&m.point, m.group), (&place.point, place.group))
                });
                let shared = DVector::from_iterator(misfits.len(), shared);
                let mean = factor.solve(&shared).dot(&values);
                let law = discrepancy.components[0];
                assert!((law.mean - mean).abs() < 1e-7, "{} {mean}", law.mean);
                let before = part.covariance.sd * part.covariance.sd
                    + part.covariance.local_sd * part.covariance.local_sd;
                let variance = before - factor.solve(&shared).dot(&shared);
                assert!((law.variance - variance).abs() < 1e-7 * before);
                for &other in &left_out {
                    assert_eq!(discrepancy.weights[other].to_bits(), 0.0_f64.to_bits());
                }
            }
        }
    }

    #[test]
    fn the_weights_are_those_of_the_mean() {
        let all = misfits(surface);
        let process = DiscrepancyProcess::through(&all).unwrap();
        let without = process.without(&[3]).unwrap().remove(0);
        for discrepancy in [process.at(&[0.2, 33.0], 1), without] {
            let by_weights: f64 = discrepancy
                .weights
                .iter()
                .zip(&all)
                .map(|(w, m)| w * m.value)
                .sum();
            assert!((by_weights - discrepancy.mean()).abs() < 1e-9);
        }
    }

    #[test]
    fn one_wheel_s_misfits_speak_for_another_that_misses_alike() {
        let alike = |_: usize, slip: f64, angle: f64| surface(0, slip, angle);
        let mut fewer = misfits(alike);
        // The second wheel has misfits straight ahead only.
        fewer.retain(|misfit| misfit.group == 0 || misfit.point[1] < 1.0);
        let discrepancy = DiscrepancyProcess::through(&fewer).unwrap().at(&[0.5, 40.0], 1);
        let expected = alike(1, 0.5, 40.0);
        assert!(
            (discrepancy.mean() - expected).abs() < 0.2 * expected,
            "{} {expected}",
            discrepancy.mean()
        );
    }

    #[test]
    fn too_few_misfits_too_many_and_none_make_no_process() {
        let all = misfits(surface);
        assert_eq!(DiscrepancyProcess::min_misfits(2), 5);
        assert!(DiscrepancyProcess::through(&all[..4]).is_none());
        assert!(DiscrepancyProcess::through(&misfits(|_, _, _| 0.0)).is_none());
        let many: Vec<Misfit> = all.iter().cycle().take(501).cloned().collect();
        assert!(DiscrepancyProcess::through(&many).is_none());
    }
}

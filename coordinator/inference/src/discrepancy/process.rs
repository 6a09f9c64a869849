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
        let parts: Vec<Part> = posterior(&misfits).into_iter().filter_map(part).collect();
        (!parts.is_empty()).then_some(DiscrepancyProcess { unit, misfits, parts })
    }

    /// Returns the discrepancy of a group in a condition. A group without a misfit has only the part that it shares with the
    /// others.
    #[must_use]
    pub fn at(&self, point: &[f64], group: usize) -> Discrepancy {
        let point = self.unit.scaled(point);
        self.mixture(|part| {
            let place = (point.as_slice(), group);
            let shared = self
                .misfits
                .iter()
                .map(|m| part.covariance.between((&m.point, m.group), place));
            let shared = DVector::from_iterator(self.misfits.len(), shared);
            let weights = part.factor.solve(&shared);
            let covariance = &part.covariance;
            let before = covariance.sd * covariance.sd + covariance.local_sd * covariance.local_sd;
            let variance = before - shared.dot(&weights);
            (weights, variance)
        })
    }

    /// Returns the discrepancy in the condition of a misfit, predicted from the other misfits; the covariance stays the same.
    ///
    /// # Arguments
    /// - `left_out`: number of the misfit.
    #[must_use]
    pub fn without(&self, left_out: usize) -> Discrepancy {
        self.mixture(|part| {
            let precision = part.inverse[(left_out, left_out)];
            let mut weights = -part.inverse.column(left_out) / precision;
            weights[left_out] = 0.0;
            (weights, 1.0 / precision - self.misfits[left_out].noise_variance)
        })
    }

    /// Returns the mixture from the weights and the variance that each covariance gives.
    fn mixture(&self, law: impl Fn(&Part) -> (DVector<f64>, f64)) -> Discrepancy {
        let values =
            DVector::from_iterator(self.misfits.len(), self.misfits.iter().map(|misfit| misfit.value));
        let mut sum = DVector::zeros(self.misfits.len());
        let mut components = Vec::with_capacity(self.parts.len());
        let total: f64 = self.parts.iter().map(|part| part.probability).sum();
        for part in &self.parts {
            let probability = part.probability / total;
            let (weights, variance) = law(part);
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
    fn leaving_a_misfit_out_by_the_inverse_is_leaving_it_out() {
        let all = misfits(surface);
        let process = DiscrepancyProcess::through(&all).unwrap();
        let left = process.without(7);
        let part = &process.parts[0];
        let mut rest = process.misfits.clone();
        let left_out = rest.remove(7);
        let factor = part.covariance.factor(&rest).unwrap();
        let shared = rest.iter().map(|m| {
            part.covariance
                .between((&m.point, m.group), (&left_out.point, left_out.group))
        });
        let shared = DVector::from_iterator(rest.len(), shared);
        let values = DVector::from_iterator(rest.len(), rest.iter().map(|m| m.value));
        let mean = factor.solve(&shared).dot(&values);
        assert!(
            (left.components[0].mean - mean).abs() < 1e-7,
            "{} {mean}",
            left.components[0].mean
        );
        let before =
            part.covariance.sd * part.covariance.sd + part.covariance.local_sd * part.covariance.local_sd;
        let variance = before - factor.solve(&shared).dot(&shared);
        assert!((left.components[0].variance - variance).abs() < 1e-7 * before);
        assert_eq!(left.weights[7].to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn the_weights_are_those_of_the_mean() {
        let all = misfits(surface);
        let process = DiscrepancyProcess::through(&all).unwrap();
        for discrepancy in [process.at(&[0.2, 33.0], 1), process.without(3)] {
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

//! The shift of parameters if some of the data were fitted alone.

use nalgebra::{Cholesky, DMatrix, DVector};

use statistics::likelihood::ErrorLaw;

/// The information of some of the data on parameters that all data have determined.
#[derive(Debug, Clone, PartialEq)]
pub struct SubsetShift {
    /// Shift of each parameter by these data [its unit].
    pub shift: Vec<f64>,
    /// Standard deviation of each shift.
    pub sd: Vec<f64>,
    /// For each parameter, the two-sided probability of a shift this large if all data agree.
    pub p: Vec<f64>,
    /// Root mean square of the residuals.
    pub rms_before: f64,
    /// Root mean square of the residuals after the shift.
    pub rms_after: f64,
}

/// Returns the least-squares step that residuals ask for, with a standard deviation that holds where the errors of a group are
/// common.
///
/// # Equation
/// With J the derivatives and r the residuals, `d = (J'J)^-1 J'r`, `e = r − J d`, and over the G groups g of k parameters `Cov(d)
/// = G / (G − k) (J'J)^-1 (sum_g J_g' e_g e_g' J_g) (J'J)^-1`; `d_i / sd_i` is compared with Student's t of G − k degrees. If all
/// data agree, d has a smaller variance than that, because the parameters have been fitted to these data too. So p is too large
/// rather than too small.
///
/// # Arguments
/// - `derivatives`: the derivatives of each prediction by each parameter. `residuals`: measured minus predicted. `groups`: the
///   group of each datum.
///
/// # Returns
/// `None` with fewer than k + 3 groups, or where the derivatives do not determine the parameters.
///
/// # Source
/// Liang & Zeger 1986, Biometrika 73:13, <https://doi.org/10.1093/biomet/73.1.13>, for the covariance. Checked by
/// `a_shift_is_found_with_its_size_and_none_where_the_data_agree`.
#[must_use]
pub fn subset_shift(derivatives: &[Vec<f64>], residuals: &[f64], groups: &[usize]) -> Option<SubsetShift> {
    let (n, k) = (residuals.len(), derivatives.first()?.len());
    let mut distinct = groups.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    if k == 0 || distinct.len() < k + 3 {
        return None;
    }
    let norm = |j: usize| derivatives.iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt();
    let norms: Vec<f64> = (0..k).map(norm).collect();
    let scaled = DMatrix::from_fn(n, k, |i, j| derivatives[i][j] / norms[j]);
    let before = DVector::from_row_slice(residuals);
    let inverse = Cholesky::new(scaled.tr_mul(&scaled))?.inverse();
    let shift = &inverse * scaled.tr_mul(&before);
    let after = &before - &scaled * &shift;
    let mut common = DMatrix::<f64>::zeros(k, k);
    for group in &distinct {
        let mut score = DVector::<f64>::zeros(k);
        for i in (0..n).filter(|&i| groups[i] == *group) {
            score += scaled.row(i).transpose() * after[i];
        }
        common += &score * score.transpose();
    }
    let freedom = (distinct.len() - k) as f64;
    let covariance = &inverse * common * &inverse * (distinct.len() as f64 / freedom);
    let law = ErrorLaw::StudentT {
        degrees_of_freedom: freedom,
    };
    let sds: Vec<f64> = (0..k).map(|j| covariance[(j, j)].sqrt()).collect();
    let rms = |values: &DVector<f64>| (values.norm_squared() / n as f64).sqrt();
    let shift = SubsetShift {
        shift: (0..k).map(|j| shift[j] / norms[j]).collect(),
        sd: (0..k).map(|j| sds[j] / norms[j]).collect(),
        p: (0..k)
            .map(|j| 2.0 * law.cumulative(-(shift[j] / sds[j]).abs()))
            .collect(),
        rms_before: rms(&before),
        rms_after: rms(&after),
    };
    shift.p.iter().all(|p| p.is_finite()).then_some(shift)
}

/// Returns the derivatives of predictions by parameters, from draws: the least-squares plane through them.
///
/// # Arguments
/// - `parameters`: the parameters of each draw. `predicted`: its predictions.
///
/// # Returns
/// For each prediction its derivative by each parameter; `None` with fewer draws than parameters + 2, or where these lie in a
/// plane.
#[must_use]
pub fn derivatives_from_draws(parameters: &[Vec<f64>], predicted: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let (draws, k) = (parameters.len(), parameters.first()?.len());
    if draws < k + 2 || predicted.len() != draws {
        return None;
    }
    let mean = |value: &dyn Fn(usize) -> f64| (0..draws).map(value).sum::<f64>() / draws as f64;
    let means: Vec<f64> = (0..k).map(|j| mean(&|d| parameters[d][j])).collect();
    let sds: Vec<f64> = (0..k)
        .map(|j| mean(&|d| (parameters[d][j] - means[j]).powi(2)).sqrt())
        .collect();
    let centred = DMatrix::from_fn(draws, k, |d, j| (parameters[d][j] - means[j]) / sds[j]);
    let factor = Cholesky::new(centred.tr_mul(&centred))?;
    let values = predicted.first()?.len();
    let slopes = (0..values).map(|i| {
        let centre = mean(&|d| predicted[d][i]);
        let column = DVector::from_iterator(draws, predicted.iter().map(|values| values[i] - centre));
        let slope = factor.solve(&centred.tr_mul(&column));
        (0..k).map(|j| slope[j] / sds[j]).collect::<Vec<f64>>()
    });
    let slopes: Vec<Vec<f64>> = slopes.collect();
    slopes.iter().flatten().all(|s| s.is_finite()).then_some(slopes)
}

#[cfg(test)]
mod tests {
    use statistics::rng::Stream;

    use super::*;

    fn normal(stream: &mut Stream) -> f64 {
        stream.normal_pair().0
    }

    /// Readings of twelve groups of five on a line that is off by `off`, with a shift of each group, less the prediction.
    fn shifted(off: [f64; 2], seed: u64) -> Option<SubsetShift> {
        let mut stream = Stream::new(seed, 0, 0, 0);
        let (mut derivatives, mut residuals, mut groups) = (Vec::new(), Vec::new(), Vec::new());
        for group in 0..12 {
            let common = 0.1 * normal(&mut stream);
            for reading in 0..5 {
                let x = f64::from(reading) + 0.3 * f64::from(group % 3);
                derivatives.push(vec![1.0, x]);
                residuals.push(off[0] + off[1] * x + common + 0.02 * normal(&mut stream));
                groups.push(group as usize);
            }
        }
        subset_shift(&derivatives, &residuals, &groups)
    }

    #[test]
    fn a_shift_is_found_with_its_size_and_none_where_the_data_agree() {
        let shift = shifted([0.5, 0.0], 1).unwrap();
        assert!(
            (shift.shift[0] - 0.5).abs() < 3.0 * shift.sd[0] && shift.p[0] < 1e-4,
            "{shift:?}"
        );
        assert!(shift.rms_after < 0.3 * shift.rms_before);
        // In 400 experiments without an error, at most a few have a probability below 0.01 in either parameter.
        let alarms = (0..400).filter(|&seed| {
            let p = shifted([0.0, 0.0], 10 + seed).unwrap().p;
            p.iter().any(|p| *p < 0.005)
        });
        assert!(
            alarms.count() <= 14,
            "three standard deviations above 0.01 of 400, and what few groups add"
        );
    }

    #[test]
    fn few_groups_and_parallel_derivatives_say_nothing() {
        let parallel = vec![vec![1.0, 2.0]; 30];
        let groups: Vec<usize> = (0..30).map(|i| i / 3).collect();
        assert_eq!(subset_shift(&parallel, &[0.1; 30], &groups), None);
        assert_eq!(
            subset_shift(&[vec![1.0], vec![1.0], vec![1.0]], &[1.0; 3], &[0, 1, 2]),
            None
        );
    }

    #[test]
    fn the_plane_through_draws_has_the_derivatives_of_a_linear_model() {
        let mut stream = Stream::new(3, 0, 0, 0);
        let parameters: Vec<Vec<f64>> = (0..50)
            .map(|_| vec![1e5 * normal(&mut stream), normal(&mut stream)])
            .collect();
        let predicted: Vec<Vec<f64>> = parameters
            .iter()
            .map(|p| vec![3.0 + 2e-5 * p[0] - p[1], 4.0 * p[1]])
            .collect();
        let shift = derivatives_from_draws(&parameters, &predicted).unwrap();
        for (row, expected) in shift.iter().zip([[2e-5, -1.0], [0.0, 4.0]]) {
            assert!(
                (row[0] - expected[0]).abs() < 1e-12 && (row[1] - expected[1]).abs() < 1e-9,
                "{row:?}"
            );
        }
        assert_eq!(derivatives_from_draws(&parameters[..3], &predicted[..3]), None);
    }
}

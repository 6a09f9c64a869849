//! Diagnostics on linear models with normal errors, where every answer is known.

use crate::setup::{correlated_pair, standard_normals, uniform};
use inference::diagnostics::{self, BINS, PredictedDraw, Region, Side};
use nalgebra::{Cholesky, DMatrix, DVector};
use statistics::rng::Stream;
use statistics::{CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Likelihood, Prior};

/// `y = X theta + sd e`, every parameter standard normal before the data.
struct Linear {
    design: DMatrix<f64>,
    sd: f64,
    /// Whether the sd is inferred: it is then the last parameter of theta, and every draw has its true value.
    inferred: bool,
}

impl Linear {
    /// Returns data on a line and a parabola, `weight` times as steep as the noise is wide.
    fn new(data: usize, weight: f64, inferred: bool) -> Self {
        let x = |i: usize| 2.0 * i as f64 / (data - 1) as f64 - 1.0;
        Linear {
            design: DMatrix::from_fn(data, 2, |i, k| weight * x(i).powi(1 + k as i32)),
            sd: 0.5,
            inferred,
        }
    }

    fn covariance(&self) -> DMatrix<f64> {
        let gram = self.design.transpose() * &self.design / (self.sd * self.sd);
        (DMatrix::identity(gram.nrows(), gram.nrows()) + gram)
            .try_inverse()
            .unwrap()
    }

    /// Returns data at one truth.
    fn data(&self, theta: &DVector<f64>, normals: &mut Stream) -> DVector<f64> {
        let clean = &self.design * theta;
        let count = clean.len();
        clean + self.sd * DVector::from_vec(normals.normals(count))
    }

    fn likelihood(&self, y: &DVector<f64>) -> Likelihood {
        let sd = match self.inferred {
            true => ErrorSd::Inferred {
                parameter: self.design.ncols(),
            },
            false => ErrorSd::Known(self.sd),
        };
        let datum = |(run, value): (usize, &f64)| Datum {
            run,
            channel: run % 2,
            value: *value,
            sd,
        };
        Likelihood::new(y.iter().enumerate().map(datum).collect()).unwrap()
    }

    fn predicted(&self, theta: DVector<f64>) -> PredictedDraw {
        let values = (&self.design * &theta).iter().copied().collect();
        let noise = self.inferred.then_some(self.sd);
        PredictedDraw {
            theta: theta.iter().copied().chain(noise).collect(),
            values,
        }
    }

    /// Draws whose sample mean and covariance are the posterior's exactly: two on each axis of its ellipsoid.
    fn posterior(&self, y: &DVector<f64>) -> Vec<PredictedDraw> {
        let covariance = self.covariance();
        let mean = &covariance * self.design.transpose() * y / (self.sd * self.sd);
        let root = Cholesky::new(covariance).unwrap().unpack();
        let reach = (root.ncols() as f64 - 0.5).sqrt();
        (0..root.ncols())
            .flat_map(|k| [reach, -reach].map(|c| &mean + c * root.column(k)))
            .map(|theta| self.predicted(theta))
            .collect()
    }

    fn truth(&self, normals: &mut Stream) -> DVector<f64> {
        DVector::from_vec(normals.normals(self.design.ncols()))
    }
}

fn stream(k: u64) -> Stream {
    Stream::new(7, 0, k, 0)
}

/// Returns the conflict of a prior with draws.
fn conflict<T: AsRef<[f64]>>(prior: &Prior, draws: &[T]) -> diagnostics::Conflict {
    let draws: Vec<&[f64]> = draws.iter().map(AsRef::as_ref).collect();
    diagnostics::conflict(prior, &draws).unwrap()
}

fn thetas(draws: Vec<PredictedDraw>) -> Vec<Vec<f64>> {
    draws.into_iter().map(|draw| draw.theta).collect()
}

#[test]
fn leverage_of_a_line_is_its_closed_form() {
    let model = Linear::new(9, 1.3, false);
    let y = DVector::from_fn(9, |i, _| 0.1 * (i * i) as f64 - 1.0);
    let draws = model.posterior(&y);
    let rows = diagnostics::residuals(&model.likelihood(&y), &draws).unwrap();
    let hat = &model.design * model.covariance() * model.design.transpose() / (model.sd * model.sd);
    let mean = PredictedDraw::mean(&draws).unwrap();
    for (i, row) in rows.iter().enumerate() {
        let h = hat[(i, i)];
        let residual = y[i] - mean.values[i];
        assert!((row.leverage - h).abs() < 1e-12 && (0.0..1.0).contains(&h), "{i}");
        let t = residual / (model.sd * (1.0 - h).sqrt());
        assert!((row.studentised.unwrap() - t).abs() < 1e-9, "{i}");
        let p = libm::erfc(t.abs() / 2.0_f64.sqrt());
        assert!((row.p.unwrap() - p).abs() < 1e-12, "{i}");
    }
}

#[test]
fn chi_square_of_a_line_is_its_closed_form() {
    let model = Linear::new(9, 1.3, false);
    let y = DVector::from_fn(9, |i, _| 0.1 * (i * i) as f64 - 1.0);
    let (likelihood, draws) = (model.likelihood(&y), model.posterior(&y));
    let all = diagnostics::chi_square(&likelihood, &draws, |_| true)
        .unwrap()
        .unwrap();
    let hat = &model.design * model.covariance() * model.design.transpose() / (model.sd * model.sd);
    let left = (DMatrix::identity(9, 9) - &hat) * &y;
    assert!((all.effective_parameters - hat.trace()).abs() < 1e-12);
    assert!((all.value - left.norm_squared() / 0.25).abs() < 1e-9);
    assert_eq!(all.data, 9);
    // The channels share it out.
    let [even, odd] = [0, 1].map(|channel| {
        diagnostics::chi_square(&likelihood, &draws, |i| likelihood.data()[i].channel == channel)
            .unwrap()
            .unwrap()
    });
    assert!((even.value + odd.value - all.value).abs() < 1e-9);
    assert!((even.effective_parameters + odd.effective_parameters - all.effective_parameters).abs() < 1e-12);
    assert_eq!(
        diagnostics::chi_square(&likelihood, &draws, |_| false).unwrap(),
        None
    );
}

/// Errors in common: `r' R^-1 r` and the trace, against dense matrices.
#[test]
fn chi_square_knows_errors_in_common() {
    let model = Linear::new(6, 1.3, false);
    let y = DVector::from_fn(6, |i, _| (i as f64 - 2.0) * 0.7);
    let data = model.likelihood(&y).data().to_vec();
    let shift = CommonError {
        data: vec![1, 2, 4],
        size: CommonErrorSize::Shift(ErrorSd::Known(0.8)),
    };
    let likelihood =
        Likelihood::with_common(data, ErrorLaw::Gaussian, vec![shift], vec![Discrepancy::None]).unwrap();
    let draws = model.posterior(&y);
    let mut errors = DMatrix::identity(6, 6) * 0.25;
    for (i, j) in [1, 2, 4].into_iter().flat_map(|i| [1, 2, 4].map(|j| (i, j))) {
        errors[(i, j)] += 0.64;
    }
    let inverse = errors.clone().try_inverse().unwrap();
    let mean = DVector::from_vec(PredictedDraw::mean(&draws).unwrap().values);
    let spread = &model.design * model.covariance() * model.design.transpose();
    let result = diagnostics::chi_square(&likelihood, &draws, |_| true)
        .unwrap()
        .unwrap();
    let residual = &y - &mean;
    assert!((result.value - residual.dot(&(&inverse * &residual))).abs() < 1e-9);
    assert!((result.effective_parameters - (&spread * &inverse).trace()).abs() < 1e-9);
    let rows = diagnostics::residuals(&likelihood, &draws).unwrap();
    for (i, row) in rows.iter().enumerate() {
        let t = residual[i] / (errors[(i, i)] - spread[(i, i)]).sqrt();
        assert!((row.studentised.unwrap() - t).abs() < 1e-9, "{i}");
    }
}

/// Share of p below 0.05 over repeated experiments.
fn level(repeats: u64, p: impl Fn(&mut Stream) -> Vec<f64>) -> f64 {
    let all: Vec<f64> = (0..repeats).flat_map(|k| p(&mut stream(k))).collect();
    all.iter().filter(|p| **p < 0.05).count() as f64 / all.len() as f64
}

#[test]
fn studentised_residuals_keep_their_level() {
    // The residuals share the part that the fit absorbs, so against their peers alarms are a little rarer than stated.
    for (inferred, range) in [(false, 0.046..0.054), (true, 0.038..0.052)] {
        let model = Linear::new(12, 1.3, inferred);
        let share = level(2000, |stream| {
            let y = model.data(&model.truth(stream), stream);
            let rows = diagnostics::residuals(&model.likelihood(&y), &model.posterior(&y)).unwrap();
            rows.iter().map(|row| row.p.unwrap()).collect()
        });
        assert!(range.contains(&share), "inferred {inferred}: {share}");
    }
}

#[test]
fn chi_square_keeps_its_level() {
    // The second prior is strong: alarms are rarer than stated, never more frequent.
    for (weight, lowest) in [(30.0, 0.04), (0.4, 0.02)] {
        let model = Linear::new(12, weight, false);
        let share = level(4000, |stream| {
            let y = model.data(&model.truth(stream), stream);
            let result = diagnostics::chi_square(&model.likelihood(&y), &model.posterior(&y), |_| true);
            vec![result.unwrap().unwrap().p.unwrap()]
        });
        assert!((lowest..0.06).contains(&share), "{weight}: {share}");
    }
}

#[test]
fn a_model_that_misses_fails_its_chi_square_and_an_outlier_is_named() {
    let model = Linear::new(12, 1.3, false);
    let mut y = model.data(&DVector::from_vec(vec![0.3, -0.4]), &mut stream(1));
    y[4] += 5.0 * model.sd;
    let rows = diagnostics::residuals(&model.likelihood(&y), &model.posterior(&y)).unwrap();
    let worst = (0..12).reduce(|a, b| if rows[b].p < rows[a].p { b } else { a });
    assert_eq!(worst, Some(4));
    assert!(rows[4].p.unwrap() * 12.0 < 0.01);
    let bent = DVector::from_fn(12, |i, _| if i % 4 < 2 { 3.0 } else { -3.0 } * model.sd);
    let result = diagnostics::chi_square(&model.likelihood(&bent), &model.posterior(&bent), |_| true);
    assert!(result.unwrap().unwrap().p.unwrap() < 1e-6);
}

#[test]
fn noise_that_is_inferred_has_no_chi_square_and_too_few_peers_no_residual() {
    let model = Linear::new(12, 1.3, true);
    let y = model.data(&model.truth(&mut stream(3)), &mut stream(4));
    let (likelihood, draws) = (model.likelihood(&y), model.posterior(&y));
    assert_eq!(
        diagnostics::chi_square(&likelihood, &draws, |_| true).unwrap(),
        None
    );
    let two = Linear::new(2, 1.3, true);
    let y = DVector::from_vec(vec![0.5, 0.6]);
    let rows = diagnostics::residuals(&two.likelihood(&y), &two.posterior(&y)).unwrap();
    assert!(rows.iter().all(|row| row.p.is_none()));
    // One draw has no spread to judge by.
    assert_eq!(diagnostics::residuals(&likelihood, &draws[..1]).unwrap(), []);
}

#[test]
fn conflict_is_rare_where_the_prior_is_right() {
    let model = Linear::new(12, 1.3, false);
    let prior = standard_normals(2);
    let check = |value: fn(&diagnostics::Conflict) -> f64| {
        level(4000, |stream| {
            let y = model.data(&model.truth(stream), stream);
            vec![value(&conflict(&prior, &thetas(model.posterior(&y))))]
        })
    };
    // Four draws only, so the sampling error of their mean, which these draws do not have, makes it a little rarer.
    let all = check(|c| c.p.unwrap());
    assert!((0.035..0.06).contains(&all), "{all}");
    let first = check(|c| c.parameters[0].unwrap());
    assert!((0.035..0.06).contains(&first), "{first}");
}

#[test]
fn a_prior_that_is_wrong_is_contradicted() {
    let model = Linear::new(12, 1.3, false);
    let prior = standard_normals(2);
    let at = |truth: [f64; 2]| {
        let y = &model.design * DVector::from_column_slice(&truth);
        conflict(&prior, &thetas(model.posterior(&y)))
    };
    let wrong = at([5.0, 0.0]);
    assert!(
        wrong.parameters[0].unwrap() < 1e-4 && wrong.p.unwrap() < 1e-4,
        "{wrong:?}"
    );
    assert!(wrong.parameters[1].unwrap() > 0.5, "{wrong:?}");
    let right = at([0.5, -0.5]);
    assert!(right.p.unwrap() > 0.3, "{right:?}");
}

/// a and b are N(0, 1) with the correlation 0.98, and their difference is measured six of its own prior-predictive sds out:
/// each alone looks fine.
#[test]
fn what_a_joint_prior_forbids_is_contradicted() {
    let (rho, noise): (f64, f64) = (0.98, 0.1);
    // The sum and the difference are independent: N(0, 2 (1 + rho)) and N(0, v) with v = 2 (1 - rho).
    let v = 2.0 * (1.0 - rho);
    let measured = 6.0 * (v + noise * noise).sqrt();
    let (mean, sd) = (
        measured * v / (v + noise * noise),
        (1.0 / (1.0 / v + 1.0 / (noise * noise))).sqrt(),
    );
    let draws: Vec<[f64; 2]> = (0..4000)
        .map(|k| {
            let (x, y) = Stream::new(8, 0, k, 0).normal_pair();
            let (sum, difference) = (x * (2.0 * (1.0 + rho)).sqrt(), mean + sd * y);
            [0.5 * (sum + difference), 0.5 * (sum - difference)]
        })
        .collect();
    let result = conflict(&correlated_pair(rho), &draws);
    assert_eq!(result.degrees_of_freedom, 1, "{result:?}");
    assert!((result.statistic - 36.0).abs() < 3.0, "{result:?}");
    assert!(result.parameters.iter().flatten().all(|p| *p > 0.1), "{result:?}");
}

#[test]
fn a_uniform_prior_is_contradicted_at_its_end_and_data_without_information_contradict_nothing() {
    let prior = Prior::new(vec![uniform(2.0, 4.0)]);
    let between = |from: f64, to: f64| {
        let draws: Vec<[f64; 1]> = (0..200)
            .map(|k| [from + (to - from) * (k as f64 + 0.5) / 200.0])
            .collect();
        conflict(&prior, &draws)
    };
    assert!(between(3.99, 4.0).parameters[0].unwrap() < 0.01);
    assert!(between(2.9, 3.1).parameters[0].unwrap() > 0.9);
    let silent = between(2.0, 4.0);
    assert_eq!((silent.parameters[0], silent.p), (None, None));
    assert_eq!(silent.degrees_of_freedom, 0);
}

/// A prior of sd 1 moves the datum `x theta` by |x|.
#[test]
fn the_signal_of_a_linear_model_is_its_slope() {
    let model = Linear::new(2, 3.0, false);
    let y = DVector::zeros(2);
    let reach = 1.0 / 2.0_f64.sqrt();
    // Theta is (+-r, 0): variance r^2 2 / 1 = 1 with divisor n - 1.
    let draws = [reach, -reach].map(|r| model.predicted(DVector::from_vec(vec![r, 0.0])));
    let result = diagnostics::signals(model.likelihood(&y).data(), &[0.25, 36.0], &draws);
    assert!((result[&0].prior_sd - 3.0).abs() < 1e-12 && (result[&0].error_sd - 0.5).abs() < 1e-12);
    assert!((result[&0].ratio - 6.0).abs() < 1e-12);
    assert!((result[&1].ratio - 0.5).abs() < 1e-12 && !result[&1].is_heard_together());
    assert!(diagnostics::signals(model.likelihood(&y).data(), &[0.25, 36.0], &draws[..1]).is_empty());
}

#[test]
fn a_uniform_prior_falls_into_equal_bins() {
    let marginal = uniform(2.0, 4.0);
    let bin = |x: f64| diagnostics::bin(marginal.cumulative(x));
    assert_eq!([2.0, 2.39, 2.41, 3.0, 3.99, 4.0].map(bin), [0, 0, 1, 2, 4, 4]);
    let mut counts = [0; BINS];
    for k in 0..1000 {
        counts[bin(marginal.quantile((f64::from(k) + 0.5) / 1000.0))] += 1;
    }
    assert_eq!(counts, [200; BINS]);
}

/// Returns every combination of bins of three parameters, this many times.
fn grid(times: usize, failed: impl Fn(&[usize]) -> bool) -> Vec<(Vec<usize>, bool)> {
    let one = (0..BINS.pow(3)).map(|k| vec![k % BINS, k / BINS % BINS, k / BINS / BINS]);
    (0..times)
        .flat_map(|_| one.clone())
        .map(|bins| {
            let failure = failed(&bins);
            (bins, failure)
        })
        .collect()
}

#[test]
fn failures_of_a_corner_are_found_there() {
    let low = diagnostics::concentration(&grid(4, |b| b[1] < 2)).unwrap();
    let side = |parameter, from, to| Side { parameter, from, to };
    let expected = Region {
        sides: vec![side(1, 0, 2)],
        drawn: 200,
        failed: 200,
        p: low.p,
    };
    assert_eq!(low, expected);
    assert!(low.p < 1e-100);
    let corner = diagnostics::concentration(&grid(4, |b| b[0] == 4 && b[2] < 2)).unwrap();
    assert_eq!(corner.sides, [side(0, 4, 5), side(2, 0, 2)]);
    assert_eq!((corner.drawn, corner.failed), (40, 40));
    assert_eq!(diagnostics::concentration(&grid(1, |_| true)), None);
    assert_eq!(diagnostics::concentration(&grid(1, |_| false)), None);
    assert_eq!(diagnostics::concentration(&[]), None);
}

#[test]
fn failures_that_fall_anywhere_concentrate_nowhere() {
    let result = (0..200)
        .filter(|&k| {
            let mut stream = stream(k);
            let mut draws = grid(2, |_| false);
            for (_, failed) in &mut draws {
                *failed = stream.uniform() < 0.3;
            }
            diagnostics::concentration(&draws).unwrap().p < 0.05
        })
        .count();
    assert!(result <= 10, "{result} of 200");
}

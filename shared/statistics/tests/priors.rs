//! Marginals, compared with numerical integration.

use proptest::prelude::*;
use statistics::rng::Stream;
use statistics::{Distribution, Marginal, Prior, PriorError};

fn uniform(lower: f64, upper: f64) -> Distribution {
    Distribution::Uniform { lower, upper }
}

fn loguniform(lower: f64, upper: f64) -> Distribution {
    Distribution::Loguniform { lower, upper }
}

fn lognormal(median: f64, factor: f64) -> Distribution {
    Distribution::Lognormal { median, factor }
}

fn cases() -> Vec<Marginal> {
    let normal = Distribution::Normal { mean: 1.1, sd: 0.2 };
    let lognormal = lognormal(0.008, 2.5);
    let half = Distribution::HalfNormal { scale: 0.3 };
    [
        (uniform(4.0, 5.6), None),
        (uniform(4.0, 5.6), Some([4.5, 5.0])),
        (loguniform(1e-3, 2.0), None),
        (loguniform(1e-3, 2.0), Some([1e-2, 0.5])),
        (normal, None),
        (normal, Some([0.8, 2.0])),
        (normal, Some([1.8, 2.5])),
        (normal, Some([-1.0, 0.5])),
        (normal, Some([0.8, f64::INFINITY])),
        (lognormal, Some([0.0, 0.03])),
        (lognormal, None),
        (lognormal, Some([0.004, 0.03])),
        (half, None),
        (half, Some([0.1, 0.7])),
    ]
    .map(|(distribution, bounds)| Marginal::new(distribution, bounds).unwrap())
    .to_vec()
}

/// Integral of f(x) p(x) by the midpoint rule in ln x for positive supports, in x otherwise; powers 0 to 2 give the moments
/// about `centre`.
fn moment(marginal: &Marginal, power: i32, centre: f64) -> f64 {
    const POINTS: u32 = 200_000;
    let (low, high) = match marginal.support() {
        support if support.1.is_finite() => support,
        _ => (marginal.quantile(1e-13), marginal.quantile(1.0 - 1e-13)),
    };
    let log = low > 0.0;
    let (from, to) = if log { (low.ln(), high.ln()) } else { (low, high) };
    let step = (to - from) / f64::from(POINTS);
    (0..POINTS)
        .map(|i| {
            let u = from + step * (f64::from(i) + 0.5);
            let (x, jacobian) = if log { (u.exp(), u.exp()) } else { (u, 1.0) };
            (x - centre).powi(power) * marginal.log_density(x).exp() * jacobian * step
        })
        .sum()
}

#[test]
fn densities_integrate_to_one_and_have_the_stated_moments() {
    for marginal in cases() {
        let mass = moment(&marginal, 0, 0.0);
        assert!((mass - 1.0).abs() < 1e-7, "{marginal:?}: mass {mass}");
        let mean = moment(&marginal, 1, 0.0);
        assert!(
            (mean / marginal.mean() - 1.0).abs() < 1e-6,
            "{marginal:?}: {mean}"
        );
        let sd = moment(&marginal, 2, mean).sqrt();
        assert!((sd / marginal.sd() - 1.0).abs() < 1e-6, "{marginal:?}: sd {sd}");
    }
}

#[test]
fn closed_forms() {
    let moments = |distribution| {
        let marginal = Marginal::new(distribution, None).unwrap();
        (marginal.mean(), marginal.sd())
    };
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
    let (mean, sd) = moments(uniform(1.0, 4.0));
    close(mean, 2.5);
    close(sd, 3.0 / 12.0_f64.sqrt());
    // s = ln 2.5: mean = m exp(s^2/2), sd = mean sqrt(exp(s^2) - 1).
    let (mean, sd) = moments(lognormal(0.008, 2.5));
    let variance = 2.5_f64.ln().powi(2);
    close(mean, 0.008 * (variance / 2.0).exp());
    close(sd, mean * (variance.exp() - 1.0).sqrt());
    let (mean, sd) = moments(Distribution::HalfNormal { scale: 2.0 });
    close(mean, 2.0 * (2.0 / std::f64::consts::PI).sqrt());
    close(sd, 2.0 * (1.0 - 2.0 / std::f64::consts::PI).sqrt());
    // (b - a) / ln(b / a).
    let (mean, _) = moments(loguniform(0.01, 1.0));
    close(mean, 0.99 / 100.0_f64.ln());
}

#[test]
fn draws_follow_the_density() {
    for marginal in cases() {
        let draw = |i| marginal.sample(&mut Stream::new(3, 0, i, 0));
        let draws: Vec<f64> = (0..4000).map(draw).collect();
        let (low, high) = marginal.support();
        assert!(draws.iter().all(|&x| low <= x && x <= high));
        let (mean, sd) = mean_and_sd(&draws);
        let error = (mean - marginal.mean()) / marginal.sd() * 4000.0_f64.sqrt();
        assert!(error.abs() < 4.0, "{marginal:?}: {error} standard errors");
        assert!((sd / marginal.sd() - 1.0).abs() < 0.3, "{marginal:?}: {sd}");
    }
}

#[test]
fn outside_the_support_the_density_is_zero() {
    for marginal in cases() {
        let (low, high) = marginal.support();
        assert!(marginal.log_density(low - 1e-3).is_infinite());
        assert!(marginal.log_density(high + 1e-3).is_infinite() || high.is_infinite());
        assert!(marginal.log_density(f64::NAN).is_infinite());
        assert!(marginal.log_density(marginal.quantile(0.3)).is_finite());
    }
    let prior = Prior::new(cases());
    assert!(prior.log_density(&[1.0]).is_infinite(), "wrong length");
}

#[test]
fn errors_name_value_and_bound() {
    let refuse = |distribution, bounds| Marginal::new(distribution, bounds).unwrap_err().to_string();
    let normal = Distribution::Normal { mean: 0.0, sd: 1.0 };
    let (certain, negative) = (
        Distribution::Normal { mean: 0.0, sd: 0.0 },
        Distribution::HalfNormal { scale: -1.0 },
    );
    for (distribution, bounds, message) in [
        (certain, None, "sd 0 is not above 0"),
        (lognormal(1.0, 1.0), None, "factor 1 is not above 1"),
        (negative, None, "scale -1 is not above 0"),
        (
            normal,
            Some([2.0, 1.0]),
            "lower bound 2 is not below upper bound 1",
        ),
        (
            normal,
            Some([f64::NAN, 1.0]),
            "lower bound NaN is not below upper bound 1",
        ),
        (normal, Some([60.0, 61.0]), "bounds [60, 61] hold no probability"),
        (
            uniform(0.0, 1.0),
            Some([0.5, 1.5]),
            "bounds [0.5, 1.5] reach outside the support [0, 1]",
        ),
        (loguniform(0.0, 1.0), None, "lower 0 is not above 0"),
    ] {
        assert_eq!(refuse(distribution, bounds), message);
    }
    let infinite = Marginal::new(uniform(0.0, f64::INFINITY), None);
    assert!(matches!(
        infinite,
        Err(PriorError::NotFinite { name: "upper", .. })
    ));
}

#[test]
fn nearness_to_a_bound_is_judged_in_the_sampling_coordinate() {
    let marginal = Marginal::new(loguniform(1e-3, 10.0), None).unwrap();
    // 0.01 is one of four decades above the lower end, although within 2 % of the linear range.
    assert!(!marginal.at_bound(0.01, 0.1));
    assert!(marginal.at_bound(0.001_1, 0.1));
}

proptest! {
    #[test]
    fn quantiles_rise_and_stay_inside(mean in -5.0..5.0_f64, sd in 0.01..10.0_f64, low in -20.0..20.0_f64,
                                      width in 0.1..20.0_f64, p in 0.0..1.0_f64, q in 0.0..1.0_f64) {
        if let Ok(marginal) = Marginal::new(Distribution::Normal { mean, sd }, Some([low, low + width])) {
            let (p, q) = (p.min(q), p.max(q));
            let (a, b) = (marginal.quantile(p), marginal.quantile(q));
            prop_assert!(low <= a && a <= b && b <= low + width);
            prop_assert!(marginal.sd() > 0.0 && low < marginal.mean() && marginal.mean() < low + width);
        }
    }
}

#[test]
fn scores_are_normal_quantiles() {
    // Phi(1) and Phi(-2.5), from tables.
    for (p, score) in [
        (0.841_344_746_068_543, 1.0),
        (0.006_209_665_325_776, -2.5),
        (0.5, 0.0),
    ] {
        for marginal in cases() {
            let x = marginal.quantile(p);
            assert!((marginal.cumulative(x) - p).abs() < 1e-9, "{marginal:?}");
            assert!((marginal.normal_score(x) - score).abs() < 1e-6, "{marginal:?}");
        }
    }
    let marginal = Marginal::new(uniform(4.0, 5.6), None).unwrap();
    assert!(marginal.normal_score(4.0) < -37.0 && marginal.normal_score(5.6) > 37.0);
    assert!(marginal.cumulative(3.0) <= 0.0 && marginal.cumulative(6.0) >= 1.0);
}

#[test]
fn coordinates_have_the_moments_of_their_draws() {
    for marginal in cases() {
        let count = 20_000;
        let draw = |k: usize| marginal.coordinate(marginal.quantile((k as f64 + 0.5) / count as f64));
        let draws: Vec<f64> = (0..count).map(draw).collect();
        let (mean, sd) = mean_and_sd(&draws);
        let (expected, expected_sd) = marginal.coordinate_moments();
        assert!((mean - expected).abs() < 1e-3 * expected_sd, "{marginal:?}");
        assert!((sd / expected_sd - 1.0).abs() < 2e-3, "{marginal:?}");
    }
}

/// Mean and sd of two parameters that are normal in x and in ln x, their correlation.
const JOINT: ([f64; 2], [f64; 2], f64) = ([3.9, -4.6], [0.02, 0.3], -0.8);

fn joint() -> Prior {
    let ([mean, log_median], [sd, log_factor], rho) = JOINT;
    let marginals = [
        Distribution::Normal { mean, sd },
        uniform(1.0, 3.0),
        lognormal(libm::exp(log_median), libm::exp(log_factor)),
    ];
    let marginals = marginals.map(|d| Marginal::new(d, None).unwrap()).to_vec();
    let joint = Prior::new(marginals).correlated(vec![0, 2], &[vec![1.0, rho], vec![rho, 1.0]]);
    joint.unwrap()
}

/// p(x, y) = exp(-(u^2 - 2 rho u v + v^2) / (2 (1 - rho^2))) / (2 pi s t sqrt(1 - rho^2)) in x and ln y.
#[test]
fn correlated_parameters_have_the_closed_form() {
    let ([m, l], [s, t], rho) = JOINT;
    let prior = joint();
    for (x, y) in [(3.9, 0.01), (3.95, 0.006), (3.86, 0.03)] {
        let (u, v) = ((x - m) / s, (libm::log(y) - l) / t);
        let rest = 1.0 - rho * rho;
        let exponent = (u * u - 2.0 * rho * u * v + v * v) / (2.0 * rest);
        let normal = -exponent - libm::log(std::f64::consts::TAU * s * t * rest.sqrt());
        let expected = normal - libm::log(y) - libm::log(2.0);
        let got = prior.log_density(&[x, 1.5, y]);
        assert!((got - expected).abs() < 1e-10, "{got} {expected}");
    }
    for outside in [[3.9, 0.5, 0.01], [3.9, 1.5, -0.01]] {
        assert!(prior.log_density(&outside) == f64::NEG_INFINITY);
    }
}

/// The prior of x and y, and that of y alone, equal the joint prior integrated over the rest.
#[test]
fn some_parameters_keep_their_correlations() {
    let prior = joint();
    let both = prior.subset(&[0, 2]);
    let point = [3.93, 1.5, 0.007];
    let second = prior.subset(&[1]).log_density(&[1.5]);
    let got = both.log_density(&[3.93, 0.007]) + second;
    assert!((got - prior.log_density(&point)).abs() < 1e-12, "{got}");
    let alone = prior.subset(&[2]);
    assert!(both.is_correlated() && !alone.is_correlated());
    let marginal = prior.marginals()[2].log_density(0.007);
    assert!((alone.log_density(&[0.007]) - marginal).abs() < 1e-12);
}

#[test]
fn draws_of_correlated_parameters_have_their_moments() {
    let ([m, l], [s, t], rho) = JOINT;
    let prior = joint();
    let draw = |k| {
        let d = prior.sample(&mut Stream::new(3, 0, k, 0));
        [
            (d[0] - m) / s,
            (libm::log(d[2]) - l) / t,
            (d[1] - 2.0) * 3.0_f64.sqrt(),
        ]
    };
    let z: Vec<[f64; 3]> = (0..40_000).map(draw).collect();
    let moment = |f: &dyn Fn(&[f64; 3]) -> f64| z.iter().map(f).sum::<f64>() / z.len() as f64;
    // four standard errors of 40 000 draws: 0.02, of squares 0.028
    for (what, got, expected) in [
        ("mean of x", moment(&|z| z[0]), 0.0),
        ("mean of ln y", moment(&|z| z[1]), 0.0),
        ("variance of x", moment(&|z| z[0] * z[0]), 1.0),
        ("variance of ln y", moment(&|z| z[1] * z[1]), 1.0),
        ("correlation", moment(&|z| z[0] * z[1]), rho),
        ("with the third", moment(&|z| z[0] * z[2]), 0.0),
        ("variance of the third", moment(&|z| z[2] * z[2]), 1.0),
    ] {
        assert!((got - expected).abs() < 0.028, "{what}: {got}");
    }
}

#[test]
fn invalid_correlations_are_refused() {
    let normal = |bounds| Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, bounds).unwrap();
    let prior = |second| Prior::new(vec![normal(None), second]);
    let half = vec![vec![1.0, 0.5], vec![0.5, 1.0]];
    assert!(prior(normal(None)).correlated(vec![0, 1], &half).is_ok());
    let truncated = prior(normal(Some([-1.0, 1.0]))).correlated(vec![0, 1], &half);
    assert_eq!(truncated, Err(PriorError::NotNormal { parameter: 1 }));
    for wrong in [
        vec![vec![1.0, 1.0], vec![1.0, 1.0]],
        vec![vec![1.0, 0.5], vec![0.4, 1.0]],
        vec![vec![2.0, 0.5], vec![0.5, 2.0]],
        vec![vec![1.0, f64::NAN], vec![f64::NAN, 1.0]],
        vec![vec![1.0, 0.5]],
    ] {
        let refused = prior(normal(None)).correlated(vec![0, 1], &wrong);
        assert_eq!(refused, Err(PriorError::NotACorrelation), "{wrong:?}");
    }
}

fn mean_and_sd(draws: &[f64]) -> (f64, f64) {
    let count = draws.len() as f64;
    let mean = draws.iter().sum::<f64>() / count;
    let squares: f64 = draws.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (count - 1.0)).sqrt())
}

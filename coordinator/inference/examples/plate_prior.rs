//! Plate tests to priors: a hierarchical fit of Bekker's law, one random strength and one random exponent a test.
//!
//! `cargo run --release -p inference --example plate_prior -- examples/cmu-sand/plates.csv`
//!
//! `ln p = ln p_ref + ln[(1 + kappa b_ref / b) / (1 + kappa)] + (n + v) x + u + e`, `x = ln(z / z_ref)`, with `u ~ N(0, s_u^2)`
//! and `v ~ N(0, s_v^2)` for each test and `e ~ N(0, s_e^2)` for each reading. Tests of one box are prepared anew each time, so
//! pooling their readings would take 200 readings for 200 independent facts. `u` and `v` are integrated in closed form: a test's
//! readings are jointly normal with the covariance `s_e^2 I + s_u^2 1 1' + s_v^2 x x'`.

use std::collections::BTreeMap;

use inference::diagnostics::summary;
use inference::{Sampler, TellProgress, TmcmcSettings};
use statistics::{Distribution, LogLikelihood, Marginal, Prior};

/// Depth and radius at which `p_ref` and `kappa` are defined [m].
const Z_REF: f64 = 0.010;
const B_REF: f64 = 0.030;

const NAMES: [&str; 6] = ["log10_p_ref", "kappa", "n", "s_u", "s_v", "s_e"];

/// A plate test: the plate's radius [m] and its readings as (x, ln p).
struct Test {
    radius_m: f64,
    readings: Vec<(f64, f64)>,
}

fn read(path: &str) -> Result<Vec<Test>, Box<dyn std::error::Error>> {
    let text = std::fs::read_to_string(path)?;
    let mut tests: BTreeMap<String, Test> = BTreeMap::new();
    for line in text.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, radius, sinkage, pressure] = cells[..] else {
            return Err(
                format!("{path}: \"{line}\" is not test,plate_radius_m,sinkage_m,pressure_pa").into(),
            );
        };
        let (radius_m, z, p): (f64, f64, f64) = (radius.parse()?, sinkage.parse()?, pressure.parse()?);
        let test = tests.entry(name.into()).or_insert(Test {
            radius_m,
            readings: Vec::new(),
        });
        test.readings.push((libm::log(z / Z_REF), libm::log(p)));
    }
    Ok(tests.into_values().collect())
}

/// Log-density of a test's readings.
fn log_density(test: &Test, theta: &[f64]) -> f64 {
    let &[log10_p_ref, kappa, n, s_u, s_v, s_e] = theta else {
        return f64::NEG_INFINITY;
    };
    let stiffness = (1.0 + kappa * B_REF / test.radius_m) / (1.0 + kappa);
    if stiffness <= 0.0 {
        return f64::NEG_INFINITY;
    }
    let level = log10_p_ref * std::f64::consts::LN_10 + libm::log(stiffness);
    // Sums over the readings: 1, x, x^2, r, r x, r^2.
    let mut sums = [0.0; 6];
    for &(x, ln_p) in &test.readings {
        let r = ln_p - level - n * x;
        for (sum, term) in sums.iter_mut().zip([1.0, x, x * x, r, r * x, r * r]) {
            *sum += term;
        }
    }
    let [count, sx, sxx, sr, srx, srr] = sums;
    // Woodbury with the 2 x 2 matrix M = D^-1 + B' B / s_e^2, B = [1 x], D = diag(s_u^2, s_v^2).
    let e2 = s_e * s_e;
    let (a, b, c) = (
        1.0 / (s_u * s_u) + count / e2,
        sx / e2,
        1.0 / (s_v * s_v) + sxx / e2,
    );
    let determinant = a * c - b * b;
    let (f, g) = (sr / e2, srx / e2);
    let quadratic = srr / e2 - (c * f * f - 2.0 * b * f * g + a * g * g) / determinant;
    let log_determinant = count * libm::log(e2) + libm::log(s_u * s_u * s_v * s_v) + libm::log(determinant);
    -0.5 * (quadratic + log_determinant + count * libm::log(std::f64::consts::TAU))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: plate_prior plates.csv")?;
    let tests = read(&path)?;
    let uniform = |lower, upper| Marginal::new(Distribution::Uniform { lower, upper }, None);
    let scale = |median| Marginal::new(Distribution::Lognormal { median, factor: 2.0 }, None);
    let prior = Prior::new(vec![
        uniform(3.0, 5.0)?,
        uniform(-0.95, 0.5)?,
        uniform(0.5, 2.5)?,
        scale(0.10)?,
        scale(0.10)?,
        scale(0.05)?,
    ]);
    let mut sampler = Sampler::new(prior, TmcmcSettings::default())?;
    let posterior = loop {
        for proposal in sampler.round().pending().to_vec() {
            let value = tests.iter().map(|t| log_density(t, &proposal.theta)).sum();
            if let TellProgress::Failed(failure) =
                sampler.tell(proposal.particle, LogLikelihood::new(value)?)?
            {
                return Err(failure.into());
            }
        }
        if let Some(posterior) = sampler.posterior() {
            break posterior;
        }
    };
    let readings: usize = tests.iter().map(|t| t.readings.len()).sum();
    println!(
        "{} tests, {readings} readings; equilibrated: {}",
        tests.len(),
        posterior.equilibrated
    );
    println!(
        "{:<12} {:>9} {:>9} {:>9} {:>9}",
        "parameter", "mean", "sd", "5 %", "95 %"
    );
    for (k, name) in NAMES.iter().enumerate() {
        let draws: Vec<f64> = posterior.particles.iter().map(|p| p.theta[k]).collect();
        let s = summary(&draws).ok_or("no draws")?;
        println!(
            "{name:<12} {:>9.4} {:>9.4} {:>9.4} {:>9.4}",
            s.mean, s.sd, s.q05, s.q95
        );
    }
    Ok(())
}

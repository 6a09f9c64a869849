//! Twelve grousers of 9 mm, compared with a three-dimensional prototype on a 4 mm grid.
//!
//! The prototype widens a grouser to a column of its grid, so the grousers are as thick here; its soil unloads at 2e8 Pa/m.

use super::Rows;
use super::row::Bounds;
use crate::scene::{Track, bars, grousered, range};
use scm::spatial::{Shape, SpatialRun};

/// Differences found: 1.8 N, 0.01 N m, 0.9 %. This model ends contacts between nodes, the prototype at whole cells; it is
/// not shown that this causes the 1.8 N.
const BOUNDS: Bounds = [0.025, 0.005, 0.03];

pub(super) fn prototype(slip: f64, flow_fraction: f64, bearing_credit: f64) -> Track {
    let mut track = grousered(slip);
    track.shape = Shape::Rim(bars(12, 0.009, 0.004));
    track.ground.elastic_stiffness_pa_m = 2e8;
    track.ground.flow_fraction = flow_fraction;
    track.ground.bearing_credit = bearing_credit;
    track.for_a_travel_of(0.6, 0.36)
}

/// Returns half of the peak-to-peak swing over the last half of a run.
fn amplitude(history: &[f64]) -> f64 {
    let steady = &history[history.len() / 2..];
    0.5 * range(steady)
}

/// Period of the oscillation `[s]`, from the greatest Fourier amplitude between 3 and 12 s. The peaks of the autocorrelation
/// would follow the grid's ripple instead.
fn period_s(run: &SpatialRun, history: &[f64]) -> f64 {
    let steady = &history[history.len() / 4..];
    let mean = steady.iter().sum::<f64>() / steady.len() as f64;
    let amplitude = |period: f64| {
        let per_step = core::f64::consts::TAU * run.history.step_s / period;
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (i, x) in steady.iter().enumerate() {
            let phase = per_step * i as f64;
            // a Hann window prevents leakage from the ends into the peak
            let weight = 1.0 - (core::f64::consts::TAU * i as f64 / steady.len() as f64).cos();
            cosine += weight * (x - mean) * phase.cos();
            sine += weight * (x - mean) * phase.sin();
        }
        cosine.hypot(sine)
    };
    (300..1200)
        .map(|hundredths| f64::from(hundredths) * 0.01)
        .max_by(|&a, &b| amplitude(a).total_cmp(&amplitude(b)))
        .expect("periods to try")
}

pub(crate) fn add(rows: &mut Rows) {
    let run = prototype(0.2, 0.0, 1.0).roll();
    rows.add_run("s 0.2", 100.0, [37.8, 6.39, 5.17e-3], &run.averages, BOUNDS);
    // slip-sinkage caused by grousers alone
    let steep = prototype(0.6, 0.0, 1.0).averages();
    rows.add("s 0.6", "z [mm]", 9.5, 1e3 * steep.sinkage_m, 0.06 * 9.5);

    // The prototype's oscillation depends on its grid: 13 / 0.96 / 0.83 at 4 mm, these figures at 2 mm, where a grouser is a
    // column of 2 mm.
    let thin = grousered(0.2).for_a_travel_of(0.6, 0.36).roll();
    for (quantity, expected, got) in [
        ("F swing [N]", 9.1, amplitude(&thin.history.drawbar_pull_n)),
        ("T swing [N m]", 0.38, amplitude(&thin.history.torque_n_m)),
        ("z swing [mm]", 0.56, 1e3 * amplitude(&thin.history.sinkage_m)),
    ] {
        rows.add("s 0.2, 2 mm thick", quantity, expected, got, 0.5 * expected);
    }

    // twelve per turn at omega = 0.01 / 0.125 rad/s; sixteen periods resolve 1 %
    let period = core::f64::consts::TAU / 12.0 / (0.01 / 0.125);
    let long = grousered(0.2).for_a_travel_of(0.8, 0.36).roll();
    for (quantity, history) in [
        ("period of F [s]", &long.history.drawbar_pull_n),
        ("period of z [s]", &long.history.sinkage_m),
    ] {
        let (got, half_step) = (period_s(&long, history), 0.5 * long.history.step_s);
        rows.add("s 0.2, 2 mm thick", quantity, period, got, half_step);
    }
}

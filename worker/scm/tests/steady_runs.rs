//! Steady runs of the source paper's wheel: under neighbouring loads, and over random draws of its prior.

use crate::scene::Track;
use crate::support::{Draws, base};

/// Returns the wheel with 12 grousers at slip 0.2.
fn track(wheel_load_n: f64) -> Track {
    let mut track = Track::with_grousers(base(0.2, wheel_load_n, 30.0));
    track.case.condition.sled_speed_m_s = 0.02;
    track
}

/// Loads from 100 N on, 0.02 N apart.
pub(crate) fn neighbours(count: u32) -> Vec<Track> {
    (0..count).map(|i| track(100.0 + 0.02 * f64::from(i))).collect()
}

/// Draws of Table 1's prior, except for the moduli: a pressure at 10 mm over its whole range in
/// `examples/paper/bevameter.toml`, because the stated moduli give ground that hardly yields or does not carry.
pub(crate) fn draws(count: u32) -> Vec<Track> {
    let mut draws = Draws(14);
    let draw = |_| {
        let mut track = track(100.0);
        let case = &mut track.case;
        let n = draws.normal(1.1, 0.2, [0.8, 2.0]);
        (case.soil.k_c, case.soil.k_phi) = scm::bekker_moduli(draws.uniform(3.5, 6.0), 0.0, n);
        case.soil.n = n;
        case.soil.friction_angle_rad = draws.normal(30.0, 5.7, [11.5, 37.3]).to_radians();
        case.wheel.radius_m = draws.uniform(0.125, 0.155);
        track
    };
    (0..count).map(draw).collect()
}

/// Returns the results of runs, each as steps, drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]`.
pub(crate) fn outcomes(tracks: &[Track]) -> Vec<[f64; 4]> {
    let outcome = |track: &Track| {
        let run = track.roll();
        let steps = (run.history.len() - 1) as f64;
        let averages = run.averages;
        [
            steps,
            averages.drawbar_pull_n,
            averages.torque_n_m,
            1e3 * averages.sinkage_m,
        ]
    };
    tracks.iter().map(outcome).collect()
}

pub(crate) fn mean(outcomes: &[[f64; 4]], quantity: usize) -> f64 {
    outcomes.iter().map(|outcome| outcome[quantity]).sum::<f64>() / outcomes.len() as f64
}

/// Returns the standard deviation of a quantity about a straight line over evenly spaced runs.
pub(crate) fn scatter(outcomes: &[[f64; 4]], quantity: usize) -> f64 {
    let count = outcomes.len() as f64;
    let middle = mean(outcomes, quantity);
    let place = |i: usize| i as f64 - 0.5 * (count - 1.0);
    let (mut rise, mut run) = (0.0, 0.0);
    for (i, outcome) in outcomes.iter().enumerate() {
        rise += place(i) * (outcome[quantity] - middle);
        run += place(i) * place(i);
    }
    let slope = rise / run;
    let squares = outcomes
        .iter()
        .enumerate()
        .map(|(i, outcome)| (outcome[quantity] - middle - slope * place(i)).powi(2));
    (squares.sum::<f64>() / (count - 2.0)).sqrt()
}

//! The end of steady runs, and the accuracy of their averages: a slice of `cargo bench -p scm --bench steady`.

use crate::scene::{range, smooth};
use crate::steady_runs::{draws, mean, neighbours, outcomes, scatter};

#[test]
fn neighbours_end_alike_and_have_averages_alike() {
    let near = outcomes(&neighbours(12));
    let steps: Vec<f64> = near.iter().map(|n| n[0]).collect();
    assert!(range(&steps) <= 4.0, "{steps:?}");
    let scatter = [1, 2, 3].map(|quantity| scatter(&near, quantity));
    let bounds = [0.025, 0.002, 0.006]; // N, N m, mm; for twelve runs a fifth more than for forty
    assert!(
        scatter.iter().zip(bounds).all(|(s, bound)| *s < bound),
        "{scatter:?}"
    );
}

#[test]
fn draws_of_the_prior_end_soon_and_have_the_means_of_long_runs() {
    let tracks = draws(8);
    let steady = outcomes(&tracks);
    assert!(mean(&steady, 0) < 400.0, "{steady:?}");
    let long = tracks.into_iter().map(|track| track.for_a_travel_of(1.0, 0.6));
    let long: Vec<_> = long.collect();
    for (steady, long) in steady.iter().zip(outcomes(&long)) {
        // forty runs give 0.13 N, 0.004 N m and 0.05 mm rms, mainly from the grid's ripple in the long means
        let off = [1, 2, 3].map(|quantity| (steady[quantity] - long[quantity]).abs());
        let bounds = [0.5, 0.02, 0.25];
        assert!(off.iter().zip(bounds).all(|(off, bound)| *off < bound), "{off:?}");
    }
}

#[test]
fn lowering_is_forgotten_by_e_2_in_a_contact_length() {
    // means over a column that begins one, two and three contact lengths after the start
    let run = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.4, 0.2).roll();
    let contact = (run.averages.contact_length_m / (0.4 / (run.history.len() - 1) as f64)) as usize;
    let mean = |from: usize| run.history.sinkage_m[from..from + 8].iter().sum::<f64>() / 8.0;
    let settled = run.averages.sinkage_m;
    let off = [0, 1, 2].map(|contacts| (mean(1 + contacts * contact) / settled - 1.0).abs());
    assert!(off[1] < 0.2 * off[0] && off[2] < 0.05 * off[0], "{off:?}");
}

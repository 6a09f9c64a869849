//! Oracle 5: the effect of a finer grid and shorter steps.

use super::Rows;
use super::row::Bounds;
use crate::scene::{Track, grousered, smooth};

/// Bounds against the finest grid: a smooth wheel changes by its ends of contact, grousers by the columns that they shape.
const GRID: Bounds = [0.015, 0.01, 0.03];
/// Soil behind the axle must keep its height for any number of steps: a wheel that dug into it at every step would sink 7 %
/// deeper in 50 times as many steps.
const STEP: Bounds = [0.01, 0.005, 0.03];

fn figures(track: &Track) -> [f64; 3] {
    let got = track.averages();
    [got.drawbar_pull_n, got.torque_n_m, got.sinkage_m]
}

pub(crate) fn add(rows: &mut Rows) {
    for (name, track, finest, shortest) in [
        ("smooth", smooth(0.2, 100.0, 30.0), 1e-3, 1e-5),
        ("grousers", grousered(0.2), 2e-3, 6.25e-5),
    ] {
        let mut track = track.for_a_travel_of(0.3, 0.16);
        let on_grid = |track: &Track, spacing: f64| {
            let mut track = track.clone();
            track.settings.dem_spacing_m = spacing;
            track
        };
        let expected = figures(&on_grid(&track, finest));
        for spacing in [8e-3, 4e-3, 2e-3] {
            if spacing > finest {
                let got = on_grid(&track, spacing).averages();
                let case = format!("{name}, {} mm of {}", 1e3 * spacing, 1e3 * finest);
                rows.add_run(&case, 100.0, expected, &got, GRID);
            }
        }
        track.settings.travel_step_m = shortest;
        let expected = figures(&track);
        for step in [1e-3, 5e-4, 2.5e-4] {
            track.settings.travel_step_m = step;
            let case = format!("{name}, step {} mm of {}", 1e3 * step, 1e3 * shortest);
            rows.add_run(&case, 100.0, expected, &track.averages(), STEP);
        }
    }
}

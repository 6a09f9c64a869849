//! The change of a run by each effect, compared with the signatures of a quasi-static prototype.
//!
//! A smooth wheel in steady motion on soil that does not flow is close to the prototype's. Each row states its differences.

use super::effects::typical;
use crate::scene::smooth;
use scm::spatial::{Protocol, SpatialRun};

/// Slips of the columns; rim speed 10 mm/s, 100 N.
const SLIPS: [f64; 3] = [0.05, 0.2, 0.6];

/// Changes of drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]` below which the sign is not compared.
const SMALL: [f64; 3] = [0.3, 0.03, 0.2];

/// Largest ratio of two figures of the same order of magnitude.
const ORDER: f64 = 3.0;

/// Changes of drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]`, slip by slip.
type Changes = [[f64; 3]; 3];

#[derive(Clone, Copy)]
struct Row {
    effect: &'static str,
    /// Parameters that differ from their typical values.
    values: &'static [(&'static str, f64)],
    /// The prototype's changes.
    changes: Changes,
    /// Changes expected instead, with the reason.
    instead: Option<(Changes, &'static str)>,
}

const fn row(effect: &'static str, changes: Changes) -> Row {
    Row {
        effect,
        values: &[],
        changes,
        instead: None,
    }
}

#[expect(clippy::approx_constant, reason = "a torque of 3.14 N m")]
const ROWS: [Row; 34] = [
    row(
        "janosi_hanamoto",
        [[-27.5, -3.54, 0.1], [-28.5, -3.67, 0.1], [-14.2, -1.83, 0.1]],
    ),
    row(
        "shear_velocity_scale",
        [[-22.6, -2.91, 0.1], [-24.4, -3.14, 0.1], [-10.4, -1.33, 0.0]],
    ),
    row(
        "interface_friction",
        [[-10.3, -1.32, 0.0], [-14.5, -1.87, 0.1], [-15.7, -2.03, 0.1]],
    ),
    row("adhesion", [[1.3, 0.17, 0.0], [1.8, 0.24, 0.0], [2.0, 0.26, 0.0]]),
    row(
        "rate_dependent_pressure",
        [[0.1, 0.0, -0.2], [0.1, 0.0, -0.2], [0.0, 0.0, -0.1]],
    ),
    row(
        "elastic_rebound",
        [[7.1, -0.03, -1.5], [8.7, 0.19, -1.5], [9.1, 0.26, -1.5]],
    ),
    row("multipass_hardening", [[0.0; 3]; 3]),
    row(
        "slip_sinkage",
        [[-0.2, 0.01, 0.3], [-1.2, -0.02, 1.2], [-3.8, -0.08, 4.0]],
    ),
    Row {
        instead: Some((
            [[-0.7, 0.0, 0.6], [-2.8, -0.04, 1.8], [-16.8, -0.34, 10.0]],
            "the prototype only reads more sinkage; a wheel that stands in what it dug has to climb out of it, \
             and soil ahead of it, not dug yet, bears some of the load",
        )),
        ..row(
            "slip_digging",
            [[0.0, 0.0, 0.5], [0.0, 0.0, 2.5], [0.0, 0.0, 15.0]],
        )
    },
    row(
        "bulldozing",
        [[-4.2, 0.0, 0.0], [-4.1, 0.0, 0.0], [-4.1, 0.0, 0.0]],
    ),
    row(
        "lug_thrust",
        [[3.4, 0.46, 0.0], [8.8, 1.19, 0.0], [11.8, 1.58, 0.0]],
    ),
    row(
        "wheel_flexibility",
        [[-0.6, -1.65, -3.5], [10.7, -0.28, -3.4], [14.0, 0.11, -3.4]],
    ),
    row(
        "hard_pan",
        [[0.4, -0.01, -0.3], [0.5, 0.01, -0.3], [0.5, 0.01, -0.3]],
    ),
    row(
        "density_gradient",
        [[0.3, -0.01, -0.3], [0.4, 0.01, -0.3], [0.5, 0.01, -0.3]],
    ),
    row(
        "side_wall_friction",
        [[0.4, 0.05, 0.0], [0.5, 0.07, 0.0], [0.6, 0.08, 0.0]],
    ),
    row("sled_tare", [[-3.0, 0.0, 0.0]; 3]),
    row(
        "sled_drag",
        [[-1.9, 0.0, 0.0], [-1.6, 0.0, 0.0], [-0.8, 0.0, 0.0]],
    ),
    row(
        "drawbar_pull_gain",
        [[1.2, 0.0, 0.0], [1.9, 0.0, 0.0], [2.1, 0.0, 0.0]],
    ),
    row(
        "torque_gain",
        [[0.0, 0.23, 0.0], [0.0, 0.33, 0.0], [0.0, 0.35, 0.0]],
    ),
    row("sinkage_offset", [[0.0, 0.0, 2.0]; 3]),
    row(
        "load_transfer",
        [[-0.7, -0.16, -0.1], [-1.9, -0.35, -0.2], [-2.3, -0.42, -0.2]],
    ),
    row(
        "load_scale",
        [[1.0, 0.23, 0.2], [1.7, 0.32, 0.2], [1.9, 0.35, 0.2]],
    ),
    row("bearing_torque", [[0.0, 0.2, 0.0]; 3]),
    row("bearing_friction", [[0.0, 0.3, 0.0]; 3]),
    row("bin_slope", [[-1.7, 0.0, 0.0]; 3]),
    Row {
        values: &[("front_share_per_slip", 0.0)],
        ..row(
            "peak_pressure_angle",
            [[-1.5, 0.03, 0.5], [-2.0, -0.04, 0.5], [-2.1, -0.05, 0.5]],
        )
    },
    Row {
        values: &[("front_share", 0.0)],
        ..row(
            "peak_pressure_angle",
            [[0.0, 0.0, 0.0], [-0.4, -0.01, 0.1], [-2.9, -0.07, 0.7]],
        )
    },
    row(
        "pressure_distribution_shape",
        [[0.5, 0.0, 0.1], [0.6, 0.01, 0.1], [0.6, 0.02, 0.1]],
    ),
    row(
        "small_diameter",
        [[-0.1, 0.0, 0.2], [-0.2, 0.0, 0.1], [-0.2, 0.0, 0.1]],
    ),
    row(
        "moisture",
        [[3.9, 0.40, -0.7], [5.5, 0.61, -0.7], [5.9, 0.67, -0.7]],
    ),
    row(
        "slip_radius_error",
        [[-6.6, -0.86, 0.0], [-1.2, -0.15, 0.0], [0.0, 0.0, 0.0]],
    ),
    row(
        "stick_slip",
        [[-4.1, -0.53, 0.0], [-5.8, -0.75, 0.0], [-6.3, -0.81, 0.0]],
    ),
    row(
        "edge_loss",
        [[-0.3, 0.01, 0.3], [-0.4, -0.01, 0.3], [-0.4, -0.01, 0.3]],
    ),
    row(
        "friction_rate_weakening",
        [[-2.3, -0.30, 0.0], [-6.0, -0.77, 0.0], [-10.5, -1.35, 0.0]],
    ),
];

/// A wheel of 130 mm at the rig's 125 mm.
fn roll(slip: f64, row: Option<&Row>) -> SpatialRun {
    let mut track = smooth(slip, 100.0, 30.0);
    track.case.wheel.radius_m = 0.130;
    track.site.density_kg_m3 = Some(1400.0);
    (track.site.grouser_count, track.site.grouser_height_m) = (12, 0.009);
    track.settings.protocol = Protocol::Steady {
        tolerance: 0.001,
        most_travel_m: 0.5,
    };
    if let Some(row) = row {
        let effect = formula::catalogue::find(row.effect).expect("in the catalogue");
        let mut values = typical(effect);
        for (name, value) in row.values {
            values[effect.parameter(name).expect("a parameter")] = *value;
        }
        track.enter(effect, &values);
    }
    track.roll()
}

fn channels(run: &SpatialRun) -> [f64; 3] {
    let averages = &run.averages;
    [
        averages.drawbar_pull_n,
        averages.torque_n_m,
        1e3 * averages.sinkage_m,
    ]
}

/// Returns whether a change has the expected sign and order of magnitude, or is small as expected.
fn agrees(expected: f64, got: f64, small: f64) -> bool {
    if expected.abs() <= small {
        got.abs() < ORDER * small
    } else {
        (1.0 / ORDER..=ORDER).contains(&(got / expected))
    }
}

#[test]
fn every_effect_has_the_expected_changes() {
    let base = SLIPS.map(|slip| channels(&roll(slip, None)));
    let mut failed = 0;
    for row in &ROWS {
        let mut verdict = "pass";
        let mut shown = String::new();
        let (expected, why) = row.instead.unwrap_or((row.changes, ""));
        for (column, slip) in SLIPS.into_iter().enumerate() {
            let got = channels(&roll(slip, Some(row)));
            // a small effect must not be absent; the first pass is not hardened
            let idle = (0..3).all(|i| got[i].to_bits() == base[column][i].to_bits());
            if idle && row.effect != "multipass_hardening" {
                verdict = "FAIL";
            }
            for i in 0..3 {
                let change = got[i] - base[column][i];
                if !agrees(expected[column][i], change, SMALL[i]) {
                    verdict = "FAIL";
                }
                let separator = if i == 0 { " | " } else { " / " };
                shown += &format!("{separator}{change:+.2} ({:+.2})", row.changes[column][i]);
            }
        }
        failed += usize::from(verdict == "FAIL");
        println!("{:28}{shown} | {verdict} {why}", row.effect);
    }
    assert_eq!(failed, 0, "rows above");
}

//! The change of a run by each effect, compared with the signatures of a quasi-static prototype.
//!
//! A smooth wheel in steady motion on soil that does not flow is close to the prototype's.

use super::effects::typical;
use crate::scene::smooth;
use formula::Effect;

/// Slips of the columns; rim speed 10 mm/s, 100 N.
const SLIPS: [f64; 3] = [0.05, 0.2, 0.6];

/// Changes of drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]` below which the sign is not compared.
const SMALL: [f64; 3] = [0.3, 0.03, 0.2];

/// Largest ratio of two figures of the same order of magnitude.
const ORDER: f64 = 3.0;

/// Changes of drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]`, slip by slip.
type Changes = [[f64; 3]; 3];

/// Returns the effect of each row, the parameter that it holds at 0, and the prototype's changes.
fn rows() -> Vec<(&'static Effect, &'static str, Changes)> {
    let lines = include_str!("../reference/spatial_signatures.csv").lines();
    let row = |line: &'static str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[2 + i].parse::<f64>().expect("a number");
        let changes = [0, 1, 2].map(|slip| [0, 1, 2].map(|channel| number(3 * slip + channel)));
        (
            formula::catalogue::find(fields[0]).expect("in the catalogue"),
            fields[1],
            changes,
        )
    };
    lines
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(row)
        .collect()
}

/// The changes by slip digging in place of the prototype's: the prototype only reads more sinkage; a wheel that stands in
/// what it dug has to climb out of it, and soil ahead of it, not dug yet, bears some of the load.
const DIGGING: Changes = [[-0.7, 0.0, 0.6], [-2.8, -0.04, 1.8], [-16.8, -0.34, 10.0]];

/// Returns drawbar pull `[N]`, torque \[N m\] and sinkage `[mm]` of a wheel of 130 mm at the rig's 125 mm.
fn roll(slip: f64, effect: Option<(&Effect, &[f64])>) -> [f64; 3] {
    let mut track = smooth(slip, 100.0, 30.0);
    track.case.wheel.radius_m = 0.130;
    track.site.density_kg_m3 = Some(1400.0);
    (track.site.grouser_count, track.site.grouser_height_m) = (12, 0.009);
    track.end_steady(0.001, 0.5);
    if let Some((effect, values)) = effect {
        track.enter(effect, values);
    }
    let got = track.averages();
    [got.drawbar_pull_n, got.torque_n_m, 1e3 * got.sinkage_m]
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
    let base = SLIPS.map(|slip| roll(slip, None));
    let (rows, mut failed) = (rows(), 0);
    assert_eq!(rows.len(), 34);
    for (effect, held, prototype) in rows {
        let mut verdict = "pass";
        let mut shown = String::new();
        let expected = if effect.name == "slip_digging" {
            DIGGING
        } else {
            prototype
        };
        let mut values = typical(effect);
        if !held.is_empty() {
            values[effect.parameter(held).expect("a parameter")] = 0.0;
        }
        for (column, slip) in SLIPS.into_iter().enumerate() {
            let got = roll(slip, Some((effect, values.as_slice())));
            // a small effect must not be absent; the first pass is not hardened
            let idle = (0..3).all(|i| got[i].to_bits() == base[column][i].to_bits());
            if idle && effect.name != "multipass_hardening" {
                verdict = "FAIL";
            }
            for i in 0..3 {
                let change = got[i] - base[column][i];
                if !agrees(expected[column][i], change, SMALL[i]) {
                    verdict = "FAIL";
                }
                let separator = if i == 0 { " | " } else { " / " };
                shown += &format!("{separator}{change:+.2} ({:+.2})", prototype[column][i]);
            }
        }
        failed += usize::from(verdict == "FAIL");
        println!("{:28}{shown} | {verdict}", effect.name);
    }
    assert_eq!(failed, 0, "rows above");
}

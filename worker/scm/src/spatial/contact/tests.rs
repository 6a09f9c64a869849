//! A flat plate pressed onto flat soil: what a contact gives where everything is known.

use super::*;
use crate::Soil;
use crate::spatial::fixture::{CONDITION, SOIL, WHEEL};

const SPACING: f64 = 0.004;
/// Strips in contact, between two guards.
const STRIPS: usize = 10;
const WIDTH: f64 = WHEEL.width_m;
const LENGTH: f64 = STRIPS as f64 * SPACING;
const DEPTH: f64 = 0.006;
const RISE: f64 = 0.1;

/// A flat underside, 40 mm by 112 mm.
fn flat() -> Envelope {
    let strips = (0..STRIPS + 2).map(|i| {
        let middle = (i as f64 - 5.5) * SPACING;
        Strip {
            column: i + 4,
            rear: middle - 0.5 * SPACING,
            middle,
            front: middle + 0.5 * SPACING,
            ahead: middle,
            rise: RISE,
            slope: 0.0,
            holds_node: true,
            smooth: false,
        }
    });
    Envelope {
        strips: strips.collect(),
        facets: Vec::new(),
    }
}

/// The flat underside pressed 6 mm into soil: its load, and the contact.
fn pressed(soil: &Soil, mirrored: bool) -> (f64, Contact, Terrain) {
    let first_y = if mirrored { 0.5 * SPACING } else { -19.5 * SPACING };
    let terrain = Terrain::new(SPACING, SPACING, first_y, 24, 40, mirrored);
    let laws = Laws::new(soil, 1e12, 0.0);
    let mut contact = Contact::default();
    contact.across.lay(&terrain, 0.0, WIDTH);
    contact.prepare(&terrain, &flat(), &laws, &Motion::new(&WHEEL, &CONDITION), false);
    let load = contact.press(&terrain, &laws, RISE - DEPTH);
    (load, contact, terrain)
}

fn soil(gamma_exponent: f64, k_c: f64) -> Soil {
    Soil {
        k_c,
        friction_angle_rad: 0.0,
        shear_velocity_m_s: 0.0,
        gamma_exponent,
        ..SOIL
    }
}

#[test]
fn a_flat_contact_carries_its_area_times_bekkers_pressure_whatever_the_distribution() {
    for gamma_exponent in [0.0, 0.5, 0.8, 1.0] {
        for k_c in [0.0, 2e5, -1e5] {
            for mirrored in [false, true] {
                let (load, mut contact, terrain) = pressed(&soil(gamma_exponent, k_c), mirrored);
                // b_eff = l b / (l + b) of a rectangle
                let k_star = 1e7 + k_c * (LENGTH + WIDTH) / (LENGTH * WIDTH);
                let expected = LENGTH * WIDTH * k_star * libm::pow(DEPTH, 1.1);
                assert!(
                    (load / expected - 1.0).abs() < 1e-12,
                    "m {gamma_exponent} k_c {k_c} mirrored {mirrored}: {load} of {expected}"
                );
                let width = contact.effective_width(&terrain);
                assert!((width / (LENGTH * WIDTH / (LENGTH + WIDTH)) - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn pressure_grows_from_the_border_with_the_power_of_the_distance() {
    let (_, contact, _) = pressed(&soil(0.5, 0.0), false);
    let at = |row: usize, lane: usize| contact.quad(row, lane).pressure.to_array()[lane % PACK];
    let lanes = contact.across.lanes;
    // half a cell, one and a half, two and a half from the rear end; the sides are far
    for (row, cells) in [(1, 0.5), (2, 1.5), (3, 2.5), (5, 4.5)] {
        let expected = (cells / 4.5_f64).sqrt();
        let got = at(row, lanes / 2) / at(5, lanes / 2);
        assert!((got / expected - 1.0).abs() < 1e-12, "{cells} cells: {got}");
    }
    // a corner lies as far from the end as from the side
    assert!((at(1, 0) / at(1, lanes / 2) - 1.0).abs() < 1e-12);
    assert!((at(5, 0) / at(1, lanes / 2) - 1.0).abs() < 1e-12);
}

#[test]
fn the_force_is_the_load_upwards_and_turns_nothing_under_the_middle() {
    let (load, mut contact, terrain) = pressed(&soil(0.5, 0.0), true);
    let laws = Laws::new(&soil(0.5, 0.0), 1e12, 0.0);
    let reaction = contact.react(&terrain, &laws, None);
    assert!((reaction.force_z / load - 1.0).abs() < 1e-12);
    assert!(reaction.force_x.abs() < 1e-12 * load && reaction.torque.abs() < 1e-12 * load);
    assert!((reaction.area / (LENGTH * WIDTH) - 1.0).abs() < 1e-12);
}

#[test]
fn distances_from_a_border_at_an_angle_are_euclidean() {
    // every fourth lane the contact begins a strip further ahead
    let begins = |lane: usize| 1 + lane / 4;
    let (_, mut contact, mut terrain) = pressed(&soil(0.5, 0.0), false);
    // with the exponent 1 the shape is the distance
    let laws = Laws::new(&soil(1.0, 0.0), 1e12, 0.0);
    let (first, lanes) = (contact.across.first_lane, contact.across.lanes);
    for lane in 0..lanes {
        for row in 0..begins(lane) {
            terrain.surface[(row + 4) * terrain.lanes + first + lane] = -0.05;
        }
    }
    contact.prepare(&terrain, &flat(), &laws, &Motion::new(&WHEEL, &CONDITION), false);
    contact.press(&terrain, &laws, RISE - DEPTH);
    let mut nodes = 0;
    for row in 1..=STRIPS {
        for lane in (0..lanes).filter(|&lane| begins(lane) <= row) {
            let mut square = f64::MAX;
            for other in (0..lanes).filter(|&other| begins(other) <= row) {
                let cells = (row - begins(other)).min(STRIPS - row) as f64 + 0.5;
                let aside = other.abs_diff(lane) as f64;
                square = square.min(cells * cells + aside * aside);
            }
            // the side of the wheel, and where the strip's contact ends at greater y
            let last = (0..lanes)
                .rfind(|&other| begins(other) <= row)
                .expect("this lane");
            let side = lane.min(last - lane) as f64 + 0.5;
            let expected = SPACING * side.min(square.sqrt());
            let got = contact.quad(row, lane).shape.to_array()[lane % PACK];
            assert!(
                (got / expected - 1.0).abs() < 1e-12,
                "{row} {lane}: {got} {expected}"
            );
            nodes += 1;
        }
    }
    assert_eq!(nodes, contact.masks.iter().map(|m| m.count_ones()).sum::<u32>());
}

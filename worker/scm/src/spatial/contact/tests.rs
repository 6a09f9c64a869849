//! A flat plate pressed onto flat soil: a contact with known results.

use super::*;
use crate::Soil;
use crate::fixture::{CONDITION, SOIL, WHEEL};

const SPACING: f64 = 0.004;
/// Number of strips in contact, between two guards.
const STRIPS: usize = 10;
const WIDTH: f64 = WHEEL.width_m;
const LENGTH: f64 = STRIPS as f64 * SPACING;
const DEPTH: f64 = 0.006;
const RISE: f64 = 0.1;

/// Returns a flat underside, 40 mm by 112 mm.
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

/// Returns the flat underside pressed 6 mm into soil: its load, and the contact.
fn pressed(soil: &Soil, mirrored: bool) -> (f64, Contact, Terrain) {
    pressed_into(level(mirrored), soil, Footprint::Hull)
}

fn level(mirrored: bool) -> Terrain {
    let first_y = if mirrored { 0.5 * SPACING } else { -19.5 * SPACING };
    Terrain::new(SPACING, SPACING, first_y, 24, 40, mirrored)
}

fn pressed_into(terrain: Terrain, soil: &Soil, footprint: Footprint) -> (f64, Contact, Terrain) {
    let laws = Laws::new(soil, 1e12, 0.0);
    let mut contact = Contact::new(footprint);
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
fn a_flat_contact_carries_its_area_times_bekkers_pressure_with_any_distribution() {
    for gamma_exponent in [0.0, 0.5, 0.8, 1.0] {
        for k_c in [0.0, 2e5, -1e5] {
            let footprints = [Footprint::Hull, Footprint::Patches];
            for (footprint, mirrored) in footprints.into_iter().flat_map(|f| [(f, false), (f, true)]) {
                let soil = soil(gamma_exponent, k_c);
                let (load, mut contact, terrain) = pressed_into(level(mirrored), &soil, footprint);
                // b_eff = l b / (l + b) of a rectangle
                let k_star = 1e7 + k_c * (LENGTH + WIDTH) / (LENGTH * WIDTH);
                let expected = LENGTH * WIDTH * k_star * libm::pow(DEPTH, 1.1);
                let ratio = load / expected;
                assert!(
                    (ratio - 1.0).abs() < 1e-12,
                    "{soil:?} {footprint:?} {mirrored}: {ratio}"
                );
                let width = contact.effective_width(&terrain, &Laws::new(&soil, 1e12, 0.0));
                assert!((width / (LENGTH * WIDTH / (LENGTH + WIDTH)) - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// Presses the wheel onto flat soil with a ditch under three of its strips; returns the effective width of the contact.
fn over_a_ditch(footprint: Footprint, depth_beyond: f64) -> f64 {
    let mut terrain = level(false);
    let lanes = terrain.lanes;
    // strips 1 to 4 are in contact, 5 to 7 are not, 8 to 10 are at the given depth
    terrain.surface[9 * lanes..12 * lanes].fill(-0.05);
    terrain.surface[12 * lanes..].fill(depth_beyond - DEPTH);
    terrain.loose[12 * lanes..].fill(depth_beyond - DEPTH);
    let mut laws = Laws::new(&soil(0.5, -1e5), 1e12, 0.0);
    laws.bearing_credit = 1.0;
    let mut contact = Contact::new(footprint);
    contact.across.lay(&terrain, 0.0, WIDTH);
    contact.prepare(&terrain, &flat(), &laws, &Motion::new(&WHEEL, &CONDITION), false);
    contact.press(&terrain, &laws, RISE - DEPTH);
    assert_eq!(contact.patches.patches.len(), 2);
    contact.effective_width(&terrain, &laws)
}

#[test]
fn the_hull_spans_the_gap_between_patches_as_far_as_both_bear() {
    let rectangle = |strips: f64| {
        let length = strips * SPACING;
        length * WIDTH / (length + WIDTH)
    };
    let near = |got: f64, expected: f64| assert!((got / expected - 1.0).abs() < 1e-10, "{got} {expected}");
    let depth_at = |share: f64| DEPTH * libm::pow(share, 1.0 / 1.1);
    near(over_a_ditch(Footprint::Hull, DEPTH), rectangle(10.0));
    // The mean over the patches, of 4 and 3 strips, is weighted by area.
    let by_patch = (4.0 * rectangle(4.0) + 3.0 * rectangle(3.0)) / 7.0;
    near(over_a_ditch(Footprint::Patches, DEPTH), by_patch);
    // with 1/20 of the largest pressure a patch counts in full
    near(over_a_ditch(Footprint::Hull, depth_at(0.051)), rectangle(10.0));
    let half = over_a_ditch(Footprint::Hull, depth_at(0.025));
    near(half, rectangle(4.0 + 0.5 * 6.0));
    let touching = over_a_ditch(Footprint::Hull, 1e-9);
    assert!((touching / rectangle(4.0) - 1.0).abs() < 1e-4, "{touching}");
}

#[test]
fn pressure_grows_from_the_border_with_the_power_of_the_distance() {
    let (_, contact, _) = pressed(&soil(0.5, 0.0), false);
    let at = |row: usize, lane: usize| contact.quad(row, lane).pressure.to_array()[lane % PACK];
    let lanes = contact.across.lanes;
    // The nodes are 0.5, 1.5, 2.5 and 4.5 cells from the rear end; the sides are farther away.
    for (row, cells) in [(1, 0.5), (2, 1.5), (3, 2.5), (5, 4.5)] {
        let expected = (cells / 4.5_f64).sqrt();
        let got = at(row, lanes / 2) / at(5, lanes / 2);
        assert!((got / expected - 1.0).abs() < 1e-12, "{cells} cells: {got}");
    }
    // a corner is as far from the end as from the side
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
    // the contact begins one strip further ahead every fourth lane
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
            // The border is the side of the wheel, or the end of the strip's contact at larger y.
            let last = (0..lanes)
                .rfind(|&other| begins(other) <= row)
                .expect("this lane");
            let side = lane.min(last - lane) as f64 + 0.5;
            let expected = SPACING * side.min(square.sqrt());
            let got = contact.quad(row, lane).shape.to_array()[lane % PACK];
            assert!((got / expected - 1.0).abs() < 1e-12, "{row} {lane}: {got}");
            nodes += 1;
        }
    }
    assert_eq!(nodes, contact.masks.iter().map(|m| m.count_ones()).sum::<u32>());
}

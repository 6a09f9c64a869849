//! Rankine's passive force on the buried segment of a wheel's side, without a heap beside it.
//!
//! `|sin b| N g/2 int (sqrt(R^2 - x^2) - H)^2 dx` over the chord, N = tan^2(45 deg + phi/2), g the soil's unit weight, H the height of the hub.

use super::Rows;
use crate::scene::{Track, smooth};

/// Adds the effect with a strength and a friction.
pub(crate) fn entered(mut track: Track, scale: f64, friction: f64) -> Track {
    track.enter_named("buried_side_wall", &[scale, friction]);
    track
}

/// Returns the lateral force of cohesionless soil on a frictionless side at a sinkage `[m]` `[N]`.
pub(crate) fn closed_form(track: &Track, sinkage_m: f64) -> f64 {
    let r = track.case.wheel.radius_m;
    let hub = r - sinkage_m;
    let half = (r * r - hub * hub).sqrt();
    let segment = r * r * (half / r).asin() + half * hub;
    let squares = 2.0 * (r * r * half - half.powi(3) / 3.0) - 2.0 * hub * segment + 2.0 * hub * hub * half;
    let half_angle = 0.25 * core::f64::consts::PI + 0.5 * track.case.soil.friction_angle_rad;
    let rankine = half_angle.tan().powi(2);
    let unit_weight = track.site.density_kg_m3.expect("a density") * track.site.gravity_m_s2;
    let across = track.case.condition.slip_angle_rad.sin();
    across * rankine * 0.5 * unit_weight * squares
}

pub(crate) fn add(rows: &mut Rows) {
    for (case, slip_angle_deg, k_phi) in [
        ("15 deg", 15.0_f64, 1e7),
        ("45 deg", 45.0, 1e7),
        ("15 deg, soft", 15.0, 1.5e6),
        ("-15 deg, soft", -15.0, 1.5e6),
    ] {
        let mut track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.3, 0.15);
        track.case.soil.k_phi = k_phi;
        track.case.condition.slip_angle_rad = slip_angle_deg.to_radians();
        track.site.density_kg_m3 = Some(1500.0);
        let base = track.averages();
        let expected = closed_form(&track, base.sinkage_m);
        let with = entered(track, 1.0, 0.0).averages();
        let got = with.lateral_force_n - base.lateral_force_n;
        rows.add(case, "lateral [N]", expected, got, 0.02 * expected.abs());
    }
}

//! The crossing of load and carried load: the first of several balances that a sinking wheel meets.
//!
//! A driving rim presses harder the deeper it is, so there is one balance. In skid the shear stress pulls the rim down where
//! it slopes, and the carried load may rise, fall and rise again with depth.

use super::footing::Footing;
use super::rim::Rim;
use crate::Rejection;

/// Number of samples of a scan, evenly spaced in the root of the sinkage (nearly so in `theta_1`).
const SAMPLES: u32 = 64;
/// Number of steps of the search for a peak between samples: each shrinks the bracket to 0.618 of its width.
const PEAK_STEPS: u32 = 40;

/// Returns whether bounds on the terms prove that the carried load rises with depth up to this contact length wherever it is
/// positive.
///
/// At a fraction u of the contact the pressure's share of the load has a slope in ln l of at least
/// `s = 2n − m/2`, and 1 more from `k* l` unless `k_c` > 0: 2n from the sinkage, less `m/2` from the changing shape of
/// gamma. Friction pulls down by at most `q = tan φ tan θ` of the pressure, whose slope is at most `q sec² θ_1`: if skid
/// mobilises less of it at greater depth, or it pushes up, the load rises faster. Over the contact the average of q is at
/// most half of its front value, because gamma is symmetric, the pressure otherwise falls towards the front, and tan θ is
/// convex. So the load rises if `q_1 ≤ 1` and `s > ½ q_1 sec² θ_1 / (1 − ½ q_1)`. Cohesion pulls down with a slope of at
/// most `1 + sec² θ_1`, and must grow more slowly than the rest. False means "not known". Effects on pressure and shear are
/// ignored: with a law whose pressure falls with depth, the balance found may not be the first.
pub(super) fn rises_up_to(rim: &Rim, contact_length: f64) -> bool {
    let soil = &rim.soil;
    let pressure_slope = 2.0 * soil.n - 0.5 * soil.gamma_exponent + if soil.k_c > 0.0 { 0.0 } else { 1.0 };
    if rim.motion.drives_everywhere() {
        return pressure_slope > 0.0;
    }
    // The bound below assumes that the pressure acts on average no farther ahead than half the contact.
    if rim.peaked.is_some() {
        return false;
    }
    let cos_squared = (1.0 - contact_length / rim.radius) * (1.0 + contact_length / rim.radius);
    let secant_squared = 1.0 / cos_squared;
    let at_front = rim.tan_friction_angle * contact_length / (rim.radius * cos_squared.sqrt());
    let on_average = 0.5 * at_front;
    let slope = pressure_slope - on_average * secant_squared / (1.0 - on_average);
    let cohesion_slope = if soil.cohesion_pa > 0.0 {
        1.0 + secant_squared
    } else {
        0.0
    };
    at_front <= 1.0 && slope > cohesion_slope
}

/// Result of a scan from the surface down.
pub(super) enum Scan {
    /// The carried load first exceeds the wheel load between these contact lengths.
    Between(f64, f64),
    /// The load is never carried; the largest load carried `[N]`.
    Never(f64),
}

/// Searches the first crossing by sampling down to z = R, from the last sample up to which the load certainly rises.
pub(super) fn scan(footing: &mut Footing, load: f64) -> Result<Scan, Rejection> {
    let radius = footing.rim.radius;
    let length = |sample: u32| {
        let root = f64::from(sample) / f64::from(SAMPLES);
        radius * root * (2.0 - root * root).sqrt()
    };
    let rising = (1..=SAMPLES)
        .take_while(|sample| rises_up_to(&footing.rim, length(*sample)))
        .count() as u32;
    let (mut before, mut last) = ((0.0, 0.0), (0.0, 0.0)); // contact length, load carried
    let mut max_load: f64 = 0.0;
    for length in (rising.max(1)..=SAMPLES).map(length) {
        let current = (length, footing.react(length)?.load());
        if current.1 >= load {
            return Ok(Scan::Between(last.0, length));
        }
        if last.1 > before.1 && last.1 > current.1 {
            let peak = peak_between(footing, before.0, current.0, load)?;
            if peak.1 >= load {
                return Ok(Scan::Between(before.0, peak.0));
            }
            max_load = max_load.max(peak.1);
        }
        max_load = max_load.max(current.1);
        (before, last) = (last, current);
    }
    Ok(Scan::Never(max_load))
}

/// Finds the contact length and height of the peak between two lengths by golden sections; it ends early above `enough`.
fn peak_between(
    footing: &mut Footing,
    mut left: f64,
    mut right: f64,
    enough: f64,
) -> Result<(f64, f64), Rejection> {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let mut at = |length: f64| footing.react(length).map(|reaction| (length, reaction.load()));
    let mut low = at(right - GOLDEN * (right - left))?;
    let mut high = at(left + GOLDEN * (right - left))?;
    for _ in 0..PEAK_STEPS {
        if low.1 >= enough || high.1 >= enough {
            break;
        }
        if low.1 > high.1 {
            right = high.0;
            high = low;
            low = at(right - GOLDEN * (right - left))?;
        } else {
            left = low.0;
            low = high;
            high = at(left + GOLDEN * (right - left))?;
        }
    }
    // The nearer point comes first, because a second crossing lies beyond a peak that is high enough.
    Ok(if low.1 >= enough || low.1 > high.1 {
        low
    } else {
        high
    })
}

#[cfg(test)]
mod tests {
    use super::super::balance::first_balance;
    use super::*;
    use crate::fixture::{CONDITION, Draws, SOIL};
    use crate::{Condition, Soil, Wheel};

    /// Draws skid from locked to slight, soft to hard soil with and without `k_c`, small wheels and large.
    fn skidding(uniform: &mut impl FnMut(f64, f64) -> f64) -> (Footing<'static, 'static>, f64) {
        let n = uniform(0.3, 1.8);
        let (k_c, k_phi) = crate::bekker_moduli(uniform(3.0, 5.0), uniform(-0.9, 0.9), n);
        let soil = Soil {
            k_c,
            k_phi,
            n,
            cohesion_pa: (uniform(-1_000.0, 500.0)).max(0.0),
            friction_angle_rad: uniform(15.0, 50.0).to_radians(),
            ..SOIL
        };
        let radius_m = uniform(0.05, 0.15);
        let wheel = Wheel {
            radius_m,
            width_m: 0.9 * radius_m,
            rig_radius_m: radius_m,
        };
        let wheel_load_n = uniform(10.0, 300.0) * (radius_m / 0.125).powi(2);
        let condition = Condition {
            slip: uniform(-1.0, 0.0),
            wheel_load_n,
            ..CONDITION
        };
        let rim = Rim::new(&soil, &wheel, &condition);
        (Footing { rim, reshaping: None }, wheel_load_n)
    }

    #[test]
    fn the_balance_is_the_first_that_a_fine_scan_meets() {
        const FINE: u32 = 2_000;
        let mut draws = Draws(1);
        let mut uniform = |low: f64, high: f64| draws.uniform(low, high);
        let (mut met, mut bounded) = (0, 0);
        for _ in 0..1_000 {
            let (mut footing, load) = skidding(&mut uniform);
            let radius = footing.rim.radius;
            let length = |place: u32| radius * f64::from(place) / f64::from(FINE);
            let mut carried = |place: u32| footing.react(length(place)).unwrap().load();
            let loads: Vec<f64> = (1..=FINE).map(&mut carried).collect();
            let first = (1..=FINE).find(|place| loads[*place as usize - 1] >= load);
            let rises = (1..=FINE).take_while(|place| rises_up_to(&footing.rim, length(*place)));
            let rises = rises.count();
            let positive: Vec<f64> = loads[..rises].iter().map(|load| load.max(0.0)).collect();
            assert!(
                positive.is_sorted(),
                "the load falls: {:?} up to {rises}",
                footing.rim
            );
            match (first_balance(&mut footing, load), first) {
                (Ok(balance), Some(place)) => {
                    let allowed = length(place - 1) - 1e-6 * radius..=length(place) + 1e-6 * radius;
                    let length = balance.contact_length;
                    assert!(
                        allowed.contains(&length),
                        "{length}: {load} N on {:?}",
                        footing.rim
                    );
                    met += 1;
                    bounded += usize::from((place as usize) < rises);
                }
                (Err(_), None) => {}
                (actual, first) => panic!("{actual:?} for {first:?}: {load} N on {:?}", footing.rim),
            }
        }
        assert!(met > 700 && bounded > 500, "{met} {bounded}");
    }
}

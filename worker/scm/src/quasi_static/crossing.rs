//! The first of several balances that a sinking wheel meets.
//!
//! A driving rim presses back harder the deeper it stands, so there is one balance. In skid the shear
//! stress pulls the rim down where it slopes, and the load that the soil carries may rise, fall and rise
//! again with depth.

use super::footing::Footing;
use super::rim::Rim;
use crate::Rejection;

/// Samples of a scan, evenly spaced in the root of the sinkage (nearly so in `theta_1`).
const SAMPLES: u32 = 64;
/// Steps of the search for a peak between samples: the bracket shrinks by 0.618 each.
const PEAK_STEPS: u32 = 40;

/// Whether the carried load certainly rises with depth up to this contact length, from bounds on its terms.
///
/// At a fixed fraction of the contact each term is bounded by its slope in ln l: the pressure by at least
/// `2n` from the sinkage, 1 from `k* l` unless `k_c` > 0, less `m/2` from the changing shape of gamma; the
/// friction that pulls down, relative to the pressure, by at most `sec²(theta_1)`; so does the cohesion,
/// which must grow more slowly than the rest. False means "not known". Effects on pressure and shear are ignored:
/// with a law whose pressure falls with depth, the balance found may not be the first.
pub(super) fn rises_up_to(rim: &Rim, contact_length: f64) -> bool {
    let soil = &rim.soil;
    let pressure_slope = 2.0 * soil.n - 0.5 * soil.gamma_exponent + if soil.k_c > 0.0 { 0.0 } else { 1.0 };
    if rim.motion.drives_everywhere() {
        return pressure_slope > 0.0;
    }
    let cos_squared = (1.0 - contact_length / rim.radius) * (1.0 + contact_length / rim.radius);
    let secant_squared = 1.0 / cos_squared;
    let pull_down = rim.tan_friction_angle * contact_length / (rim.radius * cos_squared.sqrt());
    let slope = pressure_slope - pull_down * secant_squared / (1.0 - pull_down);
    let cohesion_slope = if soil.cohesion_pa > 0.0 {
        1.0 + secant_squared
    } else {
        0.0
    };
    pull_down < 1.0 && slope > cohesion_slope
}

/// Result of a scan from the surface down.
pub(super) enum Scan {
    /// The carried load first passes the wheel load between these contact lengths.
    Between(f64, f64),
    /// It never does; the largest load carried `[N]`.
    Never(f64),
}

/// Look for the first crossing by sampling from the surface down to z = R.
pub(super) fn scan(footing: &mut Footing, load: f64) -> Result<Scan, Rejection> {
    let (mut before, mut last) = ((0.0, 0.0), (0.0, 0.0)); // contact length, load carried
    let mut most: f64 = 0.0;
    for sample in 1..=SAMPLES {
        let root = f64::from(sample) / f64::from(SAMPLES);
        let length = footing.rim.radius * root * (2.0 - root * root).sqrt();
        let here = (length, footing.react(length)?.load());
        if here.1 >= load {
            return Ok(Scan::Between(last.0, length));
        }
        if last.1 > before.1 && last.1 > here.1 {
            let peak = peak_between(footing, before.0, here.0, load)?;
            if peak.1 >= load {
                return Ok(Scan::Between(before.0, peak.0));
            }
            most = most.max(peak.1);
        }
        most = most.max(here.1);
        (before, last) = (last, here);
    }
    Ok(Scan::Never(most))
}

/// Contact length and height of the peak between two lengths by golden sections; ends early above `enough`.
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
    // The nearer point first: beyond a peak that is high enough lies a second crossing.
    Ok(if low.1 >= enough || low.1 > high.1 {
        low
    } else {
        high
    })
}

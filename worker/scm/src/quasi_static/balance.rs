//! Solution of the vertical balance for the contact length.

use super::crossing::{Scan, rises_up_to, scan};
use super::footing::Footing;
use super::reaction::Reaction;
use super::rim::Rim;
use super::start::Coordinate;
use crate::Rejection;

/// Residual load, relative to the wheel load, at which the balance is accepted.
const TOLERANCE: f64 = 1e-9;
/// Residual that is accepted if rounding prevents a smaller one (k* is a difference of nearly equal terms).
const ROUNDING_TOLERANCE: f64 = 1e-6;
/// Number of evaluations after which every other step halves the bracket.
const PATIENCE: u32 = 8;
const MAX_EVALUATIONS: u32 = 120;
/// Number of evaluations of a search from the closed form if the load may have a peak.
const EVALUATIONS_BEFORE_SCAN: u32 = 20;
/// Width of a bracket in y at which a jump of the load is interpolated between its sides.
const NARROWEST: f64 = 1e-12;
/// The longest step in y while the root is bracketed on one side only.
const LONGEST_STEP: f64 = 2.0;

/// Returns the soil's reaction at the first balance that the sinking wheel meets.
pub(super) fn first_balance(footing: &mut Footing, load: f64) -> Result<Reaction, Rejection> {
    let radius = footing.rim.radius;
    let no_support = |max_carried_n: f64| Rejection::NoSupport {
        max_carried_n,
        wheel_load_n: load,
        wheel_radius_m: radius,
    };
    let coordinate = Coordinate::new(&footing.rim).ok_or_else(|| no_support(0.0))?;
    let start = coordinate.start(&footing.rim, load);
    let rises = rises_up_to(&footing.rim, radius);
    let patience = if rises {
        MAX_EVALUATIONS
    } else {
        EVALUATIONS_BEFORE_SCAN
    };
    let result = match search(footing, load, &coordinate, Bracket::default(), start, patience) {
        Ok(Some(reaction)) if rises || rises_up_to(&footing.rim, reaction.contact_length) => {
            return Ok(reaction);
        }
        Ok(None) if rises => return Err(no_support(footing.react(radius)?.load())),
        // The search may have found a deeper balance, or the secant may have stayed around a peak below the load.
        Ok(result) => result,
        Err(Rejection::NoConvergence { .. }) if !rises => None,
        Err(rejection) => return Err(rejection),
    };
    match scan(footing, load)? {
        Scan::Never(max_carried) => Err(no_support(max_carried)),
        Scan::Between(shorter, longer) => {
            if let Some(reaction) = result
                && (shorter..=longer).contains(&reaction.contact_length)
            {
                return Ok(reaction);
            }
            let bracket = Bracket {
                low: coordinate.at(shorter),
                high: coordinate.at(longer),
            };
            let start = if bracket.is_closed() {
                bracket.middle()
            } else {
                bracket.high - LONGEST_STEP
            };
            match search(footing, load, &coordinate, bracket, start, MAX_EVALUATIONS)? {
                Some(reaction) => Ok(reaction),
                None => Err(no_support(footing.react(radius)?.load())),
            }
        }
    }
}

/// Interval of y that carries less than the load at its low end and more at its high end, as far as known.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    low: f64,
    high: f64,
}

impl Default for Bracket {
    fn default() -> Self {
        Self {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }
    }
}

impl Bracket {
    fn is_closed(&self) -> bool {
        self.low > f64::NEG_INFINITY && self.high < f64::INFINITY
    }

    fn middle(&self) -> f64 {
        0.5 * (self.low + self.high)
    }
}

/// A trial: y and ln(carried load / wheel load), −∞ if nothing is carried.
#[derive(Debug, Clone, Copy)]
struct Trial {
    y: f64,
    log_ratio: f64,
}

/// Searches the load by the secant method in (y, ln load), kept within the bracket; `None` if the load is not reached
/// going down from `start`.
fn search(
    footing: &mut Footing,
    load: f64,
    coordinate: &Coordinate,
    mut bracket: Bracket,
    start: f64,
    max_evaluations: u32,
) -> Result<Option<Reaction>, Rejection> {
    let mut y = start;
    let mut last: Option<Trial> = None;
    let jumps = footing.may_jump();
    // the last reactions below and above the load
    let mut sides = [None, None];
    let mut evaluations = 0;
    loop {
        let reaction = footing.react(coordinate.contact_length(y))?;
        evaluations += 1;
        let carried = reaction.load();
        if !carried.is_finite() {
            return Err(Rejection::NotFinite {
                quantity: "load carried by the soil",
                value: carried,
            });
        }
        let residual = carried - load;
        if residual.abs() <= TOLERANCE * load {
            return Ok(Some(reaction));
        }
        if evaluations >= max_evaluations {
            return if residual.abs() <= ROUNDING_TOLERANCE * load {
                Ok(Some(reaction))
            } else {
                Err(Rejection::NoConvergence {
                    residual_load_n: residual,
                    wheel_load_n: load,
                    sinkage_m: reaction.sinkage,
                    evaluations,
                })
            };
        }
        let below = residual < 0.0;
        if below {
            bracket.low = y;
        } else {
            bracket.high = y;
        }
        if jumps {
            sides[usize::from(!below)] = Some(reaction);
            if coordinate.is_origin(reaction.contact_length) {
                sides[0].get_or_insert(reaction.unloaded());
            }
            if let [Some(below), Some(above)] = sides
                && (bracket.high - bracket.low < NARROWEST || are_neighbours(&below, &above))
            {
                return Ok(Some(below.shared_with(&above, load)));
            }
        }
        if bracket.low >= coordinate.max_y {
            return Ok(None);
        }
        let log_ratio = if carried > 0.0 {
            libm::log(carried / load)
        } else {
            f64::NEG_INFINITY
        };
        let trial = Trial { y, log_ratio };
        let slope = slope(&footing.rim, coordinate, &reaction, trial, last);
        last = Some(trial);
        y = next(bracket, trial, slope, evaluations).min(coordinate.max_y);
    }
}

/// Returns whether no contact lies between two: close to the coordinate's origin, the contact's length runs out of digits
/// before y does.
fn are_neighbours(below: &Reaction, above: &Reaction) -> bool {
    above.contact_length - below.contact_length <= f64::EPSILON * above.contact_length
}

/// Returns the next y to try.
fn next(bracket: Bracket, trial: Trial, slope: f64, evaluations: u32) -> f64 {
    let step = (-trial.log_ratio / slope).clamp(-LONGEST_STEP, LONGEST_STEP);
    let proposal = trial.y + step;
    if !bracket.is_closed() {
        return proposal;
    }
    let inside = bracket.low < proposal && proposal < bracket.high; // false for NaN
    if inside && (evaluations < PATIENCE || evaluations % 2 == 1) {
        proposal
    } else {
        bracket.middle()
    }
}

/// Returns d ln(load) / dy from the chord through the last two trials if it rises, else from small angles.
fn slope(rim: &Rim, coordinate: &Coordinate, reaction: &Reaction, trial: Trial, last: Option<Trial>) -> f64 {
    if let Some(last) = last {
        let chord = (trial.log_ratio - last.log_ratio) / (trial.y - last.y);
        if chord > 0.0 && chord.is_finite() {
            return chord;
        }
    }
    // Per ln l: z^n gives 2n and length 1, k* −k_c/(l k*), and tan(theta) adds 1 to the part carried by shear.
    let stiffness = -rim.soil.k_c / (reaction.contact_length * reaction.k_star);
    let shear_part = reaction.load_from_shear / reaction.load();
    let per_log_length = 2.0 * rim.soil.n + 1.0 + stiffness + shear_part;
    let small_angle = per_log_length / coordinate.per_log_length(reaction.contact_length);
    if small_angle > 0.5 { small_angle } else { 1.0 }
}

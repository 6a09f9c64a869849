//! The height of the hub at which the soil carries the wheel load.

/// Residual load, relative to the wheel load, at which a step is in balance.
const TOLERANCE: f64 = 1.5e-2;
/// Width of a bracket at which the search ends: the load may jump as patches join `[m]`.
const NARROWEST: f64 = 1e-6;
const MAX_TRIALS: u32 = 60;
/// The flattest slope of the load against height that a chord may show, in wheel loads per metre.
const MIN_SLOPE: f64 = -10.0;

/// Search with the last step's slope; `load` falls as the hub rises.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Search {
    /// Height of the hub at which the search starts `[m]`.
    pub(crate) guess: f64,
    /// d load / d height at the start `[N/m]`, < 0.
    pub(crate) slope: f64,
    /// The longest first step `[m]`; it doubles until the load is bracketed.
    pub(crate) longest: f64,
}

/// A height in balance, and the slope that led to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Balance {
    pub(crate) height: f64,
    pub(crate) slope: f64,
    /// Carried load less wheel load `[N]`.
    pub(crate) residual: f64,
}

/// Finds the height at which `excess(height)`, the carried load less the wheel load, is zero; `None` if there is none
/// above `lowest`.
pub(crate) fn balance(
    search: Search,
    wheel_load: f64,
    lowest: f64,
    mut excess: impl FnMut(f64) -> f64,
) -> Option<Balance> {
    let mut slope = search.slope;
    // a guess from the trend may be below `lowest`, where a carried load is no support
    let mut height = search.guess.max(lowest);
    // heights and their excess: ≥ 0 at the low one, < 0 at the high one
    let mut low: Option<(f64, f64)> = None;
    let mut high: Option<(f64, f64)> = None;
    let mut last: Option<(f64, f64)> = None;
    let mut longest = search.longest;
    for trial in 0..MAX_TRIALS {
        let residual = excess(height);
        let done = residual.abs() <= TOLERANCE * wheel_load;
        let narrow = matches!((low, high), (Some((l, _)), Some((h, _))) if h - l < NARROWEST);
        if let Some((before, its_residual)) = last {
            let chord = (residual - its_residual) / (height - before);
            if chord < MIN_SLOPE * wheel_load && chord.is_finite() {
                slope = chord;
            }
        }
        last = Some((height, residual));
        // the caller reports a residual that is NaN
        if done || narrow || trial + 1 == MAX_TRIALS || !residual.is_finite() {
            return Some(Balance {
                height,
                slope,
                residual,
            });
        }
        if residual >= 0.0 {
            low = Some((height, residual));
        } else {
            high = Some((height, residual));
        }
        let newton = height - residual / slope;
        height = match (low, high) {
            (Some((l, fl)), Some((h, fh))) => {
                let inside = newton > l && newton < h;
                if inside && trial < 6 {
                    newton
                } else if trial % 3 == 2 {
                    0.5 * (l + h)
                } else {
                    l + (h - l) * (fl / (fl - fh)).clamp(0.05, 0.95)
                }
            }
            _ => {
                let next = newton.clamp(height - longest, height + longest);
                longest *= 2.0;
                if next <= lowest {
                    if height <= lowest {
                        return None;
                    }
                    lowest
                } else {
                    next
                }
            }
        };
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the load on soil with a stiffness of 1 kN/m that meets the wheel at 100 mm.
    fn spring(height: f64) -> f64 {
        1e3 * (0.1 - height)
    }

    fn search(guess: f64) -> Search {
        Search {
            guess,
            slope: -2e3,
            longest: 0.02,
        }
    }

    #[test]
    fn the_load_is_met_within_its_tolerance_from_above_and_below() {
        for guess in [0.099, 0.05, 0.001, -0.01] {
            let balanced = balance(search(guess), 30.0, 0.0, |height| spring(height) - 30.0);
            let balanced = balanced.expect("support");
            assert!((balanced.height - 0.07).abs() < 0.031e-3, "{balanced:?}");
            assert!((spring(balanced.height) - 30.0 - balanced.residual).abs() < 1e-12);
        }
    }

    #[test]
    fn a_load_met_only_below_the_lowest_height_is_not_met_and_never_tried_there() {
        let mut deepest = f64::MAX;
        let balanced = balance(search(-0.03), 110.0, 0.0, |height| {
            deepest = deepest.min(height);
            spring(height) - 110.0
        });
        assert!(balanced.is_none(), "{balanced:?}");
        assert!(deepest.abs() < f64::MIN_POSITIVE, "{deepest}");
    }

    #[test]
    fn a_jump_past_the_load_ends_where_the_bracket_is_narrow() {
        // 20 N above 50 mm, 60 N below
        let jump = |height: f64| if height > 0.05 { 20.0 } else { 60.0 };
        let balanced = balance(search(0.06), 30.0, 0.0, |height| jump(height) - 30.0).expect("a bracket");
        assert!((balanced.height - 0.05).abs() < 2.0 * NARROWEST, "{balanced:?}");
        assert!(balanced.residual.abs() > 5.0);
    }
}

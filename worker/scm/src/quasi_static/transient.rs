//! Sinkage of a wheel before it is steady.

use crate::effects::{Active, Site};
use crate::rejection::require;
use crate::{Condition, Rejection, Soil, Wheel};

/// Step of the integration over the length of the contact; errors are below 10 µm (`tests::a_finer_step_changes_nothing`).
const STEP: f64 = 0.1;
/// Steady sinkage below which the wheel has no contact to settle over `[m]`.
const MIN_STEADY_M: f64 = 1e-6;
/// Travel beyond which the wheel is steady, over the length of the contact: `exp(-40)` is below the rounding of a number.
const STEADY: f64 = 40.0;

/// Computes the sinkage that a wheel has reached at some points of travel, before it has the steady sinkage `z_e`.
///
/// The wheel sinks in proportion to the load that the soil does not carry yet: `dz/dx = z_e / (m L) (1 − W(z)/W)` with
/// `W(z)/W = (z/z_e)^m`, `m = n + 1/2` (pressure `z^n` on a contact of the length `√z`) and `L = √(2 R z_e)`, the length of the steady
/// contact ahead of the axle. There is no constant to fit: near the steady state, the distance to it decays by a factor e over L. An
/// effect on the exponent n acts on m, too, so the transient tells such an effect from those that leave n unchanged.
///
/// # Returns
/// The sinkage at each point `[m]`, K numbers. A wheel with `z_e` below 1 µm, whose grousers carry it, has no contact length and is steady at
/// once.
///
/// # Errors
/// [`Rejection::InvalidParameter`]: a start, a steady sinkage or a travel that is not finite, a negative travel; an effect gives an inadmissible value.
///
/// # Validity
/// Motion at constant slip from the start on; slip that begins earlier or later is not seen.
///
/// # Numerics
/// The equation is solved for `ln |1 − z/z_e|`, whose slope has no pole, by the classical Runge–Kutta method with a fixed grid of steps;
/// the value at a point does not depend on the other points.
///
/// # Source
/// The law is ours, from the sinkage histories of CMU's single-wheel runs (`examples/cmu-sand`, "Through time"); the exponent m follows
/// from Bekker 1969, ch. 5. Checked by `transient::tests`.
pub fn transient_sinkage(
    soil: &Soil,
    wheel: &Wheel,
    condition: &Condition,
    effects: &Active,
    site: &Site,
    way: &Way,
) -> Result<Vec<f64>, Rejection> {
    let &Way {
        steady_sinkage_m,
        start_sinkage_m,
        travel_m,
    } = way;
    require(true, "start_sinkage_m", start_sinkage_m, "m", "finite")?;
    require(true, "steady_sinkage_m", steady_sinkage_m, "m", "finite")?;
    for &point in travel_m {
        let is_travel = point.is_finite() && point >= 0.0;
        require(is_travel, "travel_m", point, "m", "finite and >= 0")?;
    }
    let case = effects.case(soil, wheel, condition, site)?;
    if steady_sinkage_m < MIN_STEADY_M {
        let at = |&point: &f64| {
            if point > 0.0 {
                steady_sinkage_m
            } else {
                start_sinkage_m
            }
        };
        return Ok(travel_m.iter().map(at).collect());
    }
    let contact_m = (2.0 * case.wheel.radius_m * steady_sinkage_m).sqrt();
    let mut settling = Settling::new(start_sinkage_m / steady_sinkage_m, case.soil.n + 0.5);
    let points = travel_m.iter().map(|point| point / contact_m);
    Ok(points
        .map(|lengths| steady_sinkage_m * settling.share_after(lengths))
        .collect())
}

/// The travel of a wheel towards its steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way<'a> {
    /// Steady sinkage, that of a simulation at this condition with the effects on it `[m]`.
    pub steady_sinkage_m: f64,
    /// Sinkage where the travel begins `[m]`; the wheel climbs if it is above the steady one.
    pub start_sinkage_m: f64,
    /// Travel of the sled at each of K points `[m]`, ≥ 0.
    pub travel_m: &'a [f64],
}

/// The sinkage over the steady one, integrated along the travel.
struct Settling {
    start: f64,
    exponent: f64,
    /// 1 above the steady sinkage, −1 below it.
    side: f64,
    /// Number of whole steps so far.
    steps: usize,
    /// `ln |1 − z/z_e|` there.
    logarithm: f64,
}

impl Settling {
    fn new(start: f64, exponent: f64) -> Self {
        let mut settling = Settling {
            start,
            exponent,
            side: if start > 1.0 { 1.0 } else { -1.0 },
            steps: 0,
            logarithm: 0.0,
        };
        settling.restart();
        settling
    }

    fn restart(&mut self) {
        self.steps = 0;
        self.logarithm = libm::log((self.start - 1.0).abs());
    }

    /// Returns the share after a travel over the length of the contact. Ascending points continue the integration.
    fn share_after(&mut self, lengths: f64) -> f64 {
        if lengths >= STEADY || (self.start - 1.0).abs() <= 0.0 {
            return 1.0;
        }
        if lengths <= 0.0 {
            return self.start;
        }
        let whole = (lengths / STEP).floor();
        if (whole as usize) < self.steps {
            self.restart();
        }
        for _ in self.steps..whole as usize {
            self.logarithm = self.stepped(STEP);
            self.steps += 1;
        }
        1.0 + self.side * libm::exp(self.stepped(lengths - whole * STEP))
    }

    /// Returns the logarithm after a further step, in parts where the wheel climbs so steeply that a whole step would be unstable.
    fn stepped(&self, step: f64) -> f64 {
        let steepness = rate(1.0 + self.side * libm::exp(self.logarithm), self.exponent) / self.exponent;
        let parts = steepness.max(1.0).ceil();
        let mut logarithm = self.logarithm;
        for _ in 0..parts as usize {
            logarithm = self.advanced(logarithm, step / parts);
        }
        logarithm
    }

    /// Returns the logarithm after a step of the Runge–Kutta method.
    fn advanced(&self, from: f64, step: f64) -> f64 {
        let slope =
            |logarithm: f64| -rate(1.0 + self.side * libm::exp(logarithm), self.exponent) / self.exponent;
        let first = slope(from);
        let second = slope(from + 0.5 * step * first);
        let third = slope(from + 0.5 * step * second);
        let fourth = slope(from + step * third);
        from + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    }
}

/// Returns `(ζ^m − 1)/(ζ − 1)`, which is m at ζ = 1; soil above the wheel's lowest point carries nothing.
fn rate(share: f64, exponent: f64) -> f64 {
    let beyond = share - 1.0;
    if beyond.abs() < 1e-6 {
        return exponent * (1.0 + 0.5 * (exponent - 1.0) * beyond);
    }
    let carried = if share > 0.0 {
        libm::pow(share, exponent)
    } else {
        0.0
    };
    (carried - 1.0) / beyond
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finer_step_changes_nothing() {
        // The midpoint method with tiny steps of the equation as it is written; explicit Euler errs by 1e-4 at the steepest start.
        for (start, exponent, ways) in [
            (0.1, 1.9, 0.5),
            (0.4, 1.3, 1.5),
            (-0.2, 2.4, 1.0),
            (3.0, 1.9, 0.7),
            (100.0, 1.9, 0.3),
            (1.0, 2.0, 1.0),
        ] {
            let steps = 200_000;
            let step = ways / f64::from(steps);
            let slope = |share: f64| {
                let carried = if share > 0.0 { share.powf(exponent) } else { 0.0 };
                (1.0 - carried) / exponent
            };
            let mut share: f64 = start;
            for _ in 0..steps {
                share += step * slope(share + 0.5 * step * slope(share));
            }
            let computed = Settling::new(start, exponent).share_after(ways);
            assert!(
                (computed - share).abs() < 1e-5,
                "{start} {exponent} {ways}: {computed}, {share}"
            );
        }
    }

    #[test]
    fn a_linear_soil_forgets_its_start_exponentially() {
        let computed = Settling::new(0.2, 1.0).share_after(1.7);
        assert!(
            (computed - (1.0 - 0.8 * (-1.7_f64).exp())).abs() < 1e-9,
            "{computed}"
        );
    }

    #[test]
    fn the_value_at_a_point_does_not_depend_on_the_others() {
        let mut settling = Settling::new(0.3, 1.7);
        let together = [0.5, 1.5, 4.5, 0.05].map(|lengths| settling.share_after(lengths).to_bits());
        let alone =
            [0.5, 1.5, 4.5, 0.05].map(|lengths| Settling::new(0.3, 1.7).share_after(lengths).to_bits());
        assert_eq!(together, alone);
    }
}

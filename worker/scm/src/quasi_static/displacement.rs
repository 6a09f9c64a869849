//! Shear displacement of the rim: the distance that it has slid since it met the soil.

use super::kinematics::RimMotion;

/// Largest displacement of a rim that hardly turns `[m]`; the displacement of a locked wheel grows without limit.
const FARTHEST: f64 = 1e3;

/// The distance that elements of the rim slide along the soil, in steady motion.
///
/// An element enters the contact at its front end and moves backwards; at a place x ahead of the axle it has slid
/// `j(x) = ∫ |v_t| dt` since. On the arc, with θ = asin(x/R) and `v_t = omega R − v cos θ`, the integral is `R θ − (v / omega) sin θ`
/// between both places (Wong & Reece 1967, <https://doi.org/10.1016/0022-4898(67)90105-X>), taken piecewise where `v_t`
/// changes sign; on a rim that its load has flattened to the radius `R_b` it is `|1 − v / (omega R_b)|` times the distance
/// along it. A wheel that moves sideways also slides across, for the same time: `sqrt(j² + (v sin β t)²)`, exact if the
/// direction of sliding does not change.
///
/// Checked by this file's tests and by `effects::signatures`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slide {
    radius: f64,
    per_radius: f64,
    /// v cos(β) / (omega R) and v sin(β) / (omega R).
    forward: f64,
    lateral: f64,
    /// True if the rim moves forward over the soil at its lowest point.
    skids: bool,
    /// x at which the slip velocity changes sign `[m]`, and twice the distance slid backwards from the lowest point to it.
    sign_change: f64,
    twice_to_turn: f64,
    /// Half length of the flat; distance slid and time on it per length; their differences from the arc at its end.
    flat: f64,
    way_per_length: f64,
    time_per_length: f64,
    way_lost: f64,
    time_lost: f64,
}

/// Distance slid, and time times the rim's speed, from the lowest point to the front end of the contact `[m]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// True if the contact lies on the round rim and slides in one direction.
    plain: bool,
    /// Signed distance backwards if the contact is plain, else distance along the direction of sliding.
    way: f64,
    time: f64,
}

impl Slide {
    /// Returns the sliding of a rim with a flat of a half length `[m]`, 0 for none, at a distance from the axle.
    pub(super) fn new(radius: f64, motion: &RimMotion, flat: f64, bottom_radius: f64) -> Self {
        let sign_change = motion.sign_change().map_or(f64::INFINITY, |sin| radius * sin);
        let forward = motion.forward / motion.rim_speed;
        let [edge_angle, turn_angle] = arcsine([flat / radius, (sign_change / radius).min(1.0)]);
        let mut slide = Self {
            radius,
            per_radius: 1.0 / radius,
            forward,
            lateral: motion.lateral / motion.rim_speed,
            skids: !motion.drives_everywhere(),
            sign_change,
            twice_to_turn: 2.0 * (radius * turn_angle - forward * sign_change),
            flat,
            way_per_length: (1.0 - forward * radius / bottom_radius).abs(),
            time_per_length: radius / bottom_radius,
            way_lost: 0.0,
            time_lost: 0.0,
        };
        if flat > 0.0 {
            slide.way_lost = slide.way_per_length * flat - slide.way_on_arc(flat, edge_angle);
            slide.time_lost = slide.time_per_length * flat - radius * edge_angle;
        }
        slide
    }

    /// Returns the front end of a contact at x `[m]`.
    pub(super) fn enter(&self, front: f64) -> Entry {
        let [angle] = arcsine([front * self.per_radius]);
        let plain = self.flat <= 0.0 && !(self.skids && front > self.sign_change);
        Entry {
            plain,
            way: if plain {
                self.backwards(front, angle)
            } else {
                self.way(front, angle)
            },
            time: self.time(front, angle),
        }
    }

    /// Returns the distance slid at places x `[m]` since the front end of the contact; vectorises.
    #[inline(always)]
    pub(super) fn slid<const N: usize>(&self, entry: &Entry, x: [f64; N]) -> [f64; N] {
        let angle = arcsine(x.map(|x| x * self.per_radius));
        let mut slid = [0.0; N];
        if entry.plain {
            for i in 0..N {
                slid[i] = (entry.way - self.backwards(x[i], angle[i])).abs();
            }
        } else {
            for i in 0..N {
                slid[i] = (entry.way - self.way(x[i], angle[i])).abs(); // rounding makes it negative if the rim rolls
            }
        }
        if self.lateral.abs() > 0.0 {
            for i in 0..N {
                let across = self.lateral * (entry.time - self.time(x[i], angle[i]));
                slid[i] = (slid[i] * slid[i] + across * across).sqrt();
            }
        }
        slid.map(|way| if way < FARTHEST { way } else { FARTHEST }) // a locked wheel gives NaN or ∞
    }

    /// Returns `∫ v_t dt` along the arc from the lowest point to x, at this angle of the rim; odd in x.
    #[inline(always)]
    fn backwards(&self, x: f64, angle: f64) -> f64 {
        self.radius * angle - self.forward * x
    }

    /// Returns `∫ |v_t| dt` along the arc.
    fn way_on_arc(&self, x: f64, angle: f64) -> f64 {
        let backwards = self.backwards(x, angle);
        if !self.skids {
            backwards
        } else if x.abs() > self.sign_change {
            backwards - signed(self.twice_to_turn, x)
        } else {
            -backwards
        }
    }

    /// Returns `∫ |v_t| dt` along the rim.
    fn way(&self, x: f64, angle: f64) -> f64 {
        if x.abs() <= self.flat {
            self.way_per_length * x
        } else {
            self.way_on_arc(x, angle) + signed(self.way_lost, x)
        }
    }

    /// Returns the time from the lowest point to x, times the speed of the rim `[m]`; odd in x.
    #[inline(always)]
    fn time(&self, x: f64, angle: f64) -> f64 {
        if x.abs() <= self.flat {
            self.time_per_length * x
        } else {
            self.radius * angle + signed(self.time_lost, x)
        }
    }
}

/// Returns a length with the sign of x.
#[inline(always)]
fn signed(length: f64, x: f64) -> f64 {
    if x < 0.0 { -length } else { length }
}

/// Computes arcsines of numbers in [−1, 1], to a few units in the last place; vectorises.
///
/// Up to |x| = 1/2 the rational approximation of `FreeBSD`'s msun, <https://www.netlib.org/fdlibm/e_asin.c>; beyond,
/// `asin x = π/2 − 2 asin(sqrt((1 − x)/2))`.
#[inline(always)]
pub(super) fn arcsine<const N: usize>(x: [f64; N]) -> [f64; N] {
    x.map(|x| {
        let far = x.abs();
        let beyond = 0.5 * (1.0 - far);
        let beyond = if beyond > 0.0 { beyond } else { 0.0 };
        let near = far <= 0.5;
        let square = if near { x * x } else { beyond };
        let root = square.sqrt();
        let numerator = 0.166_666_666_666_666_66
            + square
                * (-0.325_565_818_622_400_9
                    + square
                        * (0.201_212_532_134_862_93
                            + square
                                * (-0.040_055_534_500_679_41
                                    + square
                                        * (7.915_349_942_898_145e-4 + square * 3.479_331_075_960_212e-5))));
        let denominator = 1.0
            + square
                * (-2.403_394_911_734_414
                    + square
                        * (2.020_945_760_233_505_7
                            + square * (-0.688_283_971_605_453_3 + square * 0.077_038_150_555_901_94)));
        let angle = root + root * (square * numerator / denominator);
        let angle = if near {
            angle
        } else {
            core::f64::consts::FRAC_PI_2 - 2.0 * angle
        };
        angle.copysign(x)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.125;

    fn motion(rim_speed: f64, lateral: f64) -> RimMotion {
        RimMotion {
            rim_speed,
            forward: 0.01,
            lateral,
        }
    }

    /// Returns the distance slid in a contact that begins 40 mm ahead of the axle.
    fn slid<const N: usize>(slide: &Slide, x: [f64; N]) -> [f64; N] {
        slide.slid(&slide.enter(0.04), x)
    }

    #[test]
    fn arcsines_agree_with_libm() {
        for i in -1000..=1000 {
            let x = f64::from(i) * 1e-3;
            assert!((arcsine([x])[0] - libm::asin(x)).abs() <= 6e-16, "{x}");
        }
    }

    /// Sums `|v_t| dt` over small steps of the angle.
    fn summed(motion: &RimMotion, front: f64, x: f64) -> f64 {
        const STEPS: u32 = 20_000;
        let (from, to) = (libm::asin(x / RADIUS), libm::asin(front / RADIUS));
        let step = (to - from) / f64::from(STEPS);
        let per_speed = RADIUS / motion.rim_speed;
        let cosine = |i| libm::cos(from + (f64::from(i) + 0.5) * step);
        let path = |i| motion.tangential(cosine(i)).abs() * step * per_speed;
        (0..STEPS).map(path).sum()
    }

    #[test]
    fn the_way_slid_is_the_integral_of_the_slip_velocity() {
        // The rim drives, skids everywhere near the bottom, or changes direction within the contact.
        for rim_speed in [0.0125, 0.007, 0.0098] {
            let motion = motion(rim_speed, 0.0);
            let slide = Slide::new(RADIUS, &motion, 0.0, RADIUS);
            for x in [-0.03, -0.015, 0.0, 0.01, 0.03, 0.04] {
                let (actual, expected) = (slid(&slide, [x])[0], summed(&motion, 0.04, x));
                assert!((actual - expected).abs() < 1e-9, "{rim_speed} {x}: {actual}");
            }
        }
    }

    #[test]
    fn a_locked_wheel_has_slid_ever_since() {
        let slide = Slide::new(RADIUS, &motion(0.0, 0.001), 0.0, RADIUS);
        assert!((slid(&slide, [0.02])[0] - FARTHEST).abs() < f64::EPSILON);
    }

    #[test]
    fn sideways_sliding_adds_at_right_angles() {
        let straight = slid(&Slide::new(RADIUS, &motion(0.0125, 0.0), 0.0, RADIUS), [0.01])[0];
        let oblique = slid(&Slide::new(RADIUS, &motion(0.0125, 0.0025), 0.0, RADIUS), [0.01])[0];
        let time = (libm::asin(0.32) - libm::asin(0.08)) * RADIUS / 0.0125;
        assert!((oblique - libm::hypot(straight, 0.0025 * time)).abs() < 1e-12);
    }

    #[test]
    fn a_flat_slides_by_its_reduced_radius() {
        let flat = 0.03;
        let bottom = (RADIUS * RADIUS - flat * flat).sqrt();
        let slide = Slide::new(RADIUS, &motion(0.0125, 0.0), flat, bottom);
        let [edge, middle] = slid(&slide, [flat, 0.0]);
        let rate = 1.0 - 0.01 / (0.0125 * bottom / RADIUS);
        assert!((middle - edge - rate * flat).abs() < 1e-12);
    }
}

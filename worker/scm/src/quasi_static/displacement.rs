//! Shear displacement of the rim: how far it has slid since it met the soil.

use super::kinematics::RimMotion;

/// Largest displacement of a rim that hardly turns `[m]`: that of a locked wheel grows without limit.
const FARTHEST: f64 = 1e3;

/// The distance that elements of the rim slide along the soil, in steady motion.
///
/// An element enters the contact at its front end and moves backwards; at a place x ahead of the axle it has slid
/// `j(x) = ∫ |v_t| dt` since. On the arc, with θ = asin(x/R) and `v_t = omega R − v cos θ`, the integral is
/// `R θ − (v / omega) sin θ` between both places (Wong & Reece 1967, <https://doi.org/10.1016/0022-4898(67)90105-X>), taken piece by piece where `v_t` changes sign; on a rim
/// that its load has flattened to the radius `R_b` it is `|1 − v / (omega R_b)|` times the distance along it. A wheel that moves
/// sideways slides across as well, for as long: `sqrt(j² + (v sin β t)²)`, exact where the direction of sliding does
/// not change.
///
/// Checked by this file's tests and by `effects::signatures`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slide {
    radius: f64,
    /// Half length of the flat, and its distance from the axle `[m]`.
    flat: f64,
    bottom_radius: f64,
    /// v cos(β) / (omega R) and v sin(β) / (omega R).
    forward: f64,
    lateral: f64,
    /// Whether the rim moves forward over the soil at its lowest point.
    skids: bool,
    /// x at which the slip velocity changes sign `[m]`; infinite if it does not.
    sign_change: f64,
    /// θ at the ends of the flat, and where the slip velocity changes sign.
    edge_angle: f64,
    turn_angle: f64,
}

impl Slide {
    /// The way of a rim with a flat of a half length `[m]`, 0 for none, at a distance from the axle.
    pub(super) fn new(radius: f64, motion: &RimMotion, flat: f64, bottom_radius: f64) -> Self {
        let sign_change = motion.sign_change().map_or(f64::INFINITY, |sin| radius * sin);
        let [edge_angle, turn_angle] = arcsine([flat / radius, (sign_change / radius).min(1.0)]);
        Self {
            radius,
            flat,
            bottom_radius,
            forward: motion.forward / motion.rim_speed,
            lateral: motion.lateral / motion.rim_speed,
            skids: !motion.drives_everywhere(),
            sign_change,
            edge_angle,
            turn_angle,
        }
    }

    /// Way slid at places x `[m]` of the contact whose front end is at `front` `[m]`.
    pub(super) fn slid<const N: usize>(&self, front: f64, x: [f64; N]) -> [f64; N] {
        let [there] = arcsine([front / self.radius]);
        let angle = arcsine(x.map(|x| x / self.radius));
        let mut slid = [0.0; N];
        if self.skids || self.flat > 0.0 || self.lateral.abs() > 0.0 {
            let (way_there, time_there) = (self.way(front, there), self.time(front, there));
            for i in 0..N {
                let along = way_there - self.way(x[i], angle[i]);
                let across = self.lateral * (time_there - self.time(x[i], angle[i]));
                slid[i] = (along * along + across * across).sqrt();
            }
        } else {
            // all the way backwards over the soil: the common case, without branches
            for i in 0..N {
                slid[i] = (self.radius * (there - angle[i]) - self.forward * (front - x[i])).max(0.0);
            }
        }
        slid.map(|way| if way < FARTHEST { way } else { FARTHEST }) // also where the wheel is locked: NaN or ∞
    }

    /// `∫ |v_t| dt` from the lowest point to x, where the rim stands at an angle.
    fn way(&self, x: f64, angle: f64) -> f64 {
        let far = x.abs();
        let on_flat = (1.0 - self.forward * self.radius / self.bottom_radius).abs();
        let way = if far <= self.flat {
            on_flat * far
        } else {
            on_flat * self.flat + self.on_arc(far, angle.abs()) - self.on_arc(self.flat, self.edge_angle)
        };
        way.copysign(x)
    }

    /// `∫ |v_t| dt` along the arc from the lowest point to x ≥ 0.
    fn on_arc(&self, x: f64, angle: f64) -> f64 {
        let signed = |x: f64, angle: f64| self.radius * angle - self.forward * x;
        if !self.skids {
            signed(x, angle)
        } else if x <= self.sign_change {
            -signed(x, angle)
        } else {
            signed(x, angle) - 2.0 * signed(self.sign_change, self.turn_angle)
        }
    }

    /// Time from the lowest point to x, times the speed of the rim `[m]`.
    fn time(&self, x: f64, angle: f64) -> f64 {
        let far = x.abs();
        let per_length = self.radius / self.bottom_radius;
        let time = if far <= self.flat {
            per_length * far
        } else {
            per_length * self.flat + self.radius * (angle.abs() - self.edge_angle)
        };
        time.copysign(x)
    }
}

/// Arcsines of numbers in [−1, 1], to a few units in the last place; vectorises.
///
/// `asin x = 2 atan(x / (1 + sqrt(1 − x²)))` and twice `atan t = 2 atan(t / (1 + sqrt(1 + t²)))` leave |t| ≤ 0.2,
/// where nine terms of the series remain below 1e-16.
fn arcsine<const N: usize>(x: [f64; N]) -> [f64; N] {
    x.map(|x| {
        let t = x / (1.0 + ((1.0 - x) * (1.0 + x)).sqrt());
        let t = t / (1.0 + (1.0 + t * t).sqrt());
        let t = t / (1.0 + (1.0 + t * t).sqrt());
        let q = t * t;
        let tail = 1.0 / 15.0 - q * (1.0 / 17.0 - q * (1.0 / 19.0 - q * (1.0 / 21.0)));
        let middle = 1.0 / 7.0 - q * (1.0 / 9.0 - q * (1.0 / 11.0 - q * (1.0 / 13.0 - q * tail)));
        8.0 * t * (1.0 - q * (1.0 / 3.0 - q * (1.0 / 5.0 - q * middle)))
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

    #[test]
    fn arcsines_agree_with_libm() {
        for i in -1000..=1000 {
            let x = f64::from(i) * 1e-3;
            assert!((arcsine([x])[0] - libm::asin(x)).abs() <= 6e-16, "{x}");
        }
    }

    /// Sum of `|v_t| dt` over small steps of the angle.
    fn summed(motion: &RimMotion, front: f64, x: f64) -> f64 {
        const STEPS: u32 = 20_000;
        let (from, to) = (libm::asin(x / RADIUS), libm::asin(front / RADIUS));
        let step = (to - from) / f64::from(STEPS);
        let per_speed = RADIUS / motion.rim_speed;
        let path = |i| {
            motion
                .tangential(libm::cos(from + (f64::from(i) + 0.5) * step))
                .abs()
                * step
                * per_speed
        };
        (0..STEPS).map(path).sum()
    }

    #[test]
    fn the_way_slid_is_the_integral_of_the_slip_velocity() {
        // driving, skidding everywhere near the bottom, and changing direction within the contact
        for rim_speed in [0.0125, 0.007, 0.0098] {
            let motion = motion(rim_speed, 0.0);
            let slide = Slide::new(RADIUS, &motion, 0.0, RADIUS);
            for x in [-0.015, 0.0, 0.01, 0.03, 0.04] {
                let (found, expected) = (slide.slid(0.04, [x])[0], summed(&motion, 0.04, x));
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{rim_speed} {x}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_locked_wheel_has_slid_ever_since() {
        let slide = Slide::new(RADIUS, &motion(0.0, 0.001), 0.0, RADIUS);
        assert!((slide.slid(0.04, [0.02])[0] - FARTHEST).abs() < f64::EPSILON);
    }

    #[test]
    fn sideways_sliding_adds_at_right_angles() {
        let straight = Slide::new(RADIUS, &motion(0.0125, 0.0), 0.0, RADIUS).slid(0.04, [0.01])[0];
        let oblique = Slide::new(RADIUS, &motion(0.0125, 0.0025), 0.0, RADIUS).slid(0.04, [0.01])[0];
        let time = (libm::asin(0.32) - libm::asin(0.08)) * RADIUS / 0.0125;
        assert!((oblique - libm::hypot(straight, 0.0025 * time)).abs() < 1e-12);
    }

    #[test]
    fn a_flat_slides_by_its_own_radius() {
        let flat = 0.03;
        let bottom = (RADIUS * RADIUS - flat * flat).sqrt();
        let slide = Slide::new(RADIUS, &motion(0.0125, 0.0), flat, bottom);
        let [edge, middle] = slide.slid(0.04, [flat, 0.0]);
        let rate = 1.0 - 0.01 / (0.0125 * bottom / RADIUS);
        assert!((middle - edge - rate * flat).abs() < 1e-12);
    }
}

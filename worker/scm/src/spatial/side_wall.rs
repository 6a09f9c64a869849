//! Soil that the buried side of the wheel pushes at a slip angle.

use super::contact::Contact;
use super::terrain::Terrain;
use super::wheel::motion::Motion;
use super::wheel::pose::Pose;
use crate::rejection::{Rejection, require};
use crate::shear::ShearVelocity;
use crate::{Condition, Soil};

/// Passive earth pressure on the leading side of the wheel.
///
/// The side is a disc of the wheel's radius R, which a hub at H buries to `h(x) = √(R² − x²) − H` below the undisturbed
/// soil. Per length of it, a smooth vertical wall that pushes a wedge of soil up a plane at 45° − φ/2 meets
///
/// `P = N (½ γ h² + γ ζ h) + 2 c h √N`, `N = tan²(45° + φ/2)`, γ the soil's unit weight,
///
/// where the wedge reaches `h √N` beside the wheel and ζ is the mean height of the raised soil there: the heap that the wheel has
/// pushed aside is a surcharge. The wheel feels `scale P |sin β|` against its lateral motion, because soil of the width
/// `dx |sin β|` across the travel is pushed, and `tan(δ)` times as much friction on its side, against the sliding along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SideWall {
    scale: f64,
    friction: f64,
    unit_weight: f64,
    root_n: f64,
    cohesion: f64,
    radius: f64,
}

/// The soil's force and torque on the side of the wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct SidePush {
    /// Force along the heading, to the left and upwards `[N]`.
    pub(super) force_x: f64,
    pub(super) force_y: f64,
    pub(super) force_z: f64,
    /// Torque that the motor needs \[N m\].
    pub(super) torque: f64,
}

/// Passive force on a length of a wall, and its depth below the undisturbed soil.
#[derive(Debug, Clone, Copy)]
struct Passive {
    per_length: f64,
    depth: f64,
}

impl SideWall {
    /// Creates a wall of a strength and `tan(δ)`; `None` if the wheel does not move sideways.
    /// [`Rejection::InvalidParameter`] if a parameter is negative, or the density is unknown.
    pub(super) fn new(
        [scale, friction]: [f64; 2],
        soil: &Soil,
        radius: f64,
        [density, gravity]: [f64; 2],
        condition: &Condition,
    ) -> Result<Option<Self>, Rejection> {
        let not_negative =
            |name, value: f64| require(value >= 0.0, name, value, "(dimensionless)", "at least 0");
        not_negative("passive_scale", scale)?;
        not_negative("wall_friction", friction)?;
        let bound = "known, and above 0, where the side of the wheel pushes soil";
        require(density > 0.0, "density_kg_m3", density, "kg/m^3", bound)?;
        let wall = Self {
            scale,
            friction,
            unit_weight: density * gravity,
            root_n: libm::tan(0.25 * core::f64::consts::PI + 0.5 * soil.friction_angle_rad),
            cohesion: soil.cohesion_pa,
            radius,
        };
        Ok((condition.slip_angle_rad.abs() > 0.0).then_some(wall))
    }

    /// Returns the soil's push with the hub at a height, at the place of the contact.
    pub(super) fn push(
        &self,
        contact: &Contact,
        terrain: &Terrain,
        (pose, hub): (Pose, f64),
        motion: &Motion,
        law: &ShearVelocity,
    ) -> SidePush {
        let mut push = SidePush::default();
        let half = (self.radius * self.radius - hub * hub).max(0.0).sqrt();
        let column = |ahead: f64| ((pose.x + ahead) / terrain.dx).max(0.0) as usize;
        let share = motion.lateral.abs() / libm::hypot(motion.forward, motion.lateral);
        let against = if motion.lateral > 0.0 { -1.0 } else { 1.0 };
        for column in column(-half)..(column(half) + 1).min(terrain.columns) {
            let ahead = terrain.x(column) - pose.x;
            let height = self.radius * self.radius - ahead * ahead;
            let depth = height.max(0.0).sqrt() - hub;
            if depth <= 0.0 {
                continue;
            }
            let heap = self.heap(contact, terrain, column, depth, motion.lateral > 0.0);
            let passive = self.passive(depth, heap);
            let normal = self.scale * passive.per_length * share * terrain.dx;
            let rise = hub + passive.depth;
            let [along, _, up] = motion.surface_velocity(ahead, rise);
            let rubs = self.friction * normal * law.mobilised_per_velocity(libm::hypot(along, up));
            let (x, z) = (-rubs * along, -rubs * up);
            push.force_x += x;
            push.force_y += against * normal;
            push.force_z += z;
            push.torque += rise * x + ahead * z;
        }
        push
    }

    /// Returns the passive force per length on a wall of a depth, with soil of a mean height above its wedge.
    fn passive(&self, depth: f64, heap: f64) -> Passive {
        let n = self.root_n * self.root_n;
        let weight = 0.5 * n * self.unit_weight * depth * depth;
        let even = n * self.unit_weight * heap * depth + 2.0 * self.cohesion * depth * self.root_n;
        let per_length = weight + even;
        // the pressure from the weight grows with depth, the rest is uniform
        let arm = (2.0 / 3.0 * weight + 0.5 * even) / per_length.max(f64::MIN_POSITIVE);
        Passive {
            per_length,
            depth: arm * depth,
        }
    }

    /// Returns the mean height of the raised soil above the wedge beside a column of the wheel `[m]`; hollows do not
    /// count.
    fn heap(&self, contact: &Contact, terrain: &Terrain, column: usize, depth: f64, on_left: bool) -> f64 {
        let across = &contact.across;
        let reach = depth * self.root_n / terrain.dy;
        let column_surface = &terrain.surface[column * terrain.lanes..(column + 1) * terrain.lanes];
        let raised = |(lane, &height): (usize, &f64)| height.max(0.0) * (reach - lane as f64).clamp(0.0, 1.0);
        let lanes = libm::ceil(reach) as usize;
        let sum: f64 = if on_left {
            let beside = column_surface[across.first_lane + across.lanes..].iter();
            beside.take(lanes).enumerate().map(raised).sum()
        } else {
            let beside = column_surface[..across.first_lane].iter().rev();
            beside.take(lanes).enumerate().map(raised).sum()
        };
        sum / reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{CONDITION, SOIL, WHEEL};

    const AT_AN_ANGLE: Condition = Condition {
        slip_angle_rad: 0.3,
        ..CONDITION
    };

    fn wall(cohesion_pa: f64, friction: f64) -> SideWall {
        let soil = Soil { cohesion_pa, ..SOIL };
        let gravity = [1500.0, 9.81];
        let wall = SideWall::new([1.0, friction], &soil, WHEEL.radius_m, gravity, &AT_AN_ANGLE);
        wall.expect("a wall").expect("an angle")
    }

    /// Returns a wheel in the middle of a terrain whose lanes beside it have a height on the left.
    fn beside(heap: f64) -> (Contact, Terrain) {
        let mut terrain = Terrain::new(0.001, 0.004, -0.158, 600, 80, false);
        let mut contact = Contact::default();
        contact.across.lay(&terrain, 0.0, WHEEL.width_m);
        let left = contact.across.first_lane + contact.across.lanes;
        for column in terrain.surface.chunks_exact_mut(80) {
            column[left..].fill(heap);
        }
        (contact, terrain)
    }

    fn push(wall: &SideWall, heap: f64, sinkage: f64, slip_angle_rad: f64) -> SidePush {
        let (contact, terrain) = beside(heap);
        let condition = Condition {
            slip_angle_rad,
            ..CONDITION
        };
        let (x, y, turned) = (0.3, 0.0, 0.0);
        let place = (Pose { x, y, turned }, WHEEL.radius_m - sinkage);
        let motion = Motion::new(&WHEEL, &condition);
        wall.push(&contact, &terrain, place, &motion, &ShearVelocity::new(1e-3))
    }

    #[test]
    fn a_vertical_wall_meets_rankines_passive_force() {
        // tan(45° + 30°/2)² = 3: 3 (1/2 · 1000 · 0.04 + 1000 · 0.2 · 0.2) + 2 · 100 · 0.2 · √3
        let wall = SideWall {
            scale: 1.0,
            friction: 0.0,
            unit_weight: 1000.0,
            root_n: 3f64.sqrt(),
            cohesion: 100.0,
            radius: 1.0,
        };
        let got = wall.passive(0.2, 0.2).per_length;
        assert!((got - (180.0 + 40.0 * 3f64.sqrt())).abs() < 1e-9, "{got}");
        let bare = SideWall {
            cohesion: 0.0,
            ..wall
        };
        let [one, two] = [0.1, 0.2].map(|depth| bare.passive(depth, 0.0));
        assert!((two.per_length / one.per_length - 4.0).abs() < 1e-12);
        assert!((two.depth - 0.4 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_buried_segment_of_the_side_has_its_closed_form() {
        let (r, sinkage, heap) = (WHEEL.radius_m, 0.02, 0.006);
        let hub = r - sinkage;
        let half = (r * r - hub * hub).sqrt();
        // integrals of h and h² along the chord
        let disc = r * r * (half / r).asin() + half * hub;
        let first = disc - 2.0 * hub * half;
        let second = 2.0 * (r * r * half - half.powi(3) / 3.0) - 2.0 * hub * disc + 2.0 * hub * hub * half;
        let n = (0.25 * std::f64::consts::PI + 0.25_f64).tan().powi(2);
        let weight = 1500.0 * 9.81;
        for cohesion in [0.0, 400.0] {
            let expected = 0.3_f64.sin()
                * (n * weight * (0.5 * second + heap * first) + 2.0 * cohesion * n.sqrt() * first);
            let got = push(&wall(cohesion, 0.0), heap, sinkage, 0.3);
            assert!((got.force_y / expected + 1.0).abs() < 1e-3, "{got:?} {expected}");
            assert_eq!((got.force_x, got.force_z, got.torque), (0.0, 0.0, 0.0));
        }
    }

    #[test]
    fn left_mirrors_right_and_only_the_side_in_front_feels_its_heap() {
        let wall = wall(100.0, 0.3);
        let (left, right) = (push(&wall, 0.0, 0.02, 0.3), push(&wall, 0.0, 0.02, -0.3));
        assert_eq!(left.force_y.to_bits(), (-right.force_y).to_bits());
        let rest = |push: &SidePush| (push.force_x, push.force_z, push.torque);
        assert_eq!(rest(&left), rest(&right));
        assert!(left.force_y < 0.0 && left.torque != 0.0);
        assert!(push(&wall, 0.005, 0.02, 0.3).force_y < left.force_y);
        assert_eq!(push(&wall, 0.005, 0.02, -0.3), right);
    }

    #[test]
    fn a_wheel_that_goes_straight_has_no_wall_and_a_soil_of_unknown_density_none_either() {
        let new = |density, condition: &Condition| {
            SideWall::new([1.0, 0.3], &SOIL, 0.1, [density, 9.81], condition)
        };
        assert!(new(1500.0, &CONDITION).expect("no refusal").is_none());
        let message = new(f64::NAN, &AT_AN_ANGLE).expect_err("a refusal").to_string();
        let begin = "invalid parameter: density_kg_m3 = NaN kg/m^3 must be";
        assert!(message.starts_with(begin), "{message}");
    }
}

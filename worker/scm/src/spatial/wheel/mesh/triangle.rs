//! A triangle of the wheel's surface, and its place after a rotation of the wheel.

use core::f64::consts::{PI, TAU};

/// Component of a unit normal below which a triangle counts as vertical, or a surface has no normal.
const VERTICAL: f64 = 1e-9;
/// Largest slope with which a triangle presses; see `Normals::Surface`.
const STEEPEST: f64 = 10.0;

/// A triangle that faces down at some angle of rotation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    /// x, y, z with the wheel at rest `[m]`.
    pub(super) corners: [[f64; 3]; 3],
    /// Unit normal with the wheel at rest.
    normal: [f64; 3],
    /// Largest distance from the axle `[m]`.
    pub(super) reach: f64,
    /// Largest y `[m]`.
    pub(super) left: f64,
    /// Middle of the angles about the axle from straight down, positive forward, in [0, 2π), and half their extent `[rad]`.
    pub(super) angle: f64,
    pub(super) half_span: f64,
}

/// A triangle of the turned wheel: ahead of the hub, to its left and below it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// Ahead, y and rise of the corners, from rear to front `[m]`.
    pub(super) corners: [[f64; 3]; 3],
    /// d rise/dx and d rise/dy on its plane.
    pub(super) descent: [f64; 2],
    /// Slopes dh/dx and dh/dy with which it presses.
    pub(super) slopes: [f64; 2],
    pub(super) min_rise: f64,
    pub(super) max_rise: f64,
}

impl Triangle {
    /// Returns `None` if the triangle has no area, or is vertical at every rotation.
    pub(super) fn new(corners: [[f64; 3]; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let side = |from: [f64; 3], to: [f64; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let (u, v) = (side(a, b), side(a, c));
        let cross = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let area = length(cross);
        let extent = length(u) * length(v);
        if area <= VERTICAL * extent || libm::hypot(cross[0], cross[2]) <= VERTICAL * area {
            return None;
        }
        let turn = |p: [f64; 3]| libm::atan2(p[0], -p[2]);
        let first = turn(a);
        let wrapped = |angle: f64| angle - TAU * libm::round(angle / TAU);
        let (second, third) = (wrapped(turn(b) - first), wrapped(turn(c) - first));
        let (low, high) = (second.min(third).min(0.0), second.max(third).max(0.0));
        let middle = first + 0.5 * (low + high);
        // beyond half a turn the triangle lies about the axle
        let half_span = if high - low < PI { 0.5 * (high - low) } else { PI };
        Some(Self {
            corners,
            normal: cross.map(|n| n / area),
            reach: corners
                .iter()
                .fold(0.0_f64, |far, p| far.max(libm::hypot(p[0], p[2]))),
            left: corners.iter().fold(f64::MIN, |left, p| left.max(p[1])),
            angle: middle - TAU * libm::floor(middle / TAU),
            half_span,
        })
    }

    /// Returns its place after a forward turn of the wheel by an angle; `None` if it is vertical.
    #[inline]
    pub(super) fn turn(&self, sin: f64, cos: f64) -> Option<Placed> {
        let turn = |[x, y, z]: [f64; 3]| [x * cos + z * sin, y, x * sin - z * cos];
        let [ahead, aside, down] = turn(self.normal);
        if down.abs() <= VERTICAL {
            return None;
        }
        let [mut a, mut b, mut c] = self.corners.map(turn);
        if a[0] > b[0] {
            (a, b) = (b, a);
        }
        if b[0] > c[0] {
            (b, c) = (c, b);
        }
        if a[0] > b[0] {
            (a, b) = (b, a);
        }
        let (x, y) = (ahead / down, aside / down);
        let steepness = (x * x + y * y).sqrt();
        let share = if steepness > STEEPEST {
            STEEPEST / steepness
        } else {
            1.0
        };
        Some(Placed {
            corners: [a, b, c],
            descent: [-x, -y],
            slopes: [share * x, share * y],
            min_rise: a[2].min(b[2]).min(c[2]),
            max_rise: a[2].max(b[2]).max(c[2]),
        })
    }
}

impl Placed {
    /// Returns the rearmost and foremost place ahead of the hub `[m]`.
    pub(super) fn rear(&self) -> f64 {
        self.corners[0][0]
    }

    pub(super) fn front(&self) -> f64 {
        self.corners[2][0]
    }
}

//! The conditions that a rig can set, as points of a space.

use shared::experiment::rim_speed_m_s;
use shared::model::RunCondition;

use crate::hidden_effect::study::design::PlannedRun;

/// Slip, logarithm of the load and logarithm of the rim speed, each scaled from 0 to 1 over the possible runs.
type Point = [f64; 3];

/// The possible runs as points.
pub struct Space {
    least: Point,
    range: Point,
    possible: Vec<Point>,
}

fn raw(slip: f64, wheel_load_n: f64, sled_speed_m_s: f64) -> Point {
    [slip, wheel_load_n.ln(), rim_speed_m_s(slip, sled_speed_m_s).ln()]
}

impl Space {
    pub fn new(possible: &[RunCondition]) -> Self {
        let raw = possible
            .iter()
            .map(|c| raw(c.slip, c.wheel_load_n, c.sled_speed_m_s));
        let raw: Vec<Point> = raw.collect();
        let extreme = |fold: fn(f64, f64) -> f64, first: f64| {
            std::array::from_fn(|k| raw.iter().map(|point| point[k]).fold(first, fold))
        };
        let least: Point = extreme(f64::min, f64::INFINITY);
        let greatest: Point = extreme(f64::max, f64::NEG_INFINITY);
        let range = std::array::from_fn(|k| (greatest[k] - least[k]).max(f64::MIN_POSITIVE));
        let possible = Vec::new();
        let mut space = Self {
            least,
            range,
            possible,
        };
        space.possible = raw.iter().map(|point| space.scaled(point)).collect();
        space
    }

    fn scaled(&self, raw: &Point) -> Point {
        std::array::from_fn(|k| (raw[k] - self.least[k]) / self.range[k])
    }

    /// Returns the order of the possible runs in which each is the one farthest from all earlier ones and from the runs already made.
    pub fn filling(&self, made: &[PlannedRun]) -> Vec<usize> {
        let scaled = |row: &PlannedRun| self.scaled(&raw(row.slip, row.wheel_load_n, row.sled_speed_m_s));
        let mut taken: Vec<Point> = made.iter().map(scaled).collect();
        let mut order = Vec::new();
        while order.len() < self.possible.len() {
            let distance = |k: &usize| {
                let squares = taken.iter().map(|other| {
                    let pairs = self.possible[*k].iter().zip(other);
                    pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
                });
                squares.fold(f64::INFINITY, f64::min)
            };
            let left = (0..self.possible.len()).filter(|k| !order.contains(k));
            let Some(next) = left.reduce(|a, b| if distance(&b) > distance(&a) { b } else { a }) else {
                break;
            };
            taken.push(self.possible[next]);
            order.push(next);
        }
        order
    }
}

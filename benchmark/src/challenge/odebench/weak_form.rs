//! The equations of motion, multiplied by test functions and integrated by parts, so that no derivative of a measurement is needed.

use nalgebra::{DMatrix, DVector};

use super::super::dynamic_system::State;
use super::measured::{Measured, POINTS};
use super::smoothing::smoothed;

/// Measurements between the knots of the test functions, which are cubic B-splines.
const KNOT_DISTANCE: usize = 5;
/// Test functions of a trajectory: one about each knot, and one beyond either end.
const FUNCTIONS: usize = POINTS / KNOT_DISTANCE + 3;

/// Integrals of test functions over both trajectories, in numbers that the noise of the measurements makes independent, each with sd 1.
///
/// The integral of a test function p times a rate f on a trajectory x from 0 to T is p(T) x(T) - p(0) x(0) less the integral of p' x.
/// The integral of the rate is computed on smooth states, whose errors are neglected, and what it equals on the measurements. Integrals are those of
/// Simpson's rule.
#[derive(Debug)]
pub struct WeakForm {
    /// Functions by points: turns rates on a trajectory into whitened integrals.
    weights: DMatrix<f64>,
    /// What the integrals equal by the measurements of each state over its sd, whitened.
    sides: Vec<DVector<f64>>,
    sds: State,
}

/// Returns the cubic B-spline about 0 with knots at whole numbers, and its derivative.
fn spline(u: f64) -> [f64; 2] {
    let a = u.abs();
    let sign = if u < 0.0 { -1.0 } else { 1.0 };
    if a < 1.0 {
        [
            2.0 / 3.0 - a * a + 0.5 * a * a * a,
            sign * (-2.0 * a + 1.5 * a * a),
        ]
    } else if a < 2.0 {
        let rest = 2.0 - a;
        [rest * rest * rest / 6.0, -0.5 * sign * rest * rest]
    } else {
        [0.0, 0.0]
    }
}

impl WeakForm {
    /// Integrates measurements, and returns the smooth states of both trajectories, too; `None` if they have no smooth curve.
    pub fn new(measured: &Measured, dimension: usize) -> Option<(Self, Vec<State>)> {
        let simpson = |k: usize| match k {
            0 | POINTS => measured.interval / 3.0,
            _ => measured.interval / 3.0 * (2.0 + 2.0 * (k % 2) as f64),
        };
        let knot = KNOT_DISTANCE as f64;
        let at = |j: usize, k: usize| spline(k as f64 / knot - (j as f64 - 1.0));
        let of_rates = DMatrix::from_fn(FUNCTIONS, POINTS + 1, |j, k| simpson(k) * at(j, k)[0]);
        let of_values = DMatrix::from_fn(FUNCTIONS, POINTS + 1, |j, k| {
            let [value, slope] = at(j, k);
            let end = match k {
                0 => -value,
                POINTS => value,
                _ => 0.0,
            };
            end - simpson(k) * slope / (knot * measured.interval)
        });
        let noisy = of_values.columns(1, POINTS);
        let root = (noisy * noisy.transpose()).cholesky()?;
        let whitened = |matrix: &DMatrix<f64>| root.l_dirty().solve_lower_triangular(matrix);
        let (weights, of_values) = (whitened(&of_rates)?, whitened(&of_values)?);
        let mut points = vec![State::default(); 2 * (POINTS + 1)];
        let mut sides = Vec::with_capacity(dimension);
        for k in 0..dimension {
            let mut side = Vec::with_capacity(2 * FUNCTIONS);
            for (trajectory, states) in measured.values.iter().enumerate() {
                let values: Vec<f64> = states.iter().map(|state| state[k]).collect();
                let smooth = smoothed(values[0], &values[1..], measured.sds[k])?;
                let first = trajectory * (POINTS + 1);
                smooth
                    .iter()
                    .enumerate()
                    .for_each(|(i, y)| points[first + i][k] = *y);
                side.extend((&of_values * DVector::from_vec(values) / measured.sds[k]).iter());
            }
            sides.push(DVector::from_vec(side));
        }
        let form = Self {
            weights,
            sides,
            sds: measured.sds,
        };
        Some((form, points))
    }

    /// Returns the whitened integrals of a function of time on both trajectories, for sd 1.
    pub fn integrals(&self, values: &[f64]) -> DVector<f64> {
        let mut integrals = DVector::zeros(2 * FUNCTIONS);
        for (trajectory, values) in values.chunks(POINTS + 1).enumerate() {
            let mut part = integrals.rows_mut(trajectory * FUNCTIONS, FUNCTIONS);
            part.gemv(1.0, &self.weights, &DVector::from_column_slice(values), 0.0);
        }
        integrals
    }

    /// Returns the sd by which an integral in an equation is divided.
    pub fn sd(&self, equation: usize) -> f64 {
        self.sds[equation]
    }

    /// Returns the number of integrals in each equation.
    pub fn count() -> usize {
        2 * FUNCTIONS
    }

    /// Returns the integrals less the right sides, all states one after the other; `None` where a rate is not finite.
    ///
    /// # Arguments
    /// - `states`: of both trajectories, one after the other.
    pub fn residuals(&self, states: &[State], rates: impl Fn(&State) -> State) -> Option<Vec<f64>> {
        let rates: Vec<State> = states.iter().map(rates).collect();
        let mut residuals = Vec::with_capacity(self.sides.len() * Self::count());
        for (k, side) in self.sides.iter().enumerate() {
            let values: Vec<f64> = rates.iter().map(|rate| rate[k]).collect();
            let integrals = self.integrals(&values) / self.sds[k];
            residuals.extend((integrals - side).iter());
        }
        let is_finite = residuals.iter().all(|r: &f64| r.is_finite());
        is_finite.then_some(residuals)
    }
}

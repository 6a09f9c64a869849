//! The quadratic model of an objective, and its damped minimum in a box.

use nalgebra::{Cholesky, DMatrix, DVector};

/// g' p + p' H p / 2 for steps p between `lower` and `upper`, 0 among them.
#[derive(Debug, Clone)]
pub struct QuadraticModel {
    /// Gradient, by axis.
    pub gradient: Vec<f64>,
    /// Second derivatives, symmetric.
    pub hessian: DMatrix<f64>,
    /// Distance that each axis may move down: 0 or less.
    pub lower: Vec<f64>,
    /// Distance that each axis may move up: 0 or more.
    pub upper: Vec<f64>,
    /// Axes that do not move.
    pub held: Vec<bool>,
}

impl QuadraticModel {
    /// Minimises the parabola within the box after adding `damping D` to H, with D = max(diagonal of H, 1); returns `None` if it
    /// has no minimum. D is Marquardt's scale, but damps each axis at least as much as a prior of one width would.
    ///
    /// The method is an active set: an axis at a bound does not move if the parabola falls outwards there. If the minimum lies
    /// beyond bounds, the axis that meets its bound first along the step is fixed at the bound, and the other axes are solved
    /// again.
    pub fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let count = self.gradient.len();
        let mut step = vec![0.0; count];
        let mut free: Vec<usize> = (0..count)
            .filter(|&k| {
                let pushes_out = (self.lower[k] >= 0.0 && self.gradient[k] > 0.0)
                    || (self.upper[k] <= 0.0 && self.gradient[k] < 0.0);
                !self.held[k] && !pushes_out
            })
            .collect();
        while !free.is_empty() {
            let solved = self.solve(&free, &step, damping)?;
            // The axis that meets its bound first, and the share of the step at which it does.
            let mut first: Option<(usize, f64)> = None;
            for (position, &k) in free.iter().enumerate() {
                let target = solved[position];
                let bound = if target > self.upper[k] {
                    self.upper[k]
                } else if target < self.lower[k] {
                    self.lower[k]
                } else {
                    continue;
                };
                let share = bound / target;
                if first.is_none_or(|(_, lowest)| share < lowest) {
                    first = Some((position, share));
                    step[k] = bound;
                }
            }
            let Some((position, _)) = first else {
                for (position, &k) in free.iter().enumerate() {
                    step[k] = solved[position];
                }
                break;
            };
            free.remove(position);
            for &k in &free {
                step[k] = 0.0;
            }
        }
        Some(step)
    }

    /// Returns the free components of the minimum, given the other components.
    fn solve(&self, free: &[usize], step: &[f64], damping: f64) -> Option<Vec<f64>> {
        let matrix = DMatrix::from_fn(free.len(), free.len(), |row, column| {
            let (k, l) = (free[row], free[column]);
            let extra = if k == l {
                damping * self.hessian[(k, k)].max(1.0)
            } else {
                0.0
            };
            self.hessian[(k, l)] + extra
        });
        let right = DVector::from_fn(free.len(), |row, _| {
            let k = free[row];
            let moved: f64 = (0..step.len())
                .filter(|l| !free.contains(l))
                .map(|l| self.hessian[(k, l)] * step[l])
                .sum();
            -self.gradient[k] - moved
        });
        let solved: Vec<f64> = Cholesky::new(matrix)?.solve(&right).iter().copied().collect();
        solved.iter().all(|x| x.is_finite()).then_some(solved)
    }

    /// Returns the standard deviation along each axis, marginal over the other axes, from the curvature; `None` for axes that do
    /// not move, and for all axes if the parabola has no minimum.
    pub fn uncertainty(&self) -> Vec<Option<f64>> {
        let moving: Vec<usize> = (0..self.held.len()).filter(|&k| !self.held[k]).collect();
        let mut uncertainty = vec![None; self.held.len()];
        let matrix = DMatrix::from_fn(moving.len(), moving.len(), |i, j| {
            self.hessian[(moving[i], moving[j])]
        });
        if let Some(cholesky) = Cholesky::new(matrix) {
            let inverse = cholesky.inverse();
            for (i, &k) in moving.iter().enumerate() {
                uncertainty[k] = Some(inverse[(i, i)].sqrt());
            }
        }
        uncertainty
    }

    /// Returns the decrease of the undamped parabola at a step.
    pub fn decrease(&self, step: &[f64]) -> f64 {
        let mut decrease = 0.0;
        for (k, component) in step.iter().enumerate() {
            let pull: f64 = (0..step.len()).map(|l| self.hessian[(k, l)] * step[l]).sum();
            decrease -= component * (self.gradient[k] + 0.5 * pull);
        }
        decrease
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parabola(gradient: [f64; 2], upper: [f64; 2]) -> QuadraticModel {
        QuadraticModel {
            gradient: gradient.to_vec(),
            hessian: DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 2.0]),
            lower: vec![-10.0; 2],
            upper: upper.to_vec(),
            held: vec![false; 2],
        }
    }

    fn near(step: Option<Vec<f64>>, expected: [f64; 2]) {
        let step = step.unwrap();
        assert!(
            step.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12),
            "{step:?}, not {expected:?}"
        );
    }

    #[test]
    fn a_step_inside_the_box_is_newton_s() {
        // H p = (6, 5): p = (1, 2).
        let parabola = parabola([-6.0, -5.0], [10.0; 2]);
        near(parabola.step(0.0), [1.0, 2.0]);
        assert!((parabola.decrease(&[1.0, 2.0]) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn a_step_over_a_bound_ends_there_and_the_other_axis_makes_the_best_of_it() {
        // With p_2 = 1: 4 p_1 = 6 - 1.
        near(parabola([-6.0, -5.0], [10.0, 1.0]).step(0.0), [1.25, 1.0]);
    }

    #[test]
    fn an_axis_at_its_bound_stays_while_the_slope_points_outwards_and_leaves_when_it_does_not() {
        near(parabola([-6.0, -5.0], [10.0, 0.0]).step(0.0), [1.5, 0.0]);
        near(parabola([-6.0, 16.0], [10.0, 0.0]).step(0.0), [4.0, -10.0]);
        near(parabola([-6.0, 12.5], [10.0, 0.0]).step(0.0), [3.5, -8.0]);
    }

    #[test]
    fn damping_shortens() {
        let parabola = parabola([-6.0, -5.0], [10.0; 2]);
        let length = |damping| parabola.step(damping).unwrap().iter().map(|p| p * p).sum::<f64>();
        assert!(length(1.0) < length(0.1) && length(0.1) < length(0.0));
    }
}

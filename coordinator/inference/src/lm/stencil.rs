//! The stencil of a Jacobian: the finite differences that it is computed from.

use super::objective::Column;
use crate::point_estimate::PriorAxis;

/// The sides of the differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sides {
    /// One side, away from a bound: enough for the direction of descent.
    One,
    /// Both sides, within the bounds: no error from the model's curvature.
    Both,
}

/// A rejected difference is repeated on the other side, then on both sides with its length times this factor.
const SHORTER: f64 = 0.25;

/// The measured differences around a point.
#[derive(Debug, Clone)]
pub(super) struct Stencil {
    axes: Vec<Differences>,
    /// The differences of the round: axis and offset.
    asked: Vec<(usize, f64)>,
}

/// The differences along one axis.
#[derive(Debug, Clone, Default)]
struct Differences {
    /// Offset and predicted values there.
    measured: Vec<(f64, Vec<f64>)>,
    /// Offsets within the bounds that have not been tried, the preferred first.
    untried: Vec<f64>,
}

impl Stencil {
    /// Makes a stencil around a position, with a step for each axis.
    pub(super) fn new(axes: &[PriorAxis], position: &[f64], steps: &[f64]) -> Self {
        let differences = |((axis, &t), &step): ((&PriorAxis, &f64), &f64)| {
            let inside = |offset: &f64| (axis.lower..=axis.upper).contains(&(t + offset));
            let untried = [step, -step, SHORTER * step, -SHORTER * step];
            Differences {
                measured: Vec::new(),
                untried: untried.into_iter().filter(inside).collect(),
            }
        };
        Self {
            axes: axes.iter().zip(position).zip(steps).map(differences).collect(),
            asked: Vec::new(),
        }
    }

    /// Asks for the missing differences: one along every axis or, two-sided, a second one on the other side.
    ///
    /// # Returns
    /// Axis and offset of every difference; empty when none is missing or left to try.
    pub(super) fn ask(&mut self, sides: Sides) -> &[(usize, f64)] {
        self.asked.clear();
        for (k, axis) in self.axes.iter().enumerate() {
            let first = axis.measured.first().map(|(offset, _)| *offset);
            let across = |from: f64| axis.untried.iter().copied().find(|offset| offset * from < 0.0);
            match (first, axis.measured.len(), sides) {
                (None, ..) => {
                    let first = axis.untried.first().copied();
                    self.asked.extend(first.map(|offset| (k, offset)));
                    let second = first.and_then(across).filter(|_| sides == Sides::Both);
                    self.asked.extend(second.map(|offset| (k, offset)));
                }
                (Some(offset), 1, Sides::Both) => {
                    self.asked.extend(across(offset).map(|offset| (k, offset)));
                }
                _ => {}
            }
        }
        &self.asked
    }

    /// Takes the predicted values at the asked differences, in their order; `None` where the model rejected.
    pub(super) fn accept(&mut self, answers: Vec<Option<Vec<f64>>>) {
        for ((k, offset), answer) in self.asked.drain(..).zip(answers) {
            let axis = &mut self.axes[k];
            axis.untried.retain(|untried| (untried - offset).abs() > 0.0);
            axis.measured.extend(answer.map(|values| (offset, values)));
        }
    }

    /// Returns whether an axis has no difference yet and offsets left to try.
    pub(super) fn is_incomplete(&self) -> bool {
        self.axes
            .iter()
            .any(|axis| axis.measured.is_empty() && !axis.untried.is_empty())
    }

    /// Returns the columns of the Jacobian. With differences at a and, on the other side, b: the slope of the parabola through
    /// all three points: `(b^2 (m_a - m) - a^2 (m_b - m)) / (a b (b - a))`.
    pub(super) fn columns(&self, predicted: &[f64]) -> Vec<Column> {
        let column = |axis: &Differences| match axis.measured.as_slice() {
            [] => None,
            [(a, at_a)] => Some(at_a.iter().zip(predicted).map(|(x, m)| (x - m) / a).collect()),
            [(a, at_a), (b, at_b), ..] => {
                let divisor = a * b * (b - a);
                let (weight_a, weight_b) = (b * b / divisor, a * a / divisor);
                let values = at_a.iter().zip(at_b).zip(predicted);
                Some(
                    values
                        .map(|((x, y), m)| weight_a * (x - m) - weight_b * (y - m))
                        .collect(),
                )
            }
        };
        self.axes.iter().map(column).collect()
    }
}

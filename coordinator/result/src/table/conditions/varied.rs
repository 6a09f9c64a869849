//! The conditions that a set of runs varies, as coordinates.

use job::{levels_of, load_levels_of, repeats};
use shared::experiment::TestRun;

use super::axis::Axis;
use crate::words::number;

/// Minimum number of levels of a condition that are left out in turn.
const MIN_LEVELS: usize = 3;

/// The conditions that a set of runs varies, and those that it holds constant.
#[derive(Debug)]
pub(crate) struct Conditions {
    /// Conditions that vary.
    pub axes: Vec<Axis>,
    held: Vec<Axis>,
    runs: Vec<TestRun>,
}

impl Conditions {
    pub(crate) fn new(runs: &[&TestRun]) -> Self {
        let (axes, held) = Axis::distinguishing(runs)
            .into_iter()
            .partition(|axis| axis.varies(runs));
        Conditions {
            axes,
            held,
            runs: runs.iter().map(|&run| run.clone()).collect(),
        }
    }

    /// Returns the coordinates of a run.
    pub(crate) fn point(&self, run: &TestRun) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.value(run)).collect()
    }

    /// Returns the mean coordinates of repeats.
    pub(crate) fn mean_point(&self, repeats: &[&TestRun]) -> Vec<f64> {
        let mean =
            |axis: &Axis| repeats.iter().map(|run| axis.value(run)).sum::<f64>() / repeats.len() as f64;
        self.axes.iter().map(mean).collect()
    }

    /// Returns the numbers of the points at each level of each condition that varies, level by level. A condition with fewer than three
    /// levels has none here: without one of two levels, the other says nothing of how values change with it.
    ///
    /// # Arguments
    /// - `points`: coordinates as [`Conditions::point`] has them.
    pub(crate) fn levels(&self, points: &[Vec<f64>]) -> Vec<Vec<usize>> {
        let of_axis = |(k, axis): (usize, &Axis)| -> Vec<Vec<usize>> {
            let values: Vec<f64> = points.iter().map(|point| point[k]).collect();
            let of_point = match axis {
                Axis::WheelLoad => load_levels_of(&values),
                _ => levels_of(&values),
            };
            let count = of_point.iter().max().map_or(0, |last| last + 1);
            let members = |level: usize| (0..points.len()).filter(|&i| of_point[i] == level).collect();
            match count < MIN_LEVELS {
                true => Vec::new(),
                false => (0..count).map(members).collect(),
            }
        };
        self.axes.iter().enumerate().flat_map(of_axis).collect()
    }

    /// Names of the conditions that vary, as a list in a sentence.
    pub(crate) fn names(&self) -> String {
        let names: Vec<String> = self.axes.iter().map(|axis| axis.words().to_owned()).collect();
        number::list(&names)
    }

    /// Says why a run cannot be predicted: the fitted runs have only one level of a condition, and it has another. `None` if it can.
    /// Loads that scatter because the rig does not hold them count as one level.
    ///
    /// # Arguments
    /// - `subject`: the noun that begins the sentence.
    pub(crate) fn reason_beside(&self, subject: &str, run: &TestRun) -> Option<String> {
        let is_fitted = |axis: &Axis| self.runs.iter().any(|fitted| axis.is_same(fitted, run));
        let axis = *self.held.iter().find(|axis| !is_fitted(axis))?;
        let fitted: Vec<&TestRun> = self.runs.iter().collect();
        if axis != Axis::WheelLoad || axis.count(&fitted) == 1 {
            return Some(format!("{subject} was fitted at one {} alone", axis.words()));
        }
        let loads = || fitted.iter().map(|run| axis.value(run));
        let ends = [
            loads().fold(f64::INFINITY, f64::min),
            loads().fold(f64::NEG_INFINITY, f64::max),
        ];
        let [min, max] = ends.map(|load| number::significant(load, 3));
        Some(format!("{subject} was fitted at loads of {min} to {max} N alone"))
    }
}

/// Groups the indices of runs by condition; a run joins the first group that it repeats.
pub(crate) fn repeated(runs: &[&TestRun]) -> Vec<Vec<usize>> {
    let mut conditions: Vec<Vec<usize>> = Vec::new();
    for (i, run) in runs.iter().enumerate() {
        match conditions
            .iter_mut()
            .find(|members| repeats(runs[members[0]], run))
        {
            Some(members) => members.push(i),
            None => conditions.push(vec![i]),
        }
    }
    conditions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_level_holds_the_points_that_share_it_and_two_levels_are_not_left_out() {
        let calibration = fixture::calibration();
        let run = |slip: f64, angle: f64| TestRun {
            slip,
            slip_angle_deg: angle,
            ..calibration.spec.experiment.runs[0].clone()
        };
        let runs = [(0.1, 0.0), (0.102, 30.0), (0.5, 0.0), (0.9, 30.0)].map(|(slip, angle)| run(slip, angle));
        let runs: Vec<&TestRun> = runs.iter().collect();
        let conditions = Conditions::new(&runs);
        assert_eq!(conditions.axes, [Axis::Slip, Axis::SlipAngle]);
        let points: Vec<Vec<f64>> = runs.iter().map(|run| conditions.point(run)).collect();
        assert_eq!(conditions.levels(&points), [vec![0, 1], vec![2], vec![3]]);
    }
}

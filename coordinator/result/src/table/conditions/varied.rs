//! The conditions that a set of runs varies, as coordinates.

use job::repeats;
use shared::experiment::TestRun;

use super::axis::Axis;
use crate::words::number;

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

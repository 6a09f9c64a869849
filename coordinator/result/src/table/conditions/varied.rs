//! The conditions of some runs as coordinates.

use job::repeats;
use shared::experiment::TestRun;

use super::axis::Axis;
use crate::words::number;

/// The conditions in which some runs differ, and those in which they do not.
#[derive(Debug)]
pub(crate) struct Conditions {
    /// Those that vary.
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

    /// The coordinates of a run.
    pub(crate) fn point(&self, run: &TestRun) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.value(run)).collect()
    }

    /// The mean coordinates of repeats.
    pub(crate) fn mean_point(&self, repeats: &[&TestRun]) -> Vec<f64> {
        let mean =
            |axis: &Axis| repeats.iter().map(|run| axis.value(run)).sum::<f64>() / repeats.len() as f64;
        self.axes.iter().map(mean).collect()
    }

    /// Names of those that vary, as a list in a sentence.
    pub(crate) fn names(&self) -> String {
        let names: Vec<String> = self.axes.iter().map(|axis| axis.words().to_owned()).collect();
        number::list(&names)
    }

    /// Why nothing is known of a run that stands beside the one level of a condition; `None` of one that does not. The loads of a rig
    /// that does not hold them are one level, and scatter.
    ///
    /// # Arguments
    /// - `of`: what the runs are of, to begin the sentence with.
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

/// The numbers of the runs of each condition; a run joins the first that it repeats.
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

//! The runs whose repeats are compared, with their conditions and ids.

use std::collections::BTreeSet;

use job::{load_levels_of, repeats_but_for_load, repeats_earlier_column};
use shared::experiment::{Experiment, RigColumn, TestRun};

use super::RepeatedQuantity;

/// Runs with a value and an id, of one wheel or of wheels that share ids.
pub(super) struct ComparedRuns<'a> {
    /// The wheel; `None` for several.
    pub(super) wheel: Option<&'a str>,
    pub(super) runs: Vec<&'a TestRun>,
    /// The value of each run, in SI units.
    pub(super) values: Vec<f64>,
    /// Index of each run's condition.
    pub(super) conditions: Vec<usize>,
    /// Index of each run's id.
    pub(super) groups: Vec<usize>,
    pub(super) ids: Vec<&'a str>,
}

impl<'a> ComparedRuns<'a> {
    /// Returns the fitted runs by wheel, or together if wheels share ids and the quantity is the wheel load. Wheels with one id are left out.
    ///
    /// One sensor measures the load of every wheel, but each wheel sinks in its own way.
    pub(super) fn parts(
        experiment: &'a Experiment,
        fit_runs: &[usize],
        quantity: RepeatedQuantity,
        column: RigColumn,
    ) -> Vec<Self> {
        let runs = fit_runs.iter().map(|&i| &experiment.runs[i]);
        let runs: Vec<&TestRun> = runs
            .filter(|run| column.id(run).is_some() && quantity.value(run).is_some())
            .collect();
        if runs.is_empty() || repeats_earlier_column(&runs, column) {
            return Vec::new();
        }
        let wheels: BTreeSet<&str> = runs.iter().map(|run| run.wheel.as_str()).collect();
        let is_shared = runs.iter().any(|a| {
            runs.iter()
                .any(|b| a.wheel != b.wheel && column.id(a) == column.id(b))
        });
        let mut parts = Vec::new();
        if quantity == RepeatedQuantity::WheelLoad && is_shared {
            parts.push(Self::new(None, runs, quantity, column));
        } else {
            for wheel in wheels {
                let runs = runs.iter().copied().filter(|run| run.wheel == wheel);
                parts.push(Self::new(Some(wheel), runs.collect(), quantity, column));
            }
        }
        parts.retain(|part| part.ids.len() > 1);
        parts
    }

    fn new(
        wheel: Option<&'a str>,
        runs: Vec<&'a TestRun>,
        quantity: RepeatedQuantity,
        column: RigColumn,
    ) -> Self {
        let ids = runs.iter().filter_map(|run| column.id(run));
        let (groups, ids) = numbered(&ids.collect::<Vec<_>>(), |a, b| a == b);
        let loads: Vec<f64> = runs.iter().map(|run| run.wheel_load_n).collect();
        // The load that a run states must not decide which runs it is compared with, because it is one of the quantities.
        let settings: Vec<(&TestRun, usize)> = runs.iter().copied().zip(load_levels_of(&loads)).collect();
        let (conditions, _) = numbered(&settings, |a, b| a.1 == b.1 && repeats_but_for_load(a.0, b.0));
        ComparedRuns {
            wheel,
            values: runs.iter().filter_map(|run| quantity.value(run)).collect(),
            runs,
            conditions,
            groups,
            ids,
        }
    }
}

/// Returns for each item the number of the first distinct item that it is the same as, and the distinct items.
fn numbered<T: Copy>(items: &[T], is_same: impl Fn(&T, &T) -> bool) -> (Vec<usize>, Vec<T>) {
    let mut distinct: Vec<T> = Vec::new();
    let number = |item: &T| {
        distinct
            .iter()
            .position(|first| is_same(first, item))
            .unwrap_or_else(|| {
                distinct.push(*item);
                distinct.len() - 1
            })
    };
    let numbers = items.iter().map(number).collect();
    (numbers, distinct)
}

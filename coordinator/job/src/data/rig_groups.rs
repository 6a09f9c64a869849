//! Fitted runs that share a preparation of the soil, a session, a taring or an operator.

use shared::experiment::{Experiment, RigColumn, TestRun};

/// Returns the fitted runs by preparation, as positions among them; none if no run names one. A run without an id is a
/// preparation with one run.
pub(crate) fn preparations(experiment: &Experiment, fit_runs: &[usize]) -> Vec<Vec<usize>> {
    by_id(&fitted(experiment, fit_runs), |run| run.prepared.as_deref())
}

/// Returns the groups of runs that share an error of the rig; none if there is one group, whose error is part of the parameters, or
/// if an earlier column has the same groups, whose errors it could not be told from.
pub(crate) fn rig_groups(experiment: &Experiment, fit_runs: &[usize], column: RigColumn) -> Vec<Vec<usize>> {
    let runs = fitted(experiment, fit_runs);
    let groups = by_id(&runs, |run| column.id(run));
    match groups.len() < 2 || repeats_earlier_column(&runs, column) {
        true => Vec::new(),
        false => groups,
    }
}

/// Returns whether an earlier column groups the runs in the same way. A run without an id is a group with one run; a column without ids
/// has no groups.
pub fn repeats_earlier_column(runs: &[&TestRun], column: RigColumn) -> bool {
    let groups = by_id(runs, |run| column.id(run));
    let mut earlier = RigColumn::ALL
        .into_iter()
        .take_while(|earlier| *earlier != column);
    !groups.is_empty() && earlier.any(|earlier| by_id(runs, |run| earlier.id(run)) == groups)
}

fn fitted<'a>(experiment: &'a Experiment, fit_runs: &[usize]) -> Vec<&'a TestRun> {
    fit_runs.iter().map(|&run| &experiment.runs[run]).collect()
}

fn by_id<'a>(runs: &[&'a TestRun], id: impl Fn(&'a TestRun) -> Option<&'a str>) -> Vec<Vec<usize>> {
    let mut groups: Vec<(Option<&str>, Vec<usize>)> = Vec::new();
    for (position, run) in runs.iter().enumerate() {
        let id = id(run);
        match groups
            .iter_mut()
            .find(|(known, _)| known.is_some() && *known == id)
        {
            Some((_, positions)) => positions.push(position),
            None => groups.push((id, vec![position])),
        }
    }
    match groups.iter().any(|(id, _)| id.is_some()) {
        true => groups.into_iter().map(|(_, positions)| positions).collect(),
        false => Vec::new(),
    }
}

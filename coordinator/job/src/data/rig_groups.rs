//! Fitted runs that share a preparation of the soil, a session, a taring or an operator.

use shared::experiment::{Experiment, RigColumn, TestRun};

/// Returns the fitted runs by preparation, as positions among them; none if no run names one. A run without an id is a
/// preparation with one run.
pub(crate) fn preparations(experiment: &Experiment, fit_runs: &[usize]) -> Vec<Vec<usize>> {
    by_id(experiment, fit_runs, |run| run.prepared.as_deref())
}

/// Returns the fitted runs by the id of a column, as positions among them; none if no run names one. A run without an id stands alone.
pub(crate) fn by_column(experiment: &Experiment, fit_runs: &[usize], column: RigColumn) -> Vec<Vec<usize>> {
    by_id(experiment, fit_runs, |run| column.id(run))
}

/// Returns the groups of runs that share an error of the rig; none if there is one group, whose error is part of the parameters, or
/// if an earlier column has the same groups, whose errors it could not be told from.
pub(crate) fn rig_groups(experiment: &Experiment, fit_runs: &[usize], column: RigColumn) -> Vec<Vec<usize>> {
    let groups = by_column(experiment, fit_runs, column);
    let earlier = RigColumn::ALL
        .into_iter()
        .take_while(|earlier| *earlier != column);
    let mut earlier = earlier.map(|earlier| by_column(experiment, fit_runs, earlier));
    match groups.len() < 2 || earlier.any(|earlier| earlier == groups) {
        true => Vec::new(),
        false => groups,
    }
}

fn by_id<'a>(
    experiment: &'a Experiment,
    fit_runs: &[usize],
    id: impl Fn(&'a TestRun) -> Option<&'a str>,
) -> Vec<Vec<usize>> {
    let mut groups: Vec<(Option<&str>, Vec<usize>)> = Vec::new();
    for (position, &i) in fit_runs.iter().enumerate() {
        let id = id(&experiment.runs[i]);
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

//! The planned runs behind a decision: those of its options, and those that could be made before it.

use job::{ConditionDefaults, Decision, PlannedCondition, PlannedRun};

use crate::error::PredictionError;

/// Slips of the curve on which the slip of an option without a stated slip is found.
const CURVE: [f64; 21] = [
    0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.24, 0.28, 0.32, 0.36, 0.4, 0.44, 0.48, 0.52, 0.56, 0.6, 0.64, 0.68,
    0.72, 0.76, 0.8,
];
/// Slip of the run that an option without a stated slip proposes.
const PROPOSED_SLIP: f64 = 0.3;

/// The planned runs of a decision by what they are for, as positions.
#[derive(Debug, Clone, Default)]
pub struct Scenarios {
    /// The runs of each option: none, one at its slip, or a curve over slip.
    pub options: Vec<Vec<usize>>,
    /// The runs that could be made.
    pub runs: Vec<usize>,
}

/// Returns the planned runs of a decision.
///
/// An option whose condition states no slip climbs its slope with the slip at which its pull balances the weight, so that its runs are a
/// curve over slip. Where the decision states no further runs, those of its options could be made, on level ground.
///
/// # Errors
/// [`PredictionError::Request`] names the option or the run.
pub fn decision_runs(
    decision: &Decision,
    defaults: &ConditionDefaults<'_>,
) -> Result<(Vec<PlannedRun>, Scenarios), PredictionError> {
    let mut planned: Vec<PlannedRun> = Vec::new();
    let mut scenarios = Scenarios::default();
    for option in &decision.options {
        let fail =
            |e: String| PredictionError::Request(format!("[decision] option \"{}\": {e}", option.name));
        let Some(condition) = &option.condition else {
            scenarios.options.push(Vec::new());
            continue;
        };
        let slips = if condition.slip.is_some() {
            &[0.0][..]
        } else {
            &CURVE
        };
        let first = planned.len();
        for &slip in slips {
            planned.push(defaults.run(condition, &option.name, Some(slip)).map_err(fail)?);
        }
        scenarios.options.push((first..planned.len()).collect());
    }
    let of_options = || {
        decision
            .options
            .iter()
            .filter_map(|option| option.condition.as_ref())
    };
    let proposed: Vec<PlannedCondition> = match decision.runs.is_empty() {
        false => decision.runs.clone(),
        true => of_options()
            .map(|condition| PlannedCondition {
                slope_deg: None,
                ..condition.clone()
            })
            .collect(),
    };
    let mut known: Vec<PlannedCondition> = Vec::new();
    for (number, condition) in proposed.into_iter().enumerate() {
        if known.contains(&condition) {
            continue;
        }
        let fail = |e: String| PredictionError::Request(format!("[decision] run {}: {e}", number + 1));
        let name = format!("n{}", known.len() + 1);
        scenarios.runs.push(planned.len());
        let run = defaults.run(&condition, &name, Some(PROPOSED_SLIP));
        planned.push(run.map_err(fail)?);
        known.push(condition);
    }
    Ok((planned, scenarios))
}

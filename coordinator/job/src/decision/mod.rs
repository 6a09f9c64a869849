//! The table `[decision]`: options, what each would cost, and what must hold.
//!
//! # Layout
//! - here: [`Decision`], the table as a value.
//! - `quantity`: the quantities that formulas name. `formula`: losses and statements over them.
//! - `condition`: conditions that were not measured.

mod condition;
mod formula;
mod quantity;

use schemars::JsonSchema;
use serde::Deserialize;

pub use condition::{ConditionDefaults, PlannedCondition, PlannedRun};
pub use formula::{QuantityFormula, Statement};
pub use quantity::{QUANTITIES, Quantity, QuantityValues, position_of, predicted_quantities};

/// Largest number of options.
const MAX_OPTIONS: usize = 50;
/// Largest number of further runs.
const MAX_RUNS: usize = 200;

/// A decision between options under uncertainty.
#[derive(Debug, Clone)]
pub struct Decision {
    /// The options, in the order of the file; at least two.
    pub options: Vec<DecisionOption>,
    /// What must hold for an option with a condition.
    pub constraints: Vec<Constraint>,
    /// Cost of one more run, in the unit of the loss.
    pub run_cost: Option<f64>,
    /// The runs that could be made before the decision.
    pub runs: Vec<PlannedCondition>,
}

/// An option.
#[derive(Debug, Clone)]
pub struct DecisionOption {
    /// Name, unique in the decision.
    pub name: String,
    /// The condition under which the wheel would run; `None` if it would not run.
    pub condition: Option<PlannedCondition>,
    /// The loss.
    pub loss: QuantityFormula,
}

/// A statement that must hold with a probability.
#[derive(Debug, Clone)]
pub struct Constraint {
    /// The statement.
    pub statement: Statement,
    /// The least probability with which it must hold.
    pub probability: f64,
}

/// A decision between options.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawDecision {
    /// What an option costs: a formula over the channels of its run and what follows from them.
    loss: Option<String>,
    /// Cost of one more run, in the unit of the loss.
    #[schemars(range(min = 0))]
    run_cost: Option<f64>,
    /// The options.
    #[schemars(length(min = 2, max = MAX_OPTIONS))]
    options: Vec<RawOption>,
    /// What must hold.
    #[serde(default)]
    constraints: Vec<RawConstraint>,
    /// Runs that could be made before the decision; by default, those of the options.
    #[serde(default)]
    #[schemars(length(max = MAX_RUNS))]
    runs: Vec<PlannedCondition>,
}

/// An option.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RawOption {
    /// Name of the option.
    name: String,
    /// Condition of its run; without one, the wheel does not run.
    condition: Option<PlannedCondition>,
    /// What this option costs, in place of the loss of all.
    loss: Option<String>,
}

/// A statement that must hold with a probability.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RawConstraint {
    /// The statement, as in `"net_pull_n > 0"`.
    statement: String,
    /// The least probability with which it must hold.
    #[schemars(range(min = 0, max = 1))]
    probability: f64,
}

impl RawDecision {
    /// Returns the decision.
    ///
    /// # Errors
    /// A sentence that names the option or constraint.
    pub(crate) fn decision(self) -> Result<Decision, String> {
        let count = self.options.len();
        if !(2..=MAX_OPTIONS).contains(&count) {
            return Err(format!("{count} options must be 2 to {MAX_OPTIONS}"));
        }
        if self.runs.len() > MAX_RUNS {
            let count = self.runs.len();
            return Err(format!("{count} runs must be at most {MAX_RUNS}"));
        }
        if let Some(run) = self.runs.iter().position(|run| run.slip.is_none()) {
            return Err(format!("runs: number {} states no slip", run + 1));
        }
        if let Some(cost) = self.run_cost.filter(|cost| !(cost.is_finite() && *cost >= 0.0)) {
            return Err(format!("run_cost {cost} must be >= 0"));
        }
        let loss = self.loss;
        let option = |raw: RawOption| {
            let text = raw.loss.as_ref().or(loss.as_ref());
            let text = text.ok_or_else(|| format!("option \"{}\" has no loss", raw.name))?;
            let read = QuantityFormula::read(text);
            let formula = read.map_err(|e| format!("loss of option \"{}\": {e}", raw.name))?;
            Ok::<_, String>(DecisionOption {
                name: raw.name,
                condition: raw.condition,
                loss: formula,
            })
        };
        let options: Vec<DecisionOption> = self.options.into_iter().map(option).collect::<Result<_, _>>()?;
        for (i, option) in options.iter().enumerate() {
            if options[..i].iter().any(|other| other.name == option.name) {
                return Err(format!("option \"{}\" appears twice", option.name));
            }
        }
        let constraint = |raw: RawConstraint| {
            let read = Statement::read(&raw.statement);
            let statement = read.map_err(|e| format!("constraint \"{}\": {e}", raw.statement))?;
            match (0.0..=1.0).contains(&raw.probability) {
                true => Ok(Constraint {
                    statement,
                    probability: raw.probability,
                }),
                false => Err(format!(
                    "constraint \"{}\": probability {} must lie in [0, 1]",
                    raw.statement, raw.probability
                )),
            }
        };
        let constraints = self.constraints.into_iter().map(constraint);
        Ok(Decision {
            options,
            constraints: constraints.collect::<Result<_, _>>()?,
            run_cost: self.run_cost,
            runs: self.runs,
        })
    }
}

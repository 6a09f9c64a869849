//! The answer to a decision.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::ensemble::ModelWeight;

/// Expected losses of the options of a decision, and what a further run would change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct DecisionAnswer {
    /// Id of the calibration.
    pub calibration: i64,
    /// Number of draws of each model.
    pub draws: usize,
    /// The models of the study with their weights.
    pub models: Vec<ModelWeight>,
    /// The options, in the order of the decision.
    pub options: Vec<OptionLoss>,
    /// The option with the least expected loss of those whose constraints hold; null if no option's do.
    pub best: Option<String>,
    /// The second best option; null if there is none.
    pub second: Option<String>,
    /// Expected loss of the second best option less that of the best.
    pub margin: Option<f64>,
    /// Standard error of the margin by the number of draws.
    pub margin_se: Option<f64>,
    /// Probability that no other option has a smaller mean loss, over parameters and models.
    pub probability_best: Option<f64>,
    /// The option that the most probable parameters alone would choose, without uncertainty and errors.
    pub best_at_mode: Option<String>,
    /// What the difference between the two best options comes from; null with less than two.
    pub decided_by: Option<DecidedBy>,
    /// The fall of the expected loss if parameters and model were known. No run is worth more than this.
    pub perfect_information: Option<f64>,
    /// Cost of one more run.
    pub run_cost: Option<f64>,
    /// What each further run is worth, the most valuable first.
    pub runs: Vec<RunValue>,
    /// What limits these numbers, in sentences.
    pub notes: Vec<String>,
}

/// The loss of an option.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct OptionLoss {
    /// Name of the option.
    pub name: String,
    /// Expected loss over parameters, models and errors.
    pub expected_loss: f64,
    /// Its standard error by the number of draws.
    pub expected_loss_se: f64,
    /// 5 % and 95 % quantile of the loss of one run.
    pub interval: [f64; 2],
    /// Loss at the most probable parameters, without errors; null if it has none.
    pub loss_at_mode: Option<f64>,
    /// Probability that no slip balances the slope; null of an option that states its slip or does not run.
    pub stuck: Option<f64>,
    /// Mean slip of the run where the wheel is not stuck; null of an option that does not run.
    pub slip: Option<f64>,
    /// What lies outside the range of the fitted runs, in phrases, at the mean slip of an option that finds its slip; empty within it.
    pub beyond: Vec<String>,
    /// Whether all constraints hold with their probabilities; an option that does not run has none.
    pub is_feasible: bool,
    /// The constraints.
    pub constraints: Vec<ConstraintProbability>,
}

/// The probability with which a constraint holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ConstraintProbability {
    /// The statement.
    pub statement: String,
    /// Probability for one new run.
    pub probability: f64,
    /// The least probability that the decision asks for.
    pub needed: f64,
}

/// What the difference of the losses of two options comes from, as shares of its variance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct DecidedBy {
    /// Standard deviation of the difference for one run.
    pub sd: f64,
    /// Share of what differs between models.
    pub model: f64,
    /// Share of the parameters within models.
    pub parameters: f64,
    /// Share of errors, which are the same for both options: noise, scatter of the soil, discrepancy. No run reduces it.
    pub noise: f64,
    /// Parameters of the most probable model by what each explains alone, the greatest first.
    pub each: Vec<ParameterShare>,
}

/// What one parameter explains of a difference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ParameterShare {
    /// Name of the parameter.
    pub parameter: String,
    /// Squared correlation with the mean difference at each draw of the most probable model.
    pub share: f64,
}

/// The value of one more run before the decision.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RunValue {
    /// Name of the run.
    pub run: String,
    /// Name of the wheel.
    pub wheel: String,
    /// Slip.
    pub slip: f64,
    /// Load normal to the ground `[N]`.
    pub wheel_load_n: f64,
    /// Speed of travel `[m/s]`.
    pub sled_speed_m_s: f64,
    /// The fall of the least expected loss that the run is expected to bring.
    pub value: f64,
    /// Standard error of the value by the number of draws.
    pub value_se: f64,
    /// Mean effective number of draws after a measurement of the run; below 10 the value is too large.
    pub effective_draws: f64,
    /// Whether the value exceeds the cost of a run; null without a cost.
    pub is_worth_its_cost: Option<bool>,
}

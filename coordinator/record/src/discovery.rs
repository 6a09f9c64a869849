//! The result of a search for a missing effect, as stored and as shown in summary, report and terminal.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::outside::Outside;
use job::{EffectOnNodes, effect_name};
use shared::channel::Channel;

/// Name of the explanation that nothing is missing.
pub const NONE: &str = "none";
/// Name of the explanation that a law outside the library is missing.
pub const NOT_IN_LIBRARY: &str = "not_in_library";
/// Maximum number of proposed test runs.
pub const NEXT_RUNS: usize = 3;

/// The verdict of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No explanation beats the searched model by 3 nats, or the most probable explanation is that nothing is missing.
    NothingDetectable,
    /// One effect has a probability above 0.9.
    Named,
    /// Effects that these data cannot distinguish have a joint probability above 0.9.
    Class,
    /// A law outside the library is missing; its quantity and variable are known.
    NotInLibrary,
    /// Something is missing, and the data do not decide what.
    Undecided,
}

/// The result of the search of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Discovery {
    /// The effects of the searched model.
    pub given: Vec<String>,
    /// The verdict of a search.
    pub verdict: Verdict,
    /// The verdict as a sentence for a test engineer.
    pub text: String,
    /// The parameter of the searched model that the best explanation puts where its prior nearly excludes it: nothing is claimed then.
    #[serde(default)]
    pub implausible: Option<ImplausibleParameter>,
    /// The parameters of inferred noise sds that are too uncertain for a claim: nothing is claimed then.
    #[serde(default)]
    pub unsupported_noise: Vec<String>,
    /// The effect to add, if the verdict names one, or if it is open but evidence and prediction of left-out levels have the same
    /// best set: the leading effect of that set.
    pub extension: Option<Extension>,
    /// Effects of the model that no longer improve its evidence.
    pub drop: Vec<String>,
    /// Leading effects in the place of effects of the model, by falling probability. Absent from records of earlier versions.
    #[serde(default)]
    pub replacements: Vec<JudgedReplacement>,
    /// Every explanation by falling probability, with `none` and, if it was searched, `not_in_library`.
    pub effects: Vec<JudgedEffect>,
    /// Every model that was compared, by falling probability; an effect's probability is the sum over the sets that it leads.
    #[serde(default)]
    pub sets: Vec<JudgedSet>,
    /// Chi-square of the best explanation over its degrees of freedom, 1 where it fits: a set's probability is proportional to
    /// `prior exp(log_bayes_factor / misfit)`.
    #[serde(default = "fits")]
    pub misfit: f64,
    /// Whether the best explanation fits the declared noise; null where the noise is not known.
    #[serde(default)]
    pub complete: Option<bool>,
    /// The share of the searched model's excess chi-square that the best explanation removes; null without an excess.
    #[serde(default)]
    pub explained: Option<f64>,
    /// The channels that the best explanation leaves unexplained, the worst first.
    #[serde(default)]
    pub remaining: Vec<RemainingMisfit>,
    /// The leading candidate of a search that names none, if the most probable sets with it gain more than 3 nats and nothing speaks
    /// against their parameters. It may serve predictions. Null in records of earlier versions.
    #[serde(default)]
    pub leading: Option<Extension>,
    /// The law outside the library, if that is the verdict.
    pub outside: Option<Outside>,
    /// Effects that are not detectable with these data at their usual strength.
    pub cannot_exclude: Vec<String>,
    /// Effects that the model rejected at every strength, or from all starts of a fit.
    pub refused: Vec<String>,
    /// Effects that need a value missing in the experiment: they are weighed with typical values, and never named.
    #[serde(default)]
    pub not_tried: Vec<NotTried>,
    /// Test runs that together distinguish the remaining explanations best; each is chosen given those before it.
    pub next_runs: Vec<NextRun>,
    /// The information of every proposed run when made alone. Absent where no explanations are compared, in records of earlier
    /// versions, and from `summary.json`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub information: Vec<RunInformation>,
    /// The predictions of the fitted measurements by each explanation; absent from records of earlier versions, and from `summary.json`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curves: Option<EffectCurves>,
    /// Tests without a rolling wheel that would distinguish the explanations.
    pub other_tests: Vec<String>,
    /// The errors that runs share, by falling probability, beside the best explanation; empty if no column of the runs states what they
    /// share.
    #[serde(default)]
    pub rig: Vec<JudgedRigError>,
    /// Numerical noise sd of each channel by its column, in its unit, which counts as noise of the data; empty where it is negligible.
    #[serde(default)]
    pub numerical_noise: BTreeMap<String, f64>,
    /// Goodness of fit of the searched model.
    pub chi2: ChiSquare,
    /// Goodness of fit with the best explanation.
    pub chi2_best: ChiSquare,
    /// Number of evaluations until the effect had a name.
    pub evaluations_to_name: u64,
    /// Number of all evaluations.
    pub evaluations: u64,
}

/// An effect in the place of an effect of the searched model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct JudgedReplacement {
    /// Name of the effect.
    pub effect: String,
    /// Name of the effect of the model that is left out.
    pub in_place_of: String,
    /// Log evidence over that of the searched model.
    pub log_bayes_factor: f64,
    /// Probability among the replacements and all sets.
    pub probability: f64,
    /// Whether the verdict names the effect in this place.
    pub is_named: bool,
}

/// A parameter that contradicts its prior.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ImplausibleParameter {
    /// Name of the parameter.
    pub name: String,
    /// Normal score of its value in its prior, beyond 6.5 in size, or 5 of a strength, or 2 of a strength of the searched model of which the
    /// leading explanation would be more; with a joint prior, given the parameters before it.
    pub prior_sds: f64,
}

/// An addition to a model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Extension {
    /// An effect of the catalogue.
    Effect(String),
    /// An effect of the catalogue on one wheel of several.
    OnWheel {
        /// Name of the effect.
        effect: String,
        /// Name of the wheel.
        wheel: String,
    },
    /// An effect file: its name and its text.
    File {
        /// Name of the file.
        name: String,
        /// Content of the file.
        text: String,
    },
}

/// One explanation with its probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct JudgedEffect {
    /// The effect, `EFFECT.WHEEL` on one wheel of several; or `none`, or `not_in_library`.
    pub name: String,
    /// What the effect of one of the job's candidate files does, in a line; absent for the catalogue's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub summary: Option<String>,
    /// Log evidence over that of the searched model, with the stated prior of its strength \[nats\].
    pub log_bayes_factor: f64,
    /// Distance of the fitted strength from the middle of its prior, in standard deviations; null for `none` and `not_in_library`.
    #[serde(default)]
    pub prior_sds: Option<f64>,
    /// Posterior probability among all explanations.
    pub probability: f64,
    /// Whether the probability stays above 0.9 with the priors of all strengths half and twice as wide, and with prior odds of 1 to 4 and
    /// 4 to 1 that nothing is missing; null where it is not above 0.9, and in records of earlier versions.
    #[serde(default)]
    pub robust: Option<bool>,
    /// Number of the class, in which these data cannot distinguish explanations; 0 is `none`.
    pub class: u32,
    /// Whether its class belongs to the smallest set of classes with 95 % probability.
    pub in_credible_set: bool,
    /// The prior of its strength, as in its file.
    pub strength_prior: Option<String>,
    /// Parameters at the best fit of this explanation, SI.
    pub parameters: BTreeMap<String, f64>,
    /// Units of the parameters by name; empty in records of earlier versions.
    #[serde(default)]
    pub units: BTreeMap<String, String>,
    /// How the evidence was computed: `screen`, `rank_one`, `polished`, `confirmed` or `sampled`.
    pub method: String,
}

/// A model that explains the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct JudgedSet {
    /// The effects; `none` or `not_in_library` alone. A law outside the library beyond effects is named by quantity, variable and form.
    pub members: Vec<String>,
    /// Log evidence over that of the searched model, with widened priors of the strengths \[nats\].
    pub log_bayes_factor: f64,
    /// Prior probability.
    pub prior: f64,
    /// Posterior probability.
    pub probability: f64,
    /// Log predictive density of left-out levels over that of the searched model, each measurement counted once \[nats\]; null where
    /// it was not computed.
    pub predictive: Option<f64>,
}

/// The misfit of a channel under the best explanation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RemainingMisfit {
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Root mean square of measured less predicted values, in declared noise sds.
    pub noise_sds: f64,
    /// Number of measured values.
    pub values: u64,
    /// The condition with which they correlate: `slip`, `wheel_load`, `rim_speed`, `sled_speed` or `order`; null where none does.
    pub along: Option<String>,
    /// Correlation with the condition.
    pub correlation: Option<f64>,
}

/// What the data say of an error that runs share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct JudgedRigError {
    /// Key of its sd under `[noise]`, as `session_sinkage_m`; or `wear_` with a column, or `guide_friction`.
    pub name: String,
    /// Unit of sd and offsets; 1 if they are relative.
    pub unit: String,
    /// Log evidence with the error over that without it.
    pub log_bayes_factor: f64,
    /// Probability that it acts; one half before the data.
    pub probability: f64,
    /// Posterior mean of its sd if it acts.
    pub sd: f64,
    /// The error of each group of runs.
    pub offsets: Vec<RigOffset>,
}

/// The error that a group of runs shares.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RigOffset {
    /// Id of the session, taring or operator; the name of the run where it states none. For wear the session from which the
    /// change counts.
    pub id: String,
    /// Posterior mean.
    pub mean: f64,
    /// Posterior sd.
    pub sd: f64,
}

impl JudgedRigError {
    /// `session_sinkage_m: sd 0.00041 m, P 0.998`.
    #[must_use]
    pub fn words(&self) -> String {
        let unit = if self.unit == "1" { "" } else { &self.unit };
        format!("{}: sd {} {unit}", self.name, shared::limit::number(self.sd))
            .trim_end()
            .to_owned()
            + &format!(", P {:.3}", self.probability)
    }
}

impl RemainingMisfit {
    /// `sinkage (3.2 noise sds over 24 values; measured less predicted falls with slip)`.
    #[must_use]
    pub fn words(&self) -> String {
        let trend = self
            .along
            .as_ref()
            .zip(self.correlation)
            .map(|(along, correlation)| {
                let moves = if correlation > 0.0 { "rises" } else { "falls" };
                format!(
                    "; measured less predicted {moves} with {}",
                    along.replace('_', " ")
                )
            });
        format!(
            "{} ({:.1} noise sds over {} values{})",
            self.channel.name().replace('_', " "),
            self.noise_sds,
            self.values,
            trend.unwrap_or_default()
        )
    }
}

/// Returns the misfit of an explanation that fits.
fn fits() -> f64 {
    1.0
}

/// An effect that needs a value that the experiment, or an external model, does not state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct NotTried {
    /// The effect, `EFFECT.WHEEL` on one wheel of several.
    pub name: String,
    /// The missing quantity, and the value that is assumed to weigh the effect.
    pub why: String,
    /// The line of the experiment that would state the missing property, or the runs that would show it: `runs at a slip angle`.
    pub needs: String,
}

impl NotTried {
    /// The need of an effect that no line of an experiment satisfies: a model that shows its contact.
    pub const OUR_MODEL: &str = "kind = \"quasi_static\" or \"scm\" under [model]";

    /// Prefix of `needs` if runs are missing instead of a line.
    pub const RUNS: &str = "runs ";

    /// Returns whether a line of the experiment would state, or runs would show, the missing quantity.
    pub fn lacks_data(&self) -> bool {
        self.needs != Self::OUR_MODEL
    }

    /// Returns whether runs would show the missing quantity.
    pub fn lacks_runs(&self) -> bool {
        self.needs.starts_with(Self::RUNS)
    }
}

/// A proposed test run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct NextRun {
    /// Slip of the run.
    pub slip: f64,
    /// Wheel load of the run.
    pub wheel_load_n: f64,
    /// Sled speed of the run.
    pub sled_speed_m_s: f64,
    /// The explanations that it distinguishes.
    pub separates: Vec<String>,
    /// Expected information on the explanations in addition to that of the runs before it in the list \[nats\].
    pub information_nats: f64,
    /// Probability that the run, made alone, raises one of the explanations above 0.9; absent from older records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settles: Option<f64>,
}

/// The information of a test run when made alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct RunInformation {
    /// Slip of the run.
    pub slip: f64,
    /// Wheel load of the run.
    pub wheel_load_n: f64,
    /// Sled speed of the run.
    pub sled_speed_m_s: f64,
    /// Expected information on the explanations that remain \[nats\].
    pub nats: f64,
}

/// The predictions of a wheel's fitted measurements by the explanations, to six digits, SI.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct EffectCurves {
    /// The measurements, in the order of every list of values.
    pub data: Vec<CurveDatum>,
    /// The searched model at its best fit.
    pub base: Vec<f64>,
    /// Values by the name of the explanation: the model with the effect at its best fit; for an effect that was only screened,
    /// linear about the base's fit; for `not_in_library`, the best law outside the library.
    pub effects: BTreeMap<String, Vec<f64>>,
}

/// A fitted measurement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct CurveDatum {
    /// Name of the run.
    pub run: String,
    /// Channel that was measured.
    #[schema(value_type = String)]
    pub channel: Channel,
}

impl Discovery {
    /// Returns the replacement that the verdict names.
    pub fn named_replacement(&self) -> Option<&JudgedReplacement> {
        self.replacements.iter().find(|replacement| replacement.is_named)
    }

    /// Removes the parts that only pictures use.
    #[must_use]
    pub fn without_curves(self) -> Self {
        Discovery {
            curves: None,
            information: Vec::new(),
            ..self
        }
    }
}

/// Squared residuals in units of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ChiSquare {
    /// Sum of the squares; null if the noise was inferred from the residuals.
    pub value: Option<f64>,
    /// Number of data minus the effective number of fitted parameters.
    pub degrees_of_freedom: f64,
    /// p-value of the fit.
    pub p: Option<f64>,
}

/// Returns the name of an extension as a candidate; `EFFECT.WHEEL` for an effect on one wheel of several.
pub fn addition_name(extension: &Extension) -> String {
    match extension {
        Extension::OnWheel { effect, wheel } => format!("{effect}.{wheel}"),
        Extension::Effect(_) | Extension::File { .. } => effect_of(extension),
    }
}

/// Returns the name of the effect that an extension adds.
pub fn effect_of(extension: &Extension) -> String {
    match extension {
        Extension::Effect(effect) | Extension::OnWheel { effect, .. } => effect.clone(),
        Extension::File { name, text } => effect_name(text).unwrap_or_else(|| name.clone()),
    }
}

/// Returns the parts of a model that an extension adds: its effect and, if the effect keeps its displacement on the nodes, that setting.
pub fn parts_of(extension: &Extension) -> Vec<String> {
    parts_of_effect(&effect_of(extension))
}

/// Returns the parts that an effect of this name adds.
pub fn parts_of_effect(effect: &str) -> Vec<String> {
    match EffectOnNodes::find(effect) {
        Some(on_nodes) => vec![on_nodes.effect.name.clone(), on_nodes.setting.name.to_owned()],
        None => vec![effect.to_owned()],
    }
}

//! The formulas that the curve of a law outside the library may follow, in classes that the data cannot tell apart.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A class below this probability is not named in a sentence.
const NAMED: f64 = 0.1;
/// Maximum number of classes in a sentence.
const MAX_NAMED: usize = 3;

/// The formulas of a law, weighed by its curve with the covariance of the knots; the leading ones by the measurements, through the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct LawFormulas {
    /// The leading classes by falling probability, which have 0.95 together, or the first five.
    pub classes: Vec<FormulaClass>,
    /// Probability of all other classes.
    pub others: f64,
    /// Number of formulas that were fitted to the curve.
    pub fitted: u64,
    /// Number of the formulas, the most probable by the curve, that were fitted to the measurements through the model, and are weighed by
    /// that; 0 of a model that is too expensive for it.
    #[serde(default)]
    pub through_model: u64,
    /// Where the first two classes differ most; null with one class, and where no condition tells them apart by two standard deviations.
    pub splitting: Option<SplittingCondition>,
}

/// Formulas that differ by less than half a standard deviation of the curve over the whole range of the variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FormulaClass {
    /// Probability of the class among all formulas, given that the law is a formula of one variable.
    pub probability: f64,
    /// The members: the simplest, then the others by falling probability.
    pub members: Vec<LawFormula>,
    /// What the simplest member says of large values of the variable.
    pub above: String,
    /// What it says of the variable near 0; null where the range begins at 0 or below.
    pub below: Option<String>,
    /// The effect file of the simplest member, ready to be added.
    pub effect_file: String,
}

/// A formula of a law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct LawFormula {
    /// The quantity with the law, as a formula of effect files, with fitted values.
    pub formula: String,
    /// Probability among all formulas.
    pub probability: f64,
}

/// A condition at which two classes differ most.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SplittingCondition {
    /// Value of the variable, from half the lowest to twice the highest that the runs reach.
    pub at: f64,
    /// Unit of the variable.
    pub unit: String,
    /// What the first two classes say there: the factor on a stress, or the addition to a channel in its SI unit.
    pub laws: [f64; 2],
    /// Difference in standard deviations: of both formulas, and of a run that shows the law as well as the curve does.
    pub sds: f64,
}

impl LawFormulas {
    /// Returns the sentence on the formula, without a full stop: `the curve is one of: ...`.
    ///
    /// # Arguments
    /// - `variable`: the variable in words.
    #[must_use]
    pub fn words(&self, variable: &str) -> Option<String> {
        let leading = self.classes.iter().take(MAX_NAMED);
        let leading: Vec<&FormulaClass> = leading
            .enumerate()
            .filter(|(place, class)| *place == 0 || class.probability > NAMED)
            .map(|(_, class)| class)
            .collect();
        let classes: Vec<String> = leading.iter().map(|class| class.words()).collect();
        let list = match classes.as_slice() {
            [] => return None,
            [one] => format!("as a formula the curve is {one}"),
            several => format!("as a formula the curve is one of: {}", several.join("; or ")),
        };
        let named: f64 = leading.iter().map(|class| class.probability).sum();
        let rest = if named < 1.0 - NAMED {
            format!("; or another (P {:.2})", 1.0 - named)
        } else {
            String::new()
        };
        let split = self.splitting.as_ref().filter(|_| classes.len() > 1);
        let split = split.map_or(String::new(), |split| {
            let unit = if split.unit == "1" { String::new() } else { format!(" {}", split.unit) };
            format!(
                "; the first two differ most at a {variable} of {}{unit} ({} and {}, {:.1} sds): a run there would split them",
                shared::limit::number(split.at),
                shared::limit::number(split.laws[0]),
                shared::limit::number(split.laws[1]),
                split.sds
            )
        });
        Some(format!("{list}{rest}{split}"))
    }
}

impl FormulaClass {
    /// `tau * (1 + 0.3 * tanh(j / 0.01)) (P 0.72 with 2 alike; tends to a factor of 1.3)`.
    fn words(&self) -> String {
        let Some((simplest, alike)) = self.members.split_first() else {
            return String::new();
        };
        let alike = match alike.len() {
            0 => String::new(),
            count => format!(" with {count} alike"),
        };
        format!(
            "{} (P {:.2}{alike}; {})",
            simplest.formula, self.probability, self.above
        )
    }
}

//! The formulas that the curve of a law may follow: their candidates, which are fitted through the model, and their record.

use discovery::{Candidate, FormulaFit, LawCurve};
use equation::{
    Answer, FormulaClass, FormulaLibrary, FormulaText, Host, Limit, LocatedCurve, WeighedFit, answer, fits,
    probabilities, ranked, splitting,
};
use formula::Effect;
use job::free_parameters;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use record::{Extension, LawFormula, LawFormulas, SplittingCondition};

use super::dependence::Dependence;
use super::formula_file::{DIGITS, effect_file, text};
use super::range::rounded;
use crate::candidate::CandidateEffect;
use crate::entry::CandidateEntry;

/// The largest number of nodes that a formula has, without its strength.
const SIZE: usize = 7;
/// Formulas that are fitted through the model, the most probable by the curve.
const FITTED: usize = 100;
/// A formula less probable than the best by more than this factor is not fitted through the model.
const MIN_SHARE: f64 = 1e-6;
/// The leading classes are recorded until they have this probability together, or are so many.
const RECORDED: f64 = 0.95;
const MAX_RECORDED: usize = 5;
/// A condition splits two classes that differ there by more \[standard deviations\].
const SPLIT: f64 = 2.0;

/// A formula that is fitted through the model.
#[derive(Debug)]
struct Offered {
    fit: WeighedFit,
    /// Its probability by the curve among all formulas.
    probability: f64,
    /// The sign of its strength, which its candidate has in the formula, so that a fit begins with a positive strength.
    sign: f64,
    entry: CandidateEntry,
}

impl Offered {
    /// Returns the formula as it was fitted through the model, with the priors of the fits to the curve; `None` where it has a pole then.
    fn refitted(&self, curve: &LocatedCurve, fit: &FormulaFit) -> Option<WeighedFit> {
        let priors = self.entry.candidate.parameters.iter().zip(&fit.parameters);
        let log_prior = priors.map(|(prior, value)| prior.log_density(*value)).sum();
        let mut parameters = fit.parameters.clone();
        *parameters.first_mut()? *= self.sign;
        self.fit
            .refitted(curve, &parameters, fit.log_bayes_factor, log_prior)
    }
}

/// The formulas of the curve of a law.
#[derive(Debug)]
pub(crate) struct LawEquation {
    dependence: Dependence,
    curve: LocatedCurve,
    /// All formulas by the curve, the most probable first.
    ranked: Vec<WeighedFit>,
    /// The number of formulas that were fitted to the curve.
    count: usize,
    /// Names of effects that are free in the job, one for each formula that is fitted through the model.
    names: Vec<String>,
    offered: Vec<Offered>,
}

impl LawEquation {
    /// Fits the formulas to the curve of a law; `None` where the curve determines nothing.
    ///
    /// # Arguments
    /// - `is_taken`: whether an effect or a file of the job has a name.
    pub(crate) fn new(
        dependence: &Dependence,
        curve: &LawCurve,
        is_taken: impl Fn(&str) -> bool,
    ) -> Option<Self> {
        let host = match dependence.addition_sd {
            None => Host::Factor,
            Some(_) => Host::Addition,
        };
        let range = dependence.range;
        let (knots, values) = (range.knots(), &curve.knots);
        let curve =
            LocatedCurve::of_knots(host, &knots, values, &curve.covariance, range.is_logarithmic).ok()?;
        let library = FormulaLibrary::new(SIZE, dependence.variable().unit_name() == "1");
        let count = library.formulas().count();
        let fitted = (0..count)
            .into_par_iter()
            .map(|formula| fits(&curve, &library, formula));
        let fitted: Vec<_> = fitted.collect();
        let names = (1..).map(|number| format!("{}_formula_{number}", dependence.name()));
        Some(Self {
            dependence: *dependence,
            curve,
            ranked: ranked(fitted.into_iter().flatten()),
            count,
            names: names.filter(|name| !is_taken(name)).take(FITTED).collect(),
            offered: Vec::new(),
        })
    }

    /// Returns the leading formulas as candidates of a search, in the order in which [`record`](Self::record) takes their fits.
    pub(crate) fn offer(&mut self) -> Vec<Candidate> {
        let probabilities = probabilities(&self.ranked);
        let leading = self.ranked.iter().zip(probabilities.iter().copied());
        let leading = leading.filter(|(_, probability)| *probability > MIN_SHARE * probabilities[0]);
        let offered = leading.zip(&self.names).filter_map(|((fit, probability), name)| {
            let mut text = text(&self.dependence, &self.curve, fit.formula());
            let strength = text.parameters.first_mut()?;
            let sign = strength.value.signum();
            if sign < 0.0 {
                strength.value *= sign;
                text.formula = text.formula.replace("strength", "(-strength)");
            }
            Some(Offered {
                fit: fit.clone(),
                probability,
                sign,
                entry: self.entry(&text, name)?,
            })
        });
        self.offered = offered.collect();
        self.entries().map(|entry| entry.candidate.clone()).collect()
    }

    /// Returns the formulas that were offered.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &CandidateEntry> {
        self.offered.iter().map(|offered| &offered.entry)
    }

    /// Makes the candidate of a formula; `None` if its file cannot be read.
    fn entry(&self, text: &FormulaText, name: &str) -> Option<CandidateEntry> {
        let file = effect_file(&self.dependence, text, name);
        let effect = Effect::read(&file).ok()?;
        let free = free_parameters(&effect).ok()?;
        let candidate = CandidateEffect {
            extension: Extension::File {
                name: format!("{name}.toml"),
                text: file,
            },
            name: name.to_owned(),
        };
        CandidateEntry::new(candidate, &effect, free, false)
    }

    /// Records the formulas; `None` without one.
    ///
    /// The evidence of a formula is that of the model with it, where it was fitted through the model. Otherwise it is that of the curve's
    /// knots with their covariance. Formulas that were not fitted keep the probability that they have by the curve. Checked by
    /// `tests::a_curve_of_a_known_law_has_its_formula`.
    ///
    /// # Arguments
    /// - `of_model`: fits of the offered formulas through the model; none of a model that is too expensive for them.
    pub(crate) fn record(&self, of_model: &[FormulaFit]) -> Option<LawFormulas> {
        let refitted = of_model.iter().filter_map(|fit| {
            let offered = self.offered.get(fit.formula)?;
            Some((offered.probability, offered.refitted(&self.curve, fit)?))
        });
        let (shares, refitted): (Vec<f64>, Vec<WeighedFit>) = refitted.unzip();
        let through_model = refitted.len() as u64;
        let (share, answer) = match refitted.is_empty() {
            true => (1.0, answer(&self.curve, self.ranked.iter().cloned())),
            false => (shares.iter().sum(), answer(&self.curve, refitted)),
        };
        let mut recorded: Vec<&FormulaClass> = Vec::new();
        for class in answer.classes.iter().take(MAX_RECORDED) {
            if recorded.iter().map(|class| class.probability).sum::<f64>() < RECORDED {
                recorded.push(class);
            }
        }
        let (first, second) = (answer.classes.first()?, answer.classes.get(1));
        let leading = |class: &FormulaClass| &answer.formulas[answer.simplest(class)];
        let split = second.and_then(|second| splitting(&self.curve, leading(first), leading(second)));
        let split = split.filter(|split| split.sds > SPLIT);
        let sum: f64 = recorded.iter().map(|class| class.probability).sum();
        let classes = recorded.iter().zip(&self.names);
        Some(LawFormulas {
            classes: classes
                .map(|(class, name)| self.recorded_class(&answer, class, share, name))
                .collect(),
            others: (1.0 - share * sum).max(0.0),
            fitted: self.count as u64,
            through_model,
            splitting: split.map(|split| SplittingCondition {
                at: rounded(split.at, 3),
                unit: self.dependence.variable().unit_name().to_owned(),
                laws: split.laws.map(|law| rounded(law, DIGITS)),
                sds: split.sds,
            }),
        })
    }

    /// Records a class.
    ///
    /// # Arguments
    /// - `share`: probability of all formulas of the answer. `name`: of the effect of the class.
    fn recorded_class(
        &self,
        answer: &Answer,
        class: &FormulaClass,
        share: f64,
        name: &str,
    ) -> record::FormulaClass {
        let (dependence, curve) = (&self.dependence, &self.curve);
        let simplest = answer.simplest(class);
        let others = class.members.iter().copied().filter(|k| *k != simplest);
        let recorded = |k: usize| LawFormula {
            formula: text(dependence, curve, &answer.formulas[k]).with_values(DIGITS),
            probability: share * answer.formulas[k].probability,
        };
        let formula = &answer.formulas[simplest];
        record::FormulaClass {
            probability: share * class.probability,
            members: std::iter::once(simplest).chain(others).map(recorded).collect(),
            above: limit(dependence, formula.limit_above(curve), "large"),
            below: formula
                .limit_below(curve)
                .map(|below| limit(dependence, below, "small")),
            effect_file: effect_file(dependence, &text(dependence, curve, formula), name),
        }
    }
}

/// Writes where a law tends to: `tends to a factor of 0.7 for a large j`.
fn limit(dependence: &Dependence, limit: Limit, end: &str) -> String {
    let variable = dependence.depends_on.name();
    let side = |sign: f64| match (dependence.addition_sd, sign < 0.0) {
        (None, _) => "the factor",
        (Some(_), false) => "the addition",
        (Some(_), true) => "the subtraction",
    };
    let number = |value: f64| shared::limit::number(rounded(value, 3));
    match limit {
        Limit::Value(value) => match dependence.addition_sd {
            None => format!("tends to a factor of {} for a {end} {variable}", number(value)),
            Some(_) if dependence.unit() == "1" => {
                format!("tends to {} for a {end} {variable}", number(value))
            }
            Some(_) => format!(
                "tends to {} {} for a {end} {variable}",
                number(value),
                dependence.unit()
            ),
        },
        Limit::Power { exponent, sign } => {
            format!(
                "{} goes with {variable}^{} for a {end} {variable}",
                side(sign),
                number(exponent)
            )
        }
        Limit::Logarithm { sign } => {
            format!("{} changes more slowly than any power of {variable}", side(sign))
        }
        Limit::Exponential { sign } => format!("{} grows exponentially with {variable}", side(sign)),
        Limit::Ends(at) => match dependence.variable().unit_name() {
            "1" => format!("is undefined from {variable} = {} on", number(at)),
            unit => format!("is undefined from {variable} = {} {unit} on", number(at)),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::read;
    use crate::law::dependence::dependences;
    use formula::Effect;

    /// A dependence of the experiment, and the curve of a law at its knots with this sd.
    fn located(name: &str, sd: f64, law: impl Fn(f64) -> f64) -> (Dependence, LawCurve) {
        let (_, _, experiment) = read("tests/data/shear-mobilisation");
        let mut all = dependences(&experiment).into_iter();
        let dependence = all.find(|dependence| dependence.name() == name).unwrap();
        let knots: Vec<f64> = dependence.range.knots().into_iter().map(law).collect();
        let covariance = (0..25).map(|i| if i % 6 == 0 { sd * sd } else { 0.0 });
        (
            dependence,
            LawCurve {
                knots,
                covariance: covariance.collect(),
            },
        )
    }

    fn by_curve(dependence: &Dependence, curve: &LawCurve) -> LawFormulas {
        let equation = LawEquation::new(dependence, curve, |_| false);
        equation.and_then(|equation| equation.record(&[])).unwrap()
    }

    #[test]
    fn a_curve_of_a_known_law_has_its_formula() {
        let (dependence, curve) = located("shear_v_t", 0.003, |v| -0.2 * (1.0 + v / 0.0005).ln());
        let formulas = by_curve(&dependence, &curve);
        let shown = || format!("{:?}", formulas.classes);
        let members = formulas.classes.iter().flat_map(|class| &class.members);
        let mut members = members.map(|member| member.formula.as_str());
        assert!(
            members.any(|formula| formula.starts_with("tau * (1 + v_t / 0.000")),
            "{}",
            shown()
        );
        let sum: f64 = formulas.classes.iter().map(|class| class.probability).sum();
        assert!((sum + formulas.others - 1.0).abs() < 1e-9);
    }

    #[test]
    fn fits_through_the_model_decide() {
        let (dependence, curve) = located("shear_v_t", 0.003, |v| -0.2 * (1.0 + v / 0.0005).ln());
        let mut equation =
            LawEquation::new(&dependence, &curve, |name| name == "shear_v_t_formula_2").unwrap();
        let offered = equation.offer();
        assert!(offered.len() > 5, "{}", offered.len());
        assert!(
            offered
                .iter()
                .all(|candidate| candidate.name != "shear_v_t_formula_2")
        );
        // The fits through the model find the values of the curve, and the third formula by far the best.
        let values = |offered: &Offered| -> Vec<f64> {
            let text = text(&dependence, &equation.curve, offered.fit.formula());
            let mut values: Vec<f64> = text.parameters.iter().map(|parameter| parameter.value).collect();
            values[0] = values[0].abs();
            values
        };
        let fits = equation
            .offered
            .iter()
            .enumerate()
            .map(|(formula, offered)| FormulaFit {
                formula,
                log_bayes_factor: if formula == 2 { 100.0 } else { 0.0 },
                parameters: values(offered),
            });
        let formulas = equation.record(&fits.collect::<Vec<_>>()).unwrap();
        assert_eq!(formulas.through_model, offered.len() as u64);
        let third = text(&dependence, &equation.curve, equation.offered[2].fit.formula());
        assert_eq!(formulas.classes[0].members[0].formula, third.with_values(DIGITS));
        let sum: f64 = formulas.classes.iter().map(|class| class.probability).sum();
        assert!((sum + formulas.others - 1.0).abs() < 1e-9);
        let share: f64 = equation.offered.iter().map(|offered| offered.probability).sum();
        assert!((formulas.classes[0].probability - share).abs() < 1e-6 && share < 1.0);
    }

    #[test]
    fn a_sentence_names_the_leading_classes_and_what_splits_them() {
        let class = |formula: &str, probability: f64| record::FormulaClass {
            probability,
            members: vec![LawFormula {
                formula: formula.into(),
                probability,
            }],
            above: "tends to a factor of 0.7 for a large j".into(),
            below: None,
            effect_file: String::new(),
        };
        let of = |classes: Vec<record::FormulaClass>| LawFormulas {
            others: 1.0 - classes.iter().map(|class| class.probability).sum::<f64>(),
            classes,
            fitted: 1284,
            through_model: 100,
            splitting: Some(SplittingCondition {
                at: 0.04,
                unit: "m".into(),
                laws: [0.7, 0.5],
                sds: 3.25,
            }),
        };
        assert_eq!(
            of(vec![class("tau * f(j)", 0.6), class("tau * g(j)", 0.25), class("tau * h(j)", 0.05)]).words("shear displacement"),
            Some(
                "as a formula the curve is one of: tau * f(j) (P 0.60; tends to a factor of 0.7 for a large j); or tau * g(j) (P 0.25; \
                 tends to a factor of 0.7 for a large j); or another (P 0.15); the first two differ most at a shear displacement of 0.04 m \
                 (0.7 and 0.5, 3.2 sds): a run there would split them"
                    .into()
            )
        );
        assert_eq!(
            of(vec![class("tau * f(j)", 0.97), class("tau * g(j)", 0.02)]).words("shear displacement"),
            Some(
                "as a formula the curve is tau * f(j) (P 0.97; tends to a factor of 0.7 for a large j)"
                    .into()
            )
        );
    }

    #[test]
    fn every_effect_file_is_read_and_absent_without_its_strength() {
        for (name, sd) in [
            ("shear_j", 0.05),
            ("pressure_z", 0.1),
            ("drawbar_pull_slip", 1.0),
            ("shear_slip", 0.02),
        ] {
            let (dependence, curve) = located(name, sd, |x| -0.4 * x / (x + 0.1));
            let formulas = by_curve(&dependence, &curve);
            for class in &formulas.classes {
                let effect = Effect::read(&class.effect_file);
                let effect = effect.unwrap_or_else(|e| panic!("{e}: {}", class.effect_file));
                assert!(
                    effect
                        .program(dependence.acts_on.hook(), Default::default())
                        .is_some()
                );
                let strengths = effect.parameters.iter().filter(|p| p.neutral.is_some());
                assert_eq!(strengths.count(), 1);
            }
            let words = formulas.words(dependence.depends_on.words()).unwrap();
            assert!(words.starts_with("as a formula the curve is "), "{words}");
        }
    }
}

//! The forms of a law outside the library: what was fitted of them, and their probabilities and classes once the law is claimed.

use crate::laplace::evidence::log_sum_exp;
use crate::laplace::fit::LaplaceFit;
use crate::probability::DETECTED;
use statistics::likelihood::Likelihood;

/// A form of a law, or its curve, as it was fitted.
#[derive(Debug, Clone)]
pub(super) struct FittedForm {
    /// Index of the form or curve among the candidates.
    pub(super) candidate: usize,
    /// Log evidence over that of the model beyond which the law was fitted.
    pub(super) log_bayes_factor: f64,
    /// The most probable parameters of the law.
    pub(super) parameters: Vec<f64>,
    /// Predicted values of the data.
    values: Vec<f64>,
}

impl FittedForm {
    /// Takes the form from a fit.
    ///
    /// # Arguments
    /// - `parameters`: range of the law's parameters among those of the fit.
    pub(super) fn new(
        candidate: usize,
        log_bayes_factor: f64,
        fit: &LaplaceFit,
        parameters: std::ops::Range<usize>,
    ) -> Self {
        Self {
            candidate,
            log_bayes_factor,
            parameters: fit.theta()[parameters].to_vec(),
            values: fit.point.values.clone(),
        }
    }

    /// Returns the form with a log Bayes factor over another model.
    ///
    /// # Arguments
    /// - `by`: log evidence of the model beyond which it was fitted over that of the other one.
    pub(super) fn over(&self, by: f64) -> Self {
        Self {
            log_bayes_factor: self.log_bayes_factor + by,
            ..self.clone()
        }
    }
}

/// A form of a claimed law, or its curve, beside the others.
#[derive(Debug, Clone, PartialEq)]
pub struct WeighedForm {
    /// Index of the form or curve among the candidates.
    pub candidate: usize,
    /// Log evidence over that of the base; of a law beside effects, with these effects and less the cost of choosing the law.
    pub log_bayes_factor: f64,
    /// Probability among the forms of this law, each of which has the same prior.
    pub probability: f64,
    /// Number of the class, from 1, in which the data cannot distinguish forms.
    pub class: usize,
    /// The most probable parameters of the law.
    pub parameters: Vec<f64>,
}

/// Weighs the forms of a law among each other.
///
/// Two forms are alike if their log Bayes factors, and half the squared distance of their predictions in noise sds, which is the
/// log Bayes factor to expect from data of one of them, both differ by at most 3 nats. A form joins the first class to whose every
/// member it is alike.
///
/// # Arguments
/// - `forms`: in the order of the result. `fit`: of the claimed form, where the data are whitened. `misfit`: divides all nats.
pub(super) fn weighed(
    forms: &[FittedForm],
    fit: &LaplaceFit,
    likelihood: &Likelihood,
    misfit: f64,
) -> Vec<WeighedForm> {
    let weight = |form: &FittedForm| form.log_bayes_factor / misfit;
    let sum = log_sum_exp(forms.iter().map(weight));
    let whitening = likelihood.whitening(&fit.point.values, &fit.theta()).ok();
    let is_alike = |a: &FittedForm, b: &FittedForm| {
        let pairs = a.values.iter().zip(&b.values);
        let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        let distance = whitening.as_ref().map(|whitening| {
            let whitened = whitening.apply(&difference);
            0.5 * whitening.curvature(&whitened, &whitened)
        });
        (weight(a) - weight(b)).abs() <= DETECTED && distance.is_some_and(|nats| nats / misfit <= DETECTED)
    };
    let mut classes: Vec<Vec<&FittedForm>> = Vec::new();
    let mut weighed = Vec::with_capacity(forms.len());
    for form in forms {
        let alike = |members: &Vec<&FittedForm>| members.iter().all(|member| is_alike(member, form));
        let class = classes.iter().position(alike).unwrap_or(classes.len());
        if class == classes.len() {
            classes.push(Vec::new());
        }
        classes[class].push(form);
        weighed.push(WeighedForm {
            candidate: form.candidate,
            log_bayes_factor: form.log_bayes_factor,
            probability: libm::exp(weight(form) - sum),
            class: class + 1,
            parameters: form.parameters.clone(),
        });
    }
    weighed
}

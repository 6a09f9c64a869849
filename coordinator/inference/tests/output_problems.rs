//! Problems with known evidence whose likelihood is that of outputs with normal errors: for the algorithms that are told outputs.

use statistics::{Datum, Distribution, ErrorSd, Likelihood, Marginal, Prior};

use crate::problems::{self, LOG_PRESSURE, Problem, SINKAGE};

/// ln sqrt(2 pi).
const LN_SQRT_TAU: f64 = statistics::prior::LN_SQRT_TAU;

/// A problem with its outputs.
pub(crate) struct OutputProblem {
    pub(crate) name: &'static str,
    pub(crate) prior: Prior,
    pub(crate) likelihood: Likelihood,
    /// Number of parameters that the model takes.
    pub(crate) model_parameters: usize,
    /// The outputs; `None` where the model rejects the parameters.
    pub(crate) outputs: fn(&[f64]) -> Option<Vec<f64>>,
    /// ln Z with the likelihood of the outputs.
    pub(crate) log_evidence: f64,
}

impl OutputProblem {
    /// # Arguments
    /// - `data`: the measured values and their error sds.
    /// - `missing`: nats of the problem's log-likelihood beyond that of the outputs.
    fn new(
        problem: Problem,
        data: Vec<(f64, ErrorSd)>,
        missing: f64,
        outputs: fn(&[f64]) -> Option<Vec<f64>>,
    ) -> Self {
        let data = data.into_iter().enumerate().map(|(run, (value, sd))| Datum {
            run,
            channel: 0,
            value,
            sd,
        });
        Self {
            name: problem.name,
            prior: problem.prior(),
            likelihood: Likelihood::new(data.collect()).unwrap(),
            model_parameters: problem.mean.len(),
            outputs,
            log_evidence: problem.log_evidence - missing,
        }
    }

    /// Replaces log10 of the sd of the errors, the fourth parameter, by the sd itself.
    fn with_sd(mut self) -> Self {
        let sd = Distribution::Loguniform {
            lower: 1e-3,
            upper: libm::exp10(0.5),
        };
        let mut marginals = self.prior.marginals()[..3].to_vec();
        marginals.push(Marginal::new(sd, None).unwrap());
        self.prior = Prior::new(marginals);
        self.model_parameters = 3;
        self
    }
}

fn known(values: &[f64], sd: f64) -> Vec<(f64, ErrorSd)> {
    values.iter().map(|&value| (value, ErrorSd::Known(sd))).collect()
}

fn plates() -> Vec<(f64, ErrorSd)> {
    let sd = ErrorSd::Inferred { parameter: 3 };
    LOG_PRESSURE.iter().map(|&value| (value, sd)).collect()
}

/// (a) Five-dimensional normal density; the outputs are its innovations.
pub(crate) fn correlated_gaussian() -> OutputProblem {
    // The density of the parameters has the factor of the innovations' scales.
    let scales = [0.05, 0.2, 0.5, 1.0, 0.1].map(libm::log).iter().sum::<f64>() + 2.0 * libm::log(1.0 - 0.81);
    OutputProblem::new(
        problems::correlated_gaussian(),
        known(&[0.0; 5], 1.0),
        -scales,
        |x| Some(problems::whitened(x)),
    )
}

/// (b) Two-storey shear building, bimodal.
pub(crate) fn shear_building() -> OutputProblem {
    let data = known(&[0.0; 2], 1.0);
    OutputProblem::new(problems::shear_building(), data, 2.0 * LN_SQRT_TAU, |theta| {
        Some(problems::frequency_residuals(theta))
    })
}

/// (c2) A ridge 5e-6 as thick as long.
pub(crate) fn thin_ridge() -> OutputProblem {
    OutputProblem::new(problems::thin_ridge(), known(&[1e6], 5e4), 0.0, |theta| {
        Some(vec![theta[0] / 0.1 + theta[1]])
    })
}

/// ln of the pressures of Bekker's law with literal moduli; a quarter of the prior is rejected.
fn literal_plates(theta: &[f64]) -> Option<Vec<f64>> {
    let sum = theta[0] / 0.1 + theta[1];
    let pressure = |z: &f64| libm::log(sum) + theta[2] * libm::log(*z);
    (sum > 0.0).then(|| SINKAGE.iter().map(pressure).collect())
}

/// (c3) Bekker's moduli, literally, known noise.
pub(crate) fn bekker_known_noise() -> OutputProblem {
    let data = known(&LOG_PRESSURE, 0.08);
    OutputProblem::new(problems::bekker_known_noise(), data, 0.0, literal_plates)
}

/// (c4) As c3 with unknown noise.
pub(crate) fn bekker_unknown_noise() -> OutputProblem {
    OutputProblem::new(problems::bekker_unknown_noise(), plates(), 0.0, literal_plates).with_sd()
}

/// (c5) The data of c4 in coordinates that suit them.
pub(crate) fn bekker_reparametrised() -> OutputProblem {
    let outputs = |theta: &[f64]| {
        let pressure =
            |z: &f64| theta[0] * std::f64::consts::LN_10 + theta[2] * (libm::log(*z) - libm::log(0.025));
        Some(SINKAGE.iter().map(pressure).collect())
    };
    OutputProblem::new(problems::bekker_reparametrised(), plates(), 0.0, outputs).with_sd()
}

/// (d1) Two thin shells; the output is the distance from the nearer one.
pub(crate) fn shells() -> OutputProblem {
    OutputProblem::new(problems::shells(), known(&[0.0], 0.1), 0.0, |x| {
        let center = if x[0] < 0.0 { -3.5 } else { 3.5 };
        Some(vec![libm::hypot(x[0] - center, x[1]) - 2.0])
    })
}

/// (d2) Eggbox; the output is the root of what ln L falls short by, which has a cone at each of eighteen modes.
pub(crate) fn eggbox() -> OutputProblem {
    OutputProblem::new(problems::eggbox(), known(&[0.0], 1.0), 243.0 + LN_SQRT_TAU, |x| {
        let base = 2.0 + libm::cos(0.5 * x[0]) * libm::cos(0.5 * x[1]);
        Some(vec![(2.0 * (243.0 - libm::pow(base, 5.0)).max(0.0)).sqrt()])
    })
}

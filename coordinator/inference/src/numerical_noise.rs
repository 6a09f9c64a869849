//! The numerical noise of a model: how far its predictions scatter about a smooth function of its parameters.
//!
//! The predictions of a model on a grid jump when a node enters or leaves the contact. A fit that takes the jumps for physics
//! supports any effect that happens to match them.

use statistics::likelihood::{ErrorSd, Likelihood};

/// Number of positions on a line.
pub const POINTS: usize = 9;
/// Distance of neighbours on a line along every coordinate, in standard deviations of the prior.
pub const SPACING: f64 = 0.1;
/// If the model rejects too many positions, a quarter of the last distance is tried, down to this one.
const MIN_SPACING: f64 = 0.005;
const SHORTER: f64 = 0.25;
/// Coefficients of the fourth difference, in which the smooth part of the predictions vanishes; their squares sum to 70.
const FOURTH_DIFFERENCE: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
const SUM_OF_SQUARES: f64 = 70.0;
/// A scatter below this share of a channel's noise is neglected.
const NEGLIGIBLE: f64 = 0.1;

/// Returns the distances of neighbours to be tried, in standard deviations of the prior.
pub fn spacings() -> impl Iterator<Item = f64> {
    let shorter = |spacing: &f64| Some(SHORTER * spacing).filter(|s| *s > MIN_SPACING);
    std::iter::successors(Some(SPACING), shorter)
}

/// Returns the positions to evaluate: evenly on a line through the fit, which moves all parameters at once.
pub fn positions(fit: &[f64], spacing: f64) -> Vec<Vec<f64>> {
    let offset = |i: usize| spacing * (i as f64 - (POINTS / 2) as f64);
    let moved = |i| fit.iter().map(|t| t + offset(i)).collect();
    (0..POINTS).map(moved).collect()
}

/// Returns whether enough neighbouring positions were accepted for a difference.
pub fn are_enough(answers: &[Option<Vec<f64>>]) -> bool {
    let mut windows = answers.windows(FOURTH_DIFFERENCE.len());
    windows.any(|window| window.iter().all(Option::is_some))
}

/// Returns the scatter of each channel by its index, in its unit: the root mean square of the fourth differences over the root of
/// 70, over all data of the channel. `None` without data.
///
/// # Arguments
/// - `answers`: the values at [`positions`]; a difference with a rejected position is left out.
///
/// # Source
/// Moré & Wild 2011, "Estimating computational noise", SIAM Journal on Scientific Computing 33, doi:10.1137/100786125, Algorithm
/// `ECnoise` at one order. Checked by `tests`.
fn scatter(likelihood: &Likelihood, answers: &[Option<Vec<f64>>]) -> Option<Vec<f64>> {
    let data = likelihood.data();
    let channels = data.iter().map(|datum| datum.channel + 1).max()?;
    let mut squares = vec![(0.0, 0_usize); channels];
    for window in answers.windows(FOURTH_DIFFERENCE.len()) {
        let Some(window) = window.iter().map(Option::as_ref).collect::<Option<Vec<_>>>() else {
            continue;
        };
        for (i, datum) in data.iter().enumerate() {
            let terms = FOURTH_DIFFERENCE.iter().zip(&window);
            let difference: f64 = terms.map(|(c, values)| c * values[i]).sum();
            let (sum, count) = &mut squares[datum.channel];
            *sum += difference * difference / SUM_OF_SQUARES;
            *count += 1;
        }
    }
    let sd = |(sum, count): (f64, usize)| (sum / count.max(1) as f64).sqrt();
    Some(squares.into_iter().map(sd).collect())
}

/// Returns the scatter of each channel that counts as noise; 0 for a channel whose noise is inferred, because that includes the scatter.
/// `None` if all are negligible beside the declared noise.
pub fn sds(likelihood: &Likelihood, answers: &[Option<Vec<f64>>]) -> Option<Vec<f64>> {
    let sds = declared_sds(likelihood, answers)?;
    let matters = likelihood.data().iter().any(|datum| match datum.sd {
        ErrorSd::Known(sd) => sds[datum.channel] > NEGLIGIBLE * sd,
        ErrorSd::Inferred { .. } => false,
    });
    matters.then_some(sds)
}

/// Returns the scatter of each channel, however small; 0 for a channel whose noise is inferred. `None` without data.
pub(crate) fn declared_sds(likelihood: &Likelihood, answers: &[Option<Vec<f64>>]) -> Option<Vec<f64>> {
    let is_declared = |channel: usize| {
        let mut data = likelihood.data().iter().filter(|datum| datum.channel == channel);
        data.any(|datum| matches!(datum.sd, ErrorSd::Known(_)))
    };
    let sds = scatter(likelihood, answers)?.into_iter().enumerate();
    Some(
        sds.map(|(channel, sd)| if is_declared(channel) { sd } else { 0.0 })
            .collect(),
    )
}

/// Returns the sd of the log-likelihood that the scatter causes, in nats: with residuals r, scatter s and error sds e,
/// `sqrt(sum (r s / e^2)^2)`. Scatter that is small beside the noise is felt where the model misses its data by many error sds.
/// `None` without enough accepted positions.
///
/// # Arguments
/// - `theta`: parameters at which the inferred error sds are taken.
pub(crate) fn log_likelihood_sd(
    likelihood: &Likelihood,
    answers: &[Option<Vec<f64>>],
    theta: &[f64],
) -> Option<f64> {
    let scatter = scatter(likelihood, answers).filter(|_| are_enough(answers))?;
    let values = answers.iter().flatten().next()?;
    let terms = likelihood.data().iter().zip(values).map(|(datum, value)| {
        let noise = datum.sd.at(theta);
        (datum.value - value) / noise * (scatter[datum.channel] / noise)
    });
    Some(terms.map(|term| term * term).sum::<f64>().sqrt())
}

/// Returns whether the scatter was measured, and is negligible beside the noise of every datum, declared or inferred.
///
/// # Arguments
/// - `theta`: the parameters of the fit.
pub fn is_negligible(likelihood: &Likelihood, answers: &[Option<Vec<f64>>], theta: &[f64]) -> bool {
    let Some(scatter) = scatter(likelihood, answers).filter(|_| are_enough(answers)) else {
        return false;
    };
    let mut data = likelihood.data().iter();
    data.all(|datum| scatter[datum.channel] <= NEGLIGIBLE * datum.sd.at(theta))
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::likelihood::Datum;
    use statistics::rng::Stream;

    const RUNS: usize = 20;

    /// Two channels. The predictions are a cubic along the line, and those of the first channel scatter.
    fn answers(scatter: f64) -> (Likelihood, Vec<Option<Vec<f64>>>) {
        let datum = |i: usize| Datum {
            run: i / 2,
            channel: i % 2,
            value: 0.0,
            sd: ErrorSd::Known(1.0),
        };
        let likelihood = Likelihood::new((0..2 * RUNS).map(datum).collect()).unwrap();
        let values = |t: &Vec<f64>| {
            let mut scattered = Stream::new(1, 0, t[0].to_bits(), 0).normals(RUNS).into_iter();
            let value = |i: usize| {
                let smooth = (i as f64) * (3.0 * t[0] + t[0] * t[0] - 2.0 * t[0].powi(3));
                let rough = if i.is_multiple_of(2) {
                    scattered.next().unwrap()
                } else {
                    0.0
                };
                smooth + scatter * rough
            };
            Some((0..2 * RUNS).map(value).collect())
        };
        (
            likelihood,
            positions(&[0.3, -1.0], SPACING).iter().map(values).collect(),
        )
    }

    #[test]
    fn the_scatter_about_a_smooth_function_is_found() {
        let (likelihood, mut answers) = answers(0.5);
        let measured = sds(&likelihood, &answers).unwrap();
        assert!((0.4..0.6).contains(&measured[0]), "{measured:?}");
        assert!(measured[1] < 1e-9, "{measured:?}");
        assert!(are_enough(&answers));
        // Four differences of five are left.
        answers[0] = None;
        let measured = sds(&likelihood, &answers).unwrap();
        assert!((0.4..0.6).contains(&measured[0]), "{measured:?}");
    }

    #[test]
    fn a_rejected_middle_leaves_no_difference_and_shorter_lines_are_tried() {
        let (_, mut answers) = answers(0.5);
        answers[POINTS / 2] = None;
        assert!(!are_enough(&answers));
        let tried: Vec<f64> = spacings().collect();
        assert_eq!(tried, [0.1, 0.025, 0.00625]);
    }

    #[test]
    fn inferred_noise_holds_the_scatter() {
        let (likelihood, answers) = answers(0.5);
        let mut data = likelihood.data().to_vec();
        for datum in data.iter_mut().filter(|datum| datum.channel == 0) {
            datum.sd = ErrorSd::Inferred { parameter: 0 };
        }
        let likelihood = Likelihood::new(data).unwrap();
        assert_eq!(sds(&likelihood, &answers), None);
        // The scatter itself is still there.
        assert!(!is_negligible(&likelihood, &answers, &[1.0]));
        assert!(is_negligible(&likelihood, &answers, &[10.0]));
    }

    #[test]
    fn a_smooth_model_has_none() {
        let (likelihood, answers) = answers(0.0);
        assert_eq!(sds(&likelihood, &answers), None);
        assert!(is_negligible(&likelihood, &answers, &[]));
        // A scatter that was not measured is not negligible.
        assert_eq!(sds(&likelihood, &[]), None);
        assert!(!is_negligible(&likelihood, &[], &[]));
    }

    #[test]
    fn it_is_added_to_the_declared_noise() {
        let (likelihood, _) = answers(0.0);
        let with = likelihood.with_numerical_noise(&[0.75]).unwrap();
        let sds: Vec<ErrorSd> = with.data().iter().take(2).map(|datum| datum.sd).collect();
        assert_eq!(sds, [ErrorSd::Known(1.25), ErrorSd::Known(1.0)]);
    }
}

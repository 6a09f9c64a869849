//! Screen a candidate of several strengths, the knots of a curve: one step along each.

use crate::coordinate::Frame;
use crate::descent::{Descent, Point, parabola};
use crate::evidence::log_evidence;
use crate::screen::Screened;
use statistics::likelihood::Likelihood;

/// Where the candidate is asked: along each strength alone.
pub(crate) fn positions(frame: &Frame, base: &[f64], strength: f64) -> Vec<Vec<f64>> {
    let mut absent = base.to_vec();
    absent.resize(frame.dimension(), 0.0);
    let absent = frame.without(&absent);
    let along = |&(k, neutral): &(usize, f64)| {
        let mut position = absent.clone();
        position[k] = neutral + strength;
        position
    };
    frame.strengths.iter().map(along).collect()
}

/// Judges the candidate by the linear model of all its strengths; `None` if the model refused one of the steps.
///
/// # Returns
/// The log Bayes factor `g' H^-1 g / 2 - ln det(H) / 2` of the whole less that of the base.
pub(crate) fn judge(
    frame: &Frame,
    base: &Descent,
    base_evidence: f64,
    likelihood: &Likelihood,
    evaluated: &[(Vec<f64>, Option<Vec<f64>>)],
) -> Option<Screened> {
    let mut columns = base.columns.clone();
    columns.resize(frame.dimension(), vec![0.0; base.point.values.len()]);
    for ((k, neutral), (position, values)) in frame.strengths.iter().zip(evaluated) {
        let step = position[*k] - neutral;
        let pairs = values.as_ref()?.iter().zip(&base.point.values);
        columns[*k] = pairs.map(|(with, without)| (with - without) / step).collect();
    }
    let absent = frame.without(&evaluated.first()?.0);
    let absent = Point::new(frame, likelihood, absent, base.point.values.clone())?;
    let parabola = parabola(frame, likelihood, &absent, &columns);
    let evidence = log_evidence(&parabola, absent.value, &frame.halves())?;
    let solution = parabola.step(0.0)?;
    let own = || frame.strengths.iter().map(|(k, _)| *k);
    let change = (0..absent.values.len())
        .map(|i| own().map(|k| solution[k] * columns[k][i]).sum())
        .collect();
    for k in 0..base.columns.len() {
        columns[k].fill(0.0);
    }
    Some(Screened {
        point: absent,
        change,
        columns,
        log_bayes_factor: evidence - base_evidence,
    })
}

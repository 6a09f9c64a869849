//! The fit of the base with one effect added, from the screen's result.

use crate::effect_search::depth::ExtensionDepth;
use crate::effect_search::screen::Screened;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::quotient;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use statistics::likelihood::Likelihood;

/// A fit that begins at the base's fit or at the screen's point, whichever is more probable; a switch begins at the screen's point.
pub(crate) fn fit(
    frame: &NormalFrame,
    base: &LaplaceFit,
    screened: &Screened,
    likelihood: &Likelihood,
    depth: &ExtensionDepth,
) -> Option<LaplaceFit> {
    // The screen's point may have been computed with another likelihood.
    let FitPoint { position, values, .. } = screened.point.clone();
    let present = FitPoint::new(frame, likelihood, position, values)?;
    if frame.is_switch() {
        let (point, columns) = (present, screened.columns.clone());
        return Some(LaplaceFit::new(frame.clone(), point, columns, depth.plan));
    }
    let position = frame.without(&screened.point.position);
    let absent = FitPoint::new(frame, likelihood, position, base.point.values.clone())?;
    let is_present = present.value < absent.value;
    let mut columns = base.columns.clone();
    columns.extend_from_slice(&screened.columns[base.columns.len()..]);
    let shapes = || (base.columns.len()..frame.dimension()).filter(|k| !frame.is_strength(*k));
    if !is_present {
        if let Some((k, neutral)) = frame.strength() {
            columns[k] = quotient(
                &screened.point.values,
                &base.point.values,
                screened.point.position[k] - neutral,
            );
        }
        // The shape of an absent effect changes nothing.
        for k in shapes() {
            columns[k].fill(0.0);
        }
    }
    let point = if is_present { present } else { absent };
    let mut corrections = base.corrections.clone();
    corrections.extend_from_slice(&screened.corrections[corrections.len()..]);
    let fit = LaplaceFit::new(frame.clone(), point, columns, depth.plan);
    let mut fit = fit.corrected(&corrections);
    if depth.holds_shapes {
        fit.hold(shapes());
    }
    Some(fit)
}

/// The predicted values at the optimum of the model linearised where the fit begins: the effect's change before its fit has made a
/// step. `None` if the fit cannot begin.
pub(crate) fn linearised(
    frame: &NormalFrame,
    base: &LaplaceFit,
    screened: &Screened,
    likelihood: &Likelihood,
    depth: &ExtensionDepth,
) -> Option<Vec<f64>> {
    let fit = fit(frame, base, screened, likelihood, depth)?;
    let step = quadratic(frame, likelihood, &fit.point, &fit.columns).step(0.0)?;
    let moved = |i: usize| {
        let changes = step.iter().zip(&fit.columns).map(|(by, column)| by * column[i]);
        fit.point.values[i] + changes.sum::<f64>()
    };
    Some((0..fit.point.values.len()).map(moved).collect())
}

//! Unsettled runs: a note on simulated runs that were averaged before they reached a steady state.

use result::finished_calibration::FinishedCalibration;

/// Returns a sentence on the runs whose averages still changed at the most probable parameters; `None` if all were steady, or if the
/// model has no transient.
pub(crate) fn unsettled(calibration: &FinishedCalibration) -> Option<String> {
    let tolerance = calibration.spec.model.spatial?.steady_tolerance;
    let draw = calibration.predictions.first()?;
    let spec = &calibration.spec;
    let fitted = spec.fit_runs.iter().enumerate();
    let fitted = fitted.filter_map(|(k, &run)| Some((run, draw.fit.as_ref().ok()?, k)));
    let held_out = spec.holdout_runs.iter().enumerate().filter_map(|(k, &run)| {
        let (observables, position) = draw.holdout.as_ref()?.run(k).ok()?;
        Some((run, observables, position))
    });
    let settled = fitted
        .chain(held_out)
        .filter_map(|(run, observables, position)| Some((run, *observables.settled_to.get(position)?)));
    let late: Vec<(usize, f64)> = settled.filter(|(_, change)| *change > tolerance).collect();
    let (worst, change) = late
        .iter()
        .copied()
        .reduce(|worst, other| if other.1 > worst.1 { other } else { worst })?;
    Some(format!(
        "at the most probable parameters {} of {} runs {} averaged before reaching a steady state to within {tolerance}; the worst, {}, had {change:.3} still to go",
        late.len(),
        spec.fit_runs.len() + spec.holdout_runs.len(),
        if late.len() == 1 { "was" } else { "were" },
        spec.experiment.runs[worst].name
    ))
}

#[cfg(test)]
mod tests {
    use shared::model::SpatialSettings;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_run_that_still_changed_is_named_with_its_change() {
        let mut calibration = fixture::calibration();
        assert_eq!(unsettled(&calibration), None, "quasi_static waits for nothing");
        calibration.spec.model.spatial = Some(SpatialSettings::default());
        let runs = calibration.spec.fit_runs.len();
        let observables = calibration.predictions[0].fit.as_mut().expect("a prediction");
        observables.settled_to = vec![0.004; runs];
        assert_eq!(unsettled(&calibration), None);
        let observables = calibration.predictions[0].fit.as_mut().expect("a prediction");
        observables.settled_to[1] = 0.02;
        assert_eq!(
            unsettled(&calibration).expect("a note"),
            "at the most probable parameters 1 of 4 runs was averaged before reaching a steady state to within 0.005; the worst, \
             b&c, had 0.020 still to go"
        );
    }
}

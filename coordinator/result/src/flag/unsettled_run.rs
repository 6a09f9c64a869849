//! Say which runs of a rolling wheel were averaged before they had settled.

use crate::finished_calibration::FinishedCalibration;

/// A sentence on the most probable parameters' runs whose averages still changed; none where all had settled, or the
/// model does not wait for it.
pub(crate) fn unsettled(outcome: &FinishedCalibration) -> Option<String> {
    let tolerance = outcome.spec.model.spatial?.steady_tolerance;
    let draw = outcome.predictions.first()?;
    let spec = &outcome.spec;
    let fitted = spec.fit_runs.iter().zip(settled_to(draw.fit.as_ref().ok()));
    let held_out = draw.holdout.as_ref().and_then(|result| result.as_ref().ok());
    let held_out = spec.holdout_runs.iter().zip(settled_to(held_out));
    let late: Vec<(usize, f64)> = fitted
        .chain(held_out)
        .filter(|(_, change)| **change > tolerance)
        .map(|(&run, &change)| (run, change))
        .collect();
    let (worst, change) = late
        .iter()
        .copied()
        .reduce(|worst, other| if other.1 > worst.1 { other } else { worst })?;
    Some(format!(
        "at the most probable parameters {} of {} runs were averaged before they had settled to {tolerance}; the worst, {}, still changed by {change:.3} from one window to the next",
        late.len(),
        spec.fit_runs.len() + spec.holdout_runs.len(),
        spec.experiment.runs[worst].name
    ))
}

fn settled_to(observables: Option<&shared::outcome::Observables>) -> &[f64] {
    observables.map_or(&[], |o| &o.settled_to)
}

#[cfg(test)]
mod tests {
    use shared::model::SpatialSettings;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_run_that_still_changed_is_named_with_its_change() {
        let mut outcome = fixture::outcome();
        assert_eq!(unsettled(&outcome), None, "quasi_static waits for nothing");
        outcome.spec.model.spatial = Some(SpatialSettings::default());
        let runs = outcome.spec.fit_runs.len();
        let observables = outcome.predictions[0].fit.as_mut().expect("a prediction");
        observables.settled_to = vec![0.004; runs];
        assert_eq!(unsettled(&outcome), None);
        let observables = outcome.predictions[0].fit.as_mut().expect("a prediction");
        observables.settled_to[1] = 0.02;
        assert_eq!(
            unsettled(&outcome).expect("a note"),
            "at the most probable parameters 1 of 4 runs were averaged before they had settled to 0.005; the worst, \
             b&c, still changed by 0.020 from one window to the next"
        );
    }
}

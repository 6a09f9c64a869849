//! Refusal: the final draws at which the model refuses a run.

/// Final draws at which the model refuses a run.
///
/// The prediction of a holdout run rests on the other draws. If these are at most half of all draws, they represent improbable
/// parameters only, and there is no prediction.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Refusal {
    /// Number of draws at which the model refuses the run.
    pub draws: usize,
    /// Number of final draws.
    pub of: usize,
    /// Reason of the first refusal.
    pub reason: String,
}

impl Refusal {
    /// Returns whether the model refuses at least half of the draws, so that the rest does not suffice for a prediction.
    pub fn is_at_half_or_more(&self) -> bool {
        2 * self.draws >= self.of
    }

    /// Returns, for example, `20 of 20 final draws (no_support: ...)`.
    pub fn words(&self) -> String {
        format!("{} of {} final draws ({})", self.draws, self.of, self.reason)
    }
}

#[cfg(test)]
mod tests {
    use crate::fixture;

    #[test]
    fn a_refused_run_costs_its_own_cells_alone() {
        let (whole, refused) = (fixture::with_held_out_runs(4, 0.5), fixture::with_refused_runs());
        let comparison = refused.comparison();
        let row = |run: &str| comparison.rows.iter().find(|r| r.run == run).unwrap();
        let gone = row("h1").refused.clone().unwrap();
        assert!(gone.is_at_half_or_more() && row("h1").predicted.is_none() && row("h1").covered().is_none());
        let some = row("h3").refused.clone().unwrap();
        assert_eq!(
            some.words(),
            "5 of 19 final draws (no_support: condition 0: z = 0.11 m)"
        );
        assert!(!some.is_at_half_or_more() && row("h3").predicted.is_some());
        // The predictions of the other runs do not change by a bit.
        let before = whole.comparison();
        let unrefused = before.rows.iter().find(|r| r.run == "h0").unwrap();
        assert_eq!(
            (row("h0").predicted, row("h0").q05),
            (unrefused.predicted, unrefused.q05)
        );
        assert_eq!(row("h0").refused, None);
        let holdout = comparison.holdout.as_ref().unwrap();
        assert_eq!(
            (holdout.drawbar_pull.unwrap().runs, holdout.all.unpredicted),
            (2, 2)
        );
        assert_eq!(before.holdout.as_ref().unwrap().all.unpredicted, 0);
        // Interpolation is judged on the same rows as the model.
        let interpolated = comparison.baseline_holdout.as_ref().unwrap();
        assert_eq!(interpolated.drawbar_pull.unwrap().runs, 2);
        let of_whole = before.baseline_holdout.as_ref().unwrap();
        assert_eq!(of_whole.drawbar_pull.unwrap().runs, 4);
    }

    #[test]
    fn a_run_refused_at_half_of_the_draws_is_not_judged_by_the_others() {
        let refused = fixture::with_refused_runs();
        let comparison = refused.comparison();
        let row = comparison.rows.iter().find(|r| r.run == "h2").unwrap();
        let half = row.refused.clone().unwrap();
        assert_eq!((half.draws, half.of), (10, 19));
        assert!(half.is_at_half_or_more() && row.predicted.is_none() && row.q05.is_none());
        let new_measurements = crate::NewMeasurements::new(&refused);
        let place = fixture::position(&refused, "h2");
        // Predictions by the remaining draws are still available for export.
        let measurements = new_measurements.at(place, shared::channel::Channel::DrawbarPull);
        assert_eq!(measurements.len(), 9);
    }
}

//! Draws with the predictions of the model.

/// A parameter vector and the predicted values that the likelihood takes.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedDraw {
    /// Parameters, including inferred standard deviations.
    pub theta: Vec<f64>,
    /// A value for each datum, then the sensitivities; [`Likelihood::values`](statistics::Likelihood::values) is their number.
    pub values: Vec<f64>,
}

impl PredictedDraw {
    /// Returns the mean over draws; `None` with fewer than two.
    #[must_use]
    pub fn mean(draws: &[PredictedDraw]) -> Option<PredictedDraw> {
        let first = draws.first().filter(|_| draws.len() > 1)?;
        let mean = |count: usize, part: fn(&PredictedDraw) -> &[f64]| {
            let average = |i: usize| draws.iter().map(|d| part(d)[i]).sum::<f64>() / draws.len() as f64;
            (0..count).map(average).collect()
        };
        Some(PredictedDraw {
            theta: mean(first.theta.len(), |d| &d.theta),
            values: mean(first.values.len(), |d| &d.values),
        })
    }
}

//! Draws with what the model predicts at them.

/// A parameter vector and the predicted values that the likelihood takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// Parameters, inferred standard deviations among them.
    pub theta: Vec<f64>,
    /// One for each datum, then the sensitivities, as [`Likelihood::values`](statistics::Likelihood::values) counts them.
    pub values: Vec<f64>,
}

impl Predicted {
    /// The mean over draws; `None` with fewer than two.
    #[must_use]
    pub fn mean(draws: &[Predicted]) -> Option<Predicted> {
        let first = draws.first().filter(|_| draws.len() > 1)?;
        let mean = |count: usize, of: fn(&Predicted) -> &[f64]| {
            let average = |i: usize| draws.iter().map(|d| of(d)[i]).sum::<f64>() / draws.len() as f64;
            (0..count).map(average).collect()
        };
        Some(Predicted {
            theta: mean(first.theta.len(), |d| &d.theta),
            values: mean(first.values.len(), |d| &d.values),
        })
    }
}

//! `SurfaceError`: the error of the response surfaces of a channel against the model.

use shared::channel::Channel;

use super::output::OutputError;

/// The error of the response surfaces of a channel against the model, over its runs and the draws, each draw left out of the fit.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct SurfaceError {
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Unit of `rmse`.
    pub unit: String,
    /// Root mean square error.
    pub rmse: f64,
    /// The same with each run's error in its noise standard deviation; null if the noise of a run is unknown.
    pub rmse_sigma: Option<f64>,
}

impl SurfaceError {
    /// Returns the error of a channel; `None` without outputs of the channel.
    pub(super) fn new(channel: Channel, outputs: &[OutputError]) -> Option<Self> {
        let of_channel = || outputs.iter().filter(|output| output.channel == channel);
        let draws: usize = of_channel().map(|output| output.draws).sum();
        let root_mean = |sum: f64| (sum / draws as f64).sqrt();
        let in_sds = |output: &OutputError| Some(output.sum_of_squares / output.noise_sd?.powi(2));
        (draws > 0).then(|| SurfaceError {
            channel,
            unit: channel.unit().into(),
            rmse: root_mean(of_channel().map(|output| output.sum_of_squares).sum()),
            rmse_sigma: of_channel().map(in_sds).sum::<Option<f64>>().map(root_mean),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_channel_is_the_root_mean_square_over_runs_and_draws() {
        let output = |sum_of_squares, draws, noise_sd| OutputError {
            channel: Channel::Torque,
            sum_of_squares,
            draws,
            noise_sd,
        };
        let known = [output(8.0, 4, Some(0.5)), output(1.0, 5, Some(1.0))];
        let error = SurfaceError::new(Channel::Torque, &known).unwrap();
        assert!((error.rmse - 1.0).abs() < 1e-15);
        assert!((error.rmse_sigma.unwrap() - (33.0_f64 / 9.0).sqrt()).abs() < 1e-15);
        let unknown = [output(8.0, 4, Some(0.5)), output(1.0, 5, None)];
        assert_eq!(
            SurfaceError::new(Channel::Torque, &unknown).unwrap().rmse_sigma,
            None
        );
        assert_eq!(SurfaceError::new(Channel::Sinkage, &known), None);
    }
}

//! `ResponseSurface`: the answer of the REST interface about the response surface of a calibration.

use std::collections::BTreeMap;

use inference::response_surface::{Degree, ResponseSurfaceError, SurfaceDesign};
use shared::channel::Channel;

use super::channel_error::SurfaceError;
use super::draws::{PosteriorCoordinates, accepted_draws, distinct_draws, outputs};
use super::output::{OutputError, RunSurface, rounded};
use super::parameter::SurfaceParameter;
use crate::finished_calibration::FinishedCalibration;

/// Largest size as JSON of the surfaces that a report carries. A quadratic surface that is larger alone becomes linear.
pub const MAX_BYTES: usize = 400_000;

/// The outputs of a calibrated model at the measured runs as polynomials of its parameters.
///
/// A parameter vector has the coordinates x, one for each parameter (its value or its logarithm), and the whitened coordinates u, which
/// solve L u = x - m with the factor L and the centres m. An output is the polynomial in u that its coefficients state. Within the
/// length `radius` of u the polynomials interpolate between the draws; beyond it they extrapolate.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ResponseSurface {
    /// Id of the calibration.
    pub calibration: i64,
    /// Degree of the polynomials: `quadratic`, or `linear` where the draws do not suffice for it.
    #[schema(value_type = String)]
    pub degree: Degree,
    /// Number of coefficients of an output.
    pub terms: usize,
    /// Number of distinct draws with outputs that the surfaces of the fitted runs rest on.
    pub draws: usize,
    /// Mahalanobis distance from the posterior mean within which 99 % of the draws lie.
    pub radius: f64,
    /// Parameters in the order of the coordinates.
    pub parameters: Vec<SurfaceParameter>,
    /// Rows of the lower triangle of the Cholesky factor of the coordinates' covariance.
    pub factor: Vec<Vec<f64>>,
    /// Error of the surfaces of each channel.
    pub channels: Vec<SurfaceError>,
    /// Surface of each measured run and channel; runs that the model refuses at too many draws have none.
    pub outputs: Vec<RunSurface>,
}

impl FinishedCalibration {
    /// Returns the response surface; `None` without draws, or if they do not determine a surface.
    ///
    /// The surface is linear where a quadratic one would be larger than [`MAX_BYTES`].
    pub fn response_surface(&self) -> Option<ResponseSurface> {
        let coordinates = PosteriorCoordinates::new(self).ok()?;
        let distinct = distinct_draws(self);
        let draws = accepted_draws(self, *self.spec.fit_runs.first()?, &distinct).len();
        let degree = Degree::for_draws(draws, coordinates.parameters.len()).ok()?;
        let of_degree = |degree| {
            let designs = Designs {
                calibration: self,
                coordinates: &coordinates,
                degree,
                distinct: &distinct,
                found: BTreeMap::new(),
            };
            self.surface_with(designs, draws)
        };
        let surface = of_degree(degree)?;
        if degree == Degree::Quadratic && surface.size_bytes() > MAX_BYTES {
            return of_degree(Degree::Linear);
        }
        Some(surface)
    }

    /// Fits the surface of every measurement.
    ///
    /// # Arguments
    /// - `draws`: number of distinct draws at which the model accepts the fitted runs.
    fn surface_with(&self, mut designs: Designs<'_>, draws: usize) -> Option<ResponseSurface> {
        let (coordinates, degree) = (designs.coordinates, designs.degree);
        let (mut surfaces, mut errors) = (Vec::new(), Vec::new());
        for (run, channel, noise_sd) in self.measured_outputs() {
            let Some((draws, design)) = designs.of_run(run) else {
                continue;
            };
            let Some(values) = outputs(self, (run, channel), &draws) else {
                continue;
            };
            let surface = design.fit(&values);
            errors.push(OutputError::new(channel, noise_sd, &surface));
            surfaces.push(RunSurface {
                run: self.spec.experiment.runs[run].name.clone(),
                channel,
                coefficients: rounded(&surface.coefficients),
            });
        }
        let of_channel = |channel: &Channel| SurfaceError::new(*channel, &errors);
        (!surfaces.is_empty()).then(|| ResponseSurface {
            calibration: self.row.id,
            degree,
            terms: degree.term_count(coordinates.parameters.len()),
            draws,
            radius: coordinates.radius,
            parameters: coordinates.parameters.clone(),
            factor: coordinates.whitening.factor_rows(),
            channels: Channel::ALL.iter().filter_map(of_channel).collect(),
            outputs: surfaces,
        })
    }

    /// Returns the run, channel and noise standard deviation of every measurement, in the order of the comparison.
    fn measured_outputs(&self) -> Vec<(usize, Channel, Option<f64>)> {
        let runs = self.spec.experiment.runs.iter().enumerate();
        let measured = runs.flat_map(|(i, run)| {
            let channels = Channel::ALL.into_iter();
            channels
                .filter(|channel| run.measured[channel.index()].is_some())
                .map(move |channel| (i, channel))
        });
        let rows = &self.comparison().rows;
        measured
            .zip(rows)
            .map(|((run, channel), row)| (run, channel, row.noise_sd))
            .collect()
    }
}

impl ResponseSurface {
    /// Returns the size of the surface as JSON.
    pub fn size_bytes(&self) -> usize {
        serde_json::to_string(self).map_or(0, |text| text.len())
    }
}

/// The designs of all runs: runs that the model accepts at the same draws share one.
struct Designs<'a> {
    calibration: &'a FinishedCalibration,
    coordinates: &'a PosteriorCoordinates,
    degree: Degree,
    /// The distinct draws.
    distinct: &'a [usize],
    /// The design by the numbers of its draws.
    found: BTreeMap<Vec<usize>, Result<SurfaceDesign, ResponseSurfaceError>>,
}

impl Designs<'_> {
    /// Returns the draws at which the model accepts a run, and their design; `None` if they do not determine a surface.
    fn of_run(&mut self, run: usize) -> Option<(Vec<usize>, &SurfaceDesign)> {
        let draws = accepted_draws(self.calibration, run, self.distinct);
        let predictions = self.calibration.predictive_draws();
        let (coordinates, degree) = (self.coordinates, self.degree);
        let design = self.found.entry(draws.clone()).or_insert_with(|| {
            let point = |&draw: &usize| coordinates.whitened(&predictions[draw].theta);
            SurfaceDesign::new(&draws.iter().map(point).collect::<Vec<_>>(), degree)
        });
        Some((draws, design.as_ref().ok()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Returns the value of an output at whitened coordinates.
    fn value(surface: &ResponseSurface, output: usize, point: &[f64]) -> f64 {
        let terms = surface.degree.terms(point);
        let coefficients = &surface.outputs[output].coefficients;
        terms.iter().zip(coefficients).map(|(t, c)| t * c).sum()
    }

    /// Returns the calibration of the fixture with outputs that are quadratic functions of its model's parameters.
    fn with_quadratic_outputs() -> FinishedCalibration {
        let mut calibration = fixture::calibration();
        for prediction in &mut calibration.predictions {
            let [p_ref, n, friction] = [prediction.theta[0], prediction.theta[1], prediction.theta[2]];
            let pull = |run: usize| friction * n + run as f64 * (p_ref - 3.9) * (p_ref - 3.9);
            if let Ok(observables) = &mut prediction.fit {
                observables.drawbar_pull_n = (0..observables.drawbar_pull_n.len()).map(pull).collect();
            }
        }
        calibration
    }

    #[test]
    fn quadratic_outputs_are_reproduced_at_every_draw() {
        let calibration = with_quadratic_outputs();
        let surface = calibration.response_surface().unwrap();
        let names: Vec<&str> = surface.parameters.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["log10_p_ref", "n", "friction_angle_deg"]);
        assert_eq!(
            (surface.degree, surface.terms, surface.draws),
            (Degree::Quadratic, 10, 19)
        );
        let coordinates = PosteriorCoordinates::new(&calibration).unwrap();
        let spread = 3.0 * 31.0;
        for prediction in calibration.predictive_draws() {
            let point = coordinates.whitened(&prediction.theta);
            let expected = prediction.fit.as_ref().unwrap().drawbar_pull_n[0];
            let found = value(&surface, 0, &point);
            assert!(
                (found - expected).abs() < 1e-3 * spread,
                "{found}, not {expected}"
            );
        }
        let pull = &surface.channels[0];
        assert_eq!((pull.channel, pull.unit.as_str()), (Channel::DrawbarPull, "N"));
        assert!(surface.radius > 1.5 && surface.radius < 4.0, "{}", surface.radius);
    }

    #[test]
    fn the_surface_that_the_page_is_tested_with_is_that_of_the_fixture() {
        let calibration = with_quadratic_outputs();
        let surface = calibration.response_surface().unwrap();
        let coordinates = PosteriorCoordinates::new(&calibration).unwrap();
        let setting = |draw: usize| {
            let theta = &calibration.predictive_draws()[draw].theta;
            let point = coordinates.whitened(theta);
            let outputs: Vec<f64> = (0..surface.outputs.len())
                .map(|output| value(&surface, output, &point))
                .collect();
            let distance = point.iter().map(|u| u * u).sum::<f64>().sqrt();
            serde_json::json!({"values": theta[..3], "outputs": outputs, "distance": distance})
        };
        let settings: Vec<serde_json::Value> = [0, 7, 12].map(setting).to_vec();
        let computed = serde_json::json!({"surface": surface, "settings": settings});
        let kept = include_str!("../../../page/tests/response_surface.json");
        let kept: serde_json::Value = serde_json::from_str(kept).unwrap();
        assert_eq!(kept, computed, "{computed}");
    }

    #[test]
    fn every_measurement_has_a_surface_and_its_size_is_that_of_its_text() {
        let calibration = fixture::calibration();
        let surface = calibration.response_surface().unwrap();
        let rows = calibration
            .comparison()
            .rows
            .iter()
            .map(|row| (&row.run, row.channel));
        let outputs = surface.outputs.iter().map(|output| (&output.run, output.channel));
        assert!(rows.eq(outputs));
        let text = serde_json::to_string(&surface).unwrap();
        assert_eq!(surface.size_bytes(), text.len());
        assert_eq!(serde_json::from_str::<ResponseSurface>(&text).unwrap(), surface);
    }

    #[test]
    fn repeated_draws_count_once_and_few_draws_lower_the_degree() {
        let mut calibration = fixture::calibration();
        let repeated = calibration.predictions[1..8].to_vec();
        calibration.predictions.truncate(12);
        calibration.predictions.extend(repeated);
        let surface = calibration.response_surface().unwrap();
        assert_eq!((surface.degree, surface.draws), (Degree::Linear, 11));
        calibration.predictions.truncate(6);
        assert_eq!(calibration.response_surface(), None);
    }

    #[test]
    fn a_run_that_is_refused_too_often_has_no_surface() {
        let calibration = fixture::with_refused_runs();
        let surface = calibration.response_surface().unwrap();
        let has = |run: &str| surface.outputs.iter().any(|output| output.run == run);
        assert!(has("h0") && !has("h1") && !has("h2"));
    }

    #[test]
    fn calibrations_without_draws_or_outputs_have_no_surface() {
        for calibration in [fixture::fit(), fixture::search(), fixture::all_rejected()] {
            assert_eq!(calibration.response_surface(), None);
        }
    }
}

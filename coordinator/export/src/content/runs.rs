//! Groups of runs: conditions, measurements, and predictions at the draws that were simulated on every run.

use record::Prediction;
use result::{Component, FinishedCalibration, NewMeasurements};
use shared::channel::Channel;
use shared::experiment::TestRun;
use statistics::ErrorLaw;
use statistics::rng::Stream;

use super::draws::{draw_labels, numbers};
use crate::inference_data::VariableGroup;
use crate::variable::{Values, Variable};

/// The name shared by measured values, their predictions and their log-likelihoods.
const MEASUREMENT: &str = "measurement";

/// The dimension of measurements if not every run has every channel.
const OBSERVATION: &str = "observation";

/// Stage number of the random streams of new measurements: no sampler has so many stages.
const NEW: u64 = u64::MAX;

/// The fitted runs of a calibration, or those held out.
pub(super) struct Part<'a> {
    calibration: &'a FinishedCalibration,
    /// Indices of the runs in the experiment.
    places: &'a [usize],
    runs: Vec<&'a TestRun>,
    /// The channels that some run of the experiment has measured.
    channels: Vec<Channel>,
}

struct Cell {
    /// Index among the data of the likelihood.
    datum: usize,
    /// Index of the run among the fitted runs.
    run: usize,
    /// Index of the channel among those exported.
    channel: usize,
}

impl<'a> Part<'a> {
    pub(super) fn fitted(calibration: &'a FinishedCalibration) -> Self {
        Part::new(calibration, &calibration.spec.fit_runs)
    }

    pub(super) fn held_out(calibration: &'a FinishedCalibration) -> Self {
        Part::new(calibration, &calibration.spec.holdout_runs)
    }

    fn new(calibration: &'a FinishedCalibration, places: &'a [usize]) -> Self {
        let all = &calibration.spec.experiment.runs;
        let is_measured = |channel: &Channel| all.iter().any(|run| run.measured[channel.index()].is_some());
        Part {
            calibration,
            places,
            runs: places.iter().map(|&run| &all[run]).collect(),
            channels: Channel::ALL.into_iter().filter(is_measured).collect(),
        }
    }

    fn labels(&self) -> Vec<Variable> {
        let channels = self.channels.iter().map(|channel| channel.column().to_owned());
        vec![
            Variable::labels("run", Values::Text(self.texts(|run| &run.name))),
            Variable::labels("channel", Values::Text(channels.collect())),
        ]
    }

    fn texts(&self, text: impl Fn(&TestRun) -> &String) -> Vec<String> {
        self.runs.iter().map(|run| text(run).clone()).collect()
    }

    fn dims(&self) -> [(&'static str, usize); 2] {
        [("run", self.runs.len()), ("channel", self.channels.len())]
    }

    /// Makes variables over the simulated draws, runs and channels.
    fn over_draws<const N: usize>(
        &self,
        group: &str,
        variables: [(&str, &str, Vec<f64>); N],
    ) -> VariableGroup {
        self.over(group, &self.dims(), self.labels(), variables)
    }

    /// Makes variables over the simulated draws and further dimensions, which have these labels.
    fn over<const N: usize>(
        &self,
        group: &str,
        further: &[(&str, usize)],
        labels: Vec<Variable>,
        variables: [(&str, &str, Vec<f64>); N],
    ) -> VariableGroup {
        let draws = self.calibration.predictive_draws();
        let dims = [&[("chain", 1), ("draw", draws.len())], further].concat();
        let mut coords = draw_labels(places(self.calibration));
        coords.extend(labels);
        let variable = |(name, meaning, values): (&str, &str, Vec<f64>)| {
            Variable::new(name, &dims, "", meaning, Values::Real(values))
        };
        VariableGroup {
            name: group.to_owned(),
            coords,
            data_vars: variables.map(variable).into(),
        }
    }

    /// Returns the model's predictions, and new measurements with the errors that the calibration found; NaN where it rejects a draw.
    pub(super) fn predictive(&self, group: &str) -> VariableGroup {
        let law = self.calibration.spec.likelihood.law();
        let seed = self.calibration.spec.algorithm.seed();
        let new_measurements = NewMeasurements::new(self.calibration);
        let size = self.places.len() * self.channels.len();
        let empty = vec![f64::NAN; size * self.calibration.predictive_draws().len()];
        let (mut values, mut measurements) = (empty.clone(), empty);
        for (run, &place) in self.places.iter().enumerate() {
            for (column, &channel) in self.channels.iter().enumerate() {
                for prediction in new_measurements.at(place, channel) {
                    let mut stream = Stream::new(
                        seed,
                        NEW,
                        prediction.draw as u64,
                        (4 * place + channel.index()) as u64,
                    );
                    let at = prediction.draw * size + run * self.channels.len() + column;
                    if let Some(component) = chosen(&prediction.components, stream.uniform()) {
                        values[at] = component.mean;
                        let error = error(law, [stream.uniform(), stream.uniform()]);
                        measurements[at] = component.mean + component.scale.unwrap_or(0.0) * error;
                    }
                }
            }
        }
        let model = "value of the model at the draw, without noise, in the unit of the channel";
        let measured = "new measurement at the draw, with its errors, in the unit of the channel";
        self.over_draws(
            group,
            [("model", model, values), (MEASUREMENT, measured, measurements)],
        )
    }

    /// Returns the log-density of each fitted measurement. If a run lacks a channel, measurements have one dimension, because the sums
    /// over runs and channels of leave-one-out would be NaN.
    pub(super) fn log_likelihood(&self) -> VariableGroup {
        let likelihood = &self.calibration.spec.likelihood;
        let cells = self.cells();
        let mut values = Vec::new();
        for draw in self.calibration.predictive_draws() {
            let fitted = draw.fit.as_ref().ok();
            let predicted = fitted.map(|observables| self.calibration.spec.predicted_values(observables));
            let densities = predicted.and_then(|p| likelihood.log_densities(&p, &draw.theta).ok());
            let density = |cell: &Cell| densities.as_ref().map_or(f64::NAN, |all| all[cell.datum]);
            values.extend(cells.iter().map(density));
        }
        let is_alone = (0..likelihood.data().len()).all(|datum| likelihood.is_alone(datum));
        let meaning = match is_alone {
            true => "log-density of the measurement, by the model itself at the draw",
            false => {
                "log-density of the measurement by itself, by the model itself at the draw: some errors are common to several, so that the sum is not the joint log-density"
            }
        };
        let variable = [(MEASUREMENT, meaning, values)];
        if cells.len() == self.runs.len() * self.channels.len() {
            return self.over_draws("log_likelihood", variable);
        }
        let label = |cell: &Cell| {
            format!(
                "{} {}",
                self.runs[cell.run].name,
                self.channels[cell.channel].column()
            )
        };
        let labels = Variable::labels(OBSERVATION, Values::Text(cells.iter().map(label).collect()));
        self.over(
            "log_likelihood",
            &[(OBSERVATION, cells.len())],
            vec![labels],
            variable,
        )
    }

    /// Returns the fitted measurements of these runs, by run and channel.
    fn cells(&self) -> Vec<Cell> {
        let data = self.calibration.spec.likelihood.data().iter().enumerate();
        let cell = |(datum, measured): (usize, &statistics::Datum)| {
            let channel = self
                .channels
                .iter()
                .position(|channel| channel.index() == measured.channel)?;
            Some(Cell {
                datum,
                run: measured.run,
                channel,
            })
        };
        let mut cells: Vec<Cell> = data.filter_map(cell).collect();
        cells.sort_by_key(|cell| (cell.run, cell.channel));
        cells
    }

    /// Returns the measured values; NaN where none was measured.
    pub(super) fn measured(&self, group: &str) -> VariableGroup {
        let measured = |run: &&TestRun| -> Vec<f64> {
            let value = |channel: &Channel| run.measured[channel.index()].unwrap_or(f64::NAN);
            self.channels.iter().map(value).collect()
        };
        let values = self.runs.iter().flat_map(measured).collect();
        let meaning = "measured value, in the unit of the channel";
        VariableGroup {
            name: group.to_owned(),
            coords: self.labels(),
            data_vars: vec![Variable::new(
                MEASUREMENT,
                &self.dims(),
                "",
                meaning,
                Values::Real(values),
            )],
        }
    }

    /// Returns the conditions that were set on the rig.
    pub(super) fn conditions(&self, group: &str) -> VariableGroup {
        let [run, channel] = self.dims();
        let real = |name: &str, unit: &str, value: fn(&TestRun) -> f64| {
            let values = self.runs.iter().map(|run| value(run)).collect();
            Variable::new(name, &[run], unit, "", Values::Real(values))
        };
        let text = |name: &str, values| Variable::new(name, &[run], "", "", Values::Text(values));
        let passes = self.runs.iter().map(|run| i64::from(run.pass)).collect();
        let units = self.channels.iter().map(|channel| channel.unit().to_owned());
        VariableGroup {
            name: group.to_owned(),
            coords: self.labels(),
            data_vars: vec![
                text("wheel", self.texts(|run| &run.wheel)),
                text("soil", self.texts(|run| &run.soil)),
                real("slip", "1", |run| run.slip),
                real("wheel_load_n", "N", |run| run.wheel_load_n),
                real("sled_speed_m_s", "m/s", |run| run.sled_speed_m_s),
                real("slip_angle_deg", "deg", |run| run.slip_angle_deg),
                Variable::new("pass", &[run], "", "", Values::Whole(passes)),
                Variable::new("unit", &[channel], "", "", Values::Text(units.collect())),
            ],
        }
    }
}

/// Returns the component at which the cumulative weight exceeds a probability.
fn chosen(components: &[Component], mut probability: f64) -> Option<&Component> {
    let component = components.iter().find(|component| {
        probability -= component.weight;
        probability < 0.0
    });
    // Rounding may leave a remainder after the last component.
    component.or(components.last())
}

/// Returns a random error of scale 1 from two uniform numbers.
///
/// # Source
/// Box & Muller 1958, doi:10.1214/aoms/1177706645; for Student's t, Bailey 1994, Math. Comp. 62:779, doi:10.2307/2153537.
fn error(law: ErrorLaw, [first, second]: [f64; 2]) -> f64 {
    let squared = match law {
        ErrorLaw::Gaussian => -2.0 * libm::log(first),
        ErrorLaw::StudentT {
            degrees_of_freedom: nu,
        } => nu * libm::expm1(-2.0 / nu * libm::log(first)),
    };
    squared.sqrt() * libm::cos(std::f64::consts::TAU * second)
}

/// Returns the index in the posterior of each simulated draw; these are equally spaced draws of it.
fn places(calibration: &FinishedCalibration) -> Vec<i64> {
    let draws = calibration.predictive_draws();
    let is_same = |a: &[f64], b: &[f64]| a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits()));
    let mut posterior = calibration.posterior().iter().zip(0_i64..);
    let place = |draw: &Prediction| {
        let place = posterior.find(|(sample, _)| is_same(&sample.theta, &draw.theta));
        place.map(|(_, place)| place)
    };
    let places: Option<Vec<i64>> = draws.iter().map(place).collect();
    places.unwrap_or_else(|| numbers(draws.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_the_quantiles_of_their_law() {
        for law in [
            ErrorLaw::Gaussian,
            ErrorLaw::StudentT {
                degrees_of_freedom: 3.0,
            },
        ] {
            let mut stream = Stream::new(1, NEW, 0, 0);
            let errors: Vec<f64> = (0..20_000)
                .map(|_| error(law, [stream.uniform(), stream.uniform()]))
                .collect();
            for z in [-2.0, -0.5, 0.0, 1.0, 3.0] {
                let below = errors.iter().filter(|&&e| e < z).count() as f64 / errors.len() as f64;
                let expected = law.cumulative(z);
                // The tolerance is four standard errors of a share.
                let bound = 4.0 * (expected * (1.0 - expected) / errors.len() as f64).sqrt();
                assert!(
                    (below - expected).abs() < bound,
                    "{law:?} {z}: {below} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_component_is_chosen_by_its_weight() {
        let component = |mean, weight| Component {
            mean,
            scale: None,
            weight,
        };
        let both = [component(1.0, 0.25), component(2.0, 0.75)];
        let mean = |probability| chosen(&both, probability).map(|c| c.mean.to_bits());
        assert_eq!(mean(0.24), Some(1.0_f64.to_bits()));
        assert_eq!(mean(0.26), Some(2.0_f64.to_bits()));
        assert_eq!(mean(1.0), Some(2.0_f64.to_bits()));
        assert!(chosen(&[], 0.5).is_none());
    }
}

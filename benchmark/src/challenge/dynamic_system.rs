//! Equations of motion with a law left out, and what is measured of them.

use super::least_squares::Coordinate;

/// The largest number of states.
pub const MAX_STATES: usize = 4;

/// The states of a system at a time; unused ones are zero.
pub type State = [f64; MAX_STATES];

/// Returns the rates of the states.
///
/// # Arguments
/// - the time, the states, the parameters, the inputs of the experiment, the value of the law.
pub type Rates = fn(f64, &State, &[f64], &[f64], f64) -> State;

/// A system of ordinary differential equations in which a law of one state is unknown.
#[derive(Debug, Clone)]
pub struct DynamicSystem {
    pub rates: Rates,
    /// The state on which the law depends.
    pub variable: usize,
    /// Prior mean and sd of each parameter, which are independent and normal.
    pub priors: Vec<[f64; 2]>,
    /// The state that is measured.
    pub measured: usize,
    /// Standard deviation of a measurement.
    pub sd: f64,
    /// The step of the integration.
    pub step: f64,
}

/// An experiment on a system: its initial state, its inputs, and what was measured.
#[derive(Debug, Clone)]
pub struct Experiment {
    pub initial: State,
    pub inputs: Vec<f64>,
    pub times: Vec<f64>,
    pub values: Vec<f64>,
}

/// Returns the states a step later, by the classical Runge–Kutta method.
pub fn stepped(rates: impl Fn(f64, &State) -> State, time: f64, state: &State, step: f64) -> State {
    let moved = |by: &State, factor: f64| -> State { std::array::from_fn(|k| state[k] + factor * by[k]) };
    let first = rates(time, state);
    let second = rates(time + 0.5 * step, &moved(&first, 0.5 * step));
    let third = rates(time + 0.5 * step, &moved(&second, 0.5 * step));
    let fourth = rates(time + step, &moved(&third, step));
    let mean: State =
        std::array::from_fn(|k| (first[k] + 2.0 * second[k] + 2.0 * third[k] + fourth[k]) / 6.0);
    moved(&mean, step)
}

impl DynamicSystem {
    /// Returns the coordinates of a fit of the parameters.
    pub fn coordinates(&self) -> impl Iterator<Item = Coordinate> {
        let coordinate = |[mean, sd]: &[f64; 2]| Coordinate {
            mean: *mean,
            sd: *sd,
            scale: *sd,
        };
        self.priors.iter().map(coordinate)
    }

    /// Returns the measured state at the times of an experiment, by the classical Runge–Kutta method; `None` where it is not finite.
    ///
    /// # Arguments
    /// - `law`: by the state on which it depends.
    pub fn predict(
        &self,
        law: impl Fn(f64) -> f64,
        parameters: &[f64],
        experiment: &Experiment,
    ) -> Option<Vec<f64>> {
        let rates = |time: f64, state: &State| {
            let value = law(state[self.variable]);
            (self.rates)(time, state, parameters, &experiment.inputs, value)
        };
        let (mut state, mut time) = (experiment.initial, 0.0);
        let mut predicted = Vec::with_capacity(experiment.times.len());
        for until in &experiment.times {
            let count = ((until - time) / self.step).round().max(0.0) as usize;
            for _ in 0..count {
                state = stepped(rates, time, &state, self.step);
                time += self.step;
            }
            time = *until;
            let value = state[self.measured];
            if !value.is_finite() {
                return None;
            }
            predicted.push(value);
        }
        Some(predicted)
    }

    /// Returns the residuals of all experiments in sds; `None` where a prediction is not finite.
    pub fn residuals(
        &self,
        law: impl Fn(f64) -> f64,
        parameters: &[f64],
        experiments: &[Experiment],
    ) -> Option<Vec<f64>> {
        let mut residuals = Vec::new();
        for experiment in experiments {
            let predicted = self.predict(&law, parameters, experiment)?;
            residuals.extend(
                predicted
                    .iter()
                    .zip(&experiment.values)
                    .map(|(p, y)| (p - y) / self.sd),
            );
        }
        Some(residuals)
    }
}

//! The measured trajectories of a system.

use statistics::rng::Stream;

use super::super::dynamic_system::{State, stepped};
use super::system::OdeSystem;

/// Measurements of each trajectory, beside its initial state, which is given.
pub const POINTS: usize = 150;
/// Sd of the noise over the root mean square of the state.
const NOISE: f64 = 0.01;
/// Error of the integration, in sds of the noise, up to which a step is short enough.
const MAX_ERROR: f64 = 0.02;
/// The most steps between two measurements.
const MAX_STEPS: usize = 64;
/// A state beyond this counts as infinite.
const MAX_STATE: f64 = 1e6;

/// Both trajectories of a system with noise, each state at [`POINTS`] equal distances of time.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The time between two measurements.
    pub interval: f64,
    /// Steps of the integration between two measurements.
    pub steps: usize,
    /// The initial state and the states without noise.
    pub exact: [Vec<State>; 2],
    /// The initial state and the measured states.
    pub values: [Vec<State>; 2],
    /// Sd of the noise of each state.
    pub sds: State,
}

/// Returns the states at equal distances of time; `None` where they are not finite.
pub fn integrated(
    rates: impl Fn(&State) -> State,
    start: State,
    interval: f64,
    steps: usize,
) -> Option<Vec<State>> {
    let step = interval / steps as f64;
    let mut states = vec![start];
    let mut state = start;
    for _ in 0..POINTS {
        for _ in 0..steps {
            state = stepped(|_, state| rates(state), 0.0, &state, step);
        }
        if !state.iter().all(|x| x.abs() < MAX_STATE) {
            return None;
        }
        states.push(state);
    }
    Some(states)
}

impl Measured {
    /// Measures a system; `None` if it has no finite trajectory.
    pub fn new(system: &OdeSystem, seed: u64) -> Option<Self> {
        let interval = system.span / POINTS as f64;
        let with_steps = |steps: usize| -> Option<[Vec<State>; 2]> {
            let [first, second] = system.initial().map(|start| {
                let rates = |state: &State| system.rates(None, state, system.parameters);
                integrated(rates, start, interval, steps)
            });
            Some([first?, second?])
        };
        let mut steps = 1;
        let mut exact = with_steps(steps)?;
        let mut sds;
        loop {
            sds = noise(&exact);
            let finer = with_steps(2 * steps)?;
            let mut pairs = exact.iter().flatten().zip(finer.iter().flatten());
            let is_exact =
                pairs.all(|(a, b)| (0..a.len()).all(|k| (a[k] - b[k]).abs() <= MAX_ERROR * sds[k]));
            if is_exact || 2 * steps > MAX_STEPS {
                break;
            }
            (exact, steps) = (finer, 2 * steps);
        }
        let dimension = system.dimension();
        let mut number = 0;
        let values = exact.clone().map(|mut states| {
            number += 1;
            let stream = (seed, system.number as u64, number);
            let errors = Stream::new(stream.0, 3, stream.1, stream.2).normals(POINTS * dimension);
            for (state, errors) in states.iter_mut().skip(1).zip(errors.chunks(dimension)) {
                errors
                    .iter()
                    .enumerate()
                    .for_each(|(k, e)| state[k] += sds[k] * e);
            }
            states
        });
        Some(Self {
            interval,
            steps,
            exact,
            values,
            sds,
        })
    }
}

/// Returns the sd of the noise of each state; that of an unused state is 0.
fn noise(exact: &[Vec<State>; 2]) -> State {
    let count = exact.iter().map(Vec::len).sum::<usize>() as f64;
    std::array::from_fn(|k| {
        let squares = exact.iter().flatten().map(|state| state[k] * state[k]);
        NOISE * (squares.sum::<f64>() / count).sqrt()
    })
}

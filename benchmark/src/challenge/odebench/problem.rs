//! Measurements of a system of which a term may be unknown, and the fit of a hypothesis to them.

use statistics::rng::Stream;

use super::super::dynamic_system::State;
use super::super::least_squares::{Coordinate, LeastSquares, fit};
use super::answer::WeighedTerm;
use super::hypothesis::{Hypothesis, PlacedModel, Support};
use super::measured::{Measured, POINTS, integrated};
use super::system::OdeSystem;
use super::term_formula::TermFormula;
use super::weak_form::WeakForm;

/// The number of damped steps of a fit to the weak form, and of one through the equations of motion.
const STEPS: [usize; 2] = [10, 12];
/// Measurements of each trajectory that are fitted one after the other: all, and where no formula fits so, few at first.
pub const HORIZONS: [&[usize]; 2] = [&[POINTS], &[POINTS / 5, POINTS / 2, POINTS]];
/// Assumed values of parameters are wrong by this share.
const WRONG: f64 = 0.2;
/// Prior sd of the logarithm of a parameter's magnitude.
const SD: f64 = 0.5;

/// Measurements of a system of which a term may be unknown.
#[derive(Debug)]
pub struct Problem<'a> {
    pub system: &'a OdeSystem,
    pub removed: Option<usize>,
    pub measured: Measured,
    /// Priors of the logarithms of the parameters' magnitudes; their signs are given.
    pub parameters: Vec<Coordinate>,
    pub form: WeakForm,
    pub support: Support,
}

/// A hypothesis that was fitted to the weak form.
#[derive(Debug)]
pub struct Refined<'a> {
    pub hypothesis: Hypothesis<'a>,
    pub place: Vec<f64>,
    pub log_prior: f64,
    /// Log evidence in the weak form, and log prior of the formula.
    pub weight: f64,
}

impl<'a> Problem<'a> {
    /// Measures a system without telling of a term; `None` if a trajectory is not finite.
    pub fn new(system: &'a OdeSystem, removed: Option<usize>, seed: u64) -> Option<Self> {
        let measured = Measured::new(system, seed)?;
        let (form, points) = WeakForm::new(&measured, system.dimension())?;
        let mut stream = Stream::new(seed, 4, system.number as u64, 0);
        let parameter = |value: &f64| {
            let sign = if stream.uniform() < 0.5 { -1.0 } else { 1.0 };
            Coordinate {
                mean: libm::log(value.abs() * (1.0 + sign * WRONG)),
                sd: SD,
                scale: SD,
            }
        };
        let parameters: Vec<Coordinate> = system.parameters.iter().map(parameter).collect();
        let means: Vec<f64> = parameters.iter().map(|c| c.mean).collect();
        let assumed = system.signed(&means);
        Some(Self {
            system,
            removed,
            support: Support::new(points, measured.interval, system, removed, &assumed),
            parameters,
            measured,
            form,
        })
    }

    pub fn hypothesis(
        &'a self,
        removed: Option<usize>,
        term: Option<(usize, TermFormula)>,
    ) -> Hypothesis<'a> {
        Hypothesis::new(self.system, removed, term, &self.parameters, &self.support)
    }

    fn predictions(&self, model: &PlacedModel<'_>) -> Option<Vec<f64>> {
        let dimension = self.system.dimension();
        let mut predictions = Vec::new();
        for start in self.system.initial() {
            let rates = |state: &State| model.rates(state);
            let states = integrated(rates, start, self.measured.interval, self.measured.steps)?;
            for state in &states[1..] {
                predictions.extend((0..dimension).map(|k| state[k] / self.measured.sds[k]));
            }
        }
        Some(predictions)
    }

    fn fitted_weakly(
        &self,
        hypothesis: &Hypothesis<'_>,
        begin: Vec<f64>,
        states: &[State],
    ) -> Option<LeastSquares> {
        fit(&hypothesis.coordinates, begin, STEPS[0], |place| {
            let model = hypothesis.placed(place)?;
            self.form.residuals(states, |state| model.rates(state))
        })
    }

    pub fn refined(
        &self,
        hypothesis: Hypothesis<'a>,
        begin: Vec<f64>,
        states: &[State],
        log_prior: f64,
    ) -> Option<Refined<'a>> {
        let reached = self.fitted_weakly(&hypothesis, begin, states)?;
        let weight = reached.log_evidence(&hypothesis.coordinates)? + log_prior;
        Some(Refined {
            hypothesis,
            place: reached.place,
            log_prior,
            weight,
        })
    }

    /// Fits a hypothesis through the equations of motion; `None` where a trajectory is not finite.
    ///
    /// # Arguments
    /// - `horizons`: the number of measurements of each trajectory that are fitted, one fit beginning where the one before has ended.
    pub fn weighed(
        &self,
        hypothesis: &Hypothesis<'a>,
        begin: &[f64],
        log_prior: f64,
        horizons: &[usize],
    ) -> Option<WeighedTerm<'a>> {
        let dimension = self.system.dimension();
        let values = self.measured.values.iter().flat_map(|states| &states[1..]);
        let values: Vec<f64> = values
            .flat_map(|state| (0..dimension).map(|k| state[k] / self.measured.sds[k]))
            .collect();
        let mut place = begin.to_vec();
        let mut reached = None;
        for horizon in horizons {
            let fitted = fit(&hypothesis.coordinates, place, STEPS[1], |place| {
                let predictions = self.predictions(&hypothesis.placed(place)?)?;
                let trajectories = predictions
                    .chunks(POINTS * dimension)
                    .zip(values.chunks(POINTS * dimension));
                let residuals = trajectories.flat_map(|(predictions, values)| {
                    let pairs = predictions.iter().zip(values).take(horizon * dimension);
                    pairs.map(|(p, y)| p - y)
                });
                Some(residuals.collect())
            })?;
            place = fitted.place.clone();
            reached = Some(fitted);
        }
        let weight = reached.as_ref()?.log_evidence(&hypothesis.coordinates)? + log_prior;
        let predictions = self.predictions(&hypothesis.placed(&place)?)?;
        Some(WeighedTerm {
            hypothesis: hypothesis.clone(),
            place,
            weight,
            misfit: reached?.misfit,
            predictions,
        })
    }

    /// Weighs the system without the term, or another one; `None` if no start leads to finite trajectories.
    ///
    /// # Arguments
    /// - `start`: values from which a fit begins beside those of the priors; only a judgement knows the true ones.
    pub fn without(&'a self, removed: Option<usize>, start: Option<Vec<f64>>) -> Option<WeighedTerm<'a>> {
        let model = self.hypothesis(removed, None);
        let prior: Vec<f64> = self.parameters.iter().map(|c| c.mean).collect();
        let weak = self.fitted_weakly(&model, prior.clone(), &self.support.points);
        let starts = weak
            .into_iter()
            .map(|fitted| fitted.place)
            .chain([prior])
            .chain(start);
        let begins = starts.flat_map(|start| HORIZONS.map(|horizons| (start.clone(), horizons)));
        let weighed = begins.filter_map(|(start, horizons)| self.weighed(&model, &start, 0.0, horizons));
        weighed.max_by(|a, b| a.weight.total_cmp(&b.weight))
    }
}

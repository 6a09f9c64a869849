//! A model with unknown parameters, with or without a further term.

use super::super::dynamic_system::State;
use super::super::least_squares::Coordinate;
use super::system::OdeSystem;
use super::term_formula::TermFormula;

/// Sd of the prior of a term's size, over the size of the rate.
const STRENGTH: f64 = 2.0;

/// What a model is compared on.
#[derive(Debug)]
pub struct Support {
    /// Smooth states of both trajectories, one after the other.
    pub points: Vec<State>,
    /// The greatest magnitude of each state.
    pub sizes: State,
    /// Sd of the prior of a term's size in the equation of each state: twice the root of the sum of the mean squares of its rate and of its
    /// terms.
    pub strengths: State,
}

impl Support {
    /// # Arguments
    /// - `points`: smooth states of both trajectories, as many of each. `interval`: the time between two of them.
    /// - `removed`: the term that is left out. `parameters`: assumed values.
    pub fn new(
        points: Vec<State>,
        interval: f64,
        system: &OdeSystem,
        removed: Option<usize>,
        parameters: &[f64],
    ) -> Self {
        let half = points.len() / 2;
        let rises = [&points[..half], &points[half..]];
        let mut squares = State::default();
        for pair in rises.iter().flat_map(|states| states.windows(2)) {
            for (k, square) in squares.iter_mut().enumerate() {
                let rate = (pair[1][k] - pair[0][k]) / interval;
                *square += rate * rate;
            }
        }
        let kept = system
            .terms
            .iter()
            .enumerate()
            .filter(|(index, _)| removed != Some(*index));
        for (_, term) in kept {
            let rates = points.iter().map(|state| (term.rate)(state, parameters));
            squares[term.equation] += rates.map(|rate| rate * rate).sum::<f64>();
        }
        let sizes = std::array::from_fn(|k| points.iter().fold(0.0_f64, |size, x| size.max(x[k].abs())));
        Self {
            strengths: squares.map(|square| STRENGTH * (square / points.len() as f64).sqrt()),
            points,
            sizes,
        }
    }
}

/// A system without a term, and perhaps with a formula in an equation.
///
/// A place has the logarithms of the magnitudes of the system's parameters,
/// then the size of the term, which is its strength times the root mean square of the formula
/// on the support, then the constants of the formula.
#[derive(Debug, Clone)]
pub struct Hypothesis<'a> {
    pub system: &'a OdeSystem,
    pub removed: Option<usize>,
    /// The equation and the formula.
    pub term: Option<(usize, TermFormula)>,
    pub coordinates: Vec<Coordinate>,
    is_log: Vec<bool>,
    support: &'a Support,
}

/// A hypothesis at a place.
#[derive(Debug)]
pub struct PlacedModel<'a> {
    hypothesis: &'a Hypothesis<'a>,
    parameters: Vec<f64>,
    pub strength: f64,
    pub constants: Vec<f64>,
}

impl<'a> Hypothesis<'a> {
    /// # Arguments
    /// - `parameters`: coordinates of the logarithms of the magnitudes of the system's parameters.
    pub fn new(
        system: &'a OdeSystem,
        removed: Option<usize>,
        term: Option<(usize, TermFormula)>,
        parameters: &[Coordinate],
        support: &'a Support,
    ) -> Self {
        let mut coordinates = parameters.to_vec();
        let mut is_log = Vec::new();
        if let Some((equation, formula)) = &term {
            let sd = support.strengths[*equation];
            coordinates.push(Coordinate {
                mean: 0.0,
                sd,
                scale: sd,
            });
            for constant in formula.constants(&support.sizes) {
                coordinates.push(constant.coordinate);
                is_log.push(constant.is_log);
            }
        }
        Self {
            system,
            removed,
            term,
            coordinates,
            is_log,
            support,
        }
    }

    /// Returns the model at a place; `None` if the formula is not finite on the support.
    pub fn placed(&'a self, place: &[f64]) -> Option<PlacedModel<'a>> {
        let (parameters, rest) = place.split_at(self.system.parameters.len());
        let mut model = PlacedModel {
            hypothesis: self,
            parameters: self.system.signed(parameters),
            strength: 0.0,
            constants: Vec::new(),
        };
        if let (Some((_, formula)), Some((size, constants))) = (&self.term, rest.split_first()) {
            let pairs = constants.iter().zip(&self.is_log);
            let constants = pairs.map(|(x, is_log)| if *is_log { libm::exp(*x) } else { *x });
            model.constants = constants.collect();
            let values = self
                .support
                .points
                .iter()
                .map(|x| formula.value(x, &model.constants));
            let squares: f64 = values.map(|value| value * value).sum();
            model.strength = size / (squares / self.support.points.len() as f64).sqrt();
            if !model.strength.is_finite() {
                return None;
            }
        }
        Some(model)
    }
}

impl PlacedModel<'_> {
    /// Returns the rates of the states.
    pub fn rates(&self, state: &State) -> State {
        let Hypothesis {
            system,
            removed,
            term,
            ..
        } = self.hypothesis;
        let mut rates = system.rates(*removed, state, &self.parameters);
        if let Some((equation, formula)) = term {
            rates[*equation] += self.strength * formula.value(state, &self.constants);
        }
        rates
    }

    /// Returns the further term as text.
    pub fn text(&self) -> String {
        match &self.hypothesis.term {
            Some((equation, formula)) => {
                format!("x{equation}': {}", formula.text(self.strength, &self.constants))
            }
            None => "nothing".to_owned(),
        }
    }
}

//! Whether an answer is right.

use super::super::dynamic_system::State;
use super::super::least_squares::{Coordinate, fit};
use super::answer::{DISTINCT, WeighedTerm};
use super::problem::Problem;
use super::system::OdeSystem;
use super::term_formula::TermLibrary;

/// Root mean square of the difference of two rates over that of the exact rate, up to which they are equal.
const SHARP: f64 = 1e-4;
/// The same in the equation of the removed term, over the root mean square of that term.
const SHARP_TERM: f64 = 1e-3;
/// The number of damped steps of a fit to the exact rates.
const STEPS: usize = 60;

/// The answer of the search to a system, judged by the removed term.
#[derive(Debug, Clone, Default)]
pub struct Said {
    /// Whether a missing term is claimed.
    pub is_claimed: bool,
    /// Whether the data favour the whole system over the one without the term by at most [`DISTINCT`].
    pub is_undecidable: bool,
    /// Whether a listed member of the leading class is the removed term.
    pub is_listed: bool,
    /// Whether any member of the leading class is.
    pub is_in_class: bool,
    /// Whether the most probable formula is the removed term.
    pub is_best: bool,
    /// Whether the most probable formula is in the equation of the removed term.
    pub is_placed: bool,
    /// Probability of the leading class among all terms.
    pub probability: f64,
    /// The number of listed members of the leading class.
    pub members: usize,
    /// The most probable formula.
    pub text: String,
}

impl WeighedTerm<'_> {
    /// Returns whether the rates of all states are the exact ones on the trajectories once strength, constants and parameters are
    /// refitted, with no more constants than the removed term has. A term that makes the same system with other parameters is as true.
    fn is_true(&self, problem: &Problem<'_>) -> bool {
        let system = problem.system;
        let (Some(removed), Some((equation, formula))) = (problem.removed, &self.hypothesis.term) else {
            return false;
        };
        let removed = &system.terms[removed];
        if *equation != removed.equation || formula.count() > removed.constants {
            return false;
        }
        let states: Vec<&State> = problem.measured.exact.iter().flatten().collect();
        let exact: Vec<State> = states
            .iter()
            .map(|state| system.rates(None, state, system.parameters))
            .collect();
        let dimension = system.dimension();
        let count = (states.len() * dimension) as f64;
        let size = |values: &mut dyn Iterator<Item = f64>| -> f64 {
            (values.map(|value| value * value).sum::<f64>() / states.len() as f64).sqrt()
        };
        let without = |state: &State| system.rates(problem.removed, state, system.parameters)[*equation];
        let mut of_term = states
            .iter()
            .zip(&exact)
            .map(|(state, rate)| rate[*equation] - without(state));
        let of_term = SHARP_TERM * size(&mut of_term);
        let allowed: Vec<f64> = (0..dimension)
            .map(|k| match k == *equation {
                true => of_term,
                false => SHARP * size(&mut exact.iter().map(|rate| rate[k])),
            })
            .collect();
        let free = |c: &Coordinate| Coordinate {
            sd: f64::INFINITY,
            ..*c
        };
        let coordinates: Vec<Coordinate> = self.hypothesis.coordinates.iter().map(free).collect();
        let reached = fit(&coordinates, self.place.clone(), STEPS, |place| {
            let model = self.hypothesis.placed(place)?;
            let mut residuals = Vec::with_capacity(states.len() * dimension);
            for (state, exact) in states.iter().zip(&exact) {
                let rates = model.rates(state);
                residuals.extend((0..dimension).map(|k| (rates[k] - exact[k]) / allowed[k]));
            }
            Some(residuals)
        });
        reached.is_some_and(|reached| 2.0 * reached.misfit < count)
    }
}

/// Removes a term, or none, and judges what the search says; `None` if the system cannot be measured.
pub fn searched(
    system: &OdeSystem,
    removed: Option<usize>,
    seed: u64,
    library: &TermLibrary,
) -> Option<Said> {
    let problem = Problem::new(system, removed, seed)?;
    let exact = system
        .parameters
        .iter()
        .map(|value| libm::log(value.abs()))
        .collect();
    let whole = problem.without(None, Some(exact)).map(|whole| whole.weight);
    let without = problem
        .without(removed, None)
        .map_or(f64::NEG_INFINITY, |w| w.weight);
    // Trajectories of the whole system are finite at the true parameters, which are among the starts.
    let is_undecidable = removed.is_some() && whole.is_some_and(|whole| whole - without <= DISTINCT);
    let Some(answer) = problem.search(library) else {
        return Some(Said {
            is_undecidable,
            ..Said::default()
        });
    };
    let is_true: Vec<bool> = answer.terms.iter().map(|term| term.is_true(&problem)).collect();
    let best = &answer.terms[0];
    let equation = best.hypothesis.term.as_ref().map(|(equation, _)| *equation);
    Some(Said {
        is_claimed: answer.log_odds > DISTINCT,
        is_undecidable,
        is_listed: answer.listed.iter().any(|index| is_true[*index]),
        is_in_class: answer.class.iter().any(|index| is_true[*index]),
        is_best: is_true[0],
        is_placed: removed.map(|index| system.terms[index].equation) == equation,
        probability: answer.probability,
        members: answer.listed.len(),
        text: best.hypothesis.placed(&best.place)?.text(),
    })
}

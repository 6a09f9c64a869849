//! The formulas that explain best what a model leaves of the weak form.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::super::dynamic_system::State;
use super::hypothesis::{Hypothesis, Support};
use super::term_formula::{TermFormula, TermLibrary};
use super::weak_form::WeakForm;

/// The step of a derivative, over the scale of a coordinate.
const STEP: f64 = 1e-4;
/// Points between two at which functions are compared.
const KEY_DISTANCE: usize = 7;

/// A formula in an equation, with the coordinates of its size and constants at which a fit begins.
#[derive(Debug, Clone)]
pub struct Screened {
    pub equation: usize,
    pub formula: TermFormula,
    pub begin: Vec<f64>,
    /// Log prior and approximate log evidence.
    weight: f64,
    /// What equal functions have in common.
    key: Vec<i64>,
}

/// A factor with constants at which a fit may begin.
struct Begun {
    coordinates: Vec<f64>,
    /// On the support.
    values: Vec<f64>,
}

/// What a model leaves in an equation.
struct Remainder {
    /// Right sides less integrals, once the parameters have followed them.
    rest: DVector<f64>,
    /// The share of a direction that the parameters cannot follow.
    projection: DMatrix<f64>,
}

/// Returns the remainders in each equation of a model that is linearised at a place; `None` where it is not finite.
fn remainders(
    form: &WeakForm,
    states: &[State],
    model: &Hypothesis<'_>,
    place: &[f64],
) -> Option<Vec<Remainder>> {
    let residuals = |place: &[f64]| {
        let placed = model.placed(place)?;
        form.residuals(states, |state| placed.rates(state))
    };
    let here = DVector::from_vec(residuals(place)?);
    let mut slopes = DMatrix::zeros(here.len(), place.len());
    let mut precisions = DMatrix::zeros(place.len(), place.len());
    let mut pull = DVector::zeros(place.len());
    for (k, coordinate) in model.coordinates.iter().enumerate() {
        let step = STEP * coordinate.scale;
        let mut moved = place.to_vec();
        moved[k] += step;
        let there = DVector::from_vec(residuals(&moved)?);
        slopes.set_column(k, &((there - &here) / step));
        precisions[(k, k)] = 1.0 / (coordinate.sd * coordinate.sd);
        pull[k] = (place[k] - coordinate.mean) * precisions[(k, k)];
    }
    let root = (slopes.transpose() * &slopes + precisions).cholesky()?;
    let followed = &here - &slopes * root.solve(&(slopes.transpose() * &here + pull));
    let count = WeakForm::count();
    let of_equation = |equation: usize| {
        let slopes = slopes.rows(equation * count, count);
        let explained = slopes * root.solve(&slopes.transpose());
        Remainder {
            rest: -followed.rows(equation * count, count).into_owned(),
            projection: DMatrix::identity(count, count) - explained,
        }
    };
    Some((0..model.system.dimension()).map(of_equation).collect())
}

/// Returns every place at which the fit of a factor may begin, with the values there that are finite.
fn begun(library: &TermLibrary, states: &[State], support: &Support) -> Vec<Vec<Begun>> {
    let places = |factor: &super::factor::Factor| -> Vec<Begun> {
        let constants = factor.constants(&support.sizes);
        let mut places: Vec<Vec<f64>> = vec![Vec::new()];
        for constant in &constants {
            let extended = places.iter().flat_map(|place| {
                constant.begins.iter().map(move |begin| {
                    let mut place = place.clone();
                    place.push(*begin);
                    place
                })
            });
            places = extended.collect();
        }
        let of_place = |coordinates: Vec<f64>| {
            let pairs = coordinates.iter().zip(&constants);
            let values: Vec<f64> = pairs
                .map(|(x, c)| if c.is_log { libm::exp(*x) } else { *x })
                .collect();
            let values: Vec<f64> = states.iter().map(|x| factor.value(x, &values)).collect();
            let is_finite = values.iter().all(|value| value.is_finite());
            is_finite.then_some(Begun { coordinates, values })
        };
        places.into_iter().filter_map(of_place).collect()
    };
    library.factors.iter().map(places).collect()
}

/// Returns the formulas of a library with the greatest weights, the greatest first; none if the model is not finite.
///
/// # Arguments
/// - `states`: of both trajectories. `place`: parameters of the model about which it is linearised. `kept`: the number of formulas.
pub fn screened(
    form: &WeakForm,
    states: &[State],
    support: &Support,
    model: &Hypothesis<'_>,
    place: &[f64],
    library: &TermLibrary,
    kept: usize,
) -> Vec<Screened> {
    let remainders = remainders(form, states, model, place).unwrap_or_default();
    let begun = begun(library, states, support);
    let mut all: Vec<Screened> = Vec::new();
    for (index, factors) in library.formulas.iter().enumerate() {
        let formula = library.formula(index);
        let log_prior = library.log_prior(formula.size());
        let mut best: Vec<Option<Screened>> = vec![None; remainders.len()];
        for begun in products(&begun, factors, states.len()) {
            let squares: f64 = begun.values.iter().map(|value| value * value).sum();
            let size = (squares / begun.values.len() as f64).sqrt();
            if !(size > 0.0 && size.is_finite()) {
                continue;
            }
            let integrals = form.integrals(&begun.values) / size;
            for (equation, remainder) in remainders.iter().enumerate() {
                let sd = support.strengths[equation];
                let direction = &integrals * (sd / form.sd(equation));
                let precision = 1.0 + direction.dot(&(&remainder.projection * &direction)).max(0.0);
                let along = direction.dot(&remainder.rest);
                let weight = 0.5 * along * along / precision - 0.5 * libm::log(precision) + log_prior;
                if best[equation].as_ref().is_none_or(|best| weight > best.weight) {
                    let size_begin = std::iter::once(sd * along / precision);
                    best[equation] = Some(Screened {
                        equation,
                        formula: formula.clone(),
                        begin: size_begin.chain(begun.coordinates.iter().copied()).collect(),
                        weight,
                        key: key(&begun.values, size),
                    });
                }
            }
        }
        all.extend(best.into_iter().flatten());
    }
    all.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    // The shortest of equal functions, such as a positive state and its magnitude, comes first.
    let mut keys = BTreeSet::new();
    all.retain(|s| keys.len() < kept && keys.insert((s.equation, s.key.clone())));
    all
}

/// Returns every place at which the fit of a product of factors may begin, with the values there.
fn products(begun: &[Vec<Begun>], factors: &[usize], points: usize) -> Vec<Begun> {
    let one = Begun {
        coordinates: Vec::new(),
        values: vec![1.0; points],
    };
    factors.iter().fold(vec![one], |products, factor| {
        let extended = products.iter().flat_map(|product| {
            begun[*factor].iter().map(move |begun| Begun {
                coordinates: product
                    .coordinates
                    .iter()
                    .chain(&begun.coordinates)
                    .copied()
                    .collect(),
                values: product
                    .values
                    .iter()
                    .zip(&begun.values)
                    .map(|(a, b)| a * b)
                    .collect(),
            })
        });
        extended.collect()
    })
}

/// Returns the values over their size to six digits, the first of them positive.
fn key(values: &[f64], size: f64) -> Vec<i64> {
    let sign = if values[0] < 0.0 { -1.0 } else { 1.0 };
    let rounded = values.iter().step_by(KEY_DISTANCE);
    rounded
        .map(|value| (1e6 * sign * value / size).round() as i64)
        .collect()
}

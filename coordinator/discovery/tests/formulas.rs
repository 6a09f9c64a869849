//! Formulas of a law that is claimed, offered by the caller and fitted through the model.

use crate::search::{DATA, OVER_W, added, answer, length, measured, task, w, x};
use crate::setup::{effect, marginal, normal};
use discovery::{Candidate, CandidateError, Conclusion, DiscoverySearch, QueriedModel, Query, SearchVerdict};
use statistics::Distribution;

/// Formulas of w, whose indices follow those of the task: the line that acts, a growth, a square.
const LINE: usize = OVER_W + 2;
const GROWTH: usize = LINE + 1;

fn formulas() -> Vec<Candidate> {
    let scale = marginal(Distribution::Lognormal {
        median: 1.0,
        factor: 3.0,
    });
    vec![
        effect("w line formula", normal(2.0)),
        Candidate::new("w growth", vec![normal(2.0), scale], vec![0]),
        effect("w square", normal(2.0)),
    ]
}

fn predicted(query: &Query) -> Vec<f64> {
    let QueriedModel::With(effects) = &query.model else {
        return answer(query);
    };
    let Some((formula, before)) = effects.split_last().filter(|(last, _)| **last >= LINE) else {
        return answer(query);
    };
    let parameters = 2 + before.iter().map(|k| length(*k)).sum::<usize>();
    let (theta, of_formula) = query.theta.split_at(parameters);
    let value = |i: usize| {
        let mut value = theta[0] + theta[1] * x(i);
        let mut rest = &theta[2..];
        for &k in before {
            value += added(k, rest, x(i), w(i));
            rest = &rest[length(k)..];
        }
        value
            + of_formula[0]
                * match *formula {
                    LINE => w(i),
                    GROWTH => libm::exp(w(i) / of_formula[1]),
                    _ => w(i) * w(i),
                }
    };
    (0..DATA).map(value).collect()
}

/// Runs a search in which a square and a line over w act, and offers formulas where it wants them; the number of offers.
fn concluded(offered: &[Candidate]) -> (Conclusion, usize) {
    let values = measured(|x, w| 0.3 + 0.5 * x + 1.2 * x * x + 0.8 * w);
    let mut search = DiscoverySearch::new(task(&values)).unwrap();
    let mut offers = 0;
    loop {
        if let Some(conclusion) = search.conclusion() {
            return (conclusion.clone(), offers);
        }
        if let Some(request) = search.wanted_formulas() {
            assert_eq!((request.law, request.curve.knots.len()), (1, 5));
            assert!(search.pending().is_empty());
            search.offer_formulas(offered.to_vec()).unwrap();
            offers += 1;
        }
        for index in 0..search.pending().len() {
            let values = predicted(search.query(index).unwrap());
            search.tell(index, Some(&values)).unwrap();
        }
    }
}

#[test]
fn the_formula_that_acts_is_the_most_probable() {
    let (conclusion, offers) = concluded(&formulas());
    assert_eq!(offers, 1);
    let law = conclusion.outside.unwrap();
    let order: Vec<usize> = law.formulas.iter().map(|fit| fit.formula).collect();
    assert_eq!(order, [0, 1, 2]);
    let [line, growth, square] = law.formulas.as_slice() else {
        panic!("{:?}", law.formulas)
    };
    assert!((line.parameters[0] - 0.8).abs() < 0.1, "{line:?}");
    assert_eq!(growth.parameters.len(), 2);
    assert!(
        line.log_bayes_factor > square.log_bayes_factor + 50.0,
        "{square:?}"
    );
}

#[test]
fn formulas_change_nothing_else() {
    let (with, _) = concluded(&formulas());
    let (without, offers) = concluded(&[]);
    assert_eq!((without.verdict, offers), (SearchVerdict::NotInLibrary, 1));
    assert!(
        without
            .outside
            .as_ref()
            .is_some_and(|law| law.formulas.is_empty())
    );
    assert!(with.evaluations > without.evaluations);
    let bare = |conclusion: Conclusion| Conclusion {
        evaluations: 0,
        outside: None,
        ..conclusion
    };
    assert_eq!(bare(with), bare(without));
}

#[test]
fn a_formula_without_a_strength_is_refused() {
    let values = measured(|x, _| 0.3 + 0.5 * x);
    let mut search = DiscoverySearch::new(task(&values)).unwrap();
    let pending = search.pending().len();
    let refused = search.offer_formulas(vec![Candidate::new("none", vec![normal(1.0)], Vec::new())]);
    assert!(
        matches!(refused, Err(CandidateError::NoStrength { .. })),
        "{refused:?}"
    );
    // Nothing is wanted here, so an offer changes nothing.
    search.offer_formulas(formulas()).unwrap();
    assert_eq!(search.pending().len(), pending);
}

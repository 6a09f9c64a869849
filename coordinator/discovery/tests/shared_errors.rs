//! Errors that sessions share, in the likelihood of a search and beside it.

use discovery::{Conclusion, SearchTask, SharedErrorSource, SuspectedError, SuspectedShift};
use statistics::{CommonError, CommonErrorSize, ErrorLaw, ErrorSd, Likelihood, Prior};

use super::search::{answer, measured, task};
use super::setup::{self, marginal, normal};
use statistics::Distribution;

/// The parameter of the base that is the sd of the sessions' offsets.
const SESSION: usize = 2;
const SESSIONS: usize = 4;
const SCALE: f64 = 0.3;

/// Returns the data of each session: those of its number modulo their count, so that each has all levels.
pub(crate) fn sessions(count: usize) -> Vec<Vec<usize>> {
    let of_session = |session: usize| (0..count).filter(|i| i % SESSIONS == session).collect();
    (0..SESSIONS).map(of_session).collect()
}

/// Searches data whose sessions have offsets, with an inferred sd of these.
fn searched(offsets: [f64; SESSIONS]) -> Conclusion {
    let mut values = measured(|x, _| 0.3 + 0.5 * x);
    for (i, value) in values.iter_mut().enumerate() {
        *value += offsets[i % SESSIONS];
    }
    let whole = task(&values);
    let error = |data: Vec<usize>| CommonError {
        data,
        size: CommonErrorSize::Shift(ErrorSd::Inferred { parameter: SESSION }),
    };
    let common = sessions(values.len()).into_iter().map(error).collect();
    let data = whole.likelihood.data().to_vec();
    let half = marginal(Distribution::HalfNormal { scale: SCALE });
    let factor = SuspectedError {
        groups: (0..values.len()).step_by(2).map(|i| vec![i, i + 1]).collect(),
        shift: SuspectedShift::Factor,
        prior_scale: 0.1,
    };
    let task = SearchTask {
        prior: Prior::new(vec![normal(1.0), normal(1.0), half]),
        likelihood: Likelihood::with_common(data, ErrorLaw::Gaussian, common, Vec::new()).unwrap(),
        suspected_errors: vec![factor],
        ..whole
    };
    setup::conclude(task, false, |query| {
        let mut model = query.clone();
        model.theta.remove(SESSION);
        Some(answer(&model))
    })
}

#[test]
fn an_offset_of_sessions_is_found_and_where_none_acts_none_is() {
    let offsets = [0.4, -0.3, 0.2, -0.3];
    let found = searched(offsets);
    assert!(!found.verdict.is_claim(), "{:?}", found.verdict);
    let [session, factor] = &found.shared_errors[..] else {
        panic!("{:?}", found.shared_errors);
    };
    assert_eq!(session.source, SharedErrorSource::Parameter(SESSION));
    assert!(session.probability > 0.999, "{session:?}");
    assert!((0.15..0.8).contains(&session.sd), "{session:?}");
    // The mean of the offsets is part of the base's constant.
    for (group, offset) in session.groups.iter().zip(offsets) {
        assert!((group.mean - offset).abs() < 3.0 * group.sd, "{group:?} {offset}");
        assert!(group.sd < 0.2, "{group:?}");
    }
    assert_eq!(factor.source, SharedErrorSource::Suspected(0));
    assert!(factor.probability < 0.8, "{factor:?}");
    let none = searched([0.0; SESSIONS]);
    assert!(!none.verdict.is_claim(), "{:?}", none.verdict);
    assert!(
        none.shared_errors.iter().all(|error| error.probability < 0.8),
        "{:?}",
        none.shared_errors
    );
}

/// The evidence ratio of a linear model is that of the dense covariances.
#[test]
fn the_bayes_factor_is_that_of_the_marginal_likelihoods() {
    use nalgebra::{DMatrix, DVector};
    let values = {
        let mut values = measured(|x, _| 0.3 + 0.5 * x);
        for (i, value) in values.iter_mut().enumerate() {
            *value += [0.1, -0.1, 0.05, -0.05][i % SESSIONS];
        }
        values
    };
    let count = values.len();
    let x = |i: usize| (i / 3) as f64 / 7.0 * 2.0 - 1.0;
    let density = |sd: f64| {
        let covariance = DMatrix::from_fn(count, count, |i, j| {
            let noise = if i == j { 0.01 } else { 0.0 };
            let session = if i % SESSIONS == j % SESSIONS {
                sd * sd
            } else {
                0.0
            };
            noise + session + 1.0 + x(i) * x(j)
        });
        let cholesky = covariance.cholesky().unwrap();
        let y = DVector::from_vec(values.clone());
        -0.5 * (y.dot(&cholesky.solve(&y)) + cholesky.ln_determinant())
    };
    let cells = 4000;
    let sds = (0..cells).map(|k| (k as f64 + 0.5) * 6.0 * SCALE / f64::from(cells));
    let weight = |sd: f64| (-0.5 * (sd / SCALE).powi(2)).exp();
    let mean = sds
        .clone()
        .map(|sd| weight(sd) * (density(sd) - density(0.0)).exp())
        .sum::<f64>()
        / sds.map(weight).sum::<f64>();
    let found = searched([0.1, -0.1, 0.05, -0.05]);
    let factor = found.shared_errors[0].log_bayes_factor;
    assert!((factor - mean.ln()).abs() < 0.1, "{factor} {}", mean.ln());
}

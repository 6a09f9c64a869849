//! The base without one of its effects, where the sds of the noise and of an error that sessions share are inferred. The sds follow the
//! strength of the effect among the parameters, so each moves forward by one where the effect is left out.

use discovery::{Conclusion, QueriedModel, Reduction, SearchTask, SearchVerdict, SharedErrorSource};
use statistics::{CommonError, CommonErrorSize, Datum, ErrorLaw, ErrorSd, Likelihood, Prior};

use super::replacement::{answer, wrong_base};
use super::search::{LIBRARY, SQUARE};
use super::setup::{self, half_normal, noise, normal};
use super::shared_errors::sessions;

/// The parameters of the base that are inferred sds, after its constant, its slope and the strength of its effect.
const SESSION: usize = 3;
const NOISE: usize = 4;
const OFFSETS: [f64; 4] = [0.4, -0.3, 0.2, -0.3];

/// Searches beyond the base with the wrong effect, on data of sessions with offsets.
///
/// # Arguments
/// - `kept`: the parameters of the base without its effect.
fn find(truth: impl Fn(f64, f64) -> f64, kept: &[usize]) -> Conclusion {
    let whole = wrong_base(truth, (0..LIBRARY).collect());
    let data = whole.likelihood.data().iter().enumerate();
    let data: Vec<Datum> = data
        .map(|(i, datum)| Datum {
            value: datum.value + OFFSETS[i % OFFSETS.len()],
            sd: ErrorSd::Inferred { parameter: NOISE },
            ..*datum
        })
        .collect();
    let error = |data: Vec<usize>| CommonError {
        data,
        size: CommonErrorSize::Shift(ErrorSd::Inferred { parameter: SESSION }),
    };
    let common = sessions(data.len()).into_iter().map(error).collect();
    let mut prior = vec![normal(1.0); 3];
    prior.extend([half_normal(0.3), noise()]);
    let reductions = whole.reductions.iter().map(|reduction| Reduction {
        parameters: kept.to_vec(),
        ..reduction.clone()
    });
    let task = SearchTask {
        prior: Prior::new(prior),
        likelihood: Likelihood::with_common(data, ErrorLaw::Gaussian, common, Vec::new()).unwrap(),
        reductions: reductions.collect(),
        ..whole
    };
    setup::conclude(task, false, |query| {
        let mut model = query.clone();
        let first = match query.model {
            QueriedModel::With(_) => SESSION,
            QueriedModel::Without(..) => SESSION - 1,
        };
        model.theta.drain(first..first + 2);
        Some(answer(&model))
    })
}

const KEPT: [usize; 4] = [0, 1, SESSION, NOISE];

#[test]
fn an_effect_of_the_base_without_evidence_is_redundant() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x, &KEPT);
    assert_eq!(conclusion.verdict, SearchVerdict::NothingDetectable);
    assert!(
        conclusion.gains[0].is_some_and(|gain| gain < 0.0),
        "{:?}",
        conclusion.gains
    );
    assert_eq!(conclusion.redundant().collect::<Vec<_>>(), [0]);
}

#[test]
fn a_better_effect_takes_the_place_of_one_that_was_added_wrongly() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x + 1.1 * x * x, &KEPT);
    let claimed = conclusion.claimed_replacement();
    let claimed = claimed.unwrap_or_else(|| panic!("{:?}", conclusion.replacements));
    assert_eq!((claimed.reduction, claimed.candidate), (0, SQUARE));
    assert_eq!(conclusion.verdict, SearchVerdict::Named(SQUARE));
    // The error is judged beside the replacement, and named by its parameter in the base.
    let [session] = &conclusion.shared_errors[..] else {
        panic!("{:?}", conclusion.shared_errors);
    };
    assert_eq!(session.source, SharedErrorSource::Parameter(SESSION));
    assert!(session.probability > 0.99, "{session:?}");
    for (group, offset) in session.groups.iter().zip(OFFSETS) {
        assert!((group.mean - offset).abs() < 3.0 * group.sd, "{group:?} {offset}");
    }
}

#[test]
fn a_reduction_without_the_parameter_of_an_inferred_sd_is_not_fitted() {
    let conclusion = find(|x, _| 0.3 + 0.5 * x, &[0, 1, SESSION]);
    assert_eq!(conclusion.gains, [None]);
    assert!(conclusion.redundant().next().is_none());
}

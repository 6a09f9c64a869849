//! Flags of workers that compute wrongly or fail, and of external models that are not deterministic.

use shared::channel::Channel;

use result::finished_calibration::FinishedCalibration;
use result::flag::{Flag, FlagKind};
use result::words::number;

/// Returns a flag if an evaluation got two different results.
pub(super) fn disputed(calibration: &FinishedCalibration) -> Option<Flag> {
    let first = calibration.disputes.first()?;
    let who = if first.first == first.second {
        format!("by worker {} twice", first.first)
    } else {
        format!("by workers {} and {}", first.first, first.second)
    };
    let more = match calibration.disputes.len() {
        1 => String::new(),
        n => format!(", and {} more", n - 1),
    };
    if calibration.spec.model.kind.is_external() {
        let text = format!(
            "evaluation {} was answered {who} with different results{more}: the model is not deterministic, or its machines differ",
            first.evaluation
        );
        return Some(Flag::plain(FlagKind::Worker, text));
    }
    let text = format!(
        "evaluation {} was answered {who} with different results{more}: a machine computes wrongly, and no number of this calibration can be trusted; find the machine and repeat the calibration without it",
        first.evaluation
    );
    Some(Flag::plain(FlagKind::Worker, text))
}

/// Returns a flag for each worker that computes wrongly, with what became of its results.
pub(super) fn quarantined(calibration: &FinishedCalibration) -> Vec<Flag> {
    let results = |n: u64| number::count(usize::try_from(n).unwrap_or(usize::MAX), "result");
    let resting = calibration.verified.resting_on.iter().map(|(worker, &n)| {
        format!(
            "{} of worker {worker}, which was found to compute wrongly since, with what only such workers have confirmed, count: no number of this calibration can be trusted; repeat it without that machine",
            results(n)
        )
    });
    let repeated = calibration.verified.computed_again.iter().map(|(worker, &n)| {
        let what = match n {
            0 => "no result rests on it alone".to_owned(),
            n => format!(
                "{} of it, and what followed from them, were computed again by others",
                results(n)
            ),
        };
        format!(
            "{} wrongly and was quarantined; {what}; from then on every result was compared",
            who(worker)
        )
    });
    resting
        .chain(repeated)
        .map(|text| Flag::plain(FlagKind::Worker, text))
        .collect()
}

/// Names a quarantined worker; a name that ends with a slash is that of all workers of a token.
fn who(worker: &str) -> String {
    match worker.strip_suffix('/') {
        Some(token) => format!("whoever has the token {token} computes"),
        None => format!("worker {worker} computes"),
    }
}

/// Returns a flag if an external model gave different results for the same evaluation.
pub(super) fn not_deterministic(calibration: &FinishedCalibration) -> Option<Flag> {
    let repeats = &calibration.repeats;
    let sizes: Vec<String> = Channel::ALL
        .into_iter()
        .filter(|&channel| repeats.largest.channel(channel) > 0.0)
        .map(|channel| {
            let size = number::significant(repeats.largest.channel(channel), 2);
            format!("{size} {} of {}", channel.unit(), channel.words())
        })
        .collect();
    let refused = repeats.largest.is_refused.then(|| "a refusal".to_owned());
    let sizes: Vec<String> = sizes.into_iter().chain(refused).collect();
    let text = format!(
        "the model is not deterministic: {} of {} evaluations that were asked for twice were answered in two ways, up to {}; add its scatter to the noise, and expect no equal bits of a repeated calibration",
        repeats.differing,
        repeats.evaluations,
        number::list(&sizes)
    );
    (repeats.differing > 0).then(|| Flag::plain(FlagKind::Worker, text))
}

/// Returns a flag if evaluations failed on every worker.
pub(super) fn given_up(calibration: &FinishedCalibration) -> Option<Flag> {
    let count = number::count(usize::try_from(calibration.given_up).ok()?, "evaluation");
    let text = format!(
        "{count} failed on every worker that tried them and count as rejected: near their parameters the posterior is too small; the workers' logs and diagnose say what failed"
    );
    (calibration.given_up > 0).then(|| Flag::plain(FlagKind::Worker, text))
}

#[cfg(test)]
mod tests {
    use record::Dispute;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_model_that_answers_in_two_ways_is_said_with_the_size_of_it() {
        let mut calibration = fixture::calibration();
        assert_eq!(not_deterministic(&calibration), None);
        calibration.repeats.evaluations = 50;
        assert_eq!(not_deterministic(&calibration), None);
        calibration.repeats.differing = 3;
        calibration.repeats.largest.torque_n_m = 0.0625;
        let flag = not_deterministic(&calibration).unwrap();
        assert!(flag.text.contains("3 of 50 evaluations"), "{}", flag.text);
        assert!(
            flag.text.contains("up to 0.063 N m of torque;") || flag.text.contains("0.062 N m of torque"),
            "{}",
            flag.text
        );
    }

    #[test]
    fn given_up_evaluations_are_counted() {
        let mut calibration = fixture::calibration();
        assert_eq!(given_up(&calibration), None);
        calibration.given_up = 2;
        let flag = given_up(&calibration).unwrap();
        assert_eq!(flag.kind, FlagKind::Worker);
        assert!(flag.text.starts_with("2 evaluations failed"), "{}", flag.text);
    }

    #[test]
    fn a_quarantined_worker_is_named_with_what_became_of_its_results() {
        let mut calibration = fixture::calibration();
        assert!(quarantined(&calibration).is_empty());
        calibration.verified.resting_on = [("late".into(), 1)].into();
        calibration.verified.computed_again = [("bad".into(), 40), ("idle".into(), 0)].into();
        let texts: Vec<String> = quarantined(&calibration)
            .into_iter()
            .map(|flag| flag.text)
            .collect();
        assert!(
            texts[0].starts_with("1 result of worker late, which"),
            "{texts:?}"
        );
        assert!(
            texts[1].contains("40 results of it, and what followed from them, were computed again by others")
        );
        assert!(texts[2].ends_with("no result rests on it alone; from then on every result was compared"));
    }

    #[test]
    fn a_disputed_evaluation_names_its_workers() {
        let mut calibration = fixture::calibration();
        assert_eq!(disputed(&calibration), None);
        let dispute = |evaluation, second: &str| Dispute {
            evaluation,
            first: "a-1".into(),
            second: second.into(),
        };
        calibration.disputes = vec![dispute(17, "b-2"), dispute(19, "a-1")];
        let flag = disputed(&calibration).unwrap();
        assert_eq!(flag.kind.name(), "worker");
        for part in ["evaluation 17", "a-1 and b-2", "and 1 more"] {
            assert!(flag.text.contains(part), "{}", flag.text);
        }
        calibration.disputes.remove(0);
        assert!(
            disputed(&calibration)
                .unwrap()
                .text
                .contains("by worker a-1 twice with")
        );
    }
}

//! A part of the bench `sbc`: ranks of the truth are uniform, and a mistake in the noise is found.

use benchmark::sbc::{Study, Verdict, binomial_p, judge};

/// More bins would be nearly empty with twenty ranks.
const BINS: usize = 4;
const MIN_P: f64 = 1e-3;

fn verdicts(noise_factor: f64) -> Vec<Verdict> {
    let study = Study {
        sets: 20,
        particles: 100,
        seed: 7,
        noise_factor,
        is_emulated: false,
    };
    let rankings = study.run().expect("every data set is calibrated");
    assert_eq!(rankings.len(), study.sets);
    let flagged = rankings.iter().filter(|f| !f.equilibrated).count();
    assert!(flagged <= 4, "{flagged} flagged");
    assert!(rankings.iter().all(|f| f.rejected < 10));
    judge(&study.parameters().expect("the job is valid"), &rankings, BINS)
}

#[test]
fn the_truth_is_one_more_draw_of_its_posterior() {
    let verdicts = verdicts(1.0);
    let judged: Vec<&str> = verdicts.iter().map(|v| v.parameter.as_str()).collect();
    assert_eq!(judged.len(), 5, "{judged:?}");
    for v in &verdicts {
        assert!(v.p > MIN_P && v.coverage_p > MIN_P, "{v:?}");
        assert!(v.coverage >= 0.6, "{v:?}");
        assert_eq!(v.counts.iter().sum::<usize>(), 20);
    }
}

#[test]
fn noise_that_the_likelihood_understates_is_found() {
    let verdicts = verdicts(4.0);
    let found = verdicts.iter().any(|v| v.p < MIN_P || v.coverage_p < MIN_P);
    assert!(found, "{verdicts:?}");
}

#[test]
fn tails_have_their_tabulated_values() {
    // Nine of ten is the most probable count, so that every count is at most as probable. For seven of ten the sum has the counts up to 7.
    let all = binomial_p(9, 10, 0.9);
    assert!((all - 1.0).abs() < 1e-9, "{all}");
    let seven = binomial_p(7, 10, 0.9);
    assert!((seven - 0.070_190_826_4).abs() < 1e-9, "{seven}");
}

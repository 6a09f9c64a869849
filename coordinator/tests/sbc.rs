//! A slice of the bench `sbc`: ranks of the truth are uniform, and a mistake in the noise shows.

#[path = "../benches/sbc/study.rs"]
mod study;

use study::{Study, Verdict, binomial_p, chi_square_tail, judge};

/// Twenty ranks fill no more bins.
const BINS: usize = 4;
const LEAST_P: f64 = 1e-3;

fn verdicts(noise_factor: f64) -> Vec<Verdict> {
    let study = Study {
        sets: 20,
        particles: 100,
        seed: 7,
        noise_factor,
    };
    let fates = study.run().expect("every data set is calibrated");
    assert_eq!(fates.len(), study.sets);
    let flagged = fates.iter().filter(|f| !f.equilibrated).count();
    assert!(flagged <= 4, "{flagged} flagged");
    assert!(fates.iter().all(|f| f.refused < 10));
    judge(&study.parameters().expect("the job is valid"), &fates, BINS)
}

#[test]
fn the_truth_is_one_more_draw_of_its_posterior() {
    for v in verdicts(1.0) {
        assert!(v.p > LEAST_P && v.coverage_p > LEAST_P, "{v:?}");
        assert_eq!(v.counts.iter().sum::<usize>(), 20);
        assert!(v.coverage <= 1.0);
    }
}

#[test]
fn noise_that_the_likelihood_does_not_know_of_shows() {
    let verdicts = verdicts(4.0);
    let found = verdicts.iter().any(|v| v.p < LEAST_P || v.coverage_p < LEAST_P);
    assert!(found, "{verdicts:?}");
    assert!(verdicts.iter().any(|v| v.parameter == "friction_angle_deg"));
}

#[test]
fn tails_have_their_tabulated_values() {
    // tables of chi-square: 43.820 with 19 degrees of freedom and 18.467 with 4 are exceeded with 0.001, 7.815 with 3 with 0.05
    for (x, degrees, p) in [(43.820, 19, 0.001), (18.467, 4, 0.001), (7.815, 3, 0.05)] {
        let got = chi_square_tail(x, degrees);
        assert!((got / p - 1.0).abs() < 1e-3, "{x} {degrees}: {got}");
    }
    // ten of ten: 0.9^10; with what is rarer, 0.9^10 is not the mode, so counts of 7 and fewer come along
    let all = binomial_p(9, 10, 0.9);
    assert!((all - 1.0).abs() < 1e-9, "{all}");
    let seven = binomial_p(7, 10, 0.9);
    assert!((seven - 0.070_190_826_4).abs() < 1e-9, "{seven}");
}

//! Files and formulas of all kinds: no panic, places that are there, the same bits however a formula is evaluated.
//!
//! `cargo run -p formula --release --example fuzz -- --minutes 10` does the same for longer, with other bytes.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::generate::{Dice, anything, check_evaluation, check_exact, check_read, file};

/// The same cases in every run.
fn run(cases: u32, bytes: usize, check: impl Fn(&[u8])) {
    let config = Config {
        failure_persistence: None,
        ..Config::with_cases(cases)
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let checked = runner.run(&vec(any::<u8>(), 0..bytes), |bytes| {
        check(&bytes);
        Ok(())
    });
    checked.unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn any_text_is_read_or_refused_at_a_place_that_is_there() {
    run(60_000, 400, |bytes| {
        check_read(&anything(&mut Dice(bytes)));
    });
}

#[test]
fn any_formula_has_the_same_bits_at_one_point_and_in_blocks() {
    let compared = std::cell::Cell::new(0);
    run(20_000, 1200, |bytes| {
        let mut dice = Dice(bytes);
        if let Some(effect) = check_read(&file(&mut dice)) {
            compared.set(compared.get() + check_evaluation(&effect, &mut dice));
        }
    });
    assert!(compared.get() > 50_000, "{} values", compared.get());
}

#[test]
fn formulas_mean_what_their_signs_say() {
    run(60_000, 200, |bytes| check_exact(&mut Dice(bytes)));
}

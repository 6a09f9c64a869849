//! Random files and formulas: no panic, errors with valid places, and the same bits however a formula is evaluated.
//!
//! `cargo run -p formula --release --example fuzz -- --minutes 10` runs longer, with different bytes.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::generate::{Dice, anything, check_evaluation, check_exact, check_read, file};

/// Runs the check on the same cases in every run.
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
    run(250_000, 400, |bytes| {
        check_read(&anything(&mut Dice(bytes)));
    });
}

#[test]
fn any_formula_has_the_same_bits_at_one_point_and_in_blocks() {
    let compared = std::cell::Cell::new(0);
    run(90_000, 1200, |bytes| {
        let mut dice = Dice(bytes);
        if let Some(effect) = check_read(&file(&mut dice)) {
            compared.set(compared.get() + check_evaluation(&effect, &mut dice));
        }
    });
    assert!(compared.get() > 100_000, "{} values", compared.get());
}

#[test]
fn formulas_follow_the_precedence_of_their_operators() {
    run(300_000, 200, |bytes| check_exact(&mut Dice(bytes)));
}

#[test]
fn a_file_made_to_exhaust_the_stack_is_refused() {
    // 79 inline tables of 79 dotted names each are 6241 nested tables in 13 kB
    let names = ["a"; 79].join(".");
    let prior = format!("{}1{}", format!("{{ {names} = ").repeat(79), " }".repeat(79));
    let text = format!(
        "name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\npressure = \"p * a\"\n\
         [parameters.a]\nunit = \"1\"\nneutral = 0\nprior = {prior}\n"
    );
    let read = move || check_read(&text).is_none();
    let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(read);
    assert!(thread.unwrap().join().unwrap());
}

#[test]
fn the_largest_effect_is_computed() {
    // close to the maximum number of operations of an effect
    let terms = |first: usize| {
        (first..first + 60)
            .map(|i| format!("sin(z*{i}.5)"))
            .collect::<Vec<_>>()
    };
    let definitions: String = (0..4)
        .map(|k| format!("d_{k} = \"{}\"\n", terms(60 * k).join("+")))
        .collect();
    let text = format!(
        "name = \"toy\"\nsummary = \"a toy\"\nsource = \"none\"\npressure = \"p * (d_0 * d_1 + d_2 * d_3)\"\n\
         [definitions]\n{definitions}"
    );
    let effect = check_read(&text).unwrap_or_else(|| panic!("{}", formula::Effect::read(&text).unwrap_err()));
    let bytes: Vec<u8> = (0..2000_u32).map(|i| ((i * 7919) >> 3) as u8).collect();
    assert!(check_evaluation(&effect, &mut Dice(&bytes)) > 0);
}

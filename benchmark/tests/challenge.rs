//! A part of the bench `challenge`.

use std::sync::LazyLock;

use benchmark::challenge::bioreactor;
use benchmark::challenge::correction::{SCENARIOS, searched};
use equation::FormulaLibrary;

static LIBRARY: LazyLock<FormulaLibrary> = LazyLock::new(|| FormulaLibrary::new(7, false));

#[test]
fn designed_experiments_name_monods_law_in_a_reactor() {
    let campaign = bioreactor::campaign(1, &LIBRARY).expect("a campaign");
    let (designed, is_right) = campaign.named().expect("a name");
    assert!(
        is_right && (1..=bioreactor::DESIGNED).contains(&designed),
        "{designed}"
    );
}

#[test]
fn nothing_is_claimed_beyond_a_growth_rate_that_is_given() {
    for seed in 1..=3 {
        let log_bayes_factor = bioreactor::claim_beyond_the_truth(seed).expect("a fit");
        assert!(
            !bioreactor::is_claimed(log_bayes_factor),
            "{seed}: {log_bayes_factor}"
        );
    }
}

#[test]
fn a_correction_of_a_textbook_law_has_its_formula() {
    let drag = SCENARIOS
        .iter()
        .find(|scenario| scenario.name == "nonlinear drag");
    let said = searched(drag.expect("the scenario"), &LIBRARY, 0.01, 1, 5).expect("a curve");
    assert!(
        said.is_in_class && said.is_simplest && said.probability > 0.5,
        "{}",
        said.simplest
    );
}

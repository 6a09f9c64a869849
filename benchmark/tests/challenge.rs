//! A part of the bench `challenge`.

use std::sync::LazyLock;

use benchmark::challenge::bioreactor;
use benchmark::challenge::correction::{Libraries, Search};
use benchmark::challenge::scenario::SCENARIOS;
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
fn corrections_of_textbook_laws_have_their_formulas() {
    let libraries = Libraries::new(6);
    for (name, noise) in [
        ("nonlinear drag", 0.01),
        ("screened Coulomb force", 0.05),
        ("sinc of kinetic energy", 0.01),
    ] {
        let mut scenarios = SCENARIOS.iter().enumerate();
        let scenario = scenarios.find(|(_, scenario)| scenario.name == name);
        let (number, scenario) = scenario.expect("the scenario");
        let said = Search::new(scenario, &libraries).said(noise, 1, number as u64);
        let said = said.expect("a curve");
        assert!(
            said.is_in_class && said.is_simplest && said.is_credible && said.probability > 0.5,
            "{name}: {said:?}"
        );
    }
}

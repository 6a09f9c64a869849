//! A part of the bench `challenge`.

use std::sync::LazyLock;

use benchmark::challenge::bioreactor;
use benchmark::challenge::correction::{Libraries, Search};
use benchmark::challenge::odebench::{self, judgement, term_formula::TermLibrary};
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

#[test]
fn a_term_that_is_removed_from_a_system_is_in_the_class() {
    let libraries: Vec<TermLibrary> = (1..=2).map(TermLibrary::new).collect();
    // Logistic growth and a bead on a rotating hoop, whose searches are short.
    for number in [6, 34] {
        let system = odebench::systems().find(|system| system.number == number);
        let system = system.expect("the system");
        let library = &libraries[system.dimension() - 1];
        let removed = odebench::removed(system, 1);
        let said = judgement::searched(system, removed, 1, library).expect("an answer");
        assert!(
            said.is_claimed && said.is_listed && !said.is_undecidable,
            "{number}: {}",
            said.text
        );
        let of_whole = judgement::searched(system, None, 1, library).expect("an answer");
        assert!(!of_whole.is_claimed, "{number}: {}", of_whole.text);
    }
}

#[test]
fn a_term_that_the_data_hardly_show_is_undecidable_and_unclaimed() {
    let system = odebench::systems()
        .find(|system| system.number == 18)
        .expect("the system");
    let said = judgement::searched(system, Some(2), 1, &TermLibrary::new(1)).expect("an answer");
    assert!(said.is_undecidable && !said.is_claimed, "{}", said.text);
}

//! A part of the bench `decision`: the repaired model predicts unseen conditions, and the posterior of a campaign knows what its choice costs.

use benchmark::posterior_use::{campaigns, unseen};

#[test]
fn the_repaired_model_predicts_unseen_conditions_to_a_part_of_the_noise() {
    let [base, repaired] = &unseen::run(40, 3).expect("predictions")[..] else {
        panic!("two models");
    };
    let ([of_base, _, _], [of_repaired, _, interpolated]) = (base.errors(0), repaired.errors(0));
    assert!(
        of_repaired < 0.1 * of_base && of_repaired < interpolated,
        "{base}{repaired}"
    );
    assert!(
        repaired.coverage() > 0.8 && base.coverage() < 0.7,
        "{base}{repaired}"
    );
}

#[test]
fn a_posterior_states_what_its_choices_cost_and_chooses_no_worse_than_a_point_estimate() {
    let tally = campaigns::run(8, 5).expect("campaigns");
    let [excess, error] = tally.mean(|campaign| campaign.stated - campaign.by_posterior);
    assert!(excess.abs() <= 4.0 * error, "{excess} ± {error}\n{tally}");
    let [gain, error] = tally.gain();
    assert!(gain >= -error, "{tally}");
}

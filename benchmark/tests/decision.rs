//! A part of the bench `decision`: the repaired model predicts unseen conditions, and choices of campaigns have their costs.

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
fn no_choice_costs_less_than_the_best_option_at_the_truth() {
    let tally = campaigns::run(3, 5).expect("campaigns");
    for campaign in &tally.0 {
        assert!(
            campaign.by_posterior >= campaign.least && campaign.by_mode >= campaign.least,
            "{campaign:?}"
        );
        assert!(campaign.differs || (campaign.by_posterior - campaign.by_mode).abs() < 1e-9);
    }
}

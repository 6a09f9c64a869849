//! An effect of the model that another one replaces: what a search says of it.

use farm_tests::job::Job;
use farm_tests::json::word;
use farm_tests::programs::study;

#[test]
fn an_effect_that_the_model_has_wrongly_is_replaced_by_the_one_that_is_missing() {
    let job = Job::late_shear()
        .in_job(
            "shear_velocity_m_s = 0.001",
            "shear_velocity_m_s = 0.001\neffects = [\"bin_slope\"]",
        )
        .in_job(
            "algorithm = \"tmcmc\"\nparticles = 60\nmoves = [2, 4]",
            "algorithm = \"lm\"",
        )
        .in_job("[sampler]", "[discovery]\napply = \"ask\"\n[sampler]");
    let (printed, summary) = study(&job);
    let round = &summary["discovery"]["rounds"][0];
    assert_eq!(round["verdict"], "named", "{}", round["text"]);
    assert_eq!(round["extension"]["effect"], "janosi_hanamoto");
    let replacement = &round["replacements"][0];
    assert_eq!(replacement["effect"], "janosi_hanamoto");
    assert_eq!(replacement["in_place_of"], "bin_slope");
    assert_eq!(replacement["is_named"], true, "{replacement}");
    let claim = "janosi_hanamoto is missing in the place of bin_slope: ";
    assert!(word(&round["text"]).starts_with(claim), "{}", round["text"]);
    let joined = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(joined.contains(claim.trim_end()), "{printed}");
}

//! Laws outside the catalogue in a study that continues its search.

use farm_tests::job::Job;
use farm_tests::json::{float, items, word};
use farm_tests::programs::study;

/// Checks that the forms of a law are ranked, the claimed one first, and that their probabilities are a distribution.
fn check_forms(outside: &serde_json::Value) {
    let forms: Vec<&serde_json::Value> = items(&outside["forms"]).collect();
    assert!(forms.len() > 3, "{outside}");
    assert_eq!(forms[0]["form"], outside["form"]);
    assert_eq!(forms[0]["log_bayes_factor"], outside["log_bayes_factor"]);
    assert_eq!(forms[0]["class"], 1);
    let factors: Vec<f64> = forms
        .iter()
        .map(|form| float(&form["log_bayes_factor"]))
        .collect();
    assert!(
        factors[1..].windows(2).all(|pair| pair[0] >= pair[1]),
        "{factors:?}"
    );
    let sum: f64 = forms.iter().map(|form| float(&form["probability"])).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    for form in forms {
        assert!(word(&form["formula"]).starts_with("tau"), "{form}");
    }
}

/// Checks that the classes of formulas and all others have the probability 1, and that the sentence names the first.
fn check_formulas(round: &serde_json::Value) {
    let formulas = &round["outside"]["formulas"];
    let classes: Vec<&serde_json::Value> = items(&formulas["classes"]).collect();
    let of_classes = classes.iter().map(|class| float(&class["probability"]));
    let sum = of_classes.sum::<f64>() + float(&formulas["others"]);
    assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    let first = word(&classes[0]["members"][0]["formula"]);
    assert!(word(&round["text"]).contains(first), "{first}: {}", round["text"]);
    for class in classes {
        let name = word(&class["effect_file"]).lines().next().unwrap_or_default();
        assert!(name.starts_with("name = \"shear_v_t_formula_"), "{name}");
    }
}

#[test]
fn a_model_with_a_law_is_searched_again_to_a_verdict() {
    // The shear stress depends on two variables, of which a law has one, so that a misfit is left after the law.
    let job = Job::data("law-of-two-variables")
        .in_job("particles = 300", "algorithm = \"lm\"")
        .in_job("apply = \"auto\"", "apply = \"auto\"\nmax_effects = 2");
    let (_, summary) = study(&job);
    assert_eq!(summary["status"], "finished");
    let rounds = summary["discovery"]["rounds"].as_array().expect("searches");
    assert_eq!(rounds[0]["verdict"], "not_in_library");
    check_forms(&rounds[0]["outside"]);
    check_formulas(&rounds[0]);
    assert_eq!(rounds[0]["given"], serde_json::json!([]));
    let given: Vec<&str> = items(&rounds[1]["given"]).map(word).collect();
    assert!(given.len() == 1 && given[0].contains("shear_v_t"), "{given:?}");
    // An effect that the study has is not found a second time.
    for round in &rounds[1..] {
        let found = word(&round["extension"]["file"]["name"]);
        assert_ne!(found, format!("{}.toml", given[0]));
    }
}

#[test]
fn a_law_is_no_more_probable_for_forms_that_were_only_screened() {
    // The screen promised a form of a law of the sinkage thousands of nats more than its fit kept: the choice among laws was then a gain
    // in place of a cost, and the law with one of the effects had all the probability.
    let (_, summary) = study(&Job::data("two-effects"));
    let round = &summary["discovery"]["rounds"][0];
    for set in items(&round["sets"]) {
        assert!(float(&set["prior"]) <= 0.5, "{set}");
    }
    let best = items(&round["sets"]).next().expect("a set");
    assert_eq!(
        best["members"],
        serde_json::json!(["janosi_hanamoto", "bulldozing"])
    );
}

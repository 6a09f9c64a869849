//! What a search might have found, for tests.

use std::collections::BTreeMap;

use super::{ChiSquare, Discovery, Extension, JudgedEffect, NONE, NOT_IN_LIBRARY, NextRun, Verdict};

fn judged(name: &str, log_bayes_factor: f64, probability: f64, class: u32) -> JudgedEffect {
    JudgedEffect {
        name: name.into(),
        log_bayes_factor,
        probability,
        class,
        in_credible_set: probability > 0.5,
        strength_prior: (class > 0).then(|| "half_normal 0.2".into()),
        parameters: BTreeMap::new(),
        method: "confirmed".into(),
    }
}

/// A search that names one effect.
pub(crate) fn discovery() -> Discovery {
    let chi2 = |value: f64| ChiSquare {
        value: Some(value),
        degrees_of_freedom: 68.0,
        p: None,
    };
    Discovery {
        given: Vec::new(),
        verdict: Verdict::Named,
        text: "The data name slip_sinkage.".into(),
        extension: Some(Extension::Effect("slip_sinkage".into())),
        drop: Vec::new(),
        effects: vec![
            judged("slip_sinkage", 40.0, 0.96, 1),
            judged("bulldozing", 36.0, 0.03, 2),
            judged(NOT_IN_LIBRARY, 30.0, 0.01, 3),
            judged(NONE, 0.0, 0.0, 0),
        ],
        outside: None,
        cannot_exclude: vec!["moisture".into()],
        refused: Vec::new(),
        next_runs: vec![NextRun {
            slip: 0.6,
            wheel_load_n: 80.0,
            sled_speed_m_s: 0.02,
            separates: vec!["slip_sinkage".into(), "bulldozing".into()],
            information_nats: 0.4,
        }],
        other_tests: vec!["a plate test at 80 N".into()],
        chi2: chi2(210.0),
        chi2_best: chi2(70.0),
        evaluations_to_name: 1200,
        evaluations: 4000,
    }
}

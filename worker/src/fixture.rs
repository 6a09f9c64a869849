//! Variants for tests.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::model::{EffectSet, ModelSettings, ModelVariant};

/// Returns one run of a smooth wheel on a soil whose parameters are fixed, by `quasi_static`.
pub(crate) fn variant() -> ModelVariant {
    variant_of("quasi_static", 1)
}

/// Returns the first runs of a smooth wheel on a soil whose parameters are fixed, by a kind of model.
pub(crate) fn variant_of(kind: &str, runs: usize) -> ModelVariant {
    let files = FileSet {
        toml: include_str!("../../tests/data/nothing-hidden/experiment.toml").into(),
        files: BTreeMap::from([(
            "runs.csv".into(),
            include_str!("../../tests/data/nothing-hidden/runs.csv").into(),
        )]),
    };
    let experiment = Experiment::parse("experiment.toml", &files).unwrap();
    let mut settings = ModelSettings::from_table(&format!("kind = \"{kind}\"").parse().unwrap()).unwrap();
    let parameters = include_str!("../../tests/data/nothing-hidden/parameters.toml");
    let parameters: BTreeMap<String, f64> = toml::from_str(parameters).unwrap();
    settings.fixed.extend(parameters);
    let effects = EffectSet::default();
    ModelVariant::new(
        &experiment,
        &settings,
        &effects,
        Vec::new(),
        &experiment.runs[..runs],
    )
    .unwrap()
}

/// Returns variants of this run at `loads` wheel loads, by hash.
pub(crate) fn under_loads(loads: usize) -> Vec<(String, ModelVariant)> {
    let one = variant();
    let under = |k: usize| {
        let mut variant = one.clone();
        Arc::make_mut(&mut variant.conditions)[0].wheel_load_n += 0.01 * k as f64;
        (variant.hash(), variant)
    };
    (0..loads).map(under).collect()
}

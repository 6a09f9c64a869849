//! Variants for tests.

use std::collections::BTreeMap;

use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::model::{EffectSet, ModelSettings, ModelVariant};

/// Returns one run of a smooth wheel on a soil whose parameters are fixed.
pub(crate) fn variant() -> ModelVariant {
    let files = FileSet {
        toml: include_str!("../../tests/data/nothing-hidden/experiment.toml").into(),
        files: BTreeMap::from([(
            "runs.csv".into(),
            include_str!("../../tests/data/nothing-hidden/runs.csv").into(),
        )]),
    };
    let experiment = Experiment::parse("experiment.toml", &files).unwrap();
    let mut settings = ModelSettings::from_table(&"kind = \"quasi_static\"".parse().unwrap()).unwrap();
    let parameters = include_str!("../../tests/data/nothing-hidden/parameters.toml");
    let parameters: BTreeMap<String, f64> = toml::from_str(parameters).unwrap();
    settings.fixed.extend(parameters);
    let effects = EffectSet::default();
    ModelVariant::new(
        &experiment,
        &settings,
        &effects,
        Vec::new(),
        &experiment.runs[..1],
    )
    .unwrap()
}

/// Returns variants of this run at `loads` wheel loads, by hash.
pub(crate) fn under_loads(loads: usize) -> Vec<(String, ModelVariant)> {
    let one = variant();
    let under = |k: usize| {
        let mut variant = one.clone();
        variant.conditions[0].wheel_load_n += 0.01 * k as f64;
        (variant.hash(), variant)
    };
    (0..loads).map(under).collect()
}

//! A calibrated model for programs that simulate vehicles.
//!
//! # Layout
//! - `unit`: a co-simulation unit by FMI 3.0; `description`: its XML.
//! - `chrono`: soil, terrain and a rig as Project Chrono reads them.
//! - `lookup_table`: predictions over a grid, as CSV and for NumPy.

mod chrono;
mod description;
mod lookup_table;
mod unit;

pub use chrono::chrono;
pub use lookup_table::LookupTable;
pub use unit::{LIBRARY, fmu};

#[cfg(test)]
mod fixture {
    use std::collections::BTreeMap;

    use shared::experiment::Experiment;
    use shared::file::FileSet;
    use shared::model::{DrawnModel, EffectSet, ModelKind, ModelSettings, ModelVariant};

    /// A wheel whose soil is known up to its exponent, at two draws of it.
    pub(super) fn model() -> DrawnModel {
        let runs = include_str!("../../../../tests/data/nothing-hidden/runs.csv");
        let files = FileSet {
            toml: include_str!("../../../../tests/data/nothing-hidden/experiment.toml").into(),
            files: BTreeMap::from([("runs.csv".into(), runs.into())]),
        };
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        let fixed = [
            ("k_c", 0.0),
            ("k_phi", 2e6),
            ("friction_angle_deg", 30.0),
            ("cohesion_pa", 100.0),
        ];
        let settings = ModelSettings {
            kind: ModelKind::QuasiStatic,
            fixed: fixed.map(|(name, value)| (name.to_owned(), value)).into(),
            spatial: None,
            rolls_grousers: false,
            external: None,
            effects: Vec::new(),
            effect_files: Vec::new(),
        };
        let free = vec!["n".to_owned()];
        let runs = &experiment.runs[..1];
        let variant = ModelVariant::new(&experiment, &settings, &EffectSet::default(), free, runs).unwrap();
        let draws = vec![vec![1.0], vec![1.2]];
        DrawnModel::new(3, "quasi_static <a & b>".into(), "scm-1".into(), variant, draws)
    }
}

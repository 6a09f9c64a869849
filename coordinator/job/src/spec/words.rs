//! The description of a specification for terminals and reports.

use std::collections::BTreeSet;

use shared::experiment::{RigQuantity, Scatter, ScatterSd};
use shared::parameters::behind;

use crate::data::shared_error::SharedError;
use crate::spec::Spec;

impl Spec {
    /// Returns the model with its effects: `quasi_static with janosi_hanamoto, mine`, or `quasi_static with grousers, mine`.
    pub fn model_words(&self) -> String {
        let kind = self.model.kind.name();
        let grousers = self.model.rolls_grousers.then_some("grousers");
        let effects = self.fit_variant.effects.iter().map(|e| e.name.as_str());
        let parts: Vec<&str> = grousers.into_iter().chain(effects).collect();
        match parts.as_slice() {
            [] => kind.to_owned(),
            parts => format!("{kind} with {}", parts.join(", ")),
        }
    }

    /// Returns the effects of the model: `EFFECT`, or `EFFECT.WHEEL` if its strength is stated for one wheel of several.
    pub fn effects_on_wheels(&self) -> Vec<String> {
        let variant = &self.fit_variant;
        let names = || variant.parameters.iter().chain(variant.fixed.keys());
        let shown = |effect: &str| {
            let of_effect = names().filter_map(|name| match name.splitn(3, '.').collect::<Vec<_>>()[..] {
                [owner, _, wheel] if owner == effect => Some(wheel),
                _ => None,
            });
            let wheels: BTreeSet<&str> = of_effect.collect();
            match wheels.first() {
                Some(wheel) if wheels.len() == 1 => format!("{effect}.{wheel}"),
                _ => effect.to_owned(),
            }
        };
        variant.effects.iter().map(|effect| shown(&effect.name)).collect()
    }

    /// Returns a sentence for each error that tests or runs have in common.
    pub fn scatter_words(&self) -> Vec<String> {
        let sd = |scatter: Scatter| match self.experiment.noise.scatter(scatter) {
            ScatterSd::Known(sd) => format!("{sd}"),
            ScatterSd::Unknown => "unknown".to_owned(),
        };
        let mut words = Vec::new();
        let scatters = |scatter: Scatter| match self.experiment.noise.scatter(scatter) {
            ScatterSd::Known(sd) => sd > 0.0,
            ScatterSd::Unknown => true,
        };
        let twice = "; each condition is simulated twice for it";
        if self.fit_variant.stiffness_sensitivity && scatters(Scatter::Run) {
            words.push(format!(
                "the soil's stiffness scatters from run to run, relative sd {}{twice}",
                sd(Scatter::Run)
            ));
        }
        let preparations = self.preparations();
        if preparations > 1 && scatters(Scatter::Preparation) {
            words.push(format!(
                "the soil's stiffness scatters between {preparations} preparations, relative sd {}{twice}",
                sd(Scatter::Preparation)
            ));
        }
        if preparations > 1 && scatters(Scatter::PreparationStrength) {
            words.push(format!(
                "the soil's shear strength scatters between {preparations} preparations, relative sd {}",
                sd(Scatter::PreparationStrength)
            ));
        }
        words.extend(
            self.shared_errors
                .iter()
                .filter_map(|error| self.rig_words(error)),
        );
        for (what, readings, tests) in [
            (
                "pressures under plates",
                Scatter::PlateReading,
                Scatter::PlateTest,
            ),
            (
                "shear stresses under rings",
                Scatter::RingReading,
                Scatter::RingTest,
            ),
        ] {
            if self.bevameter.scatters(readings) {
                words.push(format!(
                    "{what} scatter with the relative sd {} from test to test and {} within a test",
                    sd(tests),
                    sd(readings)
                ));
            }
        }
        words
    }

    /// Returns a sentence for an error of the rig; `None` for the scatter of the soil.
    fn rig_words(&self, error: &SharedError) -> Option<String> {
        let rig = error.rig?;
        let what = match rig.quantity {
            RigQuantity::Offset(channel) => format!("an offset of {}", channel.column()),
            RigQuantity::Stiffness => "an error of the soil's stiffness".to_owned(),
        };
        let sd = match self.experiment.noise.rig(rig) {
            ScatterSd::Known(sd) => format!("{sd}{}", behind(rig.unit())),
            ScatterSd::Unknown => "unknown".to_owned(),
        };
        Some(format!(
            "the runs of each of {} ids in the column {} share {what}, sd {sd}",
            error.groups.len(),
            rig.column.name()
        ))
    }
}

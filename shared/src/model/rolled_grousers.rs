//! Grousers in the quasi-static model: the wheels and effects that it has a form of.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use formula::Effect;
use formula::effect::Mechanism;

use super::effects::EffectSet;
use super::error::ModelError;
use super::grouser_key::KEY;
use super::kind::ModelKind;
use super::variant::ModelVariant;
use crate::experiment::WheelGeometry;

impl ModelVariant {
    /// Checks that the quasi-static model has a form of the wheels' grousers, if they roll, and of the effects on these wheels.
    ///
    /// # Errors
    /// [`ModelError::Inexpressible`] names the wheel or the effect, and the bound.
    pub(super) fn check_rolled_grousers(
        &self,
        effects: &EffectSet,
        names: &BTreeSet<&str>,
    ) -> Result<(), ModelError> {
        if !self.rolls_grousers {
            return Ok(());
        }
        let fail = |why: String| ModelError::Inexpressible(format!("{KEY} = \"rolled\": {why}"));
        if self.kind != ModelKind::QuasiStatic {
            return Err(fail(format!("{} has no such form", self.kind.name())));
        }
        if !self.wheels.values().any(WheelGeometry::has_grousers) {
            return Err(fail("no wheel has grousers; leave the key out".to_owned()));
        }
        let rolled: BTreeSet<&str> = self.conditions.iter().map(|c| c.wheel.as_str()).collect();
        let lugged: BTreeSet<&str> = self
            .wheels
            .iter()
            .filter(|(name, wheel)| rolled.contains(name.as_str()) && wheel.has_grousers())
            .map(|(name, _)| name.as_str())
            .collect();
        for name in &lugged {
            check_bars(&self.wheels[*name]).map_err(|why| fail(format!("wheel {name}: {why}")))?;
        }
        let wheels: BTreeSet<&str> = self.wheels.keys().map(String::as_str).collect();
        let acts = |effect: &Effect| {
            let reach = EffectSet::acts_on(effect, names, &wheels);
            lugged.iter().copied().find(|wheel| reach.contains(wheel))
        };
        for effect in effects.iter() {
            let what = match effect.mechanism {
                Some(Mechanism::Rebound) => "soil that springs back",
                Some(Mechanism::FlatPatch) => "a rim that its load flattens",
                _ => continue,
            };
            if let Some(wheel) = acts(effect) {
                return Err(fail(format!(
                    "effect {} is {what}, which has no form under the grousers of wheel {wheel}; use {KEY} = \"ignored\" or kind = \"scm\"",
                    effect.name
                )));
            }
        }
        Ok(())
    }
}

/// Checks that grousers are straight bars across a wheel, and fit on it.
fn check_bars(wheel: &WheelGeometry) -> Result<(), String> {
    let (count, height, thickness) = (
        wheel.grouser_count,
        wheel.grouser_height_m,
        wheel.grouser_thickness_m,
    );
    if wheel.tread.is_some() {
        return Err(format!(
            "its grousers are not straight bars across the whole wheel, the only ones that quasi_static knows; use kind = \"scm\" or {KEY} = \"ignored\""
        ));
    }
    if count == 0 {
        return Err("grouser_count 0 must be at least 1, or grouser_height_m 0 m".to_owned());
    }
    if height <= 0.0 || height > wheel.radius_m {
        return Err(format!(
            "grouser_height_m {height} m must be > 0 m and <= radius_m = {} m",
            wheel.radius_m
        ));
    }
    let room = TAU * wheel.radius_m / f64::from(count);
    if thickness <= 0.0 || thickness >= room {
        return Err(format!(
            "grouser_thickness_m {thickness} m must be > 0 m and < {room:.4} m, the room on the rim for each of {count}"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;
    use crate::experiment::Experiment;
    use crate::file::FileSet;
    use crate::model::ModelSettings;

    const GROUSERS: &str = "grouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002\n";
    const SOIL: &str = "log10_p_ref = 4.6\nkappa = 0.0\nn = 1.1\nfriction_angle_deg = 30.0\n";

    /// Returns the variant of two wheels; `b` is smooth.
    fn variant(model: &str, grousers: &str) -> Result<ModelVariant, String> {
        let files = FileSet {
            toml: format!(
                "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.125\nwidth_m = 0.1\n{grousers}[wheel.b]\nradius_m = 0.125\nwidth_m = 0.1\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n"
            ),
            files: [(
                "runs.csv".to_owned(),
                "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n\
                 1,a,s,0.2,100,0.01,20,fit\n2,b,s,0.2,100,0.01,20,fit\n"
                    .to_owned(),
            )]
            .into(),
        };
        let experiment = Experiment::parse("experiment.toml", &files).map_err(|e| e.to_string())?;
        let table: toml::Table = format!("{model}\n{SOIL}").parse().expect("TOML");
        let settings = ModelSettings::from_table(&table).map_err(|e| e.to_string())?;
        let named = settings.fixed.keys().map(String::as_str);
        let effects = EffectSet::choose("job.toml", (&settings.effects, &[]), named, |_| None);
        let effects = effects.map_err(|e| e.to_string())?;
        ModelVariant::new(&experiment, &settings, &effects, Vec::new(), &experiment.runs)
            .map_err(|e| e.to_string())
    }

    const ROLLED: &str = "kind = \"quasi_static\"\ngrousers = \"rolled\"";

    #[test]
    fn the_key_alone_changes_the_variant() {
        let hash = |model: &str| variant(model, GROUSERS).unwrap().hash();
        let plain = variant("kind = \"quasi_static\"", GROUSERS).unwrap();
        assert!(!serde_json::to_string(&plain).unwrap().contains("rolls_grousers"));
        let ignored = hash("kind = \"quasi_static\"\ngrousers = \"ignored\"");
        assert_eq!(ignored, plain.hash());
        assert_ne!(hash(ROLLED), plain.hash());
        assert!(variant(ROLLED, GROUSERS).unwrap().rolls_grousers);
    }

    #[test]
    fn wheels_and_effects_without_a_form_with_grousers_are_named_with_the_bound() {
        let refused = |model: &str, grousers: &str| variant(model, grousers).unwrap_err();
        // a table's line has a slash where the file begins a new line
        for (model, message) in cases(
            r#"
            quasi_static"/grousers = "rolling" => grousers = "rolling" must be "ignored" or "rolled"
            scm"/grousers = "ignored" => grousers: scm rolls grousers as they are declared; the key is for kind = "quasi_static"
            wong_reece"/grousers = "rolled" => grousers: wong_reece rolls a smooth rim; the key is for kind = "quasi_static""#,
        ) {
            let model = format!("kind = \"{}", model.replace('/', "\n"));
            assert_eq!(refused(&model, GROUSERS), message);
        }
        for (keys, message) in cases(
            r#"
            # none => no wheel has grousers; leave the key out
            grouser_count = 12 => wheel a: grouser_height_m 0 m must be > 0 m and <= radius_m = 0.125 m
            grouser_height_m = 0.01 => wheel a: grouser_count 0 must be at least 1, or grouser_height_m 0 m
            grouser_count = 12/grouser_height_m = 0.009/grouser_thickness_m = 0.07 => wheel a: grouser_thickness_m 0.07 m must be > 0 m and < 0.0654 m, the room on the rim for each of 12
            grouser_count = 12/grouser_height_m = 0.009/grouser_thickness_m = 0.002/grouser_chevron_deg = 20.0 => wheel a: its grousers are not straight bars across the whole wheel, the only ones that quasi_static knows; use kind = "scm" or grousers = "ignored""#,
        ) {
            let refused = refused(ROLLED, &format!("{}\n", keys.replace('/', "\n")));
            assert_eq!(refused, format!("grousers = \"rolled\": {message}"));
        }
    }

    #[test]
    fn effects_without_a_form_under_grousers_act_on_the_smooth_wheel_alone() {
        for parameter in [
            "elastic_rebound.compliance_m_pa",
            "wheel_flexibility.deflection_m_n",
        ] {
            let (effect, _) = parameter.split_once('.').unwrap();
            let on = |wheel: &str| {
                let strength = format!("\"{parameter}{wheel}\" = 1e-9");
                variant(&format!("{ROLLED}\n{strength}"), GROUSERS)
            };
            assert!(on(".b").is_ok());
            for wheel in ["", ".a"] {
                let message = on(wheel).unwrap_err();
                let begin = format!("grousers = \"rolled\": effect {effect} is ");
                assert!(message.starts_with(&begin), "{message}");
                assert!(message.contains("under the grousers of wheel a"), "{message}");
            }
        }
    }
}

//! At its neutral strength an effect is absent, bit for bit.

use formula::Effect;
use formula::catalogue::catalogue;
use formula::effect::Mechanism;
use scm::effects::{CompiledEffects, ModelForm};
use scm::quasi_static;

use crate::support::Draws;
use crate::validation::effects::{SITE, values};

/// The effects of the catalogue that the quasi-static model has.
fn expressible() -> impl Iterator<Item = &'static Effect> + Clone {
    let has_form = |effect: &&Effect| effect.mechanism != Some(Mechanism::SideWall);
    catalogue().iter().filter(has_form)
}

#[test]
fn each_effect_at_neutral_strength_is_the_base() {
    for effect in expressible() {
        let effects = CompiledEffects::compile(ModelForm::QuasiStatic, [effect]).unwrap();
        let mut draws = Draws(7);
        for case in (0..20).map(|_| draws.case()) {
            let mut active = effects.activate([values(effect, "", f64::NAN)]);
            let with =
                quasi_static::simulate_with(&case.soil, &case.wheel, &case.condition, &mut active, &SITE);
            let without = quasi_static::simulate(&case.soil, &case.wheel, &case.condition);
            // the debug output shows every number to the last bit
            assert_eq!(format!("{with:?}"), format!("{without:?}"), "{}", effect.name);
        }
    }
}

#[test]
fn all_effects_together_at_neutral_strength_are_the_base() {
    let effects = CompiledEffects::compile(ModelForm::QuasiStatic, expressible()).unwrap();
    let mut draws = Draws(8);
    for case in (0..50).map(|_| draws.case()) {
        let mut active = effects.activate(expressible().map(|effect| values(effect, "", f64::NAN)));
        let with = quasi_static::simulate_with(&case.soil, &case.wheel, &case.condition, &mut active, &SITE);
        let without = quasi_static::simulate(&case.soil, &case.wheel, &case.condition);
        assert_eq!(format!("{with:?}"), format!("{without:?}"));
    }
}

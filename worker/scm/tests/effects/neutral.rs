//! At its neutral strength an effect is absent, bit for bit.

use formula::catalogue::catalogue;
use scm::effects::{CompiledEffects, ModelForm};
use scm::quasi_static;

use crate::support::Draws;
use crate::validation::effects::{SITE, values};

#[test]
fn each_effect_at_neutral_strength_is_the_base() {
    for effect in catalogue() {
        let effects = CompiledEffects::compile(ModelForm::QuasiStatic, [effect]).unwrap();
        let mut draws = Draws(7);
        for case in (0..20).map(|_| draws.case()) {
            let mut active = effects.activate([values(effect, "", f64::NAN)]);
            let with =
                quasi_static::simulate_with(&case.soil, &case.wheel, &case.condition, &mut active, &SITE);
            let without = quasi_static::simulate(&case.soil, &case.wheel, &case.condition);
            // Debug output shows every number to the last bit
            assert_eq!(format!("{with:?}"), format!("{without:?}"), "{}", effect.name);
        }
    }
}

#[test]
fn all_effects_together_at_neutral_strength_are_the_base() {
    let effects = CompiledEffects::compile(ModelForm::QuasiStatic, catalogue()).unwrap();
    let mut draws = Draws(8);
    for case in (0..50).map(|_| draws.case()) {
        let mut active = effects.activate(catalogue().iter().map(|effect| values(effect, "", f64::NAN)));
        let with = quasi_static::simulate_with(&case.soil, &case.wheel, &case.condition, &mut active, &SITE);
        let without = quasi_static::simulate(&case.soil, &case.wheel, &case.condition);
        assert_eq!(format!("{with:?}"), format!("{without:?}"));
    }
}

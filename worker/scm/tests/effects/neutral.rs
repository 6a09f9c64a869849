//! At its neutral strength an effect is absent, bit for bit.

use formula::Effect;
use formula::catalogue::catalogue;
use formula::effect::Mechanism;

use crate::support::{Draws, compiled};
use crate::validation::effects::{SITE, values};

/// Asserts that effects at neutral strength change nothing in a number of draws.
fn assert_neutral<'a>(effects: impl Iterator<Item = &'a Effect> + Clone, seed: u64, count: u32) {
    let laws = compiled(effects.clone());
    let mut draws = Draws(seed);
    for case in (0..count).map(|_| draws.case()) {
        let mut active = laws.activate(effects.clone().map(|effect| values(effect, "", f64::NAN)));
        let with = case.simulate_with(&mut active, &SITE);
        // the debug output shows every number to the last bit
        let names: Vec<&str> = effects.clone().map(|effect| effect.name.as_str()).collect();
        assert_eq!(
            format!("{with:?}"),
            format!("{:?}", case.try_simulate()),
            "{names:?}"
        );
    }
}

/// Returns the effects of the catalogue that the quasi-static model has.
fn expressible() -> impl Iterator<Item = &'static Effect> + Clone {
    let has_form = |effect: &&Effect| effect.mechanism != Some(Mechanism::SideWall);
    catalogue().iter().filter(has_form)
}

#[test]
fn each_effect_at_neutral_strength_is_the_base() {
    for effect in expressible() {
        assert_neutral(std::iter::once(effect), 7, 20);
    }
}

#[test]
fn all_effects_together_at_neutral_strength_are_the_base() {
    assert_neutral(expressible(), 8, 50);
}

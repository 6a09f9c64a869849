//! Families of candidates: laws of one quantity, each for other conditions.

use formula::Effect;
use formula::slip::variables;
use record::Extension;

use super::candidate::candidate_of;
use super::entry::CandidateEntry;

/// Slips and slip angles at one of which an effect of a family does nothing.
const SLIPS: [f64; 3] = [-0.3, 0.0, 0.3];
const SLIP_ANGLES_RAD: [f64; 2] = [0.0, 0.26];

/// Returns whether the effect does nothing in some conditions.
fn acts_in_part(effect: &Effect) -> bool {
    let mut conditions = SLIPS
        .iter()
        .flat_map(|slip| SLIP_ANGLES_RAD.map(|angle| (*slip, angle)));
    conditions.any(|(slip, angle)| effect.is_absent_at(&variables(slip, angle)))
}

/// Returns the name of the effect's family: the quantities that it changes. `None` for an effect that acts in all conditions.
fn family(effect: &Effect) -> Option<String> {
    let quantities: Vec<&str> = effect.hooks().map(|hook| hook.name()).collect();
    (acts_in_part(effect) && !quantities.is_empty()).then(|| quantities.join(" "))
}

/// Sets the families: effects of the catalogue that change the same quantities on all wheels, each in part of the conditions.
pub(super) fn set_families(entries: &mut [CandidateEntry]) {
    for entry in entries {
        let is_on_all = matches!(entry.effect.extension, Extension::Effect(_));
        let effect = candidate_of(&entry.effect.name).map(|(effect, _)| effect);
        let effect = effect.filter(|effect| is_on_all && effect.name == entry.effect.name);
        entry.candidate.family = effect.and_then(family);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use formula::catalogue::catalogue;

    use super::family;

    #[test]
    fn the_sinkage_by_slip_is_a_family_in_three_directions() {
        let mut families: BTreeMap<String, Vec<&str>> = BTreeMap::new();
        for effect in catalogue() {
            if let Some(name) = family(effect) {
                families.entry(name).or_default().push(&effect.name);
            }
        }
        families.retain(|_, members| members.len() > 1);
        let members = vec!["slip_sinkage", "skid_sinkage", "lateral_slip_sinkage"];
        assert_eq!(
            families,
            BTreeMap::from([("sinkage_exponent".to_owned(), members)])
        );
    }
}

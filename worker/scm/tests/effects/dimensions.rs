//! An error of a dimension is another dimension, bit for bit.

use formula::catalogue::find;

use crate::support::{Draws, compiled};
use crate::validation::effects::{SITE, values};

#[test]
fn an_error_of_radius_or_width_is_another_wheel() {
    const ERROR: f64 = 0.04;
    for name in ["wheel_radius_error", "wheel_width_error"] {
        let effect = find(name).unwrap();
        let laws = compiled(std::iter::once(effect));
        let mut draws = Draws(9);
        for case in (0..20).map(|_| draws.case()) {
            let mut active = laws.activate(std::iter::once(values(effect, "relative_error", ERROR)));
            let with = case.simulate_with(&mut active, &SITE);
            let mut other = case;
            match name {
                "wheel_radius_error" => other.wheel.radius_m *= 1.0 + ERROR,
                _ => other.wheel.width_m *= 1.0 + ERROR,
            }
            assert_eq!(
                format!("{with:?}"),
                format!("{:?}", other.try_simulate()),
                "{name}"
            );
        }
    }
}

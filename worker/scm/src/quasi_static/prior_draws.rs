//! Draws of every effect's prior under every kind of base prior: a draw with a balance must not be refused.

use core::fmt::Write as _;

use formula::Parameter;
use formula::catalogue::catalogue;
use formula::effect::Mechanism;

use super::{Footing, Mechanics, Panels, Reshaping, Rim, simulate_with};
use crate::effects::{CompiledEffects, ModelForm, Site};
use crate::fixture::Draws;
use crate::{Condition, Rejection, Soil, Wheel};

/// Number of draws of one effect under one kappa.
const DRAWS: u32 = 100;
/// Number of contact lengths at which the load is computed.
const LENGTHS: u32 = 400;
/// kappa of the base's priors: without `k_c`, nearly without, as for plates, and as negative as for sand.
const KAPPAS: [f64; 8] = [0.0, 0.01, 0.5, 2.0, -0.1, -0.4, -0.6, -0.8];

const SITE: Site = Site {
    density_kg_m3: Some(1400.0),
    gravity_m_s2: 9.81,
    grouser_count: 12,
    grouser_height_m: 0.009,
    bin_length_m: Some(1.5),
    // A drift is largest in the last run of a campaign.
    order: Some(0.5),
};

impl Draws {
    /// Draws a parameter of an effect from the prior in its file.
    fn parameter(&mut self, parameter: &Parameter) -> f64 {
        let prior = &parameter.prior;
        if let Some(fixed) = prior.as_float() {
            return fixed;
        }
        let pair = |key: &str| {
            let values = prior.get(key)?.as_array()?;
            Some([values.first()?.as_float()?, values.get(1)?.as_float()?])
        };
        if let Some([low, high]) = pair("uniform") {
            return self.uniform(low, high);
        }
        if let Some([mean, sd]) = pair("normal") {
            let [low, high] = pair("bounds").unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            return (mean + sd * self.normal()).clamp(low, high);
        }
        if let Some([median, factor]) = pair("lognormal") {
            return median * libm::pow(factor, self.normal());
        }
        let scale = prior.get("half_normal").and_then(|scale| scale.as_float());
        scale.expect("a prior of the catalogue") * self.normal().abs()
    }

    /// Draws loose to dense soil under wheels of the catalogue's examples, in drive and in skid, straight and at an angle.
    fn base(&mut self, kappa: f64) -> (Soil, Wheel, Condition) {
        let n = (1.1 + 0.2 * self.normal()).clamp(0.8, 2.0);
        let (k_c, k_phi) = crate::bekker_moduli(self.uniform(3.9, 5.6), kappa, n);
        let radius_m = if self.uniform(0.0, 1.0) < 0.7 {
            0.125
        } else {
            0.0625
        };
        let soil = Soil {
            k_c,
            k_phi,
            n,
            cohesion_pa: 0.0,
            friction_angle_rad: self.uniform(15.0, 37.0).to_radians(),
            shear_velocity_m_s: 1e-3,
            gamma_exponent: 0.5,
        };
        let wheel = Wheel {
            radius_m,
            width_m: 0.9 * radius_m,
            rig_radius_m: radius_m,
        };
        let scale = (radius_m / 0.125) * (radius_m / 0.125);
        let condition = Condition {
            slip: [-0.7, -0.2, 0.0, 0.05, 0.2, 0.4, 0.6, 0.9][self.uniform(0.0, 8.0) as usize],
            wheel_load_n: scale * [30.0, 60.0, 100.0, 150.0][self.uniform(0.0, 4.0) as usize],
            sled_speed_m_s: [0.008, 0.05][self.uniform(0.0, 2.0) as usize],
            slip_angle_rad: [0.0, 0.0, 0.3][self.uniform(0.0, 3.0) as usize],
            pass: 1,
        };
        (soil, wheel, condition)
    }
}

/// Returns whether the carried load rises with the contact throughout, from below the wheel's load to above it.
fn has_one_balance(
    effect: &CompiledEffects,
    values: &[f64],
    soil: &Soil,
    wheel: &Wheel,
    condition: &Condition,
) -> Result<bool, Rejection> {
    let mut active = effect.activate([values.to_vec()]);
    let case = active.case(soil, wheel, condition, &SITE)?;
    let (soil, wheel, condition) = (case.soil, case.wheel, case.condition);
    let mechanics = Mechanics::new(&active, &case)?;
    let mut rim = Rim::new(&soil, &wheel, &condition);
    rim.flat = mechanics.flat(rim.radius);
    let laws = active.nodes.take();
    let mut panels = Panels::default();
    let reshaping = Reshaping::new(&active, &rim, case, mechanics, laws, &mut panels, None);
    let (flat, radius) = (rim.flat, rim.radius);
    let mut footing = Footing {
        rim,
        reshaping: Some(reshaping),
    };
    let mut before = 0.0;
    let mut rises = true;
    for place in 1..=LENGTHS {
        let share = f64::from(place) / f64::from(LENGTHS);
        let carried = footing.react(flat + (radius - flat) * share * share)?.load();
        // a contact that carries nothing, or pulls the wheel down, is no support
        rises &= carried >= before || carried <= 0.0 && before <= 0.0;
        before = carried;
    }
    Ok(rises && before > condition.wheel_load_n)
}

#[test]
fn no_effect_refuses_a_draw_that_has_a_balance() {
    let mut draws = Draws(11);
    let mut refused = String::new();
    let (mut simulated, mut sunk, mut without) = (0, 0, 0);
    // a wall needs a terrain beside it
    let expressible = catalogue()
        .iter()
        .filter(|effect| effect.mechanism != Some(Mechanism::SideWall));
    for effect in expressible {
        let compiled = CompiledEffects::compile(ModelForm::QuasiStatic, [effect]).expect("a form");
        for kappa in KAPPAS {
            for _ in 0..DRAWS {
                let (soil, wheel, condition) = draws.base(kappa);
                let values: Vec<f64> = effect.parameters.iter().map(|p| draws.parameter(p)).collect();
                let mut active = compiled.activate([values.clone()]);
                let Err(rejection) = simulate_with(&soil, &wheel, &condition, &mut active, &SITE) else {
                    simulated += 1;
                    continue;
                };
                // a reading of a wheel sunk to its hub is no test run, even if the load is carried
                if matches!(
                    rejection,
                    Rejection::InvalidParameter {
                        name: "sinkage_m",
                        ..
                    }
                ) {
                    sunk += 1;
                    continue;
                }
                if has_one_balance(&compiled, &values, &soil, &wheel, &condition) == Ok(false) {
                    without += 1;
                    continue;
                }
                let name = &effect.name;
                writeln!(
                    refused,
                    "{name} {values:?} {soil:?} {wheel:?} {condition:?}: {rejection}"
                )
                .expect("room");
            }
        }
    }
    let counts = format!("{simulated} simulated, {sunk} sunk, {without} without a balance");
    assert!(refused.is_empty(), "{counts}; refused:\n{refused}");
    assert!(simulated > 20 * (sunk + without), "{counts}");
}

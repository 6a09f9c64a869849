//! A stand-in until the three-dimensional model takes effects itself; delete this file, and call that.
//!
//! It applies effects on the run and on the channels, and leaves out those at nodes and mechanisms.

use formula::Variable;

use crate::effects::{Active, Site};
use crate::spatial::{self, Run, Scene, Settings};
use crate::{Averages, Condition, Rejection, Soil};

/// `spatial::simulate` of a scene with effects.
///
/// # Errors
/// As the model's own.
pub fn roll_with(
    scene: &Scene,
    condition: &Condition,
    settings: &Settings,
    effects: &Active,
    site: &Site,
) -> Result<Run, Rejection> {
    if effects.is_empty() {
        return spatial::simulate(scene, condition, settings);
    }
    let case = effects.case(scene.soil, scene.wheel, condition, site)?;
    let changed = Scene {
        soil: &case.soil,
        wheel: &case.wheel,
        ..*scene
    };
    let run = spatial::simulate(&changed, &case.condition, settings)?;
    let averages = measured(effects, &case.soil, case.variables, run.averages)?;
    Ok(Run { averages, ..run })
}

fn measured(
    effects: &Active,
    soil: &Soil,
    mut variables: [f64; Variable::COUNT],
    mut averages: Averages,
) -> Result<Averages, Rejection> {
    variables[Variable::ContactLength as usize] = averages.contact_length_m;
    variables[Variable::BEff as usize] = averages.b_eff_m;
    variables[Variable::KStar as usize] = soil.k_c / averages.b_eff_m + soil.k_phi;
    variables[Variable::DrawbarPull as usize] = averages.drawbar_pull_n;
    variables[Variable::Torque as usize] = averages.torque_n_m;
    variables[Variable::Sinkage as usize] = averages.sinkage_m;
    variables[Variable::LateralForce as usize] = averages.lateral_force_n;
    effects.measure(&mut variables)?;
    averages.drawbar_pull_n = variables[Variable::DrawbarPull as usize];
    averages.torque_n_m = variables[Variable::Torque as usize];
    averages.sinkage_m = variables[Variable::Sinkage as usize];
    averages.lateral_force_n = variables[Variable::LateralForce as usize];
    Ok(averages)
}

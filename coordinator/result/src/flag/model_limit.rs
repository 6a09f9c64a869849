//! Limits of the model that a reader of its results should know.

use formula::Variable;
use job::Spec;
use shared::model::EffectSet;
use shared::model::ModelKind;

/// What the model leaves out of this job, a sentence each.
pub fn model_limits(spec: &Spec) -> Vec<String> {
    let mut limits = Vec::new();
    let lugged: Vec<&str> = spec
        .experiment
        .wheels
        .iter()
        .filter(|(_, wheel)| wheel.has_grousers())
        .map(|(name, _)| name.as_str())
        .collect();
    let lugged = lugged.join(", ");
    // what was read once is read again
    let effects = EffectSet::read(&spec.fit_variant.effects).unwrap_or_default();
    let named = |variables: &[Variable]| variables.iter().any(|v| effects.using(*v).is_some());
    let name = spec.fit_variant.kind.name();
    match spec.fit_variant.kind {
        ModelKind::QuasiStatic | ModelKind::WongReece => {
            if !lugged.is_empty() && !named(&[Variable::GrouserCount, Variable::GrouserHeight]) {
                limits.push(format!(
                    "{name} models the smooth rim: the grousers of {lugged} enter only through a wheel radius of their own (wheel_radius_m.NAME)"
                ));
            }
            if spec.experiment.runs.iter().any(|r| r.pass > 1) && !named(&[Variable::Pass]) {
                limits.push(format!(
                    "{name} keeps no state between passes: every pass is predicted like the first"
                ));
            }
        }
        ModelKind::Rft => limits.push(
            "rft knows neither cohesion nor memory: every pass is predicted like the first, and no part of the wheel shades another".into(),
        ),
        ModelKind::Scm if lugged.is_empty() => {}
        ModelKind::Scm => limits.push(format!(
            "scm includes the grousers of {lugged}, but a height field cannot represent their flanks: thrust beyond their sheared tips is left out"
        )),
    }
    limits
}

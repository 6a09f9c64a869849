//! Model limits: sentences on what a model leaves out of an experiment.

use formula::Variable;
use job::Spec;
use shared::experiment::TestRun;
use shared::model::{EffectSet, ExternalModel, ModelKind, RunInput};

/// Returns sentences that name the parts of this job that the model leaves out.
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
    // The effects were read without an error when the job was validated.
    let effects = EffectSet::read(&spec.fit_variant.effects).unwrap_or_default();
    let named = |variables: &[Variable]| variables.iter().any(|v| effects.using(*v).is_some());
    let name = spec.fit_variant.kind.name();
    match spec.fit_variant.kind {
        ModelKind::QuasiStatic | ModelKind::WongReece => {
            if spec.model.rolls_grousers {
                limits.push(format!(
                    "{name} rolls the grousers of {lugged} on average over their period: the soil does not flow, and against scm pulls are too low, by some 6 % of the load"
                ));
            } else if !lugged.is_empty() && !named(&[Variable::GrouserCount, Variable::GrouserHeight]) {
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
        ModelKind::Command | ModelKind::Umbridge => {}
        ModelKind::Scm if lugged.is_empty() => {}
        ModelKind::Scm => limits.push(format!(
            "scm includes the grousers of {lugged}, but a height field cannot represent their flanks: thrust beyond their sheared tips is left out"
        )),
    }
    if let Some(model) = &spec.fit_variant.external {
        limits.extend(of_external(spec, model));
    }
    limits
}

/// Returns a sentence for each input that varies between runs and that an external model does not take.
fn of_external(spec: &Spec, model: &ExternalModel) -> Vec<String> {
    let runs = &spec.experiment.runs;
    let mut unseen = Vec::new();
    let mut varies = |inputs: &[RunInput], value: fn(&TestRun) -> f64| {
        let mut values = runs.iter().map(value);
        let first = values.next().unwrap_or_default();
        if values.any(|value| value.to_bits() != first.to_bits()) && !inputs.iter().any(|i| model.takes(*i)) {
            unseen.extend(inputs.first().map(|input| input.name()));
        }
    };
    let speeds = [RunInput::SledSpeedMS, RunInput::AngularVelocityRadS];
    varies(&[RunInput::Slip, RunInput::AngularVelocityRadS], |run| run.slip);
    varies(&[RunInput::WheelLoadN], |run| run.wheel_load_n);
    varies(&speeds, |run| run.sled_speed_m_s);
    varies(&[RunInput::Pass], |run| f64::from(run.pass));
    let name = model.source.name();
    let sentence =
        |input: &str| format!("{input} differs between runs, but is not among the inputs of {name}");
    unseen.into_iter().map(sentence).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::file::FileSet;

    #[test]
    fn a_reader_learns_whether_grousers_roll() {
        let limits = |key: &str| {
            let job = FileSet {
                toml: format!(
                    "experiment = \"e.toml\"\n[model]\nkind = \"quasi_static\"\n{key}[priors]\nlog10_p_ref = {{ normal = [3.9, 0.2] }}\nkappa = 0.0\nn = 1.1\nfriction_angle_deg = 30.0\n"
                ),
                ..FileSet::default()
            };
            let experiment = FileSet {
                toml: "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\ngrouser_count = 12\ngrouser_height_m = 0.005\ngrouser_thickness_m = 0.001\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n".into(),
                files: [(
                    "runs.csv".to_owned(),
                    "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n1,a,s,0.2,25,0.01,0.5,fit\n".to_owned(),
                )]
                .into(),
            };
            let spec = Spec::new("job.toml", &job, "e.toml", &experiment).expect("a job");
            (model_limits(&spec).join("\n"), spec.model_words())
        };
        let (ignored, words) = limits("");
        assert!(ignored.contains("enter only through a wheel radius"), "{ignored}");
        assert_eq!(words, "quasi_static");
        let (rolled, words) = limits("grousers = \"rolled\"\n");
        assert!(
            rolled.starts_with("quasi_static rolls the grousers of a "),
            "{rolled}"
        );
        assert_eq!(words, "quasi_static with grousers");
    }
}

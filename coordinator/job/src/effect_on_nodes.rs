//! Effects of the shear displacement where that is kept on the nodes of the soil: candidates of a search beside the same on the rim.

use formula::catalogue::{catalogue, find};
use formula::{Effect, Variable};
use shared::model::EffectSet;
use shared::model::spatial::DisplacementFrame;

use crate::model_switch::ModelSwitch;
use crate::spec::Spec;

/// The ending of the candidate's name, behind the effect's name.
const ON_NODES: &str = "_node";

/// An effect of the catalogue together with the setting that keeps its displacement on the nodes: without such an effect the setting
/// changes nothing, so that no job can have it first.
#[derive(Debug, Clone, Copy)]
pub struct EffectOnNodes {
    /// The effect.
    pub effect: &'static Effect,
    /// The setting.
    pub setting: &'static ModelSwitch,
}

impl EffectOnNodes {
    fn new(effect: &'static Effect) -> Option<Self> {
        let setting = ModelSwitch::find("displacement_node")?;
        let uses_displacement = effect.uses().contains(Variable::J);
        uses_displacement.then_some(Self { effect, setting })
    }

    /// Returns the candidate with this name, for example `janosi_hanamoto_node`.
    pub fn find(name: &str) -> Option<Self> {
        Self::new(find(name.strip_suffix(ON_NODES)?)?)
    }

    /// Returns the name of the candidate.
    pub fn name(&self) -> String {
        format!("{}{ON_NODES}", self.effect.name)
    }

    /// Returns the candidates for a model that rolls and has no effect of the displacement; other models have none.
    pub fn all_of(spec: &Spec) -> impl Iterator<Item = Self> {
        let spatial = spec.model.spatial.as_ref();
        let is_on_rim = spatial.is_some_and(|spatial| spatial.displacement == DisplacementFrame::Rim);
        let effects = EffectSet::read(&spec.fit_variant.effects);
        let has_one = effects.is_ok_and(|effects| effects.using(Variable::J).is_some());
        let all = catalogue().iter().filter_map(Self::new);
        all.filter(move |_| is_on_rim && !has_one)
    }
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const RUNS: &str =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,30\n";

    /// Returns the candidates of a job with an effect of the user.
    fn candidates(formula: &str) -> Vec<String> {
        let effect = format!(
            "name = \"mine\"\nsummary = \"mine\"\nsource = \"a guess\"\n{formula}\n[parameters.a]\nunit = \"1\"\nneutral = 0.0\nprior = {{ normal = [0.0, 0.2] }}\n"
        );
        let job = FileSet {
            toml: "[model]\nkind = \"scm\"\neffect_files = [\"mine.toml\"]\n[priors]\nlog10_p_ref = 4.5\nn = 1.1\nkappa = 0.0\nfriction_angle_deg = 30.0\n".into(),
            files: [("mine.toml".to_owned(), effect)].into(),
        };
        let experiment = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".to_owned(), RUNS.to_owned())].into(),
        };
        let spec = Spec::new("job.toml", &job, "experiment.toml", &experiment).unwrap();
        EffectOnNodes::all_of(&spec)
            .map(|candidate| candidate.name())
            .collect()
    }

    #[test]
    fn an_effect_of_the_displacement_in_a_file_of_the_user_is_one_too() {
        assert_eq!(
            candidates("drawbar_pull = \"drawbar_pull * (1 + a)\""),
            ["janosi_hanamoto_node", "stretched_mobilisation_node"]
        );
        let none: [&str; 0] = [];
        assert_eq!(candidates("shear = \"tau * (1 + a * j / radius)\""), none);
    }

    #[test]
    fn only_an_effect_of_the_displacement_can_be_on_the_nodes() {
        let janosi = EffectOnNodes::find("janosi_hanamoto_node").unwrap();
        assert_eq!(janosi.effect.name, "janosi_hanamoto");
        assert_eq!(janosi.name(), "janosi_hanamoto_node");
        assert_eq!(janosi.setting.line(), "displacement = \"node\"");
        for other in [
            "slip_sinkage_node",
            "janosi_hanamoto",
            "displacement_node",
            "_node",
        ] {
            assert!(EffectOnNodes::find(other).is_none(), "{other}");
        }
        // No effect of the catalogue has such a name.
        assert!(catalogue().iter().all(|effect| !effect.name.ends_with(ON_NODES)));
    }
}

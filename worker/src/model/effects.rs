//! The effects of a variant: compiled once, and activated with the values of their parameters for each evaluation.

use scm::effects::{Active, CompiledEffects, ModelForm, Site};
use shared::model::effects::parameter_name;
use shared::model::{EffectSet, ModelError, ModelKind, ModelVariant};

use super::error::CompileError;
use super::parameters::ParameterSource;

/// The sources of every parameter of every effect, for wheels that share them.
type Sources = Vec<Vec<ParameterSource>>;

/// The effects of a variant with the sources of their parameters.
#[derive(Debug)]
pub(super) struct EffectMap {
    effects: CompiledEffects,
    /// Each distinct set of sources once: effects are activated once per set.
    sources: Vec<Sources>,
    /// The set of sources of each wheel, in the variant's order.
    by_wheel: Vec<usize>,
    /// The site of each condition.
    sites: Vec<Site>,
}

/// The effects at one parameter vector, for every wheel.
#[derive(Debug)]
pub(super) struct ActiveEffects<'a> {
    active: Vec<Active<'a>>,
    by_wheel: &'a [usize],
}

impl<'a> ActiveEffects<'a> {
    /// Returns the effects on a wheel, by its place in the variant, with their working memory.
    pub(super) fn on_wheel(&mut self, place: usize) -> &mut Active<'a> {
        &mut self.active[self.by_wheel[place]]
    }
}

impl EffectMap {
    /// Compiles the effects of a variant for its model; [`CompileError`] names the effect that the model cannot express, or
    /// the missing parameter.
    pub(super) fn new(variant: &ModelVariant, set: &EffectSet) -> Result<Self, CompileError> {
        let model = match variant.kind {
            ModelKind::QuasiStatic => ModelForm::QuasiStatic,
            ModelKind::Scm => ModelForm::Spatial,
            ModelKind::WongReece => ModelForm::WongReece,
            ModelKind::Rft => ModelForm::Rft,
            ModelKind::Command | ModelKind::Umbridge => ModelForm::Outside,
        };
        let effects = CompiledEffects::compile(model, set.iter())?;
        let mut sources: Vec<Sources> = Vec::new();
        let mut by_wheel = Vec::new();
        for wheel in variant.wheels.keys() {
            let wheel_sources = sources_of(variant, set, wheel)?;
            let place = sources.iter().position(|other| *other == wheel_sources);
            by_wheel.push(place.unwrap_or(sources.len()));
            if place.is_none() {
                sources.push(wheel_sources);
            }
        }
        Ok(EffectMap {
            effects,
            sources,
            by_wheel,
            sites: sites(variant),
        })
    }

    /// Returns the effects at one parameter vector.
    pub(super) fn at(&self, theta: &[f64]) -> ActiveEffects<'_> {
        let values = |sources: &Vec<ParameterSource>| sources.iter().map(|s| s.value(theta)).collect();
        let active = |sources: &Sources| self.effects.activate(sources.iter().map(values));
        ActiveEffects {
            active: self.sources.iter().map(active).collect(),
            by_wheel: &self.by_wheel,
        }
    }

    /// Returns the site of the condition at a position of the variant.
    pub(super) fn site(&self, position: usize) -> &Site {
        &self.sites[position]
    }
}

/// Finds the sources of a wheel's values: the wheel's parameter, the parameter of all wheels, or the neutral value of a
/// strength that acts elsewhere.
fn sources_of(variant: &ModelVariant, set: &EffectSet, wheel: &str) -> Result<Sources, ModelError> {
    let effect_sources = |effect: &formula::Effect| {
        let strengths = effect.parameters.iter().filter(|p| p.neutral.is_some());
        let find = |p: &formula::Parameter| {
            let on_wheel = ParameterSource::find(variant, &parameter_name(effect, p, Some(wheel)));
            on_wheel.or_else(|| ParameterSource::find(variant, &parameter_name(effect, p, None)))
        };
        let acts = strengths.clone().count() == 0 || strengths.clone().any(|p| find(p).is_some());
        let source = |p: &formula::Parameter| match (find(p), p.neutral) {
            (Some(source), _) => Ok(source),
            (None, Some(neutral)) => Ok(ParameterSource::Fixed(neutral)),
            // a parameter that only shapes an effect which is absent on this wheel
            (None, None) if !acts => Ok(ParameterSource::Fixed(0.0)),
            (None, None) => Err(ModelError::Unset(parameter_name(effect, p, None))),
        };
        effect.parameters.iter().map(source).collect()
    };
    set.iter().map(effect_sources).collect()
}

fn sites(variant: &ModelVariant) -> Vec<Site> {
    let site = |condition: &shared::model::RunCondition| {
        let wheel = variant.wheels.get(&condition.wheel);
        Site {
            density_kg_m3: condition.density_kg_m3,
            gravity_m_s2: variant.gravity_m_s2,
            grouser_count: wheel.map_or(0, |w| w.grouser_count),
            grouser_height_m: wheel.map_or(0.0, |w| w.grouser_height_m),
            bin_length_m: variant.bin_length_m,
            order: condition.order,
        }
    };
    variant.conditions.iter().map(site).collect()
}

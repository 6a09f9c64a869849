//! The entries of a search: each candidate of the discovery with its addition to the job.

use std::borrow::Cow;
use std::collections::BTreeSet;

use discovery::Candidate;
use formula::{Effect, Hook};
use job::{
    EffectOnNodes, FreeParameter, Job, ModelSwitch, NamedFiles, PlainParameter, Spec, free_parameters,
};
use record::{Extension, NotTried};

use shared::file::FileError;
use shared::model::ModelKind;
use shared::parameters::{SPATIAL, model_parameters};

use super::candidate::{CandidateEffect, JOB, candidate_of, spec, with_extensions};
use super::candidate_file::effects_in_files;
use super::law::dependence::{Dependence, dependences};
use super::law::file::LawFiles;
use super::law::form::LawForm;

impl CandidateEffect {
    /// Returns its effect: that of the catalogue, or that of its file; `None` for a parameter or a setting of the model.
    pub(super) fn effect(&self) -> Option<Cow<'static, Effect>> {
        match &self.extension {
            Extension::File { text, .. } => Effect::read(text).ok().map(Cow::Owned),
            _ => candidate_of(&self.name).map(|(effect, _)| Cow::Borrowed(effect)),
        }
    }
}

/// A candidate with its addition to the job.
#[derive(Debug, Clone)]
pub(super) struct CandidateEntry {
    pub(super) effect: CandidateEffect,
    pub(super) candidate: Candidate,
    /// Full names of its free parameters, in the candidate's order.
    pub(super) names: Vec<String>,
    /// Their units, in the same order.
    pub(super) units: Vec<String>,
    /// The property that the experiment leaves unstated, if the effect needs one: the effect is then weighed with a typical
    /// value, and never named.
    pub(super) not_tried: Option<NotTried>,
}

/// A dependence with its candidates.
#[derive(Debug, Clone)]
pub(super) struct LawEntry {
    pub(super) dependence: Dependence,
    pub(super) curve: CandidateEntry,
    pub(super) forms: Vec<(LawForm, CandidateEntry)>,
}

impl LawEntry {
    /// Lists the laws outside the library that the experiment can show, as candidates.
    ///
    /// # Errors
    /// [`FileError`] if the file of a law cannot be read.
    pub(super) fn all_of(job: &Job, base: &Spec) -> Result<Vec<Self>, FileError> {
        let fail = |message: String| FileError::whole(JOB, message);
        let entry = |law: CandidateEffect| -> Result<CandidateEntry, FileError> {
            let name = law.name.clone();
            let Extension::File { text, .. } = &law.extension else {
                return Err(fail(format!("{name} is not an effect file")));
            };
            let effect = Effect::read(text).map_err(|e| fail(format!("{name}: {e}")))?;
            let free = free_parameters(&effect).map_err(|e| fail(e.to_string()))?;
            let entry = CandidateEntry::new(law, &effect, free, true);
            entry.ok_or_else(|| fail(format!("{name} has no strength")))
        };
        // A law that is a candidate already is not offered a second time.
        let taken = names_taken(job, base);
        let mut laws = Vec::new();
        let is_shown = |dependence: &Dependence| dependence.is_shown_by(base.model.external.as_ref());
        for dependence in dependences(&base.experiment).into_iter().filter(is_shown) {
            let files = LawFiles::addable(&dependence, &job.files, &taken);
            let Some(LawFiles { curve, forms }) = files else {
                continue;
            };
            let forms = forms.into_iter().map(|(form, file)| Ok((form, entry(file)?)));
            laws.push(LawEntry {
                curve: entry(curve)?,
                forms: forms.collect::<Result<_, FileError>>()?,
                dependence,
            });
        }
        Ok(laws)
    }

    /// Returns its candidates: the curve, then the forms.
    pub(super) fn entries(&self) -> impl Iterator<Item = &CandidateEntry> {
        std::iter::once(&self.curve).chain(self.forms.iter().map(|(_, entry)| entry))
    }

    /// Returns the name of the form that one of its candidates is; that of the curve is `spline`.
    pub(super) fn form_name(&self, entry: &CandidateEntry) -> &'static str {
        let mut forms = self.forms.iter();
        let form = forms.find(|(_, form)| form.effect.name == entry.effect.name);
        form.map_or("spline", |(form, _)| form.name())
    }
}

impl CandidateEntry {
    /// Makes the candidate of an effect of the catalogue or of a file of the job.
    ///
    /// # Arguments
    /// - `parameters`: the free parameters of the model with the effect.
    ///
    /// # Returns
    /// `None` if none of the parameters that the effect adds is a strength.
    pub(super) fn of_library(
        candidate: CandidateEffect,
        parameters: Vec<FreeParameter>,
        base: &Spec,
    ) -> Option<Self> {
        let effect = candidate.effect()?;
        let is_known = |parameter: &FreeParameter| base.parameters.iter().any(|p| p.name == parameter.name);
        let free = parameters.into_iter().filter(|parameter| !is_known(parameter));
        Self::new(candidate, &effect, free.collect(), false)
    }

    /// Makes the candidate that frees a parameter of the model itself; `None` if the job does not hold it fixed.
    pub(super) fn plain(plain: &PlainParameter, base: &Spec) -> Option<Self> {
        let (neutral, density) = plain.held_by(base)?;
        let unit = model_parameters()
            .find(|parameter| parameter.name == plain.name)?
            .unit;
        let name = plain.name.to_owned();
        Some(Self {
            candidate: Candidate {
                neutral,
                has_low_fidelity: !SPATIAL.iter().any(|spatial| spatial.name == plain.name),
                ..Candidate::new(&name, vec![density], vec![0])
            },
            names: vec![name.clone()],
            units: vec![unit.to_owned()],
            not_tried: None,
            effect: CandidateEffect {
                extension: Extension::Effect(name.clone()),
                name,
            },
        })
    }

    /// Makes the candidate that turns a setting of the model; `None` if the setting is no candidate for the job.
    ///
    /// # Errors
    /// [`NotTried`] if the model with the setting is not valid or has other parameters.
    pub(super) fn switch(switch: &ModelSwitch, base: &Spec, job: &Job) -> Result<Option<Self>, NotTried> {
        if !switch.is_candidate(base) {
            return Ok(None);
        }
        let name = switch.name.to_owned();
        let not_tried = |why: String| NotTried {
            name: name.clone(),
            why,
            needs: format!("a job that is valid with {} as well", switch.line()),
        };
        let extension = Extension::Effect(name.clone());
        let with = with_extensions(job, &[&extension], &NamedFiles::default());
        let with = with.and_then(|with| spec(&with, &base.experiment));
        let with = with.map_err(|e| not_tried(e.to_string()))?;
        let names = |spec: &Spec| spec.parameters.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        if names(&with) != names(base) {
            let names = names(&with).join(", ");
            return Err(not_tried(format!("its free parameters are others: {names}")));
        }
        Ok(Some(Self {
            // The low-fidelity model has no switch: the corrections of the base do not hold for another setting or kind of model.
            candidate: Candidate {
                limit_of: switch.limit_of().map(str::to_owned),
                ..Candidate::new(&name, Vec::new(), Vec::new())
            },
            names: Vec::new(),
            units: Vec::new(),
            not_tried: None,
            effect: CandidateEffect { name, extension },
        }))
    }

    /// Makes the candidate of an effect with the free parameters that it adds; `None` without a free strength.
    ///
    /// # Arguments
    /// - `is_curve`: every strength counts. Otherwise the first one does, and the others shape the effect.
    pub(super) fn new(
        candidate: CandidateEffect,
        effect: &Effect,
        free: Vec<FreeParameter>,
        is_curve: bool,
    ) -> Option<Self> {
        let strengths = free.iter().enumerate().filter_map(|(k, parameter)| {
            let name = parameter.name.split('.').nth(1)?;
            let neutral = effect.parameters.iter().find(|p| p.name == name)?.neutral?;
            Some((k, neutral))
        });
        let mut strengths: Vec<(usize, f64)> = strengths.collect();
        if !is_curve {
            strengths.truncate(1);
        }
        let &(_, neutral) = strengths.first()?;
        Some(Self {
            candidate: Candidate {
                neutral,
                quantities: effect.hooks().map(quantity).collect(),
                has_low_fidelity: ModelKind::QuasiStatic.has_form(effect)
                    && EffectOnNodes::find(&candidate.name).is_none(),
                ..Candidate::new(
                    &candidate.name,
                    free.iter().map(|p| p.marginal.clone()).collect(),
                    strengths.into_iter().map(|(k, _)| k).collect(),
                )
            },
            units: free.iter().map(|p| p.unit.clone()).collect(),
            names: free.into_iter().map(|p| p.name).collect(),
            not_tried: None,
            effect: candidate,
        })
    }
}

/// Returns the names of the effects of a job and of its candidate files.
pub(super) fn names_taken(job: &Job, base: &Spec) -> BTreeSet<String> {
    let of_model = base.fit_variant.effects.iter().map(|effect| effect.name.clone());
    let of_files = effects_in_files(job).map(|effect| effect.name);
    of_model.chain(of_files).collect()
}

/// Returns the quantity that a formula changes. The sinkage exponent shapes the pressure, and the strength limits the shear stress.
fn quantity(hook: Hook) -> String {
    let changed = match hook {
        Hook::SinkageExponent => Hook::Pressure,
        Hook::ShearLimit => Hook::Shear,
        hook => hook,
    };
    changed.name().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use formula::catalogue::find;

    #[test]
    fn an_effect_changes_the_quantity_that_its_formula_shapes() {
        let quantities = |name: &str| -> Vec<String> { find(name).unwrap().hooks().map(quantity).collect() };
        assert_eq!(quantities("friction_rate_weakening"), ["shear"]);
        assert_eq!(quantities("slip_sinkage"), ["pressure"]);
    }
}

//! The effect files of a law, under names that are free in the job.

use std::collections::BTreeSet;

use job::{NamedFiles, effect_name};
use record::Extension;

use super::dependence::Dependence;
use super::form::LawForm;
use crate::candidate::CandidateEffect;

/// The curve of a dependence and its forms.
#[derive(Debug)]
pub(crate) struct LawFiles {
    pub(crate) curve: CandidateEffect,
    pub(crate) forms: Vec<(LawForm, CandidateEffect)>,
}

impl LawFiles {
    /// Returns the curve and forms of a dependence that a job does not have yet; `None` if the job has the curve.
    ///
    /// A law that the job has is fitted again with the job, so the same law is not offered a second time: two laws of one form
    /// only share the strength of one. A curve can take every form. Another form is offered, because the remaining misfit may
    /// have it. Checked by `tests::a_law_that_a_job_has_is_not_offered_again`.
    ///
    /// # Arguments
    /// - `files`: those that the job has. `taken`: the names of the effects of its model and of its candidate files.
    pub(crate) fn addable(
        dependence: &Dependence,
        files: &NamedFiles,
        taken: &BTreeSet<String>,
    ) -> Option<LawFiles> {
        let is_new = |law: &CandidateEffect| {
            let Extension::File { text, .. } = &law.extension else {
                return true;
            };
            effect_name(text).is_none_or(|name| !taken.contains(&name))
        };
        let forms = LawForm::ALL.into_iter().filter(|form| form.suits(dependence));
        let forms = forms.map(|form| (form, form.effect(dependence)));
        let forms = forms.filter(|(_, law)| is_new(law));
        Some(LawFiles {
            curve: beside(dependence.curve(), files),
            forms: forms.map(|(form, law)| (form, beside(law, files))).collect(),
        })
        .filter(|files| is_new(&files.curve))
    }
}

/// Renames the file of a law to a name that is free in the job.
fn beside(law: CandidateEffect, files: &NamedFiles) -> CandidateEffect {
    match law.extension {
        Extension::File { name, text } => CandidateEffect {
            extension: Extension::File {
                name: free_name(name.trim_end_matches(".toml"), files),
                text,
            },
            ..law
        },
        _ => law,
    }
}

/// Returns `NAME.toml`, or a numbered name if the job has a file of this name for another effect.
pub(crate) fn free_name(name: &str, files: &NamedFiles) -> String {
    let numbered = (2..).map(|number| format!("{name}-{number}.toml"));
    let mut names = std::iter::once(format!("{name}.toml")).chain(numbered);
    names.find(|name| files.get(name).is_none()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candidate::extended;
    use crate::fixture::{read, spec_of};
    use crate::law::dependence::dependences;
    use job::Spec;
    use shared::file::FileSet;

    /// The shear stress against the normal velocity.
    fn dependence(spec: &Spec) -> Dependence {
        let mut all = dependences(&spec.experiment).into_iter();
        all.find(|candidate| candidate.name() == "shear_v_n").unwrap()
    }

    /// Names of the curve and of the forms that the job can add, for the shear stress against the normal velocity.
    fn addable(job: &FileSet, experiment: &FileSet) -> Option<(String, Vec<String>)> {
        let spec = spec_of(job, experiment).unwrap();
        let effects = spec.fit_variant.effects.iter().map(|effect| effect.name.clone());
        let files = LawFiles::addable(
            &dependence(&spec),
            &NamedFiles::from(&job.files),
            &effects.collect(),
        )?;
        let forms = files.forms.iter();
        let names = forms.map(|(form, law)| format!("{}: {}", form.name(), file(law)));
        Some((file(&files.curve), names.collect()))
    }

    fn file(law: &CandidateEffect) -> String {
        match &law.extension {
            Extension::File { name, .. } => name.clone(),
            other => panic!("{other:?}"),
        }
    }

    fn law(job: &FileSet, experiment: &FileSet, form: Option<LawForm>) -> Extension {
        let dependence = dependence(&spec_of(job, experiment).unwrap());
        form.map_or_else(|| dependence.curve(), |form| form.effect(&dependence))
            .extension
    }

    #[test]
    fn a_law_that_a_job_has_is_not_offered_again() {
        let (job, experiment, _) = read("tests/data/shear-mobilisation");
        let (curve, forms) = addable(&job, &experiment).unwrap();
        assert_eq!((curve.as_str(), forms.len()), ("scan_shear_v_n.toml", 9));
        let form = law(&job, &experiment, Some(LawForm::Power));
        let with_form = extended("job.toml", &job, &[&form]).unwrap();
        let (curve, others) = addable(&with_form, &experiment).unwrap();
        assert_eq!(curve, "scan_shear_v_n.toml");
        assert_eq!(others, forms[1..], "the power is the first form");
        let curve = law(&job, &experiment, None);
        let with_curve = extended("job.toml", &job, &[&curve]).unwrap();
        assert_eq!(addable(&with_curve, &experiment), None);
    }

    #[test]
    fn a_file_of_another_effect_keeps_its_name() {
        let (mut job, experiment, _) = read("tests/data/shear-mobilisation");
        let Extension::File { name, text } = law(&job, &experiment, Some(LawForm::Power)) else {
            panic!("a law is a file");
        };
        let text = text.replace("name = \"shear_v_n_power\"", "name = \"mine\"");
        job = extended("job.toml", &job, &[&Extension::File { name, text }]).unwrap();
        let (_, forms) = addable(&job, &experiment).unwrap();
        assert_eq!(forms[0], "power: shear_v_n_power-2.toml");
        assert_eq!(forms[1], "saturation: shear_v_n_saturation.toml");
    }
}

//! The stage that a discovery is in, with the branches that it waits for.

use crate::stages::branch::SearchBranch;
use crate::stages::conclusion::Conclusion;
use crate::stages::cross_validation::CrossValidation;
use crate::stages::formula_fit::FormulaRequest;
use crate::stages::next_run::RunSelection;
use crate::stages::query::Query;
use inference::InferenceFailure;

/// A stage of a search.
#[derive(Debug, Clone)]
pub(super) enum Stage {
    SingleEffects(SearchBranch),
    BaseReduction(Vec<SearchBranch>),
    Families(Vec<SearchBranch>),
    /// Holds the size of the combinations to extend.
    BeamSearch(usize, Vec<SearchBranch>),
    BackwardElimination(Vec<SearchBranch>),
    /// Holds the number of earlier rounds of exchanges.
    Exchanges(usize, Vec<SearchBranch>),
    Curves(SearchBranch),
    Forms(SearchBranch),
    /// Holds the rank of the law.
    CrossValidation(usize, CrossValidation),
    /// Effects beyond sets that have a law; holds the size of these sets.
    EffectsBesideLaw(usize, Vec<SearchBranch>),
    /// The best set that has a law, without each of its effects.
    LawElimination(Vec<SearchBranch>),
    /// The forms of the law of the best set that has one, beyond its effects; holds the index of the law.
    LawForms(usize, SearchBranch),
    /// The best set that has a law, with an effect in the place of the law.
    LawSubstitutes(Vec<SearchBranch>),
    /// Holds the effects and the law.
    LawBesideEffects(Vec<usize>, CrossValidation),
    /// The base with a leading effect in the place of one of its effects.
    Replacements(Vec<SearchBranch>),
    /// Holds the effects of the leading sets.
    Predictions(Vec<Vec<usize>>, CrossValidation),
    /// The caller is to offer formulas of the law that is claimed.
    AwaitsFormulas(FormulaRequest),
    /// Formulas of the law; holds the index of the first among the candidates.
    Formulas(usize, SearchBranch),
    NextRuns(RunSelection),
    Done(Box<Conclusion>),
    Failed(InferenceFailure),
}

/// What a stage waits for.
enum Work<'a> {
    Branches(&'a mut [SearchBranch]),
    Validation(&'a mut CrossValidation),
    Runs(&'a mut RunSelection),
    Nothing,
}

impl Stage {
    fn work(&mut self) -> Work<'_> {
        match self {
            Self::SingleEffects(branch)
            | Self::Curves(branch)
            | Self::Forms(branch)
            | Self::LawForms(_, branch)
            | Self::Formulas(_, branch) => Work::Branches(std::slice::from_mut(branch)),
            Self::BaseReduction(branches)
            | Self::Families(branches)
            | Self::BeamSearch(_, branches)
            | Self::BackwardElimination(branches)
            | Self::Exchanges(_, branches)
            | Self::EffectsBesideLaw(_, branches)
            | Self::LawElimination(branches)
            | Self::LawSubstitutes(branches)
            | Self::Replacements(branches) => Work::Branches(branches),
            Self::CrossValidation(_, validation)
            | Self::LawBesideEffects(_, validation)
            | Self::Predictions(_, validation) => Work::Validation(validation),
            Self::NextRuns(runs) => Work::Runs(runs),
            Self::AwaitsFormulas(_) | Self::Done(_) | Self::Failed(_) => Work::Nothing,
        }
    }

    /// Returns what a search does in this stage.
    pub(super) fn doing(&self) -> &'static str {
        match self {
            Self::SingleEffects(_) => "tries each effect alone",
            Self::BaseReduction(_) => "tries the model without each of its effects",
            Self::Families(_) => "tries effects that belong together",
            Self::BeamSearch(..) => "combines effects",
            Self::BackwardElimination(_) => "leaves out effects of the best combinations",
            Self::Exchanges(..) => "exchanges effects that the data hardly tell apart",
            Self::Curves(_) | Self::Forms(_) => "tries laws outside the library",
            Self::EffectsBesideLaw(..)
            | Self::LawElimination(_)
            | Self::LawForms(..)
            | Self::LawSubstitutes(_) => "tries effects beside a law outside the library",
            Self::CrossValidation(..) | Self::LawBesideEffects(..) => {
                "tests a law on conditions that are left out"
            }
            Self::Replacements(_) => "tries effects in the place of those of the model",
            Self::Predictions(..) => "tests the leading explanations on conditions that are left out",
            Self::AwaitsFormulas(_) | Self::Formulas(..) => "fits formulas of a law outside the library",
            Self::NextRuns(_) => "chooses the runs that would tell",
            Self::Done(_) | Self::Failed(_) => "is over",
        }
    }

    /// Returns the effects that were fitted alone so far, with their log Bayes factors; none after the first stage.
    pub(super) fn single_effects(&self) -> Vec<(usize, f64)> {
        match self {
            Self::SingleEffects(branch) => branch.fitted(),
            _ => Vec::new(),
        }
    }

    /// Returns the queries of the next round; none once the stage is complete.
    pub(super) fn queries(&mut self) -> Vec<Query> {
        match self.work() {
            Work::Branches(branches) => branches.iter().flat_map(SearchBranch::queries).collect(),
            Work::Validation(validation) => validation.queries(),
            Work::Runs(runs) => runs.queries(),
            Work::Nothing => Vec::new(),
        }
    }

    /// Takes the answers to [`queries`](Self::queries), in their order.
    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        match self.work() {
            Work::Branches(branches) => {
                let mut answers = answers.into_iter();
                for branch in branches {
                    let count = branch.queries().len();
                    branch.take(answers.by_ref().take(count).collect());
                }
            }
            Work::Validation(validation) => validation.take(&answers),
            Work::Runs(runs) => runs.take(answers),
            Work::Nothing => {}
        }
    }
}

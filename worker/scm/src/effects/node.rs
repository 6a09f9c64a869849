//! Pressure, strength and shear stress at many nodes after the effects.

use formula::block::Block;
use formula::variable::Variables;
use formula::{Hook, Program, Variable};

use super::law::{Law, formulas_at};
use crate::Rejection;

/// The hooks at nodes, in the order of evaluation.
const HOOKS: [Hook; 3] = [Hook::Pressure, Hook::ShearLimit, Hook::Shear];

/// The formulas at the nodes of a contact, with the numbers that all nodes share.
#[derive(Debug, Clone)]
pub(crate) struct NodeLaws<'a> {
    laws: Vec<NodeLaw<'a>>,
    uses: Variables,
    kinks: Variables,
    /// The values before the last formula, for messages.
    before: Vec<f64>,
    /// The current nodes: callers write columns, apply formulas, and read columns.
    pub(crate) block: Block,
}

#[derive(Debug, Clone)]
struct NodeLaw<'a> {
    hook: Hook,
    law: &'a Law,
    program: &'a Program,
    parameters: Vec<f64>,
    scalars: Vec<f64>,
}

impl<'a> NodeLaws<'a> {
    /// Collects the formulas at nodes; `None` if there are none.
    pub(super) fn new(laws: &[(&'a Law, Vec<f64>)]) -> Option<Self> {
        let laws: Vec<NodeLaw> = HOOKS
            .into_iter()
            .flat_map(|hook| formulas_at(laws, hook).map(move |law| (hook, law)))
            .map(|(hook, (program, law, parameters))| NodeLaw {
                hook,
                law,
                program,
                parameters: parameters.to_vec(),
                scalars: Vec::new(),
            })
            .collect();
        let uses = laws
            .iter()
            .fold(Variables::default(), |set, law| set.union(law.program.uses()));
        let kinks = laws
            .iter()
            .fold(Variables::default(), |set, law| set.union(law.program.kinks()));
        (!laws.is_empty()).then(|| Self {
            laws,
            uses,
            kinks,
            before: Vec::new(),
            block: Block::default(),
        })
    }

    /// Returns the variables that formulas at nodes use.
    pub(crate) fn uses(&self) -> Variables {
        self.uses
    }

    /// Returns whether a formula at nodes uses a variable.
    pub(crate) fn use_variable(&self, variable: Variable) -> bool {
        self.uses.contains(variable)
    }

    /// Returns whether stresses may have kinks or jumps between nodes.
    pub(crate) fn are_kinked(&self) -> bool {
        let local = self.laws.first().map(|law| law.program.local());
        local.is_some_and(|local| self.kinks.meets(local))
    }

    /// Returns whether stresses may jump as the contact changes.
    pub(crate) fn may_jump(&self) -> bool {
        let contact_variables = [Variable::ContactLength, Variable::BEff, Variable::KStar];
        self.are_kinked() || self.kinks.meets(Variables::new(&contact_variables))
    }

    /// Returns whether there is a formula at a hook.
    pub(crate) fn enter(&self, hook: Hook) -> bool {
        self.laws.iter().any(|law| law.hook == hook)
    }

    /// Returns whether all formulas only scale the shear stress, by factors of these variables.
    pub(crate) fn only_scale_stress_by(&self, variables: Variables) -> bool {
        let allowed = variables.union(Variables::OF_RUN).with(Variable::Tau);
        let scales = |law: &NodeLaw| law.hook == Hook::Shear && law.law.effect.only_scales(Hook::Shear);
        self.laws.iter().all(scales) && self.uses.iter().all(|variable| allowed.contains(variable))
    }

    /// Computes the values that all nodes share; it must be called again after one of these variables has changed.
    pub(crate) fn settle(&mut self, variables: &[f64; Variable::COUNT]) {
        for law in &mut self.laws {
            law.program.settle(variables, &law.parameters, &mut law.scalars);
        }
    }

    /// Replaces the hook's quantity at the block's first `points` nodes.
    ///
    /// # Arguments
    /// - `counts`: whether a point is a node in contact; other points may hold any value.
    /// - `variables`: those of the last call of [`NodeLaws::settle`], for messages.
    pub(crate) fn apply(
        &mut self,
        hook: Hook,
        points: usize,
        counts: impl Fn(usize) -> bool,
        variables: &[f64; Variable::COUNT],
    ) -> Result<(), Rejection> {
        let target = hook.target();
        for place in 0..self.laws.len() {
            let law = &self.laws[place];
            if law.hook != hook {
                continue;
            }
            self.before.clear();
            self.before
                .extend_from_slice(&self.block.column(target)[..points]);
            self.block.replace(target, law.program, &law.scalars, points);
            let values = &self.block.column(target)[..points];
            // The bounds of these hooks are checked without an early exit, so that the loop vectorises.
            let fine = values
                .iter()
                .fold(true, |fine, value| fine & (0.0..=f64::MAX).contains(value));
            if fine {
                continue;
            }
            let wrong = (0..points).find(|&point| counts(point) && !hook.admits(values[point]));
            if let Some(point) = wrong {
                let value = values[point];
                let mut all = *variables;
                for variable in law.program.local().iter() {
                    all[variable as usize] = self.block.column(variable)[point];
                }
                all[target as usize] = self.before[point];
                return Err(law.law.refusal(hook, &law.parameters, value, |v| all[v as usize]));
            }
        }
        Ok(())
    }
}

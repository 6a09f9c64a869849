//! The law of an effect: its formulas, compiled for one model.

use formula::effect::Mechanism;
use formula::{Effect, Hook, Program, Variable};

use crate::Rejection;

/// An effect compiled for one model.
#[derive(Debug, Clone)]
pub(super) struct Law {
    pub(super) effect: Effect,
    /// The formulas by hook.
    pub(super) programs: [Option<Program>; Hook::COUNT],
    /// The mechanism in place of the formulas.
    pub(super) mechanism: Option<Mechanism>,
}

impl Law {
    /// Returns why a formula's value cannot be used, with the values that led to it.
    pub(super) fn refusal(
        &self,
        hook: Hook,
        parameters: &[f64],
        value: f64,
        value_of: impl Fn(Variable) -> f64,
    ) -> Rejection {
        let program = self.programs[hook as usize].iter();
        let values = program.flat_map(|program| {
            let variables = program
                .uses()
                .iter()
                .map(|v| (v.name(), value_of(v), v.unit_name()));
            let shown = program.parameters().iter().map(|&place| {
                let parameter = &self.effect.parameters[usize::from(place)];
                (
                    parameter.name.as_str(),
                    parameters[usize::from(place)],
                    parameter.unit.as_str(),
                )
            });
            variables.chain(shown).collect::<Vec<_>>()
        });
        let shown: Vec<String> = values
            .map(|(name, value, unit)| format!("{name} = {value}{}", crate::rejection::shown(unit)))
            .collect();
        Rejection::Formula(Box::new(crate::rejection::FormulaRefusal {
            effect: self.effect.name.clone(),
            hook: hook.name(),
            value,
            unit: hook.target().unit_name(),
            bound: hook.bound(),
            values: shown.join(", "),
        }))
    }
}

/// Returns the formulas at a hook, in order, each with its effect and the values of its parameters.
pub(super) fn formulas_at<'a, 'v>(
    laws: &'v [(&'a Law, Vec<f64>)],
    hook: Hook,
) -> impl Iterator<Item = (&'a Program, &'a Law, &'v [f64])> {
    laws.iter().filter_map(move |(law, values)| {
        let program = law.programs[hook as usize].as_ref()?;
        Some((program, *law, values.as_slice()))
    })
}

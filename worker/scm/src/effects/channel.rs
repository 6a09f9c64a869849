//! Effects on the measured channels.

use formula::{Hook, Variable};

use super::Active;
use crate::Rejection;

impl Active<'_> {
    /// Whether any effect changes what is measured.
    pub(crate) fn change_channels(&self) -> bool {
        Hook::CHANNELS.into_iter().any(|hook| self.enter(hook))
    }

    /// Replace the channels by their measured values. The formulas of one effect all see the channels as they are after the
    /// effects before it.
    pub(crate) fn measure(&self, variables: &mut [f64; Variable::COUNT]) -> Result<(), Rejection> {
        let mut scalars = Vec::new();
        for (law, parameters) in &self.laws {
            let before = *variables;
            for hook in Hook::CHANNELS {
                let Some(program) = &law.programs[hook as usize] else {
                    continue;
                };
                let value = program
                    .settle(&before, parameters, &mut scalars)
                    .unwrap_or(f64::NAN);
                if !hook.admits(value) {
                    return Err(law.refusal(hook, parameters, value, |v| before[v as usize]));
                }
                variables[hook.target() as usize] = value;
            }
        }
        Ok(())
    }
}

//! Effects on the measured channels.

use formula::{Hook, Variable};

use super::Active;
use crate::{Averages, Rejection};

impl Active<'_> {
    /// Returns whether any effect changes the measured channels.
    pub(crate) fn change_channels(&self) -> bool {
        Hook::CHANNELS.into_iter().any(|hook| self.enter(hook))
    }

    /// Replaces the channels of a steady run by their measured values, at this k* of the contact `[N/m^(n+2)]`.
    pub(crate) fn measure_averages(
        &self,
        variables: &mut [f64; Variable::COUNT],
        modulus: f64,
        averages: &mut Averages,
    ) -> Result<(), Rejection> {
        let channels = [
            (Variable::DrawbarPull, &mut averages.drawbar_pull_n),
            (Variable::Torque, &mut averages.torque_n_m),
            (Variable::Sinkage, &mut averages.sinkage_m),
            (Variable::LateralForce, &mut averages.lateral_force_n),
        ];
        variables[Variable::ContactLength as usize] = averages.contact_length_m;
        variables[Variable::BEff as usize] = averages.b_eff_m;
        variables[Variable::KStar as usize] = modulus;
        for (variable, channel) in &channels {
            variables[*variable as usize] = **channel;
        }
        self.measure(variables)?;
        for (variable, channel) in channels {
            *channel = variables[variable as usize];
        }
        Ok(())
    }

    /// Replaces the channels by their measured values. All formulas of one effect see the channels after the preceding effects.
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

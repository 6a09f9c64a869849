//! An instance of the unit: variables by their value references, and a step.

use std::path::Path;
use std::sync::Arc;

use shared::model::{DrawnModel, equations_of};
use worker::external::allowed::AllowedModels;
use worker::model::CompiledVariant;

use crate::error::UnitError;

/// Value reference of the time; inputs, outputs and the number of the draw follow it.
pub(crate) const TIME: u32 = 0;
const INPUTS: [&str; 4] = ["slip", "wheel_load_n", "sled_speed_m_s", "slip_angle_deg"];
const FIRST_INPUT: u32 = 1;
const FIRST_OUTPUT: u32 = 5;
/// Value reference of the number of the draw.
pub(crate) const DRAW: u32 = 9;

/// A calibrated wheel under the condition that a simulator sets.
#[derive(Debug)]
pub(crate) struct Unit {
    model: DrawnModel,
    start: [f64; 4],
    inputs: [f64; 4],
    /// Drawbar pull `[N]`, torque \[N m\], sinkage `[m]`, lateral force `[N]`; NaN where there is none.
    outputs: [f64; 4],
    draw: i32,
    /// Whether a reading of an output simulates where inputs have changed: in the initialisation mode.
    is_initialising: bool,
    /// Whether the outputs are those of the inputs and the draw.
    is_current: bool,
    /// Time `[s]`.
    pub(crate) time_s: f64,
}

impl Unit {
    /// Reads the model from the folder of the resources.
    ///
    /// # Errors
    /// [`UnitError`]: the processor lacks what the build needs, the file cannot be read, or it is that of another description.
    pub(crate) fn open(resources: &Path, token: &str) -> Result<Unit, UnitError> {
        worker::processor::check().map_err(|e| UnitError::Model(e.to_string()))?;
        let path = resources.join("model.json");
        let fail = |reason: String| UnitError::Resources {
            path: path.display().to_string(),
            reason,
        };
        let text = std::fs::read_to_string(&path).map_err(|e| fail(e.to_string()))?;
        let model: DrawnModel = serde_json::from_str(&text).map_err(|e| fail(e.to_string()))?;
        Unit::new(model, token)
    }

    fn new(model: DrawnModel, token: &str) -> Result<Unit, UnitError> {
        if model.token != token {
            return Err(UnitError::Token(token.to_owned()));
        }
        if equations_of(&model.model_version) != worker::model_version() {
            return Err(UnitError::Model(format!(
                "the model has the equations {}, this library computes {}: export it again",
                model.model_version,
                worker::model_version()
            )));
        }
        let condition = model.variant.conditions.first();
        let condition = condition.ok_or_else(|| UnitError::Model("the model has no condition".into()))?;
        let start = [
            condition.slip,
            condition.wheel_load_n,
            condition.sled_speed_m_s,
            condition.slip_angle_deg,
        ];
        Ok(Unit {
            start,
            inputs: start,
            outputs: [f64::NAN; 4],
            draw: 0,
            is_initialising: false,
            is_current: false,
            time_s: 0.0,
            model,
        })
    }

    /// Sets all variables to their start values.
    pub(crate) fn reset(&mut self) {
        (self.inputs, self.outputs, self.draw) = (self.start, [f64::NAN; 4], 0);
        (self.is_initialising, self.is_current) = (false, false);
        self.time_s = 0.0;
    }

    /// Enters the initialisation mode, in which outputs follow from the inputs at each reading.
    pub(crate) fn begin_initialisation(&mut self) {
        self.is_initialising = true;
    }

    /// Leaves the initialisation mode: outputs are those of the last simulation.
    pub(crate) fn end_initialisation(&mut self) {
        self.is_initialising = false;
    }

    /// Returns a real variable. In the initialisation mode an output is simulated first where it does not follow from the inputs yet.
    ///
    /// # Errors
    /// [`UnitError::Variable`], [`UnitError::Model`]. A refused condition is none: the output is NaN, and the end of the mode says so.
    pub(crate) fn real(&mut self, reference: u32) -> Result<f64, UnitError> {
        let is_output = (FIRST_OUTPUT..DRAW).contains(&reference);
        if is_output && self.is_initialising && !self.is_current {
            match self.simulate() {
                Ok(()) | Err(UnitError::Refused { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        let at = |values: &[f64; 4], first: u32| values.get(reference.checked_sub(first)? as usize).copied();
        let value = at(&self.outputs, FIRST_OUTPUT).or_else(|| at(&self.inputs, FIRST_INPUT));
        let value = value.or((reference == TIME).then_some(self.time_s));
        value.ok_or(UnitError::Variable {
            what: "real variable",
            reference,
        })
    }

    /// Sets an input.
    pub(crate) fn set_real(&mut self, reference: u32, value: f64) -> Result<(), UnitError> {
        let input = reference
            .checked_sub(FIRST_INPUT)
            .map_or(INPUTS.len(), |at| at as usize);
        let (unit, bound, is_valid) = match input {
            0 => ("", "lie in [-1, 1)", (-1.0..1.0).contains(&value)),
            1 => (" N", "be > 0 N", value > 0.0 && value.is_finite()),
            2 => (" m/s", "be > 0 m/s", value > 0.0 && value.is_finite()),
            3 => (" deg", "lie in [-90, 90] deg", value.abs() <= 90.0),
            _ => {
                return Err(UnitError::Variable {
                    what: "input",
                    reference,
                });
            }
        };
        if !is_valid {
            return Err(UnitError::Bound {
                name: INPUTS[input],
                value,
                unit,
                bound: bound.into(),
            });
        }
        self.inputs[input] = value;
        self.is_current = false;
        Ok(())
    }

    /// Returns the number of the draw.
    pub(crate) fn whole(&self, reference: u32) -> Result<i32, UnitError> {
        match reference {
            DRAW => Ok(self.draw),
            _ => Err(UnitError::Variable {
                what: "whole variable",
                reference,
            }),
        }
    }

    /// Chooses a draw, from 1; 0 is the mean over all of them.
    pub(crate) fn set_whole(&mut self, reference: u32, value: i32) -> Result<(), UnitError> {
        self.whole(reference)?;
        let draws = self.model.draws.len();
        if !usize::try_from(value).is_ok_and(|draw| draw <= draws) {
            return Err(UnitError::Bound {
                name: "draw",
                value: f64::from(value),
                unit: "",
                bound: format!("lie in [0, {draws}]"),
            });
        }
        self.draw = value;
        self.is_current = false;
        Ok(())
    }

    /// Simulates the steady run of the condition that is set. Without a result, all outputs are NaN.
    ///
    /// # Errors
    /// [`UnitError::Refused`]: at the chosen draw, or, for the mean, at half of the draws or more; [`UnitError::Model`].
    pub(crate) fn simulate(&mut self) -> Result<(), UnitError> {
        self.outputs = [f64::NAN; 4];
        let mut variant = self.model.variant.clone();
        let [slip, wheel_load_n, sled_speed_m_s, slip_angle_deg] = self.inputs;
        for condition in Arc::make_mut(&mut variant.conditions) {
            condition.slip = slip;
            condition.wheel_load_n = wheel_load_n;
            condition.sled_speed_m_s = sled_speed_m_s;
            condition.slip_angle_deg = slip_angle_deg;
        }
        let compiled = CompiledVariant::new(&variant, &Arc::new(AllowedModels::default()))
            .map_err(|e| UnitError::Model(e.to_string()))?;
        self.is_current = true;
        let draws = match usize::try_from(self.draw)
            .ok()
            .and_then(|draw| draw.checked_sub(1))
        {
            Some(draw) => &self.model.draws[draw..=draw],
            None => &self.model.draws,
        };
        let mut sums = [0.0; 4];
        let (mut accepted, mut first) = (0_usize, None);
        for theta in draws {
            match compiled.each(theta).pop() {
                Some(Ok(averages)) => {
                    accepted += 1;
                    let values = [
                        averages.drawbar_pull_n,
                        averages.torque_n_m,
                        averages.sinkage_m,
                        averages.lateral_force_n,
                    ];
                    for (sum, value) in sums.iter_mut().zip(values) {
                        *sum += value;
                    }
                }
                Some(Err(rejection)) => first = first.or(Some(rejection.message)),
                None => {}
            }
        }
        if 2 * accepted <= draws.len() {
            return Err(UnitError::Refused {
                refused: draws.len() - accepted,
                draws: draws.len(),
                first: first.unwrap_or_default(),
            });
        }
        self.outputs = sums.map(|sum| sum / accepted as f64);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use shared::experiment::Experiment;
    use shared::file::FileSet;
    use shared::model::{EffectSet, ModelKind, ModelSettings, ModelVariant};

    use super::*;

    /// A wheel whose soil is known up to its exponent, at two draws of it.
    fn model() -> DrawnModel {
        let files = FileSet {
            toml: include_str!("../../../tests/data/nothing-hidden/experiment.toml").into(),
            files: BTreeMap::from([(
                "runs.csv".into(),
                include_str!("../../../tests/data/nothing-hidden/runs.csv").into(),
            )]),
        };
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        let mut settings = ModelSettings {
            kind: ModelKind::QuasiStatic,
            fixed: BTreeMap::new(),
            spatial: None,
            rolls_grousers: false,
            external: None,
            effects: Vec::new(),
            effect_files: Vec::new(),
        };
        let values = include_str!("../../../tests/data/nothing-hidden/parameters.toml");
        for line in values
            .lines()
            .filter(|line| line.contains('=') && !line.starts_with('#'))
        {
            let (name, value) = line.split_once('=').unwrap();
            let value = value.split('#').next().unwrap().trim();
            settings
                .fixed
                .insert(name.trim().to_owned(), value.parse().unwrap());
        }
        let n = settings.fixed.remove("n").unwrap();
        let free = vec!["n".to_owned()];
        let runs = &experiment.runs[..1];
        let variant = ModelVariant::new(&experiment, &settings, &EffectSet::default(), free, runs).unwrap();
        DrawnModel {
            calibration: 1,
            name: "quasi_static".into(),
            model_version: worker::model_version().to_owned(),
            variant,
            draws: vec![vec![n], vec![1.05 * n]],
            token: "t".into(),
        }
    }

    fn pull_at(unit: &mut Unit, draw: i32) -> f64 {
        unit.set_whole(DRAW, draw).unwrap();
        unit.simulate().unwrap();
        unit.real(FIRST_OUTPUT).unwrap()
    }

    #[test]
    fn a_step_has_the_bits_of_the_worker() {
        let model = model();
        let mut unit = Unit::new(model.clone(), "t").unwrap();
        unit.set_real(FIRST_INPUT, 0.3).unwrap();
        let mut variant = model.variant.clone();
        Arc::make_mut(&mut variant.conditions)[0].slip = 0.3;
        let worker = CompiledVariant::new(&variant, &Arc::new(AllowedModels::default())).unwrap();
        let pulls = [1, 2].map(|draw| pull_at(&mut unit, draw));
        for (draw, pull) in model.draws.iter().zip(pulls) {
            let expected = worker.each(draw)[0].as_ref().unwrap().drawbar_pull_n;
            assert_eq!(pull.to_bits(), expected.to_bits());
        }
        let mean = pull_at(&mut unit, 0);
        assert!((mean - 0.5 * (pulls[0] + pulls[1])).abs() < 1e-12 * mean.abs());
        assert!((pulls[0] - pulls[1]).abs() > 1e-6);
    }

    #[test]
    fn outputs_follow_from_the_inputs_in_the_initialisation_mode() {
        let mut unit = Unit::new(model(), "t").unwrap();
        unit.begin_initialisation();
        let before = unit.real(FIRST_OUTPUT).unwrap();
        assert!(before.is_finite());
        unit.set_real(FIRST_INPUT, 0.3).unwrap();
        let initial = unit.real(FIRST_OUTPUT).unwrap();
        unit.set_real(2, 1e9).unwrap();
        assert!(unit.real(FIRST_OUTPUT).unwrap().is_nan());
        unit.reset();
        unit.set_real(FIRST_INPUT, 0.3).unwrap();
        let after = pull_at(&mut unit, 0);
        assert_eq!(initial.to_bits(), after.to_bits());
        assert_ne!(before.to_bits(), after.to_bits());
        // A step alone changes outputs afterwards.
        unit.set_real(FIRST_INPUT, 0.1).unwrap();
        assert_eq!(unit.real(FIRST_OUTPUT).unwrap().to_bits(), after.to_bits());
    }

    #[test]
    fn a_model_that_cannot_be_compiled_is_no_refused_condition() {
        let mut unit = Unit::new(model(), "t").unwrap();
        unit.model.variant.fixed.remove("k_phi");
        let failed = unit.simulate();
        assert!(matches!(failed, Err(UnitError::Model(_))), "{failed:?}");
    }

    #[test]
    fn values_out_of_bounds_are_refused() {
        let mut unit = Unit::new(model(), "t").unwrap();
        let refused = |result: Result<(), UnitError>| result.unwrap_err().to_string();
        assert_eq!(refused(unit.set_real(1, 1.0)), "slip 1 must lie in [-1, 1)");
        assert_eq!(refused(unit.set_real(2, 0.0)), "wheel_load_n 0 N must be > 0 N");
        assert_eq!(
            refused(unit.set_real(3, f64::NAN)),
            "sled_speed_m_s NaN m/s must be > 0 m/s"
        );
        assert_eq!(
            refused(unit.set_real(5, 1.0)),
            "there is no input with value reference 5"
        );
        assert_eq!(refused(unit.set_whole(DRAW, 3)), "draw 3 must lie in [0, 2]");
        assert_eq!(refused(unit.set_whole(DRAW, -1)), "draw -1 must lie in [0, 2]");
        let other = Unit::new(model(), "u").unwrap_err().to_string();
        assert!(other.contains("token \"u\""), "{other}");
    }

    #[test]
    fn a_condition_that_the_model_refuses_leaves_no_output() {
        let mut unit = Unit::new(model(), "t").unwrap();
        unit.simulate().unwrap();
        unit.set_real(2, 1e9).unwrap();
        let refused = unit.simulate().unwrap_err().to_string();
        assert!(refused.contains("at 2 of 2 draws"), "{refused}");
        assert!(unit.real(FIRST_OUTPUT).unwrap().is_nan());
    }
}

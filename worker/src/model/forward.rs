//! The forward model of a variant: simulates every condition with its transient, and predicts plates and rings, at one parameter vector.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use scm::spatial::SpatialRun;
use scm::{Averages, Condition, Wheel};
use shared::channel::Channel;
use shared::model::{
    EffectSet, ModelKind, ModelVariant, PlateCondition, RingCondition, RunCondition, TransientCondition,
};
use shared::outcome::{Observables, Outcome, ParameterRejection};

use super::bevameter::CompiledBevameter;
use super::effects::{ActiveEffects, EffectMap};
use super::error::CompileError;
use super::parameters::Radius;
use super::physics::{Physics, PhysicsAt, Run, Simulated};
use super::recording;
use super::shared_time::SharedTime;
use super::transients::Transients;

/// The forward model of a variant with its names resolved, so that an evaluation looks up nothing.
#[derive(Debug)]
pub(super) struct ForwardModel {
    pub(super) dimension: usize,
    physics: Physics,
    wheels: Vec<(Wheel, Radius)>,
    conditions: Vec<(usize, Condition)>,
    effects: EffectMap,
    /// The channels to return; empty: all.
    channels: Vec<Channel>,
    stiffness_sensitivity: bool,
    histories: bool,
    /// The transients to predict, by run.
    transients: Transients,
    /// The bevameter with its plates and rings, if there are readings to predict.
    bevameter: Option<(CompiledBevameter, Vec<PlateCondition>, Vec<RingCondition>)>,
}

/// The simulation of one condition.
type SimulatedRun = Result<Simulated, scm::Rejection>;

/// Relative increase of the stiffness for its derivatives: it must exceed the noise of a grid model, about 0.3 % of a force,
/// and the laws are smooth powers of the stiffness.
const STIFFER: f64 = 0.05;

impl ForwardModel {
    /// Resolves the names of a variant; [`CompileError`] names what this worker does not know or cannot express.
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, CompileError> {
        let set = EffectSet::read(&variant.effects)?;
        variant.check_expressible(&set)?;
        if variant.histories && variant.kind != ModelKind::Scm {
            return Err(CompileError::NoHistories(variant.kind.name()));
        }
        let transients = Transients::new(variant)?;
        let effects = EffectMap::new(variant, &set)?;
        let names: Vec<&str> = variant.wheels.keys().map(String::as_str).collect();
        let wheels = variant
            .wheels
            .iter()
            .map(|(name, w)| {
                let wheel = Wheel {
                    radius_m: w.radius_m,
                    width_m: w.width_m,
                    rig_radius_m: w.rig_radius_m,
                };
                (wheel, Radius::new(variant, name))
            })
            .collect();
        let conditions = variant
            .conditions
            .iter()
            .map(|c| {
                let wheel = names
                    .iter()
                    .position(|n| *n == c.wheel)
                    .ok_or_else(|| CompileError::UnknownWheel(c.wheel.clone()))?;
                Ok((wheel, condition(c)))
            })
            .collect::<Result<_, CompileError>>()?;
        Ok(ForwardModel {
            dimension: variant.parameters.len(),
            physics: Physics::new(variant)?,
            wheels,
            conditions,
            effects,
            channels: variant.channels.clone(),
            stiffness_sensitivity: variant.stiffness_sensitivity,
            histories: variant.histories,
            transients,
            bevameter: match variant.plates.is_empty() && variant.rings.is_empty() {
                true => None,
                false => Some((
                    CompiledBevameter::new(variant)?,
                    variant.plates.clone(),
                    variant.rings.clone(),
                )),
            },
        })
    }

    /// Returns the number of conditions of an evaluation.
    pub(super) fn runs(&self) -> usize {
        self.conditions.len()
    }

    /// Simulates every condition at one parameter vector; the first rejection ends it. `keep` receives each run of a
    /// time-dependent model, in the order of the conditions.
    ///
    /// # Arguments
    /// - `time`: where given, threads of the pool that calls share the conditions of an expensive model.
    pub(super) fn evaluate(
        &self,
        theta: &[f64],
        time: Option<&SharedTime>,
        mut keep: impl FnMut(SpatialRun),
    ) -> Outcome {
        let physics = match self.physics_at(theta) {
            Ok(physics) => physics,
            Err(rejection) => return Outcome::Rejected(rejection),
        };
        let mut effects = self.effects.at(theta);
        let mut observables = Observables::with_capacity(self.runs());
        observables.transient_sinkage_m = vec![0.0; self.transients.count()];
        let mut shared = self.share(theta, &physics, time).into_iter();
        for position in 0..self.runs() {
            let shared = shared.next().flatten();
            let simulated = shared.unwrap_or_else(|| self.simulate(theta, &physics, &mut effects, position));
            let simulated = match simulated {
                Ok(simulated) => simulated,
                Err(rejection) => return rejected(rejection.kind(), position, rejection.to_string()),
            };
            for (places, transient) in self.transients.of_run(position) {
                match self.transient(theta, &physics, &mut effects, &simulated, transient) {
                    Ok(sinkage_m) => {
                        observables.transient_sinkage_m[places.clone()].copy_from_slice(&sinkage_m);
                    }
                    Err(rejection) => return rejected(rejection.kind(), position, rejection.to_string()),
                }
            }
            match simulated {
                Simulated::Steady(averages) => push(&mut observables, &averages),
                Simulated::Rolled(run) => {
                    push(&mut observables, &run.averages);
                    observables.settled_to.extend(run.settled_to);
                    if self.histories {
                        match recording::recorded(&run.history) {
                            Ok(history) => observables.histories.push(history),
                            Err(rejection) => {
                                return rejected(rejection.kind(), position, rejection.to_string());
                            }
                        }
                    }
                    keep(*run);
                }
            }
        }
        if self.stiffness_sensitivity
            && let Err(rejection) =
                self.differentiate_by_stiffness(theta, &physics, time, &mut effects, &mut observables)
        {
            return Outcome::Rejected(rejection);
        }
        if let Err(rejection) = self.read_bevameter(theta, &mut observables) {
            return Outcome::Rejected(rejection);
        }
        if !self.channels.is_empty() {
            observables.keep_only(&self.channels);
        }
        Outcome::Evaluated(observables)
    }

    /// Simulates the conditions of a model whose runs take milliseconds on all threads of the pool that calls. A condition after a rejected
    /// one may be left out. Empty for fast models, and where nothing is shared.
    fn share(
        &self,
        theta: &[f64],
        physics: &PhysicsAt,
        time: Option<&SharedTime>,
    ) -> Vec<Option<SimulatedRun>> {
        let Some(time) = time.filter(|_| physics.is_expensive()) else {
            return Vec::new();
        };
        let first_rejected = AtomicUsize::new(usize::MAX);
        let simulate = |effects: &mut ActiveEffects, position: usize| {
            if position > first_rejected.load(Ordering::Relaxed) {
                return None;
            }
            let simulated = time.measure(|| self.simulate(theta, physics, effects, position));
            if simulated.is_err() {
                first_rejected.fetch_min(position, Ordering::Relaxed);
            }
            Some(simulated)
        };
        (0..self.runs())
            .into_par_iter()
            .with_max_len(1)
            .map_init(|| self.effects.at(theta), simulate)
            .collect()
    }

    /// Simulates every condition on stiffer soil: derivatives of the channels by ln k*.
    fn differentiate_by_stiffness(
        &self,
        theta: &[f64],
        physics: &PhysicsAt,
        time: Option<&SharedTime>,
        effects: &mut ActiveEffects,
        observables: &mut Observables,
    ) -> Result<(), ParameterRejection> {
        let stiffer = physics.stiffer(1.0 + STIFFER);
        let step = libm::log1p(STIFFER);
        let mut shared = self.share(theta, &stiffer, time).into_iter();
        for position in 0..self.runs() {
            let shared = shared.next().flatten();
            let simulated = shared.unwrap_or_else(|| self.simulate(theta, &stiffer, effects, position));
            let averages = match simulated {
                Ok(Simulated::Steady(averages)) => averages,
                Ok(Simulated::Rolled(run)) => run.averages,
                Err(rejection) => {
                    let message = format!("on soil stiffer by {STIFFER}: {rejection}");
                    return Err(parameter_rejection(rejection.kind(), position, message));
                }
            };
            let o = &mut *observables;
            let change = |stiffer: f64, base: f64| (stiffer - base) / step;
            o.d_drawbar_pull_n
                .push(change(averages.drawbar_pull_n, o.drawbar_pull_n[position]));
            o.d_torque_n_m
                .push(change(averages.torque_n_m, o.torque_n_m[position]));
            o.d_sinkage_m
                .push(change(averages.sinkage_m, o.sinkage_m[position]));
            o.d_lateral_force_n
                .push(change(averages.lateral_force_n, o.lateral_force_n[position]));
        }
        Ok(())
    }

    /// Predicts plates and rings. Their likelihood uses logarithms, so a stress of zero is a rejection.
    fn read_bevameter(&self, theta: &[f64], observables: &mut Observables) -> Result<(), ParameterRejection> {
        let Some((bevameter, plates, rings)) = &self.bevameter else {
            return Ok(());
        };
        let readings = bevameter.at(theta);
        let positive = |position: usize, what: &str, stress: Result<f64, scm::Rejection>| match stress {
            Ok(stress) if stress > 0.0 => Ok(stress),
            Ok(stress) => Err(parameter_rejection(
                "no_support",
                position,
                format!("{what}: {stress} Pa must be above 0"),
            )),
            Err(rejection) => Err(parameter_rejection(
                rejection.kind(),
                position,
                format!("{what}: {rejection}"),
            )),
        };
        for (i, plate) in plates.iter().enumerate() {
            let pressure = readings.pressure_pa(plate.plate_radius_m, plate.sinkage_m);
            let pressure = positive(self.runs() + i, "pressure under a plate", pressure)?;
            observables.plate_pressure_pa.push(pressure);
        }
        for (i, ring) in rings.iter().enumerate() {
            let stress = readings.shear_stress_pa(ring.normal_stress_pa, ring.shear_displacement_m);
            let position = self.runs() + plates.len() + i;
            let stress = positive(position, "shear stress under a ring", stress)?;
            observables.shear_stress_pa.push(stress);
        }
        Ok(())
    }

    /// Simulates every condition at one parameter vector; a rejection of one does not affect the rest.
    pub(super) fn evaluate_each(&self, theta: &[f64]) -> Vec<Result<Averages, ParameterRejection>> {
        let physics = match self.physics_at(theta) {
            Ok(physics) => physics,
            Err(rejection) => return vec![Err(rejection); self.runs()],
        };
        let mut effects = self.effects.at(theta);
        let averages = |position| match self.simulate(theta, &physics, &mut effects, position) {
            Ok(Simulated::Steady(averages)) => Ok(averages),
            Ok(Simulated::Rolled(run)) => Ok(run.averages),
            Err(rejection) => Err(parameter_rejection(
                rejection.kind(),
                position,
                rejection.to_string(),
            )),
        };
        (0..self.runs()).map(averages).collect()
    }

    fn physics_at(&self, theta: &[f64]) -> Result<PhysicsAt<'_>, ParameterRejection> {
        if theta.len() != self.dimension {
            let message = format!(
                "theta has {} entries, the variant has {}",
                theta.len(),
                self.dimension
            );
            return Err(parameter_rejection("invalid_parameter", 0, message));
        }
        let physics = self.physics.at(theta);
        physics.map_err(|rejection| parameter_rejection(rejection.kind(), 0, rejection.to_string()))
    }

    fn simulate(
        &self,
        theta: &[f64],
        physics: &PhysicsAt,
        effects: &mut ActiveEffects,
        position: usize,
    ) -> SimulatedRun {
        let wheel = self.wheel(theta, position);
        let run = self.run(theta, &wheel, position);
        physics.simulate(&run, effects.on_wheel(run.wheel_index))
    }

    /// Returns the sinkage at each point of a run's transient `[m]`.
    fn transient(
        &self,
        theta: &[f64],
        physics: &PhysicsAt,
        effects: &mut ActiveEffects,
        simulated: &Simulated,
        transient: &TransientCondition,
    ) -> Result<Vec<f64>, scm::Rejection> {
        let wheel = self.wheel(theta, transient.run);
        let run = self.run(theta, &wheel, transient.run);
        physics.transient_sinkage(&run, effects.on_wheel(run.wheel_index), simulated, transient)
    }

    /// Returns the wheel of a condition, with its radius at these parameters.
    fn wheel(&self, theta: &[f64], position: usize) -> Wheel {
        let (wheel, radius) = &self.wheels[self.conditions[position].0];
        Wheel {
            radius_m: radius.value(theta).unwrap_or(wheel.radius_m),
            ..*wheel
        }
    }

    fn run<'r>(&'r self, theta: &'r [f64], wheel: &'r Wheel, position: usize) -> Run<'r> {
        let (wheel_index, condition) = &self.conditions[position];
        Run {
            theta,
            position,
            wheel_index: *wheel_index,
            wheel,
            condition,
            site: self.effects.site(position),
        }
    }
}

/// Converts a condition of a variant to the physics' type.
pub(super) fn condition(c: &RunCondition) -> Condition {
    Condition {
        slip: c.slip,
        wheel_load_n: c.wheel_load_n,
        sled_speed_m_s: c.sled_speed_m_s,
        slip_angle_rad: c.slip_angle_deg.to_radians(),
        pass: c.pass,
    }
}

fn push(o: &mut Observables, a: &Averages) {
    o.drawbar_pull_n.push(a.drawbar_pull_n);
    o.torque_n_m.push(a.torque_n_m);
    o.sinkage_m.push(a.sinkage_m);
    o.lateral_force_n.push(a.lateral_force_n);
    o.b_eff_m.push(a.b_eff_m);
    o.contact_length_m.push(a.contact_length_m);
    o.residual_load_n.push(a.residual_load_n);
    o.nodes_in_contact.push(a.nodes_in_contact);
    o.simulated_travel_m.push(a.simulated_travel_m);
}

fn parameter_rejection(kind: &str, condition: usize, message: String) -> ParameterRejection {
    ParameterRejection {
        kind: kind.to_owned(),
        condition: condition as u32,
        message,
    }
}

fn rejected(kind: &str, condition: usize, message: String) -> Outcome {
    Outcome::Rejected(parameter_rejection(kind, condition, message))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use shared::outcome::Outcome;

    use super::ForwardModel;
    use crate::fixture::variant_of;
    use crate::model::SharedTime;

    /// Returns the model of six runs of `scm` under these loads, with derivatives by the stiffness and histories.
    fn of_loads(loads_n: [f64; 6]) -> ForwardModel {
        let mut variant = variant_of("scm", loads_n.len());
        for (condition, load_n) in Arc::make_mut(&mut variant.conditions).iter_mut().zip(loads_n) {
            condition.wheel_load_n = load_n;
        }
        variant.stiffness_sensitivity = true;
        variant.histories = true;
        ForwardModel::new(&variant).unwrap()
    }

    fn pool() -> rayon::ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap()
    }

    #[test]
    fn runs_that_threads_share_have_the_same_bits() {
        let model = of_loads([100.0, 80.0, 120.0, 90.0, 110.0, 70.0]);
        let alone = model.evaluate(&[], None, |_| {});
        let time = SharedTime::default();
        let shared = pool().install(|| model.evaluate(&[], Some(&time), |_| {}));
        assert!(matches!(alone, Outcome::Evaluated(_)), "{alone:?}");
        assert_eq!(alone, shared);
        assert!(time.total().is_some());
        assert_eq!(SharedTime::default().total(), None);
    }

    #[test]
    fn the_first_of_two_rejected_runs_is_named_whichever_thread_ends_first() {
        let model = of_loads([100.0, 80.0, 1e6, 90.0, 1e7, 70.0]);
        let alone = model.evaluate(&[], None, |_| {});
        let Outcome::Rejected(rejection) = &alone else {
            panic!("{alone:?}");
        };
        assert_eq!(rejection.condition, 2, "{rejection:?}");
        let time = SharedTime::default();
        let shared = pool().install(|| model.evaluate(&[], Some(&time), |_| {}));
        assert_eq!(alone, shared);
        let physics = model.physics_at(&[]).unwrap();
        let runs = pool().install(|| model.share(&[], &physics, Some(&time)));
        let accepted: Vec<Option<bool>> = runs
            .iter()
            .map(|run| run.as_ref().map(Result::is_ok))
            .take(3)
            .collect();
        assert_eq!(accepted, [Some(true), Some(true), Some(false)]);
    }
}

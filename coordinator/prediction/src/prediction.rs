//! Predictions of a plan: channels, what follows from them, probabilities of statements, the slip on a slope.

use job::{PlannedRun, QUANTITIES, QuantityValues, Statement, position_of, predicted_quantities};
use result::table::correction::Corrections;
use result::table::mixture::quantile;
use result::table::predictive::{Levels, predictive};
use result::{Component, Refusal};
use serde::{Deserialize, Serialize};
use shared::channel::Channel;
use utoipa::ToSchema;

use crate::balance::{climb, curve_of_runs, slip_curves};
use crate::beyond::beyond;
use crate::draw::{DrawnRun, Draws, ERRORS};
use crate::ensemble::{MIN_DRAWS, ModelWeight, Simulated};
use crate::quantity_value::quantity_values;
use crate::spread::{interval, mean, probability};

/// Predictions of planned runs by the posterior of a calibration and of the other models of its study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Prediction {
    /// Id of the calibration.
    pub calibration: i64,
    /// Number of draws of each model.
    pub draws: usize,
    /// The models of the study with their weights.
    pub models: Vec<ModelWeight>,
    /// The planned runs, in the order of the plan.
    pub runs: Vec<PredictedRun>,
    /// The slip at which the wheel climbs, of planned runs that differ in slip alone.
    pub climbs: Vec<PredictedClimb>,
    /// What limits these predictions, in sentences.
    pub notes: Vec<String>,
}

/// A planned run with its predictions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PredictedRun {
    /// Name of the run.
    pub run: String,
    /// Name of the wheel.
    pub wheel: String,
    /// Slip.
    pub slip: f64,
    /// Load normal to the ground `[N]`.
    pub wheel_load_n: f64,
    /// Speed of travel `[m/s]`.
    pub sled_speed_m_s: f64,
    /// From wheel heading to travel `[deg]`.
    pub slip_angle_deg: f64,
    /// Number of the pass.
    pub pass: u32,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// Inclination of the ground `[deg]`.
    pub slope_deg: f64,
    /// What lies outside the range of the fitted runs, in phrases; empty within it.
    pub beyond: Vec<String>,
    /// The draws at which the model refuses the run; null if it refuses none. At half of the draws or more, nothing is predicted.
    pub refused: Option<Refusal>,
    /// Predictions of channels and of what follows from them.
    pub quantities: Vec<PredictedQuantity>,
    /// Probabilities of the statements.
    pub statements: Vec<StatementProbability>,
}

/// The prediction of one quantity, in its SI unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PredictedQuantity {
    /// Name with the unit at its end.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Mean over the posterior of the calibration.
    pub mean: f64,
    /// 90 % interval by the parameters of the calibration's model alone.
    pub parameters: [f64; 2],
    /// 90 % interval of a new measurement, if the calibration's model holds: parameters, noise, scatter of the soil, discrepancy. Null of
    /// a channel whose noise is unknown.
    pub measurement: Option<[f64; 2]>,
    /// Mean over all models by their weights.
    pub models_mean: f64,
    /// 90 % interval by the parameters of all models.
    pub models: [f64; 2],
    /// 90 % interval of a new measurement by all models.
    pub models_measurement: Option<[f64; 2]>,
    /// Mean corrected by what the calibration's model misses in the fitted conditions; null of what is no channel, or if nothing can be
    /// corrected.
    pub corrected: Option<f64>,
    /// 90 % interval of a new measurement by the corrected prediction.
    pub corrected_measurement: Option<[f64; 2]>,
}

/// The probability of a statement about a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct StatementProbability {
    /// The statement.
    pub statement: String,
    /// Probability over the parameters of the calibration's model.
    pub parameters: Option<f64>,
    /// Probability over the parameters of all models.
    pub models: Option<f64>,
    /// Probability that a new measurement says so, over all models.
    pub measurement: Option<f64>,
}

/// Planned runs that differ in slip alone, as a wheel on its slope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PredictedClimb {
    /// Name of the wheel.
    pub wheel: String,
    /// Load on level ground `[N]`.
    pub wheel_load_n: f64,
    /// Inclination of the ground `[deg]`.
    pub slope_deg: f64,
    /// Acceleration of gravity `[m/s^2]`.
    pub gravity_m_s2: f64,
    /// Probability that some slip of the plan balances the weight along the slope, over all models.
    pub probability: f64,
    /// Mean of that slip where there is one; null if there is none.
    pub slip: Option<f64>,
    /// 90 % interval of that slip.
    pub slip_interval: Option<[f64; 2]>,
    /// Mean energy per metre at that slip `[J/m]`.
    pub energy_j_m: Option<f64>,
    /// 90 % interval of that energy.
    pub energy_interval: Option<[f64; 2]>,
}

/// Predicts simulated runs.
pub fn predict(simulated: &Simulated, statements: &[Statement]) -> Prediction {
    let draws = Draws::new(simulated);
    let asked = &simulated.models[0].calibration;
    let curves = curve_of_runs(&simulated.runs);
    let drawn: Vec<Vec<Option<DrawnRun>>> = (0..simulated.runs.len())
        .map(|run| draws.of_run(run, curves[run]))
        .collect();
    let levels = Levels::new(asked);
    let corrections = Corrections::new(asked);
    let runs = simulated.runs.iter().enumerate().map(|(i, planned)| {
        let sampled = Sampled {
            draws: &draws,
            planned,
            rig_radius_m: rig_radius_m(simulated, planned),
            drawn: &drawn[i],
        };
        let position = simulated.first + i;
        let refused = asked.refusal(position);
        let is_refused = refused.as_ref().is_some_and(Refusal::is_at_half_or_more);
        let corrected = |channel: Channel| {
            let model = predictive(asked, &levels, position, channel)?;
            corrections.at(position, channel, model).ok()
        };
        let quantity = |q: usize| {
            let mut predicted = sampled.quantity(q, asked.spec.likelihood.law())?;
            if let Some(corrected) = Channel::ALL.get(q).and_then(|&channel| corrected(channel)) {
                predicted.corrected = Some(corrected.mean);
                predicted.corrected_measurement = corrected.interval;
            }
            Some(predicted)
        };
        let quantities = predicted_quantities()
            .filter(|_| !is_refused)
            .filter_map(quantity);
        let run = &planned.run;
        PredictedRun {
            run: run.name.clone(),
            wheel: run.wheel.clone(),
            slip: run.slip,
            wheel_load_n: run.wheel_load_n,
            sled_speed_m_s: run.sled_speed_m_s,
            slip_angle_deg: run.slip_angle_deg,
            pass: run.pass,
            gravity_m_s2: planned.gravity_m_s2,
            slope_deg: planned.slope_deg,
            beyond: beyond(&asked.spec.experiment, planned),
            quantities: quantities.collect(),
            statements: statements
                .iter()
                .filter(|_| !is_refused)
                .map(|statement| sampled.statement(statement))
                .collect(),
            refused,
        }
    });
    Prediction {
        calibration: asked.row.id,
        draws: simulated.draws,
        models: simulated.weights.clone(),
        runs: runs.collect(),
        climbs: climbs(simulated, &draws, &drawn),
        notes: notes(simulated),
    }
}

/// Returns the radius with which a planned run turns slip into rim speed `[m]`.
pub(crate) fn rig_radius_m(simulated: &Simulated, planned: &PlannedRun) -> f64 {
    let wheels = &simulated.models[0].calibration.spec.experiment.wheels;
    wheels[&planned.run.wheel].rig_radius_m
}

/// Returns what limits predictions by simulated models, in sentences.
pub(crate) fn notes(simulated: &Simulated) -> Vec<String> {
    let mut notes = Vec::new();
    if simulated.is_thinned {
        notes.push(format!(
            "{} evenly spaced draws of each model stand for its posterior, because more would be too many simulations",
            simulated.draws
        ));
    }
    if simulated.draws < MIN_DRAWS {
        notes.push(format!("intervals of {} draws are rough", simulated.draws));
    }
    let asked = &simulated.models[0].calibration;
    let unknown = Channel::ALL.into_iter().filter(|channel| {
        let noise = asked.spec.experiment.noise.sd[channel.index()];
        let is_fitted = asked
            .spec
            .likelihood
            .data()
            .iter()
            .any(|d| d.channel == channel.index());
        is_fitted && noise.is_none()
    });
    for channel in unknown {
        notes.push(format!(
            "[noise] states no sd of the {}: predictions of it have no interval of a new measurement",
            channel.words()
        ));
    }
    notes
}

/// A planned run at all draws.
struct Sampled<'a> {
    draws: &'a Draws<'a>,
    planned: &'a PlannedRun,
    rig_radius_m: f64,
    drawn: &'a [Option<DrawnRun>],
}

impl Sampled<'_> {
    fn values(&self, channels: [f64; 4]) -> QuantityValues {
        quantity_values(self.planned, self.rig_radius_m, channels, false)
    }

    /// Returns the accepted draws with their weights: those of the first model, each with the weight 1, or of all models.
    fn accepted(&self, all: bool) -> impl Iterator<Item = (&DrawnRun, f64)> {
        let weighted = self.draws.all.iter().zip(self.drawn);
        weighted.filter_map(move |(draw, drawn)| match (all, draw.model) {
            (true, _) => Some((drawn.as_ref()?, draw.weight)),
            (false, 0) => Some((drawn.as_ref()?, 1.0)),
            (false, _) => None,
        })
    }

    /// Returns the values of a quantity by the model.
    fn modelled(&self, q: usize, all: bool) -> Vec<(f64, f64)> {
        let values = self
            .accepted(all)
            .map(|(drawn, weight)| (self.values(drawn.values)[q], weight));
        values.filter(|(value, _)| value.is_finite()).collect()
    }

    /// Returns the values of a quantity in new measurements.
    fn measured(&self, q: usize, all: bool) -> Vec<(f64, f64)> {
        let values = self.accepted(all).flat_map(|(drawn, weight)| {
            (0..ERRORS).map(move |error| (self.values(drawn.measured(error))[q], weight))
        });
        values.filter(|(value, _)| value.is_finite()).collect()
    }

    /// Returns the 90 % interval of a new measurement: of a channel as a mixture of laws, else of drawn errors.
    fn new_measurement(&self, q: usize, all: bool, law: statistics::ErrorLaw) -> Option<[f64; 2]> {
        let Some(channel) = Channel::ALL.get(q).map(|channel| channel.index()) else {
            return interval(&self.measured(q, all));
        };
        let component = |(drawn, weight): (&DrawnRun, f64)| {
            Some(Component {
                mean: drawn.values[channel],
                scale: Some(drawn.scales[channel]?),
                weight,
            })
        };
        let components: Option<Vec<Component>> = self.accepted(all).map(component).collect();
        let components = components.filter(|all| !all.is_empty())?;
        Some([0.05, 0.95].map(|p| quantile(&components, law, p)))
    }

    fn quantity(&self, q: usize, law: statistics::ErrorLaw) -> Option<PredictedQuantity> {
        let own = self.modelled(q, false);
        let all = self.modelled(q, true);
        Some(PredictedQuantity {
            name: QUANTITIES[q].name.to_owned(),
            unit: QUANTITIES[q].unit.to_owned(),
            mean: mean(&own)?,
            parameters: interval(&own)?,
            measurement: self.new_measurement(q, false, law),
            models_mean: mean(&all)?,
            models: interval(&all)?,
            models_measurement: self.new_measurement(q, true, law),
            corrected: None,
            corrected_measurement: None,
        })
    }

    fn statement(&self, statement: &Statement) -> StatementProbability {
        let modelled = |all: bool| {
            let holds = self.accepted(all).filter_map(|(drawn, weight)| {
                let holds = statement.holds(&self.values(drawn.values))?;
                Some((holds, weight))
            });
            probability(holds)
        };
        let measured = self.accepted(true).flat_map(|(drawn, weight)| {
            (0..ERRORS).filter_map(move |error| {
                let holds = statement.holds(&self.values(drawn.measured(error)))?;
                Some((holds, weight))
            })
        });
        StatementProbability {
            statement: statement.text.clone(),
            parameters: modelled(false),
            models: modelled(true),
            measurement: probability(measured),
        }
    }
}

/// Returns the slips at which wheels climb, by the values of all models.
fn climbs(simulated: &Simulated, draws: &Draws<'_>, drawn: &[Vec<Option<DrawnRun>>]) -> Vec<PredictedClimb> {
    let [slip_at, energy_at] =
        ["slip", "energy_j_m"].map(|name| position_of(name).expect("a quantity of the list"));
    let curves = slip_curves(&simulated.runs).into_iter();
    let predicted = curves.filter_map(|curve| {
        let planned = &simulated.runs[*curve.runs.first()?];
        let along_n = planned.weight_n * libm::sin(planned.slope_deg.to_radians());
        let radius_m = rig_radius_m(simulated, planned);
        let of_draw = |i: usize| {
            let points = curve.runs.iter().filter_map(|&run| {
                let drawn = drawn[run][i].as_ref()?;
                Some((simulated.runs[run].run.slip, drawn.values))
            });
            climb(&points.collect::<Vec<_>>(), along_n)
        };
        let found = draws.all.iter().enumerate();
        let found: Vec<_> = found
            .filter_map(|(i, draw)| Some((of_draw(i)?, draw.weight)))
            .collect();
        let climbing = || found.iter().filter(|(climb, _)| !climb.is_stuck);
        let values = |q: usize| -> Vec<(f64, f64)> {
            let value = |(climb, weight): &(crate::balance::Climb, f64)| {
                let planned = planned.at_slip(climb.slip);
                (
                    quantity_values(&planned, radius_m, climb.channels, false)[q],
                    *weight,
                )
            };
            climbing().map(value).collect()
        };
        let (slips, energies) = (values(slip_at), values(energy_at));
        Some(PredictedClimb {
            wheel: planned.run.wheel.clone(),
            wheel_load_n: planned.weight_n,
            slope_deg: planned.slope_deg,
            gravity_m_s2: planned.gravity_m_s2,
            probability: probability(found.iter().map(|(climb, weight)| (!climb.is_stuck, *weight)))?,
            slip: mean(&slips),
            slip_interval: interval(&slips),
            energy_j_m: mean(&energies),
            energy_interval: interval(&energies),
        })
    });
    predicted.collect()
}

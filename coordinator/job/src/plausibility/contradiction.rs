//! Contradictions in the balance of moments, and the one mistake of the table that resolves each.

use shared::experiment::Experiment;
use shared::limit::number;

use super::moment_balance::{Misfit, MomentBalance, Reading};

/// Factor by which the residual falls at least if swapped columns are swapped back.
const SWAPPED: f64 = 3.0;
/// The same if a diameter in place of the radius is halved. In correct tables it grows threefold.
const DIAMETER: f64 = 1.5;
/// The same if half a radius is doubled. A large torque of bearings looks similar, so that less than this is no evidence.
const HALF_RADIUS: f64 = 3.5;
/// The same if two wheels are exchanged back.
const EXCHANGED: f64 = 2.0;
/// The same if an offset of the pull is subtracted.
const OFFSET: f64 = 2.5;
/// Relative difference of radii that can be told apart.
const DISTINCT_RADII: f64 = 0.2;
/// Smallest offset that is asked about, in mean wheel loads: effects of the rig such as the friction of bearings are smaller.
const MIN_OFFSET: f64 = 0.15;
/// Largest offset that is tried, in mean wheel loads, and the step between two.
const OFFSETS: [f64; 2] = [0.8, 0.02];
/// Largest residual of a table whose only mistake is an offset `[rad]`.
const OFFSET_RESIDUAL_RAD: f64 = 0.05;
/// Share of the contact angle below which an offset is improbable beside a wrong radius.
const IMPROBABLE_SHARE: f64 = 0.1;
/// Factors of an offset's residual when it competes with mistakes that have no free number: usually, and with an improbable share.
const HANDICAP: [f64; 2] = [1.2, 3.0];

/// A mistake of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cause {
    /// Pull and torque stand in each other's columns.
    SwappedColumns,
    /// The radius of wheels must be multiplied by a factor: ½ where a diameter was typed.
    Radius { wheels: Vec<String>, factor: f64 },
    /// The runs of each of two wheels carry the name of the other.
    ExchangedWheels([String; 2]),
    /// The pull is too high by a constant, or the torque too low.
    ForceZero { pull_n: f64, torque_n_m: f64 },
}

/// A table whose torque, pull, load and sinkage contradict its radii, and fit them without one mistake.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contradiction {
    /// The mistake.
    pub(super) cause: Cause,
    runs: usize,
    stated_rad: f64,
    corrected_rad: f64,
}

struct Candidate {
    cause: Cause,
    corrected: Misfit,
    /// Factor by which the correction must reduce the residual.
    improvement: f64,
    /// Factor of the residual in the comparison with other candidates.
    handicap: f64,
}

impl Contradiction {
    /// Returns the contradiction in an experiment, with the mistake that explains it best; `None` where no mistake explains much.
    pub(super) fn find(experiment: &Experiment) -> Option<Self> {
        let balance = MomentBalance::new(experiment)?;
        let mut candidates = vec![swapped_columns(&balance)];
        candidates.extend(radii(&balance));
        candidates.extend(exchanged_wheels(&balance));
        candidates.extend(force_zero(&balance));
        let stated_rad = balance.stated().residual_rad;
        candidates.retain(|found| stated_rad >= found.improvement * found.corrected.residual_rad);
        let size = |found: &Candidate| found.handicap * found.corrected.residual_rad;
        let best = candidates
            .into_iter()
            .min_by(|a, b| size(a).total_cmp(&size(b)))?;
        Some(Contradiction {
            cause: best.cause,
            runs: balance.readings.len(),
            stated_rad,
            corrected_rad: best.corrected.residual_rad,
        })
    }

    /// Returns the beginning of the question; the condition under which the table fits must follow it.
    pub(super) fn words(&self) -> String {
        let rounded = |angle_rad: f64| number((1e3 * angle_rad).round() / 1e3);
        format!(
            "torque_n_m, drawbar_pull_n, wheel_load_n and sinkage_m of {} runs do not fit radius_m: by the balance of moments, the point where the soil's force meets the rim is off by {} rad (rms), and by {} rad if",
            self.runs,
            rounded(self.stated_rad),
            rounded(self.corrected_rad)
        )
    }
}

fn swapped_columns(balance: &MomentBalance) -> Candidate {
    let corrected = balance.corrected(|reading| Reading {
        pull_n: reading.torque_n_m,
        torque_n_m: reading.pull_n,
        ..reading
    });
    Candidate {
        cause: Cause::SwappedColumns,
        corrected,
        improvement: SWAPPED,
        handicap: 1.0,
    }
}

/// Returns the candidates with other radii: of all wheels together and, of several, of each alone.
fn radii(balance: &MomentBalance) -> Vec<Candidate> {
    let wheels = balance.wheels();
    let mut sets = vec![wheels.clone()];
    if wheels.len() > 1 {
        sets.extend(wheels.iter().map(|wheel| vec![*wheel]));
    }
    let mut candidates = Vec::new();
    for set in sets {
        for (factor, improvement) in [(0.5, DIAMETER), (2.0, HALF_RADIUS)] {
            let corrected = balance.corrected(|reading| match set.contains(&reading.wheel) {
                true => Reading {
                    radius_m: factor * reading.radius_m,
                    ..reading
                },
                false => reading,
            });
            candidates.push(Candidate {
                cause: Cause::Radius {
                    wheels: set.iter().map(|wheel| (*wheel).to_owned()).collect(),
                    factor,
                },
                corrected,
                improvement,
                handicap: 1.0,
            });
        }
    }
    candidates
}

/// Returns the candidates with two wheels exchanged, of each pair of wheels whose radii can be told apart.
fn exchanged_wheels(balance: &MomentBalance) -> Vec<Candidate> {
    let radius_m = |wheel: &str| {
        balance
            .readings
            .iter()
            .find(|r| r.wheel == wheel)
            .map(|r| r.radius_m)
    };
    let wheels: Vec<(&str, f64)> = balance
        .wheels()
        .into_iter()
        .filter_map(|wheel| Some((wheel, radius_m(wheel)?)))
        .collect();
    let mut candidates = Vec::new();
    for (place, &(first, first_m)) in wheels.iter().enumerate() {
        for &(second, second_m) in &wheels[place + 1..] {
            if first_m.max(second_m) < (1.0 + DISTINCT_RADII) * first_m.min(second_m) {
                continue;
            }
            let corrected = balance.corrected(|reading| {
                let radius_m = match reading.wheel {
                    wheel if wheel == first => second_m,
                    wheel if wheel == second => first_m,
                    _ => reading.radius_m,
                };
                Reading { radius_m, ..reading }
            });
            candidates.push(Candidate {
                cause: Cause::ExchangedWheels([first.to_owned(), second.to_owned()]),
                corrected,
                improvement: EXCHANGED,
                handicap: 1.0,
            });
        }
    }
    candidates
}

/// Returns the candidate with the offset of the pull that fits best; `None` if this is small, or does not fit well.
fn force_zero(balance: &MomentBalance) -> Option<Candidate> {
    let load_n = balance.mean(|reading| reading.load_n);
    let [largest, step] = OFFSETS;
    let count = (largest / step).round() as i32;
    let offsets = (-count..=count).map(|i| f64::from(i) * step);
    let fits = offsets.map(|offset| {
        let corrected = balance.corrected(|reading| Reading {
            pull_n: reading.pull_n - offset * load_n,
            ..reading
        });
        (offset, corrected)
    });
    let (offset, corrected) = fits.min_by(|a, b| a.1.residual_rad.total_cmp(&b.1.residual_rad))?;
    if offset.abs() < MIN_OFFSET || corrected.residual_rad > OFFSET_RESIDUAL_RAD {
        return None;
    }
    let [usual, improbable] = HANDICAP;
    Some(Candidate {
        cause: Cause::ForceZero {
            pull_n: offset * load_n,
            torque_n_m: offset * load_n * balance.mean(|reading| reading.radius_m),
        },
        corrected,
        improvement: OFFSET,
        handicap: match corrected.share < IMPROBABLE_SHARE {
            true => improbable,
            false => usual,
        },
    })
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;

    /// Returns an experiment with a small and a large wheel, in which the soil's force acts at half the contact angle.
    fn experiment(radii_m: [f64; 2], row: impl Fn(Row) -> Row) -> Experiment {
        let mut runs =
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m,use\n"
                .to_owned();
        for (wheel, radius_m) in [("small", 0.1), ("large", 0.16)] {
            for (place, load_n) in [60.0, 60.0, 120.0, 120.0, 120.0].into_iter().enumerate() {
                let (shear, sinkage_m) = (0.2 + 0.06 * place as f64, 1e-4 * load_n + 1e-3 * place as f64);
                let angle = 0.5 * libm::acos(1.0 - sinkage_m / radius_m);
                // On the rim at this angle: tangential and normal force of the soil, which carry the load.
                let tangential_n = shear * load_n;
                let normal_n = (load_n - tangential_n * libm::sin(angle)) / libm::cos(angle);
                let pull_n = tangential_n * libm::cos(angle) - normal_n * libm::sin(angle);
                let [pull_n, torque_n_m, sinkage_m] = row([pull_n, tangential_n * radius_m, sinkage_m]);
                runs += &format!(
                    "{wheel}{place},{wheel},s,{},{load_n},0.01,{pull_n},{torque_n_m},{sinkage_m},fit\n",
                    0.1 + 0.1 * place as f64
                );
            }
        }
        let toml = format!(
            "runs = \"runs.csv\"\n[wheel.small]\nradius_m = {}\nwidth_m = 0.1\n[wheel.large]\nradius_m = {}\nwidth_m = 0.1\n\
             [soil.s]\n[noise]\ndrawbar_pull_n = 1.0\ntorque_n_m = 0.1\nsinkage_m = 0.001\n",
            radii_m[0], radii_m[1]
        );
        let files = [("runs.csv".to_owned(), runs)].into();
        Experiment::parse("experiment.toml", &FileSet { toml, files }).unwrap()
    }

    /// Pull, torque and sinkage.
    type Row = [f64; 3];

    fn cause(experiment: &Experiment) -> Option<Cause> {
        Contradiction::find(experiment).map(|found| found.cause)
    }

    fn radius(wheels: &[&str], factor: f64) -> Option<Cause> {
        let wheels = wheels.iter().map(|wheel| (*wheel).to_owned()).collect();
        Some(Cause::Radius { wheels, factor })
    }

    #[test]
    fn each_mistake_is_told_from_the_others() {
        let right = |row: Row| row;
        assert_eq!(cause(&experiment([0.1, 0.16], right)), None);
        let swapped = experiment([0.1, 0.16], |[pull, torque, sinkage]| [torque, pull, sinkage]);
        assert_eq!(cause(&swapped), Some(Cause::SwappedColumns));
        assert_eq!(
            cause(&experiment([0.2, 0.32], right)),
            radius(&["small", "large"], 0.5)
        );
        assert_eq!(cause(&experiment([0.2, 0.16], right)), radius(&["small"], 0.5));
        assert_eq!(
            cause(&experiment([0.05, 0.08], right)),
            radius(&["small", "large"], 2.0)
        );
        let exchanged = Cause::ExchangedWheels(["small".to_owned(), "large".to_owned()]);
        assert_eq!(cause(&experiment([0.16, 0.1], right)), Some(exchanged));
    }

    #[test]
    fn an_offset_of_the_pull_is_found_from_a_sixth_of_the_load_on() {
        let offset = |size_n: f64| {
            let table = experiment([0.1, 0.16], |[pull, torque, sinkage]| {
                [pull + size_n, torque, sinkage]
            });
            cause(&table).map(|found| match found {
                Cause::ForceZero { pull_n, .. } => pull_n.round(),
                other => panic!("{other:?}"),
            })
        };
        assert_eq!(offset(10.0), None);
        assert_eq!(offset(-10.0), None);
        // The mean load is 96 N, of which the offsets that are tried are even per cents.
        assert_eq!(offset(19.2), Some(19.0));
        assert_eq!(offset(-19.2), Some(-19.0));
    }

    #[test]
    fn a_radius_that_is_off_by_a_tenth_is_not_asked_about() {
        for factor in [0.9, 1.1] {
            assert_eq!(cause(&experiment([0.1 * factor, 0.16 * factor], |row| row)), None);
        }
    }
}

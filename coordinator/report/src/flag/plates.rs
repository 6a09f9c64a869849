//! Flags of a conflict between the soil parameters of the wheel and those of plate tests.

use std::collections::BTreeSet;

use inference::diagnostics::{self, SubsetShift, conflict, derivatives_from_draws, subset_shift};
use job::{FreeParameter, JointPrior, PLATE};
use statistics::{Marginal, Prior};

use result::finished_calibration::FinishedCalibration;
use result::flag::{Flag, FlagKind};
use result::words::data_channel::{BevameterTest, DataChannel};
use result::words::number;
use result::words::probability::{LEVEL, p_words};

/// The parameters that plates determine.
const OF_PLATES: [&str; 5] = ["log10_p_ref", "kappa", "n", "k_c", "k_phi"];
/// Number of standard deviations of the plates' estimate within which the prior must have probability.
const ALLOWED: f64 = 2.0;
/// Ratio of the readings' error with the plates' parameters to the error with common parameters at and above which no flag is raised.
const MUCH: f64 = 0.8;

/// Returns at most one flag for each source of plate tests: another calibration's posterior, and the readings of this experiment.
pub(crate) fn plates_conflict(calibration: &FinishedCalibration) -> Vec<Flag> {
    let has_wheel = !calibration.spec.fit_runs.is_empty();
    let of_prior = has_wheel.then(|| against_posterior(calibration)).flatten();
    let of_readings = has_wheel.then(|| against_readings(calibration)).flatten();
    of_prior.into_iter().chain(of_readings).collect()
}

/// Returns the positions in the parameter vector of the parameters that plates determine.
fn soil_parameters(calibration: &FinishedCalibration) -> Vec<usize> {
    let parameters = calibration.spec.parameters.iter().enumerate();
    let of_plates = parameters.filter(|(_, p)| OF_PLATES.contains(&p.name.as_str()));
    of_plates.map(|(i, _)| i).collect()
}

/// Compares the wheel with a prior that is the posterior of plates. The whole prior is compared even if the model rejects much of it,
/// because what the plates say does not depend on the limits of the model.
fn against_posterior(calibration: &FinishedCalibration) -> Option<Flag> {
    let spec = &calibration.spec;
    let joint = spec.joint_prior.as_ref().filter(|joint| joint.of_plates)?;
    let is_joint = |i: &usize| joint.parameters.contains(&spec.parameters[*i].name);
    let places: Vec<usize> = soil_parameters(calibration)
        .into_iter()
        .filter(is_joint)
        .collect();
    let prior = marginal_prior(calibration, joint, &places)?;
    let draws: Vec<Vec<f64>> = calibration
        .posterior()
        .iter()
        .map(|sample| places.iter().map(|&i| sample.theta[i]).collect())
        .collect();
    let draws: Vec<&[f64]> = draws.iter().map(Vec::as_slice).collect();
    let found = conflict(&prior, &draws)?;
    let tests = 1 + found.parameters.iter().flatten().count();
    let min = found
        .parameters
        .iter()
        .flatten()
        .copied()
        .chain(found.p)
        .reduce(f64::min)?;
    let p = (min * tests as f64).min(1.0);
    if p >= LEVEL {
        return None;
    }
    let compared = places.iter().enumerate().filter_map(|(k, &i)| {
        let free = &spec.parameters[i];
        let (mean, sd) = diagnostics::mean_and_sd(&calibration.draws(i))?;
        found.parameters[k].filter(|p| *p * (tests as f64) < LEVEL)?;
        Some(format!(
            "{} {} where they say {}",
            free.name,
            number::with_spread(mean, sd),
            number::with_spread(free.marginal.mean(), free.marginal.sd())
        ))
    });
    let compared: Vec<String> = compared.collect();
    let what = match compared.is_empty() {
        true => format!(
            "{} together",
            number::list(
                &places
                    .iter()
                    .map(|&i| spec.parameters[i].name.clone())
                    .collect::<Vec<_>>()
            )
        ),
        false => number::list(&compared),
    };
    let refused = calibration
        .prior_draws()
        .iter()
        .filter(|draw| draw.result.is_err())
        .count();
    let limits = match refused {
        0 => String::new(),
        refused => format!(
            "; the model refuses {refused} of {} of the prior, and cannot go where it refuses",
            number::count(calibration.prior_draws().len(), "draw")
        ),
    };
    // Where the model rejects, the measurements of the wheel have no influence.
    let (who, why) = match 2 * refused > calibration.prior_draws().len() {
        true => (
            "the posterior of the wheel lies far from that",
            "the model's limits may be the cause; else an effect is missing, or a wheel is no plate and transfer is too small",
        ),
        false => (
            "the wheel contradicts the posterior",
            "an effect is missing, or a wheel is no plate and transfer is too small",
        ),
    };
    let text = format!(
        "{who} of the plates in {} ({} among {}): {what}, their covariance times {}{limits}: {why}",
        joint.stated.file,
        p_words(p),
        number::count(tests, "test"),
        joint.stated.transfer
    );
    Some(Flag {
        p: Some(p),
        ..Flag::plain(FlagKind::PlatesConflict, text)
    })
}

/// Returns the prior of a subset of the jointly normal parameters.
fn marginal_prior(calibration: &FinishedCalibration, joint: &JointPrior, places: &[usize]) -> Option<Prior> {
    let parameters = &calibration.spec.parameters;
    let marginals = places.iter().map(|&i| parameters[i].marginal.clone()).collect();
    let position = |i: &usize| {
        joint
            .parameters
            .iter()
            .position(|name| *name == parameters[*i].name)
    };
    let positions: Vec<usize> = places.iter().map(position).collect::<Option<_>>()?;
    let row = |&a: &usize| positions.iter().map(|&b| joint.correlations[a][b]).collect();
    let correlations: Vec<Vec<f64>> = positions.iter().map(row).collect();
    let all = (0..places.len()).collect();
    (!places.is_empty())
        .then(|| Prior::new(marginals).correlated(all, &correlations).ok())
        .flatten()
}

/// Compares two misfits of the plates' readings, if wheel and plates are fitted together: that of the common parameters, and that of the
/// parameters that fit the plates only.
fn against_readings(calibration: &FinishedCalibration) -> Option<Flag> {
    let spec = &calibration.spec;
    let data = spec.likelihood.data();
    let readings: Vec<usize> = (0..data.len()).filter(|&i| data[i].channel == PLATE).collect();
    let places = soil_parameters(calibration);
    if readings.is_empty() || places.is_empty() {
        return None;
    }
    let accepted = calibration.predictive_draws().iter().filter_map(|draw| {
        let values = spec.predicted_values(draw.fit.as_ref().ok()?);
        let predicted: Vec<f64> = readings.iter().map(|&i| values[i]).collect();
        let parameters: Vec<f64> = places.iter().map(|&i| draw.theta[i]).collect();
        Some((parameters, predicted))
    });
    let (parameters, predicted): (Vec<Vec<f64>>, Vec<Vec<f64>>) = accepted.unzip();
    let derivatives = derivatives_from_draws(&parameters, &predicted)?;
    let residual = |(k, &i): (usize, &usize)| {
        let mean = predicted.iter().map(|values| values[k]).sum::<f64>() / predicted.len() as f64;
        data[i].value - mean
    };
    let residuals: Vec<f64> = readings.iter().enumerate().map(residual).collect();
    let plates = &spec.bevameter.plates;
    let tests: BTreeSet<&str> = plates.iter().map(|reading| reading.test.as_str()).collect();
    let group = |test: &str| tests.iter().position(|other| *other == test);
    let groups = plates.iter().map(|reading| group(&reading.test));
    let groups: Vec<usize> = groups.collect::<Option<_>>()?;
    let found = subset_shift(&derivatives, &residuals, &groups)?;
    let free: Vec<&FreeParameter> = places.iter().map(|&i| &spec.parameters[i]).collect();
    let mean = |k: usize| parameters.iter().map(|draw| draw[k]).sum::<f64>() / parameters.len() as f64;
    let from: Vec<f64> = (0..free.len()).map(mean).collect();
    readings_flag(&found, &free, &from, tests.len())
}

/// Returns whether a prior excludes a value and everything within [`ALLOWED`] standard deviations of it.
fn excludes(prior: &Marginal, value: f64, sd: f64) -> bool {
    let ends = [value - ALLOWED * sd, value + ALLOWED * sd].map(|end| prior.cumulative(end));
    let tail = 0.5 * LEVEL;
    ends[1] < tail || ends[0] > 1.0 - tail
}

/// Words the flag of the readings; `None` if no parameter is pulled significantly.
///
/// # Arguments
/// - `from`: the values that fit all data.
fn readings_flag(found: &SubsetShift, free: &[&FreeParameter], from: &[f64], tests: usize) -> Option<Flag> {
    let count = found.p.len();
    let p = found.p.iter().copied().reduce(f64::min)? * count as f64;
    if p >= LEVEL || found.rms_after > MUCH * found.rms_before {
        return None;
    }
    let is_pulled = |k: &usize| found.p[*k] * (count as f64) < LEVEL;
    let pulled = (0..count).filter(is_pulled).map(|k| {
        let sds = number::significant((found.shift[k] / found.sd[k]).abs(), 2);
        format!("{} by {sds} of their standard deviations", free[k].name)
    });
    // The prior is the cause if it excludes the plates' estimate. The shift is a linear extrapolation and its end is inaccurate, so the
    // prior alone is blamed only if it excludes even half of the shift.
    let excluded = |share: f64| -> Vec<String> {
        let is_excluded =
            |&k: &usize| excludes(&free[k].marginal, from[k] + share * found.shift[k], found.sd[k]);
        let names = (0..count)
            .filter(is_pulled)
            .filter(is_excluded)
            .map(|k| free[k].name.clone());
        names.collect()
    };
    let (half, whole) = (number::list(&excluded(0.5)), number::list(&excluded(1.0)));
    let (who, why) = match (half.is_empty(), whole.is_empty()) {
        (false, _) => (
            "the prior contradicts the plates",
            format!(
                "the prior of {half} excludes even half of that; widen it, and whether the wheel contradicts the plates will be seen"
            ),
        ),
        (true, false) => (
            "the wheel or the prior contradicts the plates",
            format!(
                "the prior of {whole} excludes what they ask for, and may be too tight; else an effect is missing, or a wheel is no plate"
            ),
        ),
        (true, true) => (
            "the wheel contradicts the plates",
            "an effect is missing, or a wheel is no plate".to_owned(),
        ),
    };
    let text = format!(
        "{who} ({} among {}): fitted together, the readings of {} of plates are missed by {:.0} % (root mean square), and by {:.0} % with the soil that the plates alone ask for, which differs in {}: {why}",
        p_words(p),
        number::count(count, "test"),
        number::count(tests, "test"),
        100.0 * found.rms_before,
        100.0 * found.rms_after,
        number::list(&pulled.collect::<Vec<_>>())
    );
    Some(Flag {
        channel: Some(DataChannel::Bevameter(BevameterTest::Plates)),
        p: Some(p),
        ..Flag::plain(FlagKind::PlatesConflict, text)
    })
}

#[cfg(test)]
mod tests {
    use record::{PriorDraw, RejectionReason};
    use shared::file::FileSet;
    use statistics::rng::Stream;

    use super::*;
    use crate::fixture;

    const JOB: &str = "[model]\nkind = \"quasi_static\"\n[priors]\nSOIL\nfriction_angle_deg = { normal = [31.0, 4.0] }\n[sampler]\nparticles = 40\n";
    const FREE: &str = "log10_p_ref = { normal = [3.9, 0.3] }\nkappa = { uniform = [-0.95, 0.5] }\nn = { normal = [1.2, 0.3], bounds = [0.8, 2.0] }";
    const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.sand]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const RUNS: &str =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\nr,a,sand,0.2,25,0.01,0.5,fit\n";
    /// The soil that the plates were pressed into: `log10_p_ref`, `kappa`, `n`.
    const TRUTH: [f64; 3] = [3.9, -0.6, 1.2];

    /// Returns the pressure under a plate, ln Pa.
    fn bekker([p_ref, kappa, n]: [f64; 3], radius_m: f64, sinkage_m: f64) -> f64 {
        let stiffness = (1.0 + kappa * 0.03 / radius_m) / (1.0 + kappa);
        p_ref * std::f64::consts::LN_10 + stiffness.ln() + n * (sinkage_m / 0.01).ln()
    }

    /// Returns test, radius and sinkage of each reading: six tests of each of three radii.
    fn readings() -> Vec<(String, f64, f64)> {
        let tests = (0..18).map(|test| (format!("t{test}"), 0.03 + 0.01 * f64::from(test % 3)));
        tests
            .flat_map(|(test, radius)| (1..6).map(move |k| (test.clone(), radius, 0.003 * f64::from(k))))
            .collect()
    }

    fn normals(stream: &mut Stream, sds: [f64; 3]) -> [f64; 3] {
        sds.map(|sd| sd * stream.normal_pair().0)
    }

    /// Returns draws about a point.
    fn about(centre: [f64; 3], sds: [f64; 3], count: usize) -> Vec<[f64; 3]> {
        let mut stream = Stream::new(5, 0, 0, 0);
        let draw = |_| {
            let off = normals(&mut stream, sds);
            [0, 1, 2].map(|i| centre[i] + off[i])
        };
        (0..count).map(draw).collect()
    }

    /// Puts the soil of a calibration's draws about a point.
    fn with_soil(
        mut calibration: FinishedCalibration,
        centre: [f64; 3],
        sds: [f64; 3],
    ) -> FinishedCalibration {
        let names = ["log10_p_ref", "kappa", "n"];
        let parameters = &calibration.spec.parameters;
        let places = names.map(|name| parameters.iter().position(|p| p.name == name).unwrap());
        let draws = about(centre, sds, calibration.posterior().len());
        let set = |theta: &mut Vec<f64>, draw: &[f64; 3]| {
            for (&place, value) in places.iter().zip(draw) {
                theta[place] = *value;
            }
        };
        for (sample, draw) in fixture::sampled(&mut calibration).draws.iter_mut().zip(&draws) {
            set(&mut sample.theta, draw);
        }
        for (prediction, draw) in calibration.predictions.iter_mut().zip(&draws) {
            set(&mut prediction.theta, draw);
            if let Ok(observables) = &mut prediction.fit {
                let readings = readings();
                let pressures = readings
                    .iter()
                    .map(|(_, radius, z)| bekker(*draw, *radius, *z).exp());
                observables.plate_pressure_pa = pressures.take(observables.plate_pressure_pa.len()).collect();
            }
        }
        calibration
    }

    /// Returns the flags where wheel and plates are fitted together and the draws lie about a point.
    fn together(centre: [f64; 3]) -> Vec<Flag> {
        together_under(FREE, centre)
    }

    /// Returns the same flags with the given priors in the job.
    fn together_under(priors: &str, centre: [f64; 3]) -> Vec<Flag> {
        let mut stream = Stream::new(7, 0, 0, 0);
        let mut plates = "test,plate_radius_m,sinkage_m,pressure_pa\n".to_owned();
        let mut common = 0.0;
        for (k, (test, radius, z)) in readings().into_iter().enumerate() {
            if k % 5 == 0 {
                common = 0.1 * stream.normal_pair().0;
            }
            let pressure = (bekker(TRUTH, radius, z) + common + 0.05 * stream.normal_pair().0).exp();
            plates += &format!("{test},{radius},{z},{pressure}\n");
        }
        let experiment = FileSet {
            toml: format!("plates = \"plates.csv\"\n{EXPERIMENT}plate_scatter = 0.1\nplate_noise = 0.05\n"),
            files: [("runs.csv".into(), RUNS.into()), ("plates.csv".into(), plates)].into(),
        };
        let job = FileSet {
            toml: JOB.replace("SOIL", priors),
            files: Default::default(),
        };
        let calibration = with_soil(fixture::of_files(job, &experiment), centre, [0.01, 0.02, 0.02]);
        plates_conflict(&calibration)
    }

    #[test]
    fn plates_that_the_wheel_pulls_away_from_are_flagged_and_others_are_not() {
        assert_eq!(together(TRUTH), []);
        // This point lies within the uncertainty of the plates.
        assert_eq!(together([3.92, -0.57, 1.21]), []);
        let flags = together([3.9, 0.0, 1.2]);
        assert_eq!(flags.len(), 1);
        assert_eq!(
            (flags[0].kind, flags[0].channel.map(DataChannel::name)),
            (FlagKind::PlatesConflict, Some("plates"))
        );
        for words in [
            "the readings of 18 tests of plates are missed by ",
            "which differs in kappa by ",
        ] {
            assert!(flags[0].text.contains(words), "{words} in {}", flags[0].text);
        }
    }

    #[test]
    fn where_the_prior_excludes_what_plates_ask_for_it_is_named_and_not_the_wheel() {
        let tight = FREE.replace("{ uniform = [-0.95, 0.5] }", "{ normal = [0.0, 0.02] }");
        let flags = together_under(&tight, [3.9, 0.0, 1.2]);
        assert_eq!(flags.len(), 1);
        for words in [
            "the prior contradicts the plates (p ",
            "which differs in kappa by ",
            ": the prior of kappa excludes even half of that; widen it, ",
        ] {
            assert!(flags[0].text.contains(words), "{words} in {}", flags[0].text);
        }
        let wider = FREE.replace("{ uniform = [-0.95, 0.5] }", "{ normal = [0.0, 0.25] }");
        let flags = together_under(&wider, [3.9, 0.0, 1.2]);
        let begins = "the wheel or the prior contradicts the plates (p ";
        assert!(flags[0].text.starts_with(begins), "{}", flags[0].text);
    }

    /// Returns the flags where the posterior of plates is the prior of a wheel, whose own posterior lies about a point.
    fn after_plates(centre: [f64; 3], sds: [f64; 3], header: &str, refused: usize) -> Vec<Flag> {
        let mut text = format!("{header}\n");
        let noises = ",0.1".repeat(header.split(',').count() - 3);
        for [p_ref, kappa, n] in about(TRUTH, [0.03, 0.03, 0.05], 200) {
            text += &format!("{p_ref},{kappa},{n}{noises}\n");
        }
        let job = FileSet {
            toml: JOB.replace("SOIL", "posterior = \"plates-posterior.csv\"\ntransfer = 4.0"),
            files: [("plates-posterior.csv".into(), text)].into(),
        };
        let experiment = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".into(), RUNS.into())].into(),
        };
        let mut calibration = with_soil(fixture::of_files(job, &experiment), centre, sds);
        let refuse = |draw: &mut PriorDraw| {
            draw.result = Err(RejectionReason("no_convergence: condition 0: x".into()))
        };
        let prior_draws = &mut fixture::sampled(&mut calibration).prior_draws;
        prior_draws.iter_mut().take(refused).for_each(refuse);
        plates_conflict(&calibration)
    }

    const OF_PLATES: &str = "log10_p_ref,kappa,n,noise.plate_scatter";

    #[test]
    fn a_wheel_far_from_the_posterior_of_plates_is_flagged_however_much_of_it_is_refused() {
        assert_eq!(after_plates(TRUTH, [0.03, 0.03, 0.05], OF_PLATES, 30), []);
        assert_eq!(
            after_plates([3.95, -0.55, 1.25], [0.03, 0.03, 0.05], OF_PLATES, 30),
            []
        );
        let flags = after_plates([3.9, 0.02, 1.2], [0.03, 0.02, 0.05], OF_PLATES, 30);
        assert_eq!(
            flags.iter().map(|f| f.kind).collect::<Vec<_>>(),
            [FlagKind::PlatesConflict]
        );
        for words in [
            "the posterior of the wheel lies far from that of the plates in plates-posterior.csv (p < ",
            "): kappa 0.0",
            " where they say -0.5",
            "times 4; the model refuses 31 of 40 draws of the prior",
            ": the model's limits may be the cause; ",
        ] {
            assert!(
                flags[0].text.replace('\u{2212}', "-").contains(words),
                "{words} in {}",
                flags[0].text
            );
        }
        let flags = after_plates([3.9, 0.02, 1.2], [0.03, 0.02, 0.05], OF_PLATES, 3);
        assert!(
            flags[0].text.starts_with(
                "the wheel contradicts the posterior of the plates in plates-posterior.csv (p < "
            )
        );
        let of_wheels = OF_PLATES.replace("noise.plate_scatter", "noise.torque_n_m");
        let of_both = format!("{OF_PLATES},noise.torque_n_m");
        for (header, of) in [(of_wheels, "a wheel"), (of_both, "plates and a wheel")] {
            let flags = after_plates([3.9, 0.02, 1.2], [0.03, 0.02, 0.05], &header, 30);
            assert_eq!(flags, [], "a posterior of {of}");
        }
    }
}

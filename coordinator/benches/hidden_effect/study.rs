//! Hide an effect in an experiment, measure with noise, search.

use inference::discovery::{Engine, Finding, Settings};
use inference::rng::Stream;
use inference::{Datum, Likelihood, Sd};
use shared::file::FileSet;

use crate::models::Models;

/// Streams of this study, far from those of any sampler.
const STAGE: u64 = 1 << 41;
/// Vectors of the prior that the model may refuse in a row.
const MOST_REFUSED: u64 = 1000;
/// Noise of a channel, as a share of the root mean square of its noise-free values over the design.
pub(crate) const NOISE: f64 = 0.03;

pub(crate) const SLIPS: [f64; 6] = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6];
pub(crate) const LOADS_N: [f64; 2] = [60.0, 120.0];
/// Speeds of the rim.
pub(crate) const SPEEDS_M_S: [f64; 2] = [0.01, 0.05];

/// What is known of the base before the measurements; truths are drawn from it.
pub(crate) const JOB: &str = "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = { uniform = [4.0, 5.6] }\nkappa = { normal = [0.0, 0.3], bounds = [-0.8, 2.0] }\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\nfriction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 37.3] }\nwheel_radius_m = { uniform = [0.125, 0.155] }\n";

/// The experiment, its channels to be measured.
pub(crate) fn experiment() -> FileSet {
    let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\ngrouser_count = 12\ngrouser_height_m = 0.009\ngrouser_thickness_m = 0.002\n[soil.s]\ndensity_kg_m3 = 1400.0\n[rig]\nbin_length_m = 1.5\n[noise]\ndrawbar_pull_n = 1.2\ntorque_n_m = 0.15\nsinkage_m = 0.0004\n";
    let mut runs =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m\n".to_owned();
    for slip in SLIPS {
        for load in LOADS_N {
            for speed in SPEEDS_M_S {
                let sled = speed * (1.0 - slip);
                runs += &format!("s{slip}w{load}v{speed},w,s,{slip},{load},{sled},0,0,0\n");
            }
        }
    }
    FileSet {
        toml: toml.into(),
        files: [("runs.csv".to_owned(), runs)].into(),
    }
}

/// An experiment whose truth is known.
pub(crate) struct Case {
    pub(crate) hidden: Option<usize>,
    pub(crate) truth: Vec<f64>,
    /// With noise, and without.
    pub(crate) measured: Likelihood,
    pub(crate) noise_free: Likelihood,
}

impl Case {
    /// The log-likelihood of the truth.
    pub(crate) fn perfect(&self) -> f64 {
        let values: Vec<f64> = self.noise_free.data().iter().map(|d| d.value).collect();
        let scored = self.measured.log_likelihood(&values, &[]);
        scored.map_or(f64::NAN, |l| l.value())
    }
}

/// Draws a truth from the priors of a model and measures it.
pub(crate) fn draw(models: &Models, hidden: Option<usize>, seed: u64, number: u64) -> Result<Case, String> {
    let model = models.model(hidden);
    for refused in 0..MOST_REFUSED {
        let truth = model
            .spec
            .prior()
            .sample(&mut Stream::new(seed, STAGE, number, refused));
        let Some(values) = model.values(&truth) else {
            continue;
        };
        let skeleton = models.base.spec.likelihood.data();
        let sd = |channel: usize| {
            let squares: Vec<f64> = skeleton
                .iter()
                .zip(&values)
                .filter(|(d, _)| d.channel == channel)
                .map(|(_, v)| v * v)
                .collect();
            NOISE * (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
        };
        let noise = Stream::new(seed, STAGE + 1, number, 0).normals(values.len());
        let with = |factor: f64| {
            let data = skeleton.iter().zip(values.iter().zip(&noise)).map(|(d, (v, e))| {
                let sd = sd(d.channel);
                Datum {
                    value: v + factor * sd * e,
                    sd: Sd::Known(sd),
                    ..*d
                }
            });
            Likelihood::new(data.collect()).map_err(|e| e.to_string())
        };
        return Ok(Case {
            hidden,
            measured: with(1.0)?,
            noise_free: with(0.0)?,
            truth,
        });
    }
    Err(format!(
        "the model refused {MOST_REFUSED} draws of the prior in a row"
    ))
}

/// Searches for the missing effect.
pub(crate) fn search(models: &Models, likelihood: &Likelihood) -> Result<Finding, String> {
    let mut engine = Engine::new(
        &models.prior(),
        likelihood.clone(),
        models.candidates.clone(),
        &Settings::default(),
    )
    .map_err(|e| e.to_string())?;
    loop {
        if let Some(finding) = engine.finding() {
            return Ok(finding.clone());
        }
        let pending: Vec<_> = engine.pending().collect();
        if pending.is_empty() {
            return Err("the search asks for nothing and has found nothing".into());
        }
        for (index, request) in pending.iter().enumerate() {
            let values = models.model(request.candidate).values(&request.theta);
            engine.tell(index, values.as_deref()).map_err(|e| e.to_string())?;
        }
    }
}

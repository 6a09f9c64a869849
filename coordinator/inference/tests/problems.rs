//! Problems with known evidence and moments, for tests and bench.

use inference::evolution::{Evolution, EvolutionSettings};
use inference::{Sampler, TellProgress, TmcmcSettings};
use statistics::{Distribution, LogLikelihood, Marginal, Prior};

/// A function of the parameters, its posterior mean and sd.
pub(crate) type Derived = (fn(&[f64]) -> f64, f64, f64);

/// A problem with a known answer.
pub(crate) struct Problem {
    /// Short name.
    pub(crate) name: &'static str,
    prior: Vec<Distribution>,
    log_likelihood: fn(&[f64]) -> f64,
    /// ln Z.
    pub(crate) log_evidence: f64,
    /// Highest ln p(data | theta) + ln p(theta).
    pub(crate) optimum: f64,
    /// Posterior means.
    pub(crate) mean: Vec<f64>,
    /// Posterior standard deviations.
    pub(crate) sd: Vec<f64>,
    /// A derived quantity that is sharper than the parameters, and its mean and sd.
    pub(crate) derived: Option<Derived>,
}

impl Problem {
    /// Returns the prior.
    pub(crate) fn prior(&self) -> Prior {
        Prior::new(
            self.prior
                .iter()
                .map(|&distribution| Marginal::new(distribution, None).unwrap())
                .collect(),
        )
    }

    /// Returns the log-likelihood of a parameter vector.
    pub(crate) fn score(&self, theta: &[f64]) -> LogLikelihood {
        LogLikelihood::new((self.log_likelihood)(theta)).unwrap()
    }

    /// Runs an evolution to its end.
    pub(crate) fn evolve(&self, settings: EvolutionSettings) -> Evolution {
        let mut evolution = Evolution::new(self.prior(), settings).unwrap();
        while !evolution.round().pending().is_empty() {
            for proposal in evolution.round().pending().to_vec() {
                let value = self.score(&proposal.theta);
                evolution.tell(proposal.particle, value).unwrap();
            }
        }
        evolution
    }

    /// Runs a sampler to its end.
    pub(crate) fn run(&self, settings: TmcmcSettings) -> Sampler {
        let mut sampler = Sampler::new(self.prior(), settings).unwrap();
        loop {
            let mut last = TellProgress::Waiting;
            for proposal in sampler.round().pending().to_vec() {
                last = sampler
                    .tell(proposal.particle, self.score(&proposal.theta))
                    .unwrap();
            }
            match last {
                TellProgress::NextRound | TellProgress::StageFinished => (),
                TellProgress::Waiting | TellProgress::Finished | TellProgress::Failed(_) => return sampler,
            }
        }
    }
}

fn uniform(lower: f64, upper: f64) -> Distribution {
    Distribution::Uniform { lower, upper }
}

fn log_normal_density(x: f64, mean: f64, sd: f64) -> f64 {
    let z = (x - mean) / sd;
    -0.5 * z * z - libm::log(sd) - 0.5 * libm::log(std::f64::consts::TAU)
}

const GAUSSIAN_MEAN: [f64; 5] = [1.0, -2.0, 0.5, 3.0, 0.0];
const GAUSSIAN_SD: [f64; 5] = [0.05, 0.2, 0.5, 1.0, 0.1];

/// Returns the innovations of (a), each of unit variance.
pub(crate) fn whitened(x: &[f64]) -> Vec<f64> {
    let z: Vec<f64> = (0..5)
        .map(|i| (x[i] - GAUSSIAN_MEAN[i]) / GAUSSIAN_SD[i])
        .collect();
    let innovation = (1.0_f64 - 0.81).sqrt();
    let rest = (1..5).map(|i| (z[i] - 0.9 * z[i - 1]) / innovation);
    std::iter::once(z[0]).chain(rest).collect()
}

/// (a) Five-dimensional normal density with correlation 0.9^|i - j| in a wide box.
///
/// Standardised, the residuals form an AR(1) sequence, whose density is a product.
pub(crate) fn correlated_gaussian() -> Problem {
    fn log_likelihood(x: &[f64]) -> f64 {
        let innovation = (1.0_f64 - 0.81).sqrt();
        let density: f64 = whitened(x).iter().map(|&z| log_normal_density(z, 0.0, 1.0)).sum();
        density - 4.0 * libm::log(innovation) - GAUSSIAN_SD.iter().map(|&sd| libm::log(sd)).sum::<f64>()
    }
    Problem {
        name: "a",
        prior: vec![uniform(-10.0, 10.0); 5],
        log_likelihood,
        log_evidence: -14.978_661_37,
        optimum: -8.650_989_331_88,
        mean: GAUSSIAN_MEAN.to_vec(),
        sd: GAUSSIAN_SD.to_vec(),
        derived: None,
    }
}

/// Lognormal of given mode and standard deviation: mode = m exp(-s^2), sd^2 = m^2 exp(s^2) (exp(s^2) - 1).
fn lognormal_of_mode(mode: f64, sd: f64) -> Distribution {
    // With q = exp(s^2): q^3 (q - 1) = (sd / mode)^2, rising in q > 1.
    let target = (sd / mode) * (sd / mode);
    let (mut low, mut high) = (1.0_f64, 100.0_f64);
    for _ in 0..200 {
        let q = 0.5 * (low + high);
        if q * q * q * (q - 1.0) > target {
            high = q
        } else {
            low = q
        }
    }
    Distribution::Lognormal {
        median: mode * low,
        factor: libm::exp(libm::log(low).sqrt()),
    }
}

/// Relative errors of the squared frequencies of (b), in units of their sd of 1/16.
pub(crate) fn frequency_residuals(theta: &[f64]) -> Vec<f64> {
    let (m1, m2) = (16.5e3, 16.1e3);
    let (k1, k2) = (29.7e6 * theta[0], 29.7e6 * theta[1]);
    // det(K - w M) = 0: m1 m2 w^2 - ((k1 + k2) m2 + k2 m1) w + k1 k2 = 0.
    let half = 0.5 * ((k1 + k2) * m2 + k2 * m1);
    let root = (half * half - m1 * m2 * k1 * k2).max(0.0).sqrt();
    let w_high = (half + root) / (m1 * m2);
    let w_low = k1 * k2 / (half + root);
    let square = |w: f64, f: f64| w / (std::f64::consts::TAU * f) / (std::f64::consts::TAU * f) - 1.0;
    vec![16.0 * square(w_low, 3.13), 16.0 * square(w_high, 9.83)]
}

/// (b) Two-storey shear building, bimodal (Beck & Au 2002).
pub(crate) fn shear_building() -> Problem {
    fn log_likelihood(theta: &[f64]) -> f64 {
        let residuals = frequency_residuals(theta);
        -0.5 * residuals.iter().map(|r| r * r).sum::<f64>()
    }
    Problem {
        name: "b",
        prior: vec![lognormal_of_mode(1.3, 1.0), lognormal_of_mode(0.8, 1.0)],
        log_likelihood,
        log_evidence: -6.495_973_65,
        optimum: -2.951_742_892_39,
        mean: vec![1.116_995_03, 0.593_436_54],
        sd: vec![0.662_373_08, 0.329_946_52],
        derived: Some((
            |theta| f64::from(u8::from(theta[1] > 0.5 * theta[0])),
            0.530_793_07,
            0.499_050_7,
        )),
    }
}

/// (c2) A ridge 5e-6 as thick as long.
pub(crate) fn thin_ridge() -> Problem {
    fn sum(theta: &[f64]) -> f64 {
        theta[0] / 0.1 + theta[1]
    }
    Problem {
        name: "c2",
        prior: vec![uniform(-1e9, 1e9), uniform(1.0, 1e10)],
        log_likelihood: |theta| log_normal_density(sum(theta), 1e6, 5e4),
        log_evidence: -23.718_998_11,
        optimum: -56.180_980_764_96,
        mean: vec![-4.999e8, 5.0e9],
        sd: vec![2.886_751_35e8, 2.886_751_35e9],
        derived: Some((sum, 1e6, 5e4)),
    }
}

pub(crate) const SINKAGE: [f64; 12] = [
    0.01,
    0.014_545_454_5,
    0.019_090_909_1,
    0.023_636_363_6,
    0.028_181_818_2,
    0.032_727_272_7,
    0.037_272_727_3,
    0.041_818_181_8,
    0.046_363_636_4,
    0.050_909_090_9,
    0.055_454_545_5,
    0.06,
];

pub(crate) const LOG_PRESSURE: [f64; 12] = [
    8.588_387_429_148,
    9.084_761_790_596,
    9.202_510_686_505,
    9.548_809_053_126,
    9.758_352_902_302,
    9.799_554_068_086,
    10.114_823_789_157,
    10.196_162_945_062,
    10.200_285_889_081,
    10.280_468_093_119,
    10.501_302_832_696,
    10.504_561_608_791,
];

/// Plate pressures with log-normal scatter `tau`, given ln of the modulus sum.
fn plate(log_sum: f64, n: f64, tau: f64) -> f64 {
    SINKAGE
        .iter()
        .zip(&LOG_PRESSURE)
        .map(|(&z, &log_p)| log_normal_density(log_p, log_sum + n * libm::log(z), tau))
        .sum()
}

/// ln (`k_c` / b + `k_phi`), if there is support.
fn log_sum(theta: &[f64]) -> Option<f64> {
    let sum = theta[0] / 0.1 + theta[1];
    (sum > 0.0).then(|| libm::log(sum))
}

/// (c3) Bekker's moduli, literally, known noise; a quarter of the prior fails.
pub(crate) fn bekker_known_noise() -> Problem {
    Problem {
        name: "c3",
        prior: vec![uniform(-1e9, 1e9), uniform(1.0, 1e10), uniform(0.8, 2.0)],
        log_likelihood: |theta| log_sum(theta).map_or(f64::NEG_INFINITY, |sum| plate(sum, theta[2], 0.08)),
        log_evidence: 0.101_649_73,
        optimum: -29.092_426_450_53,
        mean: vec![-4.999_224_24e8, 5.0e9, 1.076_811_59],
        sd: vec![2.886_751_35e8, 2.886_751_35e9, 4.289_118_94e-2],
        derived: Some((
            |theta| log_sum(theta).unwrap_or(0.0),
            13.561_602_874,
            0.150_988_805,
        )),
    }
}

/// (c4) As c3 with unknown noise.
pub(crate) fn bekker_unknown_noise() -> Problem {
    Problem {
        name: "c4",
        prior: vec![
            uniform(-1e9, 1e9),
            uniform(1.0, 1e10),
            uniform(0.8, 2.0),
            uniform(-3.0, 0.5),
        ],
        log_likelihood: |theta| {
            log_sum(theta).map_or(f64::NEG_INFINITY, |sum| {
                plate(sum, theta[2], libm::exp10(theta[3]))
            })
        },
        log_evidence: -2.359_492_03,
        optimum: -29.774_760_971_69,
        mean: vec![-4.999_225_28e8, 5.0e9, 1.076_433_52, -1.136_401_32],
        sd: vec![2.886_751_35e8, 2.886_751_35e9, 4.174_204_58e-2, 1.024_649_18e-1],
        derived: Some((
            |theta| log_sum(theta).unwrap_or(0.0),
            13.560_255_975,
            0.146_956_366,
        )),
    }
}

/// (c5) The data of c4 in coordinates that suit them.
pub(crate) fn bekker_reparametrised() -> Problem {
    Problem {
        name: "c5",
        prior: vec![
            uniform(3.0, 9.0),
            uniform(0.0, 1.0),
            uniform(0.8, 2.0),
            uniform(-3.0, 0.5),
        ],
        log_likelihood: |theta| {
            let log_sum = theta[0] * std::f64::consts::LN_10 - theta[2] * libm::log(0.025);
            plate(log_sum, theta[2], libm::exp10(theta[3]))
        },
        log_evidence: 5.184_196_59,
        optimum: 12.875_743_569_94,
        mean: vec![4.164_964_28, 0.5, 1.070_415_76, -1.136_988_51],
        sd: vec![0.010_421_96, 0.288_675_13, 0.041_510_59, 0.102_145_33],
        derived: None,
    }
}

/// (d1) Two thin Gaussian shells (Feroz, Hobson & Bridges 2009).
pub(crate) fn shells() -> Problem {
    fn log_likelihood(x: &[f64]) -> f64 {
        let shell = |centre: f64| {
            let radius = ((x[0] - centre) * (x[0] - centre) + x[1] * x[1]).sqrt();
            log_normal_density(radius, 2.0, 0.1)
        };
        let (left, right) = (shell(-3.5), shell(3.5));
        let max = left.max(right);
        max + libm::log(libm::exp(left - max) + libm::exp(right - max))
    }
    Problem {
        name: "d1",
        prior: vec![uniform(-6.0, 6.0); 2],
        log_likelihood,
        log_evidence: -1.745_641_87,
        optimum: -3.586_166_739_79,
        mean: vec![0.0, 0.0],
        sd: vec![3.776_903_49, 1.419_506_96],
        derived: Some((|x| f64::from(u8::from(x[0] > 0.0)), 0.5, 0.5)),
    }
}

/// (d2) Eggbox: eighteen modes, ten of them at the border.
pub(crate) fn eggbox() -> Problem {
    const SIDE: f64 = 10.0 * std::f64::consts::PI;
    Problem {
        name: "d2",
        prior: vec![uniform(0.0, SIDE); 2],
        log_likelihood: |x| {
            let base = 2.0 + libm::cos(0.5 * x[0]) * libm::cos(0.5 * x[1]);
            base * base * base * base * base
        },
        log_evidence: 235.855_940_33,
        optimum: 236.105_370_042_31,
        mean: vec![15.707_963_27; 2],
        sd: vec![9.398_735_39; 2],
        derived: None,
    }
}

/// A skew target that no reflection leaves alone: a half-normal prior of scale 1 and ln L = -3 x, so that
/// Z = 2 exp(9/2) Q(3) and the posterior is a normal of mean -3 and sd 1, cut at 0.
pub(crate) fn skew() -> Problem {
    // Mills' ratio: hazard h = phi(3) / Q(3); mean = h - 3; variance = 1 - h (h - 3).
    let upper_tail = 0.5 * libm::erfc(3.0 * std::f64::consts::FRAC_1_SQRT_2);
    let hazard = libm::exp(log_normal_density(3.0, 0.0, 1.0)) / upper_tail;
    Problem {
        name: "skew",
        prior: vec![Distribution::HalfNormal { scale: 1.0 }],
        log_likelihood: |x| -3.0 * x[0],
        log_evidence: libm::log(2.0 * upper_tail) + 4.5,
        optimum: -0.225_791_352_64,
        mean: vec![hazard - 3.0],
        sd: vec![(1.0 - hazard * (hazard - 3.0)).sqrt()],
        derived: None,
    }
}

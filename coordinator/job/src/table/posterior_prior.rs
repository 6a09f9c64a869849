//! The posterior of another calibration as a prior: a joint normal distribution of parameters.

use std::collections::BTreeSet;

use inference::diagnostics::{linear_dependence, mean_and_sd};
use shared::channel::Channel;
use shared::experiment::Scatter;
use shared::file::{FileError, number, unknown_word};
use shared::model::ParameterScope;
use shared::parameters::{
    NOISE_PREFIX, RING_TRANSFER, TRANSIENT_ERRORS, WHEEL_RADIUS, bekker_moduli, noise_parameter,
    scatter_parameter,
};
use statistics::{Distribution, Marginal};

use super::error::TableError;
use super::prior_entry::FreeParameter;

/// Minimum number of draws per parameter of a covariance.
const DRAWS_PER_PARAMETER: usize = 10;
/// Relative standard deviation below which a column is constant.
const ROUNDING: f64 = 1e-12;
/// The parameter of an effect that also acts under rings.
const RING_MODULUS: &str = "janosi_hanamoto.shear_modulus_m";

/// `posterior`, `transfer` and `moduli` under `[priors]`, as written.
#[derive(Debug, Clone, PartialEq)]
pub struct PosteriorPrior {
    /// Name of the file, a posterior's table of draws.
    pub file: String,
    /// Factor of the covariance, ≥ 1: soil under plates is not quite the soil under wheels.
    pub transfer: f64,
    /// Whether draws of `log10_p_ref`, `kappa` and `n` are converted to `k_c`, `k_phi` and `n` first.
    pub literal: bool,
}

/// The parameters whose prior is another calibration's posterior.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPrior {
    /// The keys of the job that state it.
    pub stated: PosteriorPrior,
    /// Number of draws in the file.
    pub draws: usize,
    /// The correlated parameters: the first of the parameter vector, in this order.
    pub parameters: Vec<String>,
    /// Correlations of these parameters.
    pub correlations: Vec<Vec<f64>>,
    /// Columns of parameters that the job states itself, or that its model does not have.
    pub unused: Vec<String>,
    /// The Bekker moduli that the draws imply; `None` if the draws do not determine them.
    pub moduli: Option<ImpliedModuli>,
    /// Whether that calibration fitted plates alone: it inferred the scatter of plates, and no parameter that only wheels determine.
    pub of_plates: bool,
}

/// Bekker's moduli as the draws of a posterior imply them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpliedModuli {
    /// Mean and standard deviation of `k_c` `[N/m^(n+1)]`, n each draw's own.
    pub k_c: (f64, f64),
    /// Mean and standard deviation of `k_phi` `[N/m^(n+2)]`, n each draw's own.
    pub k_phi: (f64, f64),
    /// Correlation of the two moduli.
    pub correlation: f64,
    /// Share of the draws with `k_c < 0`.
    pub negative: f64,
}

impl PosteriorPrior {
    /// Removes its keys from the table `[priors]`.
    pub(crate) fn take(
        mut remove: impl FnMut(&str) -> Option<toml::Value>,
    ) -> Result<Option<PosteriorPrior>, TableError> {
        let (transfer, moduli) = (remove("transfer"), remove("moduli"));
        let Some(file) = remove("posterior") else {
            return match (transfer, moduli) {
                (None, None) => Ok(None),
                _ => Err(TableError::NoPosterior),
            };
        };
        let file = file
            .as_str()
            .ok_or_else(|| TableError::kind("posterior", &file, "the name of a CSV file is"))?;
        let transfer = match transfer {
            None => 1.0,
            Some(value) => number(&value)
                .filter(|t| t.is_finite() && *t >= 1.0)
                .ok_or_else(|| {
                    let rule = "must be a number >= 1: it widens a covariance";
                    TableError::value("transfer", &value, rule)
                })?,
        };
        let literal = match &moduli {
            None => false,
            Some(toml::Value::String(word)) if word == "reference" => false,
            Some(toml::Value::String(word)) if word == "literal" => true,
            Some(toml::Value::String(word)) => {
                let unknown = unknown_word("value of moduli", word, ["reference", "literal"]);
                return Err(TableError::Unknown(unknown));
            }
            Some(value) => {
                let expected = "\"reference\" or \"literal\" is";
                return Err(TableError::kind("moduli", value, expected));
            }
        };
        Ok(Some(PosteriorPrior {
            file: file.to_owned(),
            transfer,
            literal,
        }))
    }

    /// Fits the joint prior to the draws in the file's text: its parameters with their normal marginals.
    ///
    /// It takes the columns of parameters that the job does not state itself (`is_stated`); `fixed` has its numbers. Draws count equally; means and
    /// covariances are those of the sample, the covariance times `transfer`. Nothing is truncated: what the model cannot be
    /// evaluated at, it refuses.
    ///
    /// # Errors
    /// [`FileError`] names the file and the line or column.
    pub(crate) fn fit(
        self,
        text: &str,
        fixed: impl Fn(&str) -> Option<f64>,
        is_stated: impl Fn(&str) -> bool,
        scope: &ParameterScope,
    ) -> Result<(JointPrior, Vec<FreeParameter>), FileError> {
        let file = self.file.clone();
        let whole = |message: String| FileError::whole(&file, message);
        let mut table = Draws::read(&file, text)?;
        let moduli = table.moduli(fixed);
        let scatters = [Scatter::PlateTest, Scatter::PlateReading].map(scatter_parameter);
        let of_plates = table.columns.iter().any(|column| scatters.contains(column))
            && !table.columns.iter().any(|column| is_of_wheel(column));
        if self.literal {
            table.turn_to_moduli().map_err(|e| whole(e.to_string()))?;
        }
        let (mut covered, mut unused) = (Vec::new(), Vec::new());
        for (position, name) in table.columns.iter().enumerate() {
            let is_error = name.starts_with(NOISE_PREFIX) || name == RING_TRANSFER;
            if is_error || ["log_likelihood", "log_prior"].contains(&name.as_str()) {
                continue;
            }
            match shared::model::lookup(name, scope) {
                Ok(quantity) if !is_stated(name) => covered.push((position, name.clone(), quantity)),
                _ => unused.push(name.clone()),
            }
        }
        if covered.is_empty() {
            return Err(whole(
                "no column is a parameter of which the job says nothing itself: it is the prior of none"
                    .into(),
            ));
        }
        let (draws, least) = (table.rows.len(), DRAWS_PER_PARAMETER * covered.len());
        if draws < least {
            return Err(whole(format!(
                "{draws} draws are too few for the covariance of {} parameters: at least {least}",
                covered.len()
            )));
        }
        let columns: Vec<Vec<f64>> = covered.iter().map(|(i, ..)| table.column(*i)).collect();
        let mut free = Vec::new();
        for ((_, name, quantity), column) in covered.iter().zip(&columns) {
            let (mean, sd) = mean_and_sd(column).unwrap_or_default();
            // A difference within the rounding error of the sum counts as no spread.
            if sd <= ROUNDING * mean.abs() {
                return Err(whole(format!(
                    "{name} is {} in every draw and has no density: fix it in the job",
                    column[0]
                )));
            }
            let normal = Distribution::Normal {
                mean,
                sd: sd * self.transfer.sqrt(),
            };
            free.push(FreeParameter {
                name: name.clone(),
                unit: quantity.unit.clone(),
                marginal: Marginal::new(normal, None).map_err(|e| whole(format!("{name}: {e}")))?,
            });
        }
        let correlation = |i: usize, j: usize| match i == j {
            true => 1.0,
            false => correlation(&columns[i.min(j)], &columns[i.max(j)]),
        };
        let count = covered.len();
        let row = |i| (0..count).map(|j| correlation(i, j)).collect();
        let correlations: Vec<Vec<f64>> = (0..count).map(row).collect();
        let parameters: Vec<String> = covered.into_iter().map(|(_, name, _)| name).collect();
        if let Some((last, others)) = linear_dependence(&correlations) {
            let others: Vec<&str> = others.into_iter().map(|i| parameters[i].as_str()).collect();
            return Err(whole(format!(
                "{} follows from {} in every draw, so their covariance is singular: give {} a number or a prior of its own in the job",
                parameters[last],
                others.join(" and "),
                parameters[last]
            )));
        }
        let joint = JointPrior {
            draws,
            parameters,
            correlations,
            unused,
            moduli,
            of_plates,
            stated: self,
        };
        Ok((joint, free))
    }
}

/// Returns whether only wheels determine a column of a posterior: a radius, the noise of a channel, or an effect other than the
/// shear modulus, which also acts under rings.
fn is_of_wheel(column: &str) -> bool {
    let of_channel = |channel: Channel| column == noise_parameter(channel);
    match column.starts_with(NOISE_PREFIX) {
        true => Channel::ALL.into_iter().any(of_channel) || TRANSIENT_ERRORS.contains(&column),
        false => {
            column == WHEEL_RADIUS || column.contains('.') && ![RING_TRANSFER, RING_MODULUS].contains(&column)
        }
    }
}

impl JointPrior {
    /// Returns lines for a terminal that describe the prior.
    pub fn words(&self) -> Vec<String> {
        let PosteriorPrior { file, transfer, .. } = &self.stated;
        let (names, draws) = (self.parameters.join(", "), self.draws);
        let mut lines = vec![format!(
            "{names}: jointly normal as {draws} draws of {file}, covariance times {transfer}"
        )];
        let count = self.parameters.len();
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (j, i)));
        let correlations: Vec<String> = pairs
            .map(|(i, j)| {
                let (a, b) = (&self.parameters[i], &self.parameters[j]);
                format!("{a}–{b} {:.2}", self.correlations[i][j])
            })
            .collect();
        if !correlations.is_empty() {
            lines.push(format!("    correlations: {}", correlations.join(", ")));
        }
        if let Some(m) = &self.moduli {
            lines.push(format!(
                "    implied by the draws: k_c {:.3e} ± {:.1e} N/m^(n+1), k_phi {:.3e} ± {:.1e} N/m^(n+2), correlation {:.2}; k_c < 0 in {:.1} % of them",
                m.k_c.0,
                m.k_c.1,
                m.k_phi.0,
                m.k_phi.1,
                m.correlation,
                100.0 * m.negative
            ));
        }
        if !self.unused.is_empty() {
            lines.push(format!(
                "    not taken from {file}, because the job specifies them or its model has no such parameter: {}",
                self.unused.join(", ")
            ));
        }
        lines
    }
}

/// The table of a posterior.
struct Draws {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Draws {
    fn read(file: &str, text: &str) -> Result<Draws, FileError> {
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let cells = |line: &str| -> Vec<String> { line.split(',').map(|c| c.trim().to_owned()).collect() };
        let (first, header) = lines
            .next()
            .ok_or_else(|| FileError::whole(file, "the file has no header"))?;
        let columns = cells(header);
        let names: BTreeSet<&String> = columns.iter().collect();
        if names.len() < columns.len() {
            return Err(FileError::at(file, first, "a column is named twice"));
        }
        let mut rows = Vec::new();
        for (line, text) in lines {
            let cells = cells(text);
            if cells.len() != columns.len() {
                let message = format!("{} fields where the header has {}", cells.len(), columns.len());
                return Err(FileError::at(file, line, message));
            }
            let value = |(name, cell): (&String, &String)| match cell.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value),
                _ => Err(FileError::at(
                    file,
                    line,
                    format!("{name} \"{cell}\" is not a finite number"),
                )),
            };
            rows.push(columns.iter().zip(&cells).map(value).collect::<Result<_, _>>()?);
        }
        Ok(Draws { columns, rows })
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|c| c == name)
    }

    fn column(&self, position: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row[position]).collect()
    }

    /// Converts the columns of `log10_p_ref` and `kappa` to columns of `k_c` and `k_phi`, draw by draw.
    fn turn_to_moduli(&mut self) -> Result<(), TableError> {
        if self.position("k_c").is_some() && self.position("k_phi").is_some() {
            return Ok(());
        }
        let position = |name: &'static str| self.position(name).ok_or(TableError::NoColumn(name));
        let [p_ref, kappa, n] = [position("log10_p_ref")?, position("kappa")?, position("n")?];
        for row in &mut self.rows {
            (row[p_ref], row[kappa]) = bekker_moduli(row[p_ref], row[kappa], row[n]);
        }
        (self.columns[p_ref], self.columns[kappa]) = ("k_c".into(), "k_phi".into());
        Ok(())
    }

    /// Returns the moduli of the draws if the draws and the fixed parameters of the job determine them.
    fn moduli(&self, fixed: impl Fn(&str) -> Option<f64>) -> Option<ImpliedModuli> {
        let values = |name: &str| match self.position(name) {
            Some(position) => Some(self.column(position)),
            None => fixed(name).map(|value| vec![value; self.rows.len()]),
        };
        let (k_c, k_phi): (Vec<f64>, Vec<f64>) = match (values("k_c"), values("k_phi")) {
            (Some(k_c), Some(k_phi)) => (k_c, k_phi),
            _ => {
                let (p_ref, kappa, n) = (values("log10_p_ref")?, values("kappa")?, values("n")?);
                let draws = p_ref.iter().zip(kappa).zip(n);
                draws.map(|((&p, kappa), n)| bekker_moduli(p, kappa, n)).unzip()
            }
        };
        let negative = k_c.iter().filter(|k| **k < 0.0).count();
        Some(ImpliedModuli {
            k_c: mean_and_sd(&k_c)?,
            k_phi: mean_and_sd(&k_phi)?,
            correlation: correlation(&k_c, &k_phi),
            negative: negative as f64 / k_c.len() as f64,
        })
    }
}

/// Returns the correlation of two samples; 0 if one does not vary.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let ((mean_a, sd_a), (mean_b, sd_b)) = (
        mean_and_sd(a).unwrap_or_default(),
        mean_and_sd(b).unwrap_or_default(),
    );
    let products: f64 = a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b)).sum();
    let scale = sd_a * sd_b * (a.len() as f64 - 1.0).max(1.0);
    if scale > 0.0 { products / scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use shared::file::FileSet;

    use super::*;
    use crate::Spec;

    const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const RUNS: &str =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\na,w,s,0.2,100,0.008,30\n";
    const NAMES: [&str; 3] = ["log10_p_ref", "kappa", "n"];

    /// Sixty draws in which kappa follows `log10_p_ref` and n goes its own way.
    fn draws() -> Vec<[f64; 3]> {
        let z = |k: usize, step: usize| ((k * step) % 60) as f64 / 30.0 - 1.0;
        let draw = |k| {
            [
                3.9 + 0.02 * z(k, 7),
                -0.6 + 0.03 * z(k, 7) + 0.02 * z(k, 11),
                1.3 + 0.01 * z(k, 17),
            ]
        };
        (0..60).map(draw).collect()
    }

    fn csv() -> String {
        let mut text = "log_likelihood,log_prior,log10_p_ref,kappa,n,noise.plate_noise\n".to_owned();
        for [p, kappa, n] in draws() {
            let _ = writeln!(text, "-3.5,0.1,{p},{kappa},{n},0.1");
        }
        text
    }

    fn spec(priors: &str, csv: &str) -> Result<Spec, String> {
        let job = FileSet {
            toml: format!(
                "[model]\nkind = \"quasi_static\"\n[priors]\n{priors}\nfriction_angle_deg = {{ uniform = [20.0, 40.0] }}\n"
            ),
            files: [("p.csv".to_owned(), csv.to_owned())].into(),
        };
        let files = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".to_owned(), RUNS.to_owned())].into(),
        };
        Spec::new("job.toml", &job, "experiment.toml", &files).map_err(|e| e.to_string())
    }

    /// Returns the covariance of two columns of the draws, times `transfer`.
    fn covariance(transfer: f64, a: &[f64], b: &[f64]) -> f64 {
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let (at, bt) = (mean(a), mean(b));
        let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - at) * (b - bt)).sum();
        transfer * sum / (a.len() as f64 - 1.0)
    }

    fn covered(spec: &Spec) -> &[String] {
        &spec.joint_prior.as_ref().unwrap().parameters
    }

    #[test]
    fn what_the_job_leaves_unstated_has_the_moments_of_the_draws() {
        let spec = spec("posterior = \"p.csv\"\ntransfer = 4.0", &csv()).unwrap();
        assert_eq!(covered(&spec), NAMES);
        let names: Vec<&str> = spec.parameters.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["log10_p_ref", "kappa", "n", "friction_angle_deg"]);
        let columns: Vec<Vec<f64>> = (0..3).map(|i| draws().iter().map(|d| d[i]).collect()).collect();
        let joint = spec.joint_prior.as_ref().unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let sd = |k: usize| spec.parameters[k].marginal.sd();
                let got = joint.correlations[i][j] * sd(i) * sd(j);
                let expected = covariance(4.0, &columns[i], &columns[j]);
                assert!(
                    (got - expected).abs() < 1e-7 * sd(i) * sd(j),
                    "{i} {j}: {got} {expected}"
                );
            }
        }
        assert!(joint.correlations[0][1] > 0.5);
        // a vector against the correlation is less probable than one along it
        let density = |p: f64, kappa: f64| spec.prior().log_density(&[p, kappa, 1.3, 30.0]);
        assert!(density(3.92, -0.57) > density(3.92, -0.63) + 1.0);
    }

    #[test]
    fn parameters_of_a_wheel_or_of_its_effects_make_a_posterior_that_of_more_than_plates() {
        for column in [
            "n",
            "noise.plate_noise",
            RING_TRANSFER,
            RING_MODULUS,
            "log_likelihood",
        ] {
            assert!(!is_of_wheel(column), "{column}");
        }
        for column in [
            WHEEL_RADIUS,
            "wheel_radius_m.w",
            "noise.drawbar_pull_n",
            "slip_sinkage.slip_exponent",
            "janosi_hanamoto.shear_modulus_m.w",
        ] {
            assert!(is_of_wheel(column), "{column}");
        }
        let scatter = scatter_parameter(Scatter::PlateTest);
        let of_plates = |column: &str| {
            let csv = csv().replacen("log_likelihood,log_prior", &format!("{scatter},{column}"), 1);
            let spec = spec("posterior = \"p.csv\"", &csv).unwrap();
            spec.joint_prior.unwrap().of_plates
        };
        assert!(of_plates("log_prior"));
        assert!(!of_plates("slip_sinkage.slip_exponent"));
    }

    #[test]
    fn the_job_speaks_first() {
        let spec = spec(
            "posterior = \"p.csv\"\nn = 1.2\nkappa = { uniform = [-0.9, 0.5] }",
            &csv(),
        )
        .unwrap();
        assert_eq!(covered(&spec), ["log10_p_ref"]);
        assert_eq!(spec.joint_prior.as_ref().unwrap().unused, ["kappa", "n"]);
        assert!((spec.fit_variant.fixed["n"] - 1.2).abs() < 1e-15);
    }

    #[test]
    fn literal_moduli_are_those_that_each_draw_implies() {
        let spec = spec("posterior = \"p.csv\"\nmoduli = \"literal\"", &csv()).unwrap();
        assert_eq!(covered(&spec), ["k_c", "k_phi", "n"]);
        let moduli: Vec<(f64, f64)> = draws()
            .iter()
            .map(|[p, kappa, n]| bekker_moduli(*p, *kappa, *n))
            .collect();
        let k_c: Vec<f64> = moduli.iter().map(|m| m.0).collect();
        let (mean, sd) = mean_and_sd(&k_c).unwrap();
        let marginal = &spec.parameters[0].marginal;
        assert!((marginal.mean() / mean - 1.0).abs() < 1e-6 && (marginal.sd() / sd - 1.0).abs() < 1e-6);
        let implied = spec.joint_prior.as_ref().unwrap().moduli.unwrap();
        assert_eq!(implied.k_c, (mean, sd));
        assert!(implied.negative > 0.99 && implied.correlation < -0.5);
        // 7943 Pa at 10 mm, n 1.3, kappa -0.6: k_phi = 7943 / 0.01^1.3 / 0.4, k_c = -0.6 k_phi 0.03
        let k_phi = 7943.28 / 0.01_f64.powf(1.3) / 0.4;
        assert!((implied.k_phi.0 / k_phi - 1.0).abs() < 0.03);
        assert!((implied.k_c.0 / (-0.018 * k_phi) - 1.0).abs() < 0.03);
    }

    #[test]
    fn what_is_no_prior_is_refused() {
        let few: String = csv().lines().take(30).map(|line| format!("{line}\n")).collect();
        let constant: String = csv()
            .lines()
            .map(|line| match line.rsplit_once(",1.") {
                Some((head, _)) => format!("{head},1.3,0.1\n"),
                None => format!("{line}\n"),
            })
            .collect();
        let mut dependent = "log10_p_ref,kappa,n\n".to_owned();
        for [p_ref, kappa, _] in draws() {
            let _ = writeln!(dependent, "{p_ref},{kappa},{}", 0.3 * p_ref - 0.2 * kappa);
        }
        for (priors, text, message) in [
            (
                "posterior = \"p.csv\"",
                few,
                "p.csv: 29 draws are too few for the covariance of 3 parameters: at least 30",
            ),
            (
                "posterior = \"p.csv\"",
                constant,
                "p.csv: n is 1.3 in every draw and has no density: fix it in the job",
            ),
            (
                "posterior = \"p.csv\"",
                dependent,
                "p.csv: n follows from log10_p_ref and kappa in every draw, so their covariance is singular: give n a number or a prior of its own in the job",
            ),
            (
                "posterior = \"p.csv\"",
                csv().replacen("-3.5,0.1,", "-3.5,0.1,x", 1),
                "p.csv line 2: log10_p_ref \"x3.88\" is not a finite number",
            ),
            (
                "posterior = \"p.csv\"\ntransfer = 0.5",
                csv(),
                "job.toml: [priors] transfer = 0.5 must be a number >= 1: it widens a covariance",
            ),
            (
                "transfer = 2.0",
                csv(),
                "job.toml: [priors] transfer and moduli belong to posterior = \"FILE.csv\", which is missing",
            ),
            (
                "posterior = \"p.csv\"\nmoduli = \"literl\"",
                csv(),
                "job.toml: [priors] unknown value of moduli \"literl\"; the nearest known is \"literal\"",
            ),
            (
                "posterior = \"q.csv\"",
                csv(),
                "job.toml: file \"q.csv\" is named but was not sent",
            ),
            (
                "posterior = \"p.csv\"\nmoduli = \"literal\"",
                csv().replacen("kappa", "cappa", 1),
                "p.csv: moduli = \"literal\" asks for draws of kappa, which has no column",
            ),
            (
                "posterior = \"p.csv\"",
                csv().replacen(",kappa,", ",n,", 1),
                "p.csv line 1: a column is named twice",
            ),
        ] {
            assert_eq!(spec(priors, &text).unwrap_err(), message);
        }
    }
}

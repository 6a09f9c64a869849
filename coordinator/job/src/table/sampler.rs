//! The table `[sampler]`: an algorithm with its settings.
//!
//! Each algorithm has a struct here. Its fields are the keys that the algorithm takes; the reader, the schema and the test of
//! docs/job.md take names, types, bounds, defaults and descriptions from it. A new key is a field, and its use in `settings`.

use inference::evolution::{CmaEsSettings, EvolutionSettings, GaSettings, MAX_POPULATION};
use inference::lm::LmSettings;
use inference::{Algorithm, MAX_PARTICLES, StageMethod, TmcmcSettings};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use shared::file::{FileError, TomlFile, unknown_word};
use shared::keys::keys_of;
use shared::model::ModelKind;
use toml::de::DeValue;

use super::algorithm_settings::{AlgorithmName, AlgorithmSettings};
use super::error::TableError;
use crate::derived_schema::from_type;

/// The algorithms that a job may state, in the order in which messages name them.
pub(crate) const ALGORITHMS: [StatedAlgorithm; 6] = [
    StatedAlgorithm::new::<Tmcmc>(),
    StatedAlgorithm::new::<ChingChen2007>(),
    StatedAlgorithm::new::<Basis>(),
    StatedAlgorithm::new::<Lm>(),
    StatedAlgorithm::new::<Ga>(),
    StatedAlgorithm::new::<CmaEs>(),
];

/// A key of earlier versions.
pub(crate) const METAMODEL_MOVES: &str = "metamodel_moves";

/// The seed of all random numbers.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(transparent)]
struct Seed(u64);

impl Default for Seed {
    fn default() -> Self {
        Seed(TmcmcSettings::default().seed)
    }
}

/// Fits of the same job beside the sample, with their default settings and the job's seed.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(transparent)]
#[schemars(extend("uniqueItems" = true, "items" = { "type": "string", "enum": AlgorithmName::POINT_ESTIMATES }))]
struct PointEstimates(Vec<String>);

/// How a stage gets its particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Stages {
    Draws,
    Moves,
    Emulated,
}

/// Draws of the posterior and the evidence.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Tmcmc {
    /// Size of the population, and draws of a stage; at least 2 d + 2 for d parameters.
    #[schemars(range(max = MAX_PARTICLES))]
    particles: usize,
    /// How a stage gets its particles: draws on an emulator of the model, independent draws from a mixture, or Metropolis moves.
    stages: Option<Stages>,
    /// Evaluations that a round of an emulator asks for at once.
    #[schemars(range(min = 1, max = TmcmcSettings::MAX_BATCH))]
    batch: Option<usize>,
    /// Largest number of components of the mixture that draws come from.
    #[schemars(range(min = 1, max = TmcmcSettings::MAX_COMPONENTS))]
    components: Option<usize>,
    /// Least and most Metropolis steps per particle in a stage of moves.
    #[schemars(inner(range(min = 1, max = TmcmcSettings::MAX_MOVES)))]
    moves: Option<[usize; 2]>,
    seed: Seed,
    point_estimates: PointEstimates,
}

impl Default for Tmcmc {
    fn default() -> Self {
        let usual = TmcmcSettings::default();
        Tmcmc {
            particles: usual.particles,
            stages: None,
            batch: None,
            components: None,
            moves: None,
            seed: Seed::default(),
            point_estimates: PointEstimates::default(),
        }
    }
}

/// Draws of the posterior and the evidence by the original algorithm of the source paper.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct ChingChen2007 {
    /// Size of the population, and draws of a stage; at least 2 d + 2 for d parameters.
    #[schemars(range(max = MAX_PARTICLES))]
    particles: usize,
    /// Least and most Metropolis steps per particle in a stage of moves.
    #[schemars(inner(range(min = 1, max = TmcmcSettings::MAX_MOVES)))]
    moves: [usize; 2],
    seed: Seed,
    point_estimates: PointEstimates,
}

impl Default for ChingChen2007 {
    fn default() -> Self {
        let usual = TmcmcSettings::default();
        ChingChen2007 {
            particles: usual.particles,
            moves: usual.moves,
            seed: Seed::default(),
            point_estimates: PointEstimates::default(),
        }
    }
}

/// Draws of the posterior and the evidence, with one step per particle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Basis {
    /// Size of the population, and draws of a stage; at least 2 d + 2 for d parameters.
    #[schemars(range(max = MAX_PARTICLES))]
    particles: usize,
    seed: Seed,
    point_estimates: PointEstimates,
}

impl Default for Basis {
    fn default() -> Self {
        Basis {
            particles: TmcmcSettings::default().particles,
            seed: Seed::default(),
            point_estimates: PointEstimates::default(),
        }
    }
}

/// Most probable parameters by Levenberg-Marquardt, then draws and evidence of the normal approximation about them.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Lm {
    /// Draws of the normal approximation, at least 20; 0 for the point estimate alone.
    #[schemars(range(max = MAX_PARTICLES))]
    particles: usize,
    /// Points of the first round: the prior mean, then prior draws.
    #[schemars(range(min = 1))]
    starts: usize,
    /// Largest number of evaluations.
    #[schemars(range(min = 1, max = LmSettings::MAX_EVALUATIONS))]
    max_evaluations: usize,
    /// Shortest difference, in prior widths.
    #[schemars(extend("exclusiveMinimum" = 0), range(max = LmSettings::MAX_DIFFERENCE_STEP))]
    difference_step: f64,
    seed: Seed,
}

impl Default for Lm {
    fn default() -> Self {
        let usual = LmSettings::default();
        Lm {
            particles: usual.draws,
            starts: usual.starts,
            max_evaluations: usual.max_evaluations,
            difference_step: usual.difference_step,
            seed: Seed::default(),
        }
    }
}

/// Most probable parameters by a genetic algorithm.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Ga {
    /// Individuals of a generation.
    #[schemars(range(min = GaSettings::MIN_POPULATION, max = MAX_POPULATION))]
    population: usize,
    /// Largest number of generations.
    #[schemars(range(min = 2, max = GaSettings::MAX_GENERATIONS))]
    generations: usize,
    seed: Seed,
}

impl Default for Ga {
    fn default() -> Self {
        let usual = GaSettings::default();
        Ga {
            population: usual.population,
            generations: usual.generations,
            seed: Seed::default(),
        }
    }
}

/// Most probable parameters by covariance matrix adaptation with restarts.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct CmaEs {
    /// Individuals of a generation; 4 + floor(3 ln d) for d parameters where the job does not say it.
    #[schemars(range(min = CmaEsSettings::MIN_POPULATION, max = MAX_POPULATION))]
    population: Option<usize>,
    /// Largest number of evaluations.
    #[schemars(range(min = 1, max = CmaEsSettings::MAX_EVALUATIONS))]
    max_evaluations: usize,
    /// Largest number of restarts, each with twice the population.
    #[schemars(range(max = CmaEsSettings::MAX_RESTARTS))]
    restarts: usize,
    seed: Seed,
}

impl Default for CmaEs {
    fn default() -> Self {
        let usual = CmaEsSettings::default();
        CmaEs {
            population: usual.population,
            max_evaluations: usual.max_evaluations,
            restarts: usual.restarts,
            seed: Seed::default(),
        }
    }
}

/// The keys of an algorithm.
trait Keys: DeserializeOwned + JsonSchema + Default {
    const NAME: AlgorithmName;

    /// Returns the settings.
    ///
    /// # Errors
    /// [`TableError`]: keys contradict each other.
    fn settings(self) -> Result<AlgorithmSettings, TableError>;

    /// Returns the names of the point estimates.
    fn point_estimates(&self) -> &[String] {
        &[]
    }

    /// Returns whether the kind of the model decides how a stage gets its particles.
    fn follows_kind(&self) -> bool {
        false
    }

    /// Returns the number of evaluations in a round of an emulator, if the job states it.
    fn batch(&self) -> Option<usize> {
        None
    }
}

impl Keys for Tmcmc {
    const NAME: AlgorithmName = AlgorithmName::Tmcmc;

    fn settings(self) -> Result<AlgorithmSettings, TableError> {
        let usual = TmcmcSettings::default();
        let stages = match self.stages {
            Some(Stages::Draws) => StageMethod::Draws,
            Some(Stages::Moves) => StageMethod::Moves,
            Some(Stages::Emulated) => StageMethod::Emulated,
            None => usual.stages,
        };
        if let (StageMethod::Moves, Some(components)) = (stages, self.components) {
            let rule = "belongs to stages = \"draws\"";
            return Err(TableError::value("components", components, rule));
        }
        Ok(AlgorithmSettings::Sample(TmcmcSettings {
            algorithm: Algorithm::Tmcmc,
            stages,
            particles: self.particles,
            components: self.components.unwrap_or(usual.components),
            moves: self.moves.unwrap_or(usual.moves),
            batch: self.batch.unwrap_or(usual.batch),
            seed: self.seed.0,
            ..usual
        }))
    }

    fn point_estimates(&self) -> &[String] {
        &self.point_estimates.0
    }

    fn follows_kind(&self) -> bool {
        self.stages.is_none() && self.moves.is_none() && self.components.is_none()
    }

    fn batch(&self) -> Option<usize> {
        self.batch
    }
}

impl Keys for ChingChen2007 {
    const NAME: AlgorithmName = AlgorithmName::ChingChen2007;

    fn settings(self) -> Result<AlgorithmSettings, TableError> {
        Ok(AlgorithmSettings::Sample(TmcmcSettings {
            algorithm: Algorithm::ChingChen2007,
            particles: self.particles,
            moves: self.moves,
            seed: self.seed.0,
            ..TmcmcSettings::default()
        }))
    }

    fn point_estimates(&self) -> &[String] {
        &self.point_estimates.0
    }
}

impl Keys for Basis {
    const NAME: AlgorithmName = AlgorithmName::Basis;

    fn settings(self) -> Result<AlgorithmSettings, TableError> {
        Ok(AlgorithmSettings::Sample(TmcmcSettings {
            algorithm: Algorithm::Basis,
            particles: self.particles,
            seed: self.seed.0,
            ..TmcmcSettings::default()
        }))
    }

    fn point_estimates(&self) -> &[String] {
        &self.point_estimates.0
    }
}

impl Keys for Lm {
    const NAME: AlgorithmName = AlgorithmName::Lm;

    fn settings(self) -> Result<AlgorithmSettings, TableError> {
        Ok(AlgorithmSettings::Fit(LmSettings {
            starts: self.starts,
            max_evaluations: self.max_evaluations,
            draws: self.particles,
            difference_step: self.difference_step,
            seed: self.seed.0,
            ..LmSettings::default()
        }))
    }
}

impl Keys for Ga {
    const NAME: AlgorithmName = AlgorithmName::Ga;

    fn settings(self) -> Result<AlgorithmSettings, TableError> {
        Ok(AlgorithmSettings::Evolve(EvolutionSettings::Ga(GaSettings {
            population: self.population,
            generations: self.generations,
            seed: self.seed.0,
            ..GaSettings::default()
        })))
    }
}

impl Keys for CmaEs {
    const NAME: AlgorithmName = AlgorithmName::CmaEs;

    fn settings(self) -> Result<AlgorithmSettings, TableError> {
        Ok(AlgorithmSettings::Evolve(EvolutionSettings::CmaEs(
            CmaEsSettings {
                population: self.population,
                max_evaluations: self.max_evaluations,
                restarts: self.restarts,
                seed: self.seed.0,
                ..CmaEsSettings::default()
            },
        )))
    }
}

/// An algorithm that a job may state.
pub(crate) struct StatedAlgorithm {
    pub(crate) name: AlgorithmName,
    /// The keys that it takes, in the order of its struct.
    pub(crate) keys: fn() -> &'static [&'static str],
    /// The schema of its keys.
    pub(crate) schema: fn() -> serde_json::Value,
    read: fn(&TomlFile, toml::Spanned<DeValue>) -> Result<SamplerTable, FileError>,
}

impl StatedAlgorithm {
    const fn new<K: Keys>() -> Self {
        StatedAlgorithm {
            name: K::NAME,
            keys: keys_of::<K>,
            schema: from_type::<K>,
            read: |file, table| {
                let keys: K = file.read(table)?;
                SamplerTable::new(keys).map_err(|e| file.error(format!("[sampler] {e}")))
            },
        }
    }
}

/// The table `[sampler]`, read.
#[derive(Debug)]
pub(crate) struct SamplerTable {
    pub(crate) algorithm: AlgorithmSettings,
    /// Whether the kind of the model decides how a stage gets its particles, because no key is stated that says it.
    pub(crate) follows_kind: bool,
    /// The number of evaluations in a round of an emulator, if the job states it.
    batch: Option<usize>,
    /// The fits and searches beside the sample.
    pub(crate) point_estimates: Vec<AlgorithmSettings>,
}

impl SamplerTable {
    /// Reads the table by the struct of the algorithm that it names.
    ///
    /// # Errors
    /// [`FileError`] with the line of a key or value, or with the name of the table.
    pub(crate) fn read(file: &TomlFile) -> Result<SamplerTable, FileError> {
        let Some(mut value) = file.get("sampler").cloned() else {
            return SamplerTable::new(Tmcmc::default()).map_err(|e| file.error(e.to_string()));
        };
        let in_table = |e: TableError| file.error(format!("[sampler] {e}"));
        let mut name = AlgorithmName::Tmcmc.name().to_owned();
        let DeValue::Table(table) = value.get_mut() else {
            return (ALGORITHMS[0].read)(file, value);
        };
        if let Some(stated) = table.remove("algorithm") {
            name = file.read(stated)?;
        }
        let algorithm = ALGORITHMS.iter().find(|algorithm| algorithm.name.name() == name);
        let algorithm = algorithm.ok_or_else(|| {
            let known = ALGORITHMS.iter().map(|algorithm| algorithm.name.name());
            in_table(TableError::Unknown(unknown_word("algorithm", &name, known)))
        })?;
        for key in table.keys() {
            let takes = |algorithm: &&StatedAlgorithm| (algorithm.keys)().contains(&key.get_ref().as_ref());
            let owners: Vec<&str> = ALGORITHMS
                .iter()
                .filter(takes)
                .map(|algorithm| algorithm.name.name())
                .collect();
            if key.get_ref() == METAMODEL_MOVES {
                let message = format!(
                    "{METAMODEL_MOVES} was removed, because stages = \"emulated\" finds the same posterior with fewer evaluations: submit the job with that in place of this line"
                );
                return Err(file.error_at(&key.span(), message));
            }
            if owners.is_empty() {
                let message = unknown_word("key", key.get_ref(), known_keys());
                return Err(file.error_at(&key.span(), message));
            }
            if !owners.contains(&algorithm.name.name()) {
                return Err(in_table(TableError::ForeignKey {
                    key: key.get_ref().to_string(),
                    owners: owners.join(" and "),
                    algorithm: algorithm.name.name(),
                    keys: (algorithm.keys)().join(", "),
                }));
            }
        }
        (algorithm.read)(file, value)
    }

    fn new(keys: impl Keys) -> Result<SamplerTable, TableError> {
        let names = keys.point_estimates().to_vec();
        let (follows_kind, batch) = (keys.follows_kind(), keys.batch());
        let algorithm = keys.settings()?;
        let seed = Seed(algorithm.seed());
        let mut point_estimates: Vec<AlgorithmSettings> = Vec::new();
        for name in names {
            let settings = point_estimate(&name, seed)?;
            if point_estimates.contains(&settings) {
                return Err(TableError::Twice(name));
            }
            point_estimates.push(settings);
        }
        Ok(SamplerTable {
            algorithm,
            follows_kind,
            batch,
            point_estimates,
        })
    }

    /// Returns the algorithm for a kind of model.
    pub(crate) fn algorithm_for(&self, kind: ModelKind) -> AlgorithmSettings {
        match self.follows_kind {
            true => self.algorithm.with_stages_for(kind),
            false => self.algorithm,
        }
    }

    /// Refuses a stated batch if no model is sampled by an emulator.
    ///
    /// # Errors
    /// [`TableError`] with the batch and the stages that it belongs to.
    pub(crate) fn check_batch(&self, kinds: impl IntoIterator<Item = ModelKind>) -> Result<(), TableError> {
        let is_used = kinds
            .into_iter()
            .any(|kind| self.algorithm_for(kind).is_emulated());
        match self.batch {
            Some(batch) if !is_used => {
                let rule = "belongs to stages = \"emulated\", which this job does not use";
                Err(TableError::value("batch", batch, rule))
            }
            _ => Ok(()),
        }
    }
}

/// Returns a fit or search beside a sample, with its default settings and the sample's seed.
fn point_estimate(name: &str, seed: Seed) -> Result<AlgorithmSettings, TableError> {
    let algorithms = AlgorithmName::POINT_ESTIMATES;
    match algorithms.into_iter().find(|algorithm| algorithm.name() == name) {
        Some(AlgorithmName::Ga) => Ga {
            seed,
            ..Ga::default()
        }
        .settings(),
        Some(AlgorithmName::CmaEs) => CmaEs {
            seed,
            ..CmaEs::default()
        }
        .settings(),
        // The sample makes draws of the normal approximation superfluous.
        Some(_) => Lm {
            seed,
            particles: 0,
            ..Lm::default()
        }
        .settings(),
        None => {
            let names = algorithms.map(AlgorithmName::name);
            Err(TableError::Unknown(unknown_word("point estimate", name, names)))
        }
    }
}

/// Returns the keys of all algorithms.
fn known_keys() -> impl Iterator<Item = &'static str> {
    let mut keys = vec!["algorithm"];
    for algorithm in &ALGORITHMS {
        for key in (algorithm.keys)() {
            if !keys.contains(key) {
                keys.push(key);
            }
        }
    }
    keys.into_iter()
}

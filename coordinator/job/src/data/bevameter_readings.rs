//! Readings of plates and rings as data: logarithms of stresses, with a common shift of the readings of each test.

use shared::experiment::{Experiment, Scatter};
use shared::model::{ModelVariant, PlateCondition, RingCondition};
use shared::parameters::RING_TRANSFER;
use statistics::{Datum, Distribution, ErrorSd, Marginal};

use super::error::DataError;
use crate::table::prior_entry::FreeParameter;

/// The channel of plates among the data, behind those of the wheel.
pub const PLATE: usize = 4;
/// The channel of rings.
pub const RING: usize = 5;

/// Prior sd of the logarithm of the transfer of tan(phi) from ring to wheel.
const TRANSFER_SD: f64 = 0.1;

/// One measured reading.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading<C> {
    /// The test that the reading belongs to.
    pub test: String,
    /// Conditions of the plate or ring.
    pub condition: C,
    /// Measured pressure or shear stress `[Pa]`, > 0.
    pub stress_pa: f64,
}

/// The measured readings of an experiment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BevameterReadings {
    /// The readings of plates, in the order of the file.
    pub plates: Vec<Reading<PlateCondition>>,
    /// The readings of rings, in the order of the file.
    pub rings: Vec<Reading<RingCondition>>,
}

/// Readings of one kind, as data.
pub(crate) struct ReadingTable<'a> {
    channel: usize,
    readings: Vec<(&'a str, f64)>,
    /// Scatter of its readings within a test.
    pub(crate) between_readings: Scatter,
    /// Scatter of its tests.
    pub(crate) between_tests: Scatter,
}

impl BevameterReadings {
    /// Returns the measured readings of an experiment.
    ///
    /// # Errors
    /// A stress or a displacement is zero and has no logarithm.
    pub(crate) fn new(experiment: &Experiment) -> Result<Self, DataError> {
        let loaded = |test: &str, stress: (&'static str, f64), way: (&'static str, f64)| {
            if stress.1 > 0.0 && way.1 > 0.0 {
                return Ok(());
            }
            Err(DataError::NoLogarithm {
                test: test.to_owned(),
                stress: stress.0,
                stress_pa: stress.1,
                displacement: way.0,
                displacement_m: way.1,
            })
        };
        let mut readings = BevameterReadings::default();
        for row in &experiment.plates {
            let Some(stress_pa) = row.pressure_pa else {
                continue;
            };
            loaded(
                &row.test,
                ("pressure_pa", stress_pa),
                ("sinkage_m", row.sinkage_m),
            )?;
            readings.plates.push(Reading {
                test: row.test.clone(),
                condition: PlateCondition {
                    plate_radius_m: row.plate_radius_m,
                    sinkage_m: row.sinkage_m,
                },
                stress_pa,
            });
        }
        for row in &experiment.shear {
            let Some(stress_pa) = row.shear_stress_pa else {
                continue;
            };
            let way = ("shear_displacement_m", row.shear_displacement_m);
            loaded(&row.test, ("shear_stress_pa", stress_pa), way)?;
            readings.rings.push(Reading {
                test: row.test.clone(),
                condition: RingCondition {
                    normal_stress_pa: row.normal_stress_pa,
                    shear_displacement_m: row.shear_displacement_m,
                },
                stress_pa,
            });
        }
        Ok(readings)
    }

    /// Adds the conditions of the readings to a variant, so that it predicts them.
    pub(crate) fn ask(&self, variant: &mut ModelVariant) {
        variant.plates = self.plates.iter().map(|r| r.condition.clone()).collect();
        variant.rings = self.rings.iter().map(|r| r.condition.clone()).collect();
    }

    /// Adds the transfer of tan(phi) from ring to wheel if a ring was measured and the job does not state the transfer.
    ///
    /// # Errors
    /// The job states it without a ring, or a ring has no single shear modulus.
    pub(crate) fn add_transfer(
        &self,
        fixed: &std::collections::BTreeMap<String, f64>,
        parameters: &mut Vec<FreeParameter>,
    ) -> Result<(), DataError> {
        let is_stated = |name: &str| fixed.contains_key(name) || parameters.iter().any(|p| p.name == name);
        if self.rings.is_empty() {
            return match is_stated(RING_TRANSFER) {
                true => Err(DataError::NoRing(RING_TRANSFER)),
                false => Ok(()),
            };
        }
        let wheel_modulus = "janosi_hanamoto.shear_modulus_m.";
        let free = parameters.iter().map(|p| &p.name);
        if let Some(name) = free.chain(fixed.keys()).find(|n| n.starts_with(wheel_modulus)) {
            return Err(DataError::ModulusOfOneWheel(name.clone()));
        }
        if !is_stated(RING_TRANSFER) {
            let (mean, sd) = (0.0, TRANSFER_SD);
            parameters.push(FreeParameter {
                name: RING_TRANSFER.to_owned(),
                unit: "1".to_owned(),
                marginal: Marginal::new(Distribution::Normal { mean, sd }, None)?,
            });
        }
        Ok(())
    }

    /// Returns the kinds of readings that the experiment has.
    pub(crate) fn tables(&self) -> Vec<ReadingTable<'_>> {
        let plates = ReadingTable {
            channel: PLATE,
            readings: self.plates.iter().map(|r| (&*r.test, r.stress_pa)).collect(),
            between_readings: Scatter::PlateReading,
            between_tests: Scatter::PlateTest,
        };
        let rings = ReadingTable {
            channel: RING,
            readings: self.rings.iter().map(|r| (&*r.test, r.stress_pa)).collect(),
            between_readings: Scatter::RingReading,
            between_tests: Scatter::RingTest,
        };
        [plates, rings]
            .into_iter()
            .filter(|table| !table.readings.is_empty())
            .collect()
    }

    /// Returns whether the experiment has readings of this kind.
    pub(crate) fn scatters(&self, scatter: Scatter) -> bool {
        let tables = self.tables();
        tables
            .iter()
            .any(|t| t.between_readings == scatter || t.between_tests == scatter)
    }
}

impl ReadingTable<'_> {
    /// Returns the readings as data: logarithms of stresses `[ln Pa]`, so that their sd is relative.
    pub(crate) fn data(&self, sd: ErrorSd) -> impl Iterator<Item = Datum> {
        let readings = self.readings.iter().enumerate();
        readings.map(move |(run, (_, stress))| Datum {
            run,
            channel: self.channel,
            value: libm::log(*stress),
            sd,
        })
    }

    /// Returns the readings of each test, in the order of the file.
    pub(crate) fn tests(&self) -> Vec<Vec<usize>> {
        let mut tests: Vec<(&str, Vec<usize>)> = Vec::new();
        for (i, (name, _)) in self.readings.iter().enumerate() {
            match tests.iter_mut().find(|(known, _)| known == name) {
                Some((_, readings)) => readings.push(i),
                None => tests.push((name, vec![i])),
            }
        }
        tests.into_iter().map(|(_, readings)| readings).collect()
    }
}

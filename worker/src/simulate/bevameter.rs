//! The tables of plates and rings.

use shared::experiment::{Experiment, PLATE_COLUMNS, SHEAR_COLUMNS};

use super::error::SimulateError;
use crate::model::Readings;

/// Writes the table of the plates, in the order of the experiment.
pub(super) fn plates(experiment: &Experiment, readings: &Readings) -> Result<Vec<u8>, SimulateError> {
    table(
        PLATE_COLUMNS,
        experiment.plates.iter().map(|r| {
            let (radius, sinkage) = (r.plate_radius_m, r.sinkage_m);
            (&*r.test, [radius, sinkage], readings.pressure_pa(radius, sinkage))
        }),
    )
}

/// Writes the table of the rings, in the order of the experiment.
pub(super) fn shear(experiment: &Experiment, readings: &Readings) -> Result<Vec<u8>, SimulateError> {
    table(
        SHEAR_COLUMNS,
        experiment.shear.iter().map(|r| {
            let (stress, way) = (r.normal_stress_pa, r.shear_displacement_m);
            (&*r.test, [stress, way], readings.shear_stress_pa(stress, way))
        }),
    )
}

/// Writes rows of a test's name, its two conditions and the model's prediction.
fn table<'a>(
    columns: [&str; 4],
    rows: impl Iterator<Item = (&'a str, [f64; 2], Result<f64, scm::Rejection>)>,
) -> Result<Vec<u8>, SimulateError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns)?;
    for (test, [a, b], predicted) in rows {
        let value = predicted.map_err(|rejection| SimulateError::Rejected {
            what: "test",
            name: test.to_owned(),
            message: rejection.to_string(),
        })?;
        writer.write_record([test, &a.to_string(), &b.to_string(), &value.to_string()])?;
    }
    let bytes = writer.into_inner();
    Ok(bytes.map_err(|e| csv::Error::from(e.into_error()))?)
}

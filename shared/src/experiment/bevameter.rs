//! The rows of `plates.csv` and `shear.csv`.

use super::check::ValueError;
use super::table::{self, Columns, Row};
use crate::file::FileError;

/// One reading of a plate that is pressed into the soil.
#[derive(Debug, Clone, PartialEq)]
pub struct PlateReading {
    /// The test that the reading belongs to.
    pub test: String,
    /// Radius of the round plate `[m]`.
    pub plate_radius_m: f64,
    /// Sinkage `[m]`, ≥ 0.
    pub sinkage_m: f64,
    /// Measured pressure `[Pa]`; `None` = unmeasured.
    pub pressure_pa: Option<f64>,
}

/// One reading of a ring that is turned on the soil.
#[derive(Debug, Clone, PartialEq)]
pub struct ShearReading {
    /// The test that the reading belongs to.
    pub test: String,
    /// Normal stress under the ring `[Pa]`, ≥ 0.
    pub normal_stress_pa: f64,
    /// Displacement at the ring's mean radius `[m]`, ≥ 0.
    pub shear_displacement_m: f64,
    /// Measured shear stress `[Pa]`; `None` = unmeasured.
    pub shear_stress_pa: Option<f64>,
}

/// The columns of `plates.csv`, in the order of the file; the last one may be blank or absent.
pub const PLATE_COLUMNS: [&str; 4] = ["test", "plate_radius_m", "sinkage_m", "pressure_pa"];
/// The columns of `shear.csv`, in the order of the file; the last one may be blank or absent.
pub const SHEAR_COLUMNS: [&str; 4] = [
    "test",
    "normal_stress_pa",
    "shear_displacement_m",
    "shear_stress_pa",
];

/// Upper bound on the sinkage of a plate: no bevameter presses deeper, but a number in millimetres is larger.
const DEEPEST_PLATE_M: f64 = 1.0;
/// Upper bound on the displacement of a ring: no ring is turned as far as this; a number in millimetres usually exceeds
/// it.
const LARGEST_SHEAR_M: f64 = 10.0;

/// Parses `plates.csv`.
pub(super) fn plates(file: &str, text: &str) -> Result<Vec<PlateReading>, FileError> {
    let readings = table::rows(file, text, &columns(&PLATE_COLUMNS), |row, _| {
        let plate_radius_m = row.positive("plate_radius_m", "m")?;
        let sinkage_m = row.not_negative("sinkage_m", "m")?;
        in_metres("sinkage_m", sinkage_m, DEEPEST_PLATE_M)?;
        Ok(PlateReading {
            test: row.word("test")?.to_owned(),
            plate_radius_m,
            sinkage_m,
            pressure_pa: row.number("pressure_pa")?,
        })
    })?;
    some(file, readings, "the file has no reading of a plate")
}

/// Parses `shear.csv`.
pub(super) fn shear(file: &str, text: &str) -> Result<Vec<ShearReading>, FileError> {
    let readings = table::rows(file, text, &columns(&SHEAR_COLUMNS), |row: &Row<'_>, _| {
        let shear_displacement_m = row.not_negative("shear_displacement_m", "m")?;
        in_metres("shear_displacement_m", shear_displacement_m, LARGEST_SHEAR_M)?;
        Ok(ShearReading {
            test: row.word("test")?.to_owned(),
            normal_stress_pa: row.not_negative("normal_stress_pa", "Pa")?,
            shear_displacement_m,
            shear_stress_pa: row.number("shear_stress_pa")?,
        })
    })?;
    some(file, readings, "the file has no reading of a ring")
}

fn columns<'a>(names: &'a [&'a str; 4]) -> Columns<'a> {
    Columns {
        allowed: names.to_vec(),
        required: &names[..3],
        max_rows: table::MAX_ROWS,
    }
}

fn in_metres(column: &str, value: f64, largest: f64) -> Result<(), ValueError> {
    if value <= largest {
        return Ok(());
    }
    let key = column.to_owned();
    Err(ValueError::Millimetres { key, value, largest })
}

fn some<T>(file: &str, readings: Vec<T>, otherwise: &str) -> Result<Vec<T>, FileError> {
    match readings.is_empty() {
        true => Err(FileError::whole(file, otherwise)),
        false => Ok(readings),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;

    #[test]
    fn readings_keep_their_order_and_a_blank_measurement() {
        let text = "# thinned\ntest,plate_radius_m,sinkage_m,pressure_pa\nb,0.03,0.002,1337.5\na,0.05,0,\n";
        let readings = plates("plates.csv", text).unwrap();
        assert_eq!(readings[0].test, "b");
        assert_eq!(readings[0].pressure_pa, Some(1337.5));
        assert_eq!(readings[1].pressure_pa, None);
        let text = "test,normal_stress_pa,shear_displacement_m\nr,5000,0.01\n";
        let readings = shear("shear.csv", text).unwrap();
        assert_eq!(readings[0].shear_stress_pa, None);
        assert!((readings[0].normal_stress_pa - 5000.0).abs() < 1e-12);
    }

    #[test]
    fn malformed_readings_name_line_value_unit_and_bound() {
        let plate = |row: &str| {
            let text = format!("test,plate_radius_m,sinkage_m,pressure_pa\na,0.03,0.001,500\n{row}\n");
            plates("plates.csv", &text).unwrap_err().to_string()
        };
        for (row, message) in cases(
            r#"
            a,0,0.002,1 => plate_radius_m 0 m must be > 0 m
            a,0.03,-0.002,1 => sinkage_m -0.002 m must be >= 0 m
            a,30,0.002,1 => plate_radius_m 30 m must be at most 1 m: was it typed in mm (0.03 m) or cm (0.3 m)?
            a,0.03,2,1 => sinkage_m 2 m must be <= 1 m: metres are expected, were these millimetres?
            a,0.03,,1 => sinkage_m is blank
            ,0.03,0.002,1 => test is blank
            a,0.03,0.002,inf => pressure_pa inf is not a finite number
            a,0.03,0.002 => 3 fields where the header has 4"#,
        ) {
            assert_eq!(plate(row), format!("plates.csv line 3: {message}"));
        }
        for (columns, message) in cases(
            r#"
            shear_displacement_mm,shear_stress_pa =>  line 1: unknown column "shear_displacement_mm"; the nearest known is "shear_displacement_m"
            shear_stress_pa =>  line 1: column "shear_displacement_m" is missing
            shear_displacement_m => : the file has no reading of a ring"#,
        ) {
            let refused = shear("shear.csv", &format!("test,normal_stress_pa,{columns}\n")).unwrap_err();
            assert_eq!(refused.to_string(), format!("shear.csv{message}"));
        }
    }
}

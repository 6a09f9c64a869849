//! Predictions over a grid of conditions: a lookup table with intervals.

use std::io::{Cursor, Write};

use prediction::Sweep;
use prediction::plan::MAX_RUNS;
use prediction::prediction::{PredictedQuantity, PredictedRun, Prediction};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::error::ExportError;

/// A value of a quantity by its prediction.
type Value = fn(&PredictedQuantity) -> Option<f64>;

/// What a table has of each quantity, by the suffix of the column.
const PARTS: [(&str, Value); 5] = [
    ("", |q| Some(q.mean)),
    ("_low", |q| Some(q.parameters[0])),
    ("_high", |q| Some(q.parameters[1])),
    ("_measurement_low", |q| q.measurement.map(|ends| ends[0])),
    ("_measurement_high", |q| q.measurement.map(|ends| ends[1])),
];

/// Predictions at every point of a grid, the last quantity of the grid varying fastest.
#[derive(Debug)]
pub struct LookupTable {
    axes: Vec<(String, Vec<f64>)>,
    columns: Vec<(String, Vec<f64>)>,
}

impl LookupTable {
    /// Returns the plan of a grid: a row for each of its points.
    ///
    /// # Arguments
    /// - `fixed`: other columns of the plan, with their value in every row.
    ///
    /// # Errors
    /// [`ExportError::Size`]: the grid has more points than a plan may have runs.
    pub fn plan(grid: &[Sweep], fixed: &[(&str, &str)]) -> Result<String, ExportError> {
        // Points are counted before they are made: a short request can ask for more than memory holds.
        let count = grid
            .iter()
            .fold(1_usize, |count, sweep| count.saturating_mul(sweep.values().len()));
        if count > MAX_RUNS {
            return Err(ExportError::Size {
                what: "points of the grid",
                count,
                max: MAX_RUNS as u64,
            });
        }
        let names = grid.iter().map(Sweep::name);
        let names: Vec<&str> = names.chain(fixed.iter().map(|(name, _)| *name)).collect();
        let mut rows = vec![String::new()];
        for sweep in grid {
            let longer = |row: &String| -> Vec<String> {
                sweep
                    .values()
                    .iter()
                    .map(|value| format!("{row}{value},"))
                    .collect()
            };
            rows = rows.iter().flat_map(longer).collect();
        }
        let fixed: Vec<&str> = fixed.iter().map(|(_, value)| *value).collect();
        let fixed = fixed.join(",");
        let rows: String = rows
            .iter()
            .map(|row| match fixed.is_empty() {
                true => format!("{}\n", row.trim_end_matches(',')),
                false => format!("{row}{fixed}\n"),
            })
            .collect();
        Ok(format!("{}\n{rows}", names.join(",")))
    }

    /// Returns the table of predictions of the runs of [`LookupTable::plan`], in their order.
    ///
    /// # Errors
    /// [`ExportError::Shape`]: there are more or fewer runs than points. Checked by `tests::a_table_has_the_points_of_its_grid`.
    pub fn new(grid: &[Sweep], prediction: &Prediction) -> Result<Self, ExportError> {
        let shape: Vec<usize> = grid.iter().map(|sweep| sweep.values().len()).collect();
        let runs = &prediction.runs;
        let points = shape.iter().product();
        if runs.len() != points {
            return Err(ExportError::Shape {
                name: "prediction".into(),
                shape,
                actual: runs.len(),
                expected: points,
            });
        }
        let mut names: Vec<&str> = Vec::new();
        for quantity in runs.iter().flat_map(|run| &run.quantities) {
            if !names.contains(&quantity.name.as_str()) {
                names.push(&quantity.name);
            }
        }
        let mut columns = Vec::new();
        for name in names {
            for (suffix, value) in PARTS {
                let at = |run: &PredictedRun| {
                    let quantity = run.quantities.iter().find(|q| q.name == name)?;
                    value(quantity)
                };
                let values: Vec<Option<f64>> = runs.iter().map(at).collect();
                if values.iter().any(Option::is_some) {
                    let values = values.into_iter().map(|value| value.unwrap_or(f64::NAN));
                    columns.push((format!("{name}{suffix}"), values.collect()));
                }
            }
        }
        let beyond = runs.iter().map(|run| f64::from(u8::from(!run.beyond.is_empty())));
        columns.push(("beyond".into(), beyond.collect()));
        let axes = grid
            .iter()
            .map(|sweep| (sweep.name().to_owned(), sweep.values().to_vec()));
        Ok(LookupTable {
            axes: axes.collect(),
            columns,
        })
    }

    /// Returns the table as CSV: a row for each point, columns of the grid first; an empty cell where nothing is predicted.
    pub fn csv(&self) -> String {
        let names = self
            .axes
            .iter()
            .chain(&self.columns)
            .map(|(name, _)| name.as_str());
        let mut text = names.collect::<Vec<_>>().join(",") + "\n";
        let points = self.columns.first().map_or(0, |(_, values)| values.len());
        for point in 0..points {
            let mut rest = point;
            let mut cells: Vec<String> = Vec::new();
            for (_, values) in self.axes.iter().rev() {
                cells.push(values[rest % values.len()].to_string());
                rest /= values.len();
            }
            cells.reverse();
            cells.extend(self.columns.iter().map(|(_, values)| match values[point] {
                value if value.is_nan() => String::new(),
                value => value.to_string(),
            }));
            text += &(cells.join(",") + "\n");
        }
        text
    }

    /// Returns the table as an archive of NumPy: an array for each quantity of the grid, and one over the grid for each column; NaN where
    /// nothing is predicted.
    ///
    /// # Errors
    /// [`ExportError::Archive`]: the archive cannot be written.
    ///
    /// # Source
    /// NumPy enhancement proposal 1, version 1.0 of the format. Checked by `tests/fmu`, where NumPy reads it.
    pub fn npz(&self) -> Result<Vec<u8>, ExportError> {
        let shape: Vec<usize> = self.axes.iter().map(|(_, values)| values.len()).collect();
        let axes = self
            .axes
            .iter()
            .map(|(name, values)| (name, values, vec![values.len()]));
        let columns = self
            .columns
            .iter()
            .map(|(name, values)| (name, values, shape.clone()));
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::DEFAULT);
        for (name, values, shape) in axes.chain(columns) {
            archive.start_file(format!("{name}.npy"), options)?;
            archive
                .write_all(&npy(values, &shape))
                .map_err(|e| ExportError::Archive(e.to_string()))?;
        }
        Ok(archive.finish()?.into_inner())
    }
}

/// Returns an array of 64-bit numbers as a file of NumPy.
fn npy(values: &[f64], shape: &[usize]) -> Vec<u8> {
    let shape: String = shape.iter().map(|length| format!("{length},")).collect();
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
    // Magic, version and length are 10 bytes; the header ends with a line end at a multiple of 64.
    let padding = 64 - (10 + header.len() + 1) % 64;
    header += &(" ".repeat(padding) + "\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantity(mean: f64) -> PredictedQuantity {
        PredictedQuantity {
            name: "drawbar_pull_n".into(),
            unit: "N".into(),
            mean,
            parameters: [mean - 1.0, mean + 1.0],
            measurement: None,
            models_mean: mean,
            models: [mean, mean],
            models_measurement: None,
            corrected: None,
            corrected_measurement: None,
        }
    }

    fn run(mean: Option<f64>) -> PredictedRun {
        PredictedRun {
            run: "p".into(),
            wheel: "w".into(),
            slip: 0.0,
            wheel_load_n: 1.0,
            sled_speed_m_s: 1.0,
            slip_angle_deg: 0.0,
            pass: 1,
            gravity_m_s2: 9.81,
            slope_deg: 0.0,
            beyond: Vec::new(),
            refused: None,
            quantities: mean.map(quantity).into_iter().collect(),
            statements: Vec::new(),
        }
    }

    fn prediction(means: &[Option<f64>]) -> Prediction {
        Prediction {
            calibration: 1,
            draws: 20,
            models: Vec::new(),
            runs: means.iter().copied().map(run).collect(),
            climbs: Vec::new(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn a_table_has_the_points_of_its_grid() {
        let grid = ["slip=0:0.5:2", "wheel_load_n=50:150:3"].map(|text| Sweep::read(text).unwrap());
        let plan = LookupTable::plan(&grid, &[("wheel", "w")]).unwrap();
        assert_eq!(
            plan,
            "slip,wheel_load_n,wheel\n0,50,w\n0,100,w\n0,150,w\n0.5,50,w\n0.5,100,w\n0.5,150,w\n"
        );
        assert_eq!(LookupTable::plan(&grid[..1], &[]).unwrap(), "slip\n0\n0.5\n");
        let means = [Some(1.0), Some(2.0), None, Some(4.0), Some(5.0), Some(6.0)];
        let table = LookupTable::new(&grid, &prediction(&means)).unwrap();
        let csv = table.csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(
            lines[0],
            "slip,wheel_load_n,drawbar_pull_n,drawbar_pull_n_low,drawbar_pull_n_high,beyond"
        );
        assert_eq!(lines[2], "0,100,2,1,3,0");
        assert_eq!(lines[3], "0,150,,,,0");
        let error = LookupTable::new(&grid, &prediction(&means[1..])).unwrap_err();
        assert!(error.to_string().contains("has 5 values"), "{error}");
    }

    #[test]
    fn the_header_of_an_array_ends_at_a_multiple_of_64() {
        for shape in [vec![3], vec![12, 5, 7, 100], vec![]] {
            let file = npy(&[], &shape);
            assert_eq!(file.len() % 64, 0);
            assert_eq!(file.last(), Some(&b'\n'));
        }
    }
}

//! An expected figure, and the model's result.

use scm::Averages;

/// A figure, in the unit that its quantity names.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    pub(crate) case: String,
    pub(crate) quantity: &'static str,
    pub(crate) expected: f64,
    pub(crate) got: f64,
    /// Largest difference allowed.
    pub(crate) tolerance: f64,
}

impl Row {
    /// Returns whether the figure is met; a NaN never is.
    pub(crate) fn passes(&self) -> bool {
        (self.got - self.expected).abs() <= self.tolerance
    }
}

/// Largest differences of drawbar pull, torque and sinkage: relative to load, to load times radius, to the sinkage.
pub(crate) type Bounds = [f64; 3];

/// Rows under construction.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    rows: Vec<Row>,
}

impl Rows {
    /// Adds a figure with its tolerance.
    pub(crate) fn add(
        &mut self,
        case: &str,
        quantity: &'static str,
        expected: f64,
        got: f64,
        tolerance: f64,
    ) {
        let case = case.to_owned();
        self.rows.push(Row {
            case,
            quantity,
            expected,
            got,
            tolerance,
        });
    }

    /// Adds a sinkage of which both figures are in metres, with a relative tolerance.
    pub(crate) fn add_sinkage(&mut self, case: &str, expected: f64, got: f64, tolerance: f64) {
        let (expected, got) = (1e3 * expected, 1e3 * got);
        self.add(case, "z [mm]", expected, got, tolerance * expected.abs());
    }

    /// Drawbar pull `[N]`, torque \[N m\] and sinkage `[m]` of a wheel of 125 mm under a load `[N]`.
    pub(crate) fn add_run(
        &mut self,
        case: &str,
        load: f64,
        expected: [f64; 3],
        got: &Averages,
        bounds: Bounds,
    ) {
        let [pull, torque, sinkage] = expected;
        self.add(case, "F [N]", pull, got.drawbar_pull_n, bounds[0] * load);
        self.add(case, "T [N m]", torque, got.torque_n_m, bounds[1] * load * 0.125);
        self.add_sinkage(case, sinkage, got.sinkage_m, bounds[2]);
    }

    pub(crate) fn into_rows(self) -> Vec<Row> {
        self.rows
    }
}

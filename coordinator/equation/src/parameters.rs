//! The parameters of a formula as coordinates of its fit, and their prior density.

use crate::answer::FittedFormula;
use crate::curve::LocatedCurve;
use crate::prior::{PARAMETERS, log_normal};
use crate::text::{FormulaText, ParameterKind};

impl FittedFormula {
    /// Returns the kinds of the parameters that belong to the constants, in their order.
    fn kinds(&self, curve: &LocatedCurve) -> impl Iterator<Item = ParameterKind> {
        let written = FormulaText::new(curve, self, "y", "x").parameters.into_iter();
        let kinds = written.map(|parameter| parameter.kind);
        // A parameter is written for each constant in their order, and a value at the end after them.
        kinds
            .filter(|kind| *kind != ParameterKind::Strength)
            .take(self.tree.constants)
    }

    /// Returns the values that belong to the constants.
    fn of_constants<'p>(&self, parameters: &'p [f64]) -> &'p [f64] {
        &parameters[usize::from(self.link.has_strength())..]
    }

    /// Returns the coordinates of a fit by the values of its parameters. Checked by `text::parameters_determine_a_formula`.
    ///
    /// # Arguments
    /// - `parameters`: in the order of [`FormulaText::parameters`].
    pub(crate) fn place_of(&self, curve: &LocatedCurve, parameters: &[f64]) -> [f64; PARAMETERS] {
        let problem = self.problem(curve);
        let fitted = self.constants(curve);
        let mut place = self.fit.place;
        for (k, (kind, value)) in self.kinds(curve).zip(self.of_constants(parameters)).enumerate() {
            let constant = match kind {
                // The sign of its constant stands in the formula.
                ParameterKind::Scale => libm::copysign(curve.scale / value, fitted[k]),
                ParameterKind::Shift | ParameterKind::Threshold => value / curve.scale,
                ParameterKind::Strength | ParameterKind::Exponent | ParameterKind::Factor => *value,
            };
            place[k + 1] = problem.coordinate(k, constant);
        }
        if self.link.has_strength() {
            place[0] = parameters[0] * problem.size(&place);
        }
        place
    }

    /// Returns the log density of the priors that [`fits`](crate::fits) has, at values of the parameters.
    ///
    /// # Arguments
    /// - `place`: the coordinates of these values.
    pub(crate) fn log_prior(
        &self,
        curve: &LocatedCurve,
        parameters: &[f64],
        place: &[f64; PARAMETERS],
    ) -> f64 {
        let problem = self.problem(curve);
        let of_strength = match self.link.has_strength() {
            true => log_normal(place[0], problem.strength_sd()) + libm::log(problem.size(place)),
            false => 0.0,
        };
        let kinds = self.kinds(curve).zip(self.of_constants(parameters));
        let of_constants = kinds.enumerate().map(|(k, (kind, value))| {
            // The derivative of the constant by the parameter.
            let slope = match kind {
                ParameterKind::Scale => curve.scale / (value * value),
                ParameterKind::Shift | ParameterKind::Threshold => 1.0 / curve.scale,
                ParameterKind::Strength | ParameterKind::Exponent | ParameterKind::Factor => 1.0,
            };
            problem.log_prior(place, k) + libm::log(slope)
        });
        of_strength + of_constants.sum::<f64>()
    }
}

//! Stiffness line: the moduli that agree with an independent test, in the figure of their joint posterior.

use std::collections::BTreeMap;

use inference::diagnostics;

use crate::finished_calibration::FinishedCalibration;
use crate::words::number;

/// The parameters of the figure that has the line.
pub(super) const MODULI: [&str; 2] = ["k_c", "k_phi"];

/// A labelled straight line.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct LabelledLine {
    /// Meaning in words.
    pub label: String,
    /// Two points of the line.
    pub points: [[f64; 2]; 2],
}

/// Returns the line `k_c / b + k_phi = k*` of all moduli that give the stiffness k* of an independent test under the wheel. The width b
/// is the mean effective width over the final draws.
pub(super) fn stiffness_line(
    sample: &FinishedCalibration,
    names: [&str; 2],
    range: [[f64; 2]; 2],
    reference: &BTreeMap<String, f64>,
) -> Option<LabelledLine> {
    if names != MODULI {
        return None;
    }
    let (k_c, k_phi) = (reference.get("k_c").unwrap_or(&0.0), reference.get("k_phi")?);
    let accepted = sample
        .predictive_draws()
        .iter()
        .filter_map(|d| d.fit.as_ref().ok());
    let widths: Vec<f64> = accepted.flat_map(|o| o.b_eff_m.iter().copied()).collect();
    let b = diagnostics::mean(&widths).filter(|b| *b > 0.0)?;
    let k_star = k_c / b + k_phi;
    Some(LabelledLine {
        label: format!(
            "k* = {} N/m^(n+2) at b = {:.1} mm",
            number::significant(k_star, 3),
            1e3 * b
        ),
        points: range[0].map(|x| [x, k_star - x / b]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_line_of_k_star_has_the_mean_width_s_slope() {
        let mut calibration = fixture::calibration();
        for (k, draw) in calibration.predictions.iter_mut().enumerate() {
            if let Ok(o) = &mut draw.fit {
                // The first prediction is that of the most probable parameters, which is not a random draw.
                o.b_eff_m = vec![if k == 0 { 9.0 } else { 0.02 }, if k == 0 { 9.0 } else { 0.03 }];
            }
        }
        let reference = BTreeMap::from([("k_c".to_owned(), 0.0), ("k_phi".to_owned(), 1e7)]);
        let range = [[-1e5, 1e5], [0.0, 1e8]];
        let line = stiffness_line(&calibration, MODULI, range, &reference).unwrap();
        assert_eq!(line.label, "k* = 1.00e7 N/m^(n+2) at b = 25.0 mm");
        // The line is k_phi = 1e7 - k_c / 0.025.
        let expected = [[-1e5, 1.4e7], [1e5, 6e6]];
        for (point, expected) in line.points.iter().zip(expected) {
            assert!((point[0] - expected[0]).abs() < 1e-6 && (point[1] - expected[1]).abs() < 1e-3);
        }
        assert_eq!(
            stiffness_line(&calibration, ["n", "wheel_radius_m"], range, &reference),
            None
        );
    }
}

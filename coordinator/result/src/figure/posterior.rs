//! Joint densities of two parameters, with point estimates and reference values: the source paper's Fig. 6.

use std::collections::BTreeMap;

use inference::diagnostics;

use super::axis_parameter::AxisParameter;
use super::mark::{Mark, MarkKind, PlanePoint};
use super::reference;
use super::thinned::{five_digits, thinned_draws};
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;
use crate::words::number;

/// The pairs that the source paper shows.
const PAPER: [[&str; 2]; 3] = [
    ["k_c", "k_phi"],
    ["n", "friction_angle_deg"],
    ["n", "wheel_radius_m"],
];
const GRID: usize = 32;
/// Most pairs of all: those of ten parameters.
const PAIRS: usize = 45;
/// Shares of the posterior that the contours enclose.
const SHARES: [f64; 5] = [0.95, 0.8, 0.6, 0.4, 0.2];
/// The grid reaches this share of the draws' range beyond them.
const MARGIN: f64 = 0.15;

/// The joint posterior density of two parameters.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct JointPosterior {
    /// The parameters, the horizontal one first.
    pub parameters: [AxisParameter; 2],
    /// Draws that the density is estimated from, equally weighted.
    pub draws: usize,
    /// Ends of both axes: density and marks lie within.
    pub range: [[f64; 2]; 2],
    /// Values of each parameter at which the density is given.
    pub grid: [Vec<f64>; 2],
    /// Density over its highest value, rounded to 1e-4; one row for each value of the second parameter.
    pub density: Vec<Vec<f64>>,
    /// The highest density, in 1 over the product of the units.
    pub highest: f64,
    /// Contours, the widest first.
    pub contours: Vec<Contour>,
    /// Rank correlation of the draws.
    pub rank_correlation: f64,
    /// Single points.
    pub marks: Vec<Mark<PlanePoint>>,
    /// Lines with a meaning.
    pub lines: Vec<LabelledLine>,
}

/// A highest-density contour.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Contour {
    /// Share of the posterior that it encloses.
    pub share: f64,
    /// Density over its highest value there.
    pub density: f64,
}

/// A straight line with a meaning.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct LabelledLine {
    /// Its meaning.
    pub label: String,
    /// Two points of it.
    pub points: [[f64; 2]; 2],
}

/// All pairs of parameters in the order of the job; where those are more than [`PAIRS`], the most correlated. Estimated from a part of
/// many draws, so that the cost has a bound. Pairs whose draws lie on a line have no density and are left out.
pub(super) fn all(study: &Study, sample: &FinishedCalibration) -> Vec<JointPosterior> {
    let draws = thinned_draws(sample);
    let correlation =
        |[i, j]: [usize; 2]| diagnostics::rank_correlation(&draws[i], &draws[j]).map_or(0.0, f64::abs);
    let pairs = (0..draws.len()).flat_map(|i| (i + 1..draws.len()).map(move |j| [i, j]));
    let mut pairs: Vec<([usize; 2], f64)> = pairs.map(|pair| (pair, correlation(pair))).collect();
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    pairs.truncate(PAIRS);
    pairs.sort_by_key(|(pair, _)| *pair);
    let reference = reference::values(&sample.spec);
    let joint = |(pair, _)| posterior(study, sample, &draws, pair, &reference);
    pairs
        .into_iter()
        .filter_map(joint)
        .map(JointPosterior::rounded)
        .collect()
}

impl JointPosterior {
    /// With five digits of each density, which are more than a picture shows. Places keep all of theirs: a narrow posterior may lie
    /// within the fifth.
    fn rounded(mut self) -> Self {
        self.highest = five_digits(self.highest);
        for contour in &mut self.contours {
            contour.density = five_digits(contour.density);
        }
        self.rank_correlation = five_digits(self.rank_correlation);
        self
    }
}

fn posterior(
    study: &Study,
    sample: &FinishedCalibration,
    draws: &[Vec<f64>],
    pair: [usize; 2],
    reference: &BTreeMap<String, f64>,
) -> Option<JointPosterior> {
    let parameters = pair.map(|i| &sample.spec.parameters[i]);
    let values = pair.map(|i| draws[i].as_slice());
    let support = parameters.map(|p| p.marginal.support());
    let ends = [0, 1].map(|i| ends(values[i], support[i]));
    let grid = ends.map(|[low, high]| -> Vec<f64> {
        let step = (high - low) / (GRID - 1) as f64;
        // the last point to the bit: a step beyond a bound there would be no density
        let inner = (0..GRID - 1).map(|k| low + step * k as f64);
        inner.chain(std::iter::once(high)).collect()
    });
    let density = diagnostics::joint_density(values, support, [&grid[0], &grid[1]])?;
    let highest = density.iter().copied().fold(0.0, f64::max);
    let levels = diagnostics::highest_density_levels(&density, &SHARES);
    let marks = marks(study, sample, pair, reference);
    let mut range = ends;
    for mark in &marks {
        for (end, at) in range.iter_mut().zip([mark.at.x, mark.at.y]) {
            if let Some(at) = at {
                *end = [end[0].min(at), end[1].max(at)];
            }
        }
    }
    let contour = |(&share, level): (&f64, f64)| Contour {
        share,
        density: level / highest,
    };
    Some(JointPosterior {
        parameters: parameters.map(AxisParameter::from),
        draws: values[0].len(),
        range,
        density: density
            .chunks(GRID)
            .map(|row| row.iter().map(|f| round(f / highest)).collect())
            .collect(),
        grid,
        highest,
        contours: SHARES.iter().zip(levels).map(contour).collect(),
        rank_correlation: diagnostics::rank_correlation(values[0], values[1])?,
        marks,
        lines: stiffness_line(sample, parameters.map(|p| p.name.as_str()), range, reference)
            .into_iter()
            .collect(),
    })
}

fn round(share: f64) -> f64 {
    libm::round(share * 1e4) / 1e4
}

/// Ends of the grid: around the draws, within the support.
fn ends(values: &[f64], (lower, upper): (f64, f64)) -> [f64; 2] {
    let min = values.iter().copied().fold(f64::INFINITY, f64::min);
    let max = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let margin = MARGIN * (max - min);
    [(min - margin).max(lower), (max + margin).min(upper)]
}

fn marks(
    study: &Study,
    sample: &FinishedCalibration,
    pair: [usize; 2],
    reference: &BTreeMap<String, f64>,
) -> Vec<Mark<PlanePoint>> {
    let names = pair.map(|i| sample.spec.parameters[i].name.as_str());
    let mut marks = Vec::new();
    if let Some(draw) = sample.likeliest() {
        let at = pair.map(|i| Some(draw.theta[i]));
        marks.push(Mark::new(
            MarkKind::MaximumLikelihood,
            "maximum likelihood",
            at.into(),
        ));
    }
    for (label, calibration) in study.optima_beside(sample) {
        let value = |name: &str| {
            let place = calibration.spec.parameters.iter().position(|p| p.name == name)?;
            Some(calibration.estimate()?.theta[place])
        };
        marks.push(Mark::new(MarkKind::PointEstimate, label, names.map(value).into()));
    }
    let at = names.map(|name| reference.get(name).copied());
    // k_c and k_phi alone are no measurement: only k* is, which is a line.
    if at != [None, None] && names != PAPER[0] {
        marks.push(Mark::new(MarkKind::Reference, "bevameter", at.into()));
    }
    marks
}

/// The moduli that give the stiffness k* of an independent test under the wheel: `k_c / b + k_phi = k*`, b the mean effective
/// width over the final draws.
fn stiffness_line(
    sample: &FinishedCalibration,
    names: [&str; 2],
    range: [[f64; 2]; 2],
    reference: &BTreeMap<String, f64>,
) -> Option<LabelledLine> {
    if names != PAPER[0] {
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
                // the first draw is the most probable one, which is no random draw
                o.b_eff_m = vec![if k == 0 { 9.0 } else { 0.02 }, if k == 0 { 9.0 } else { 0.03 }];
            }
        }
        let reference = BTreeMap::from([("k_c".to_owned(), 0.0), ("k_phi".to_owned(), 1e7)]);
        let range = [[-1e5, 1e5], [0.0, 1e8]];
        let line = stiffness_line(&calibration, PAPER[0], range, &reference).unwrap();
        assert_eq!(line.label, "k* = 1.00e7 N/m^(n+2) at b = 25.0 mm");
        // 1e7 - k_c / 0.025
        let expected = [[-1e5, 1.4e7], [1e5, 6e6]];
        for (point, expected) in line.points.iter().zip(expected) {
            assert!((point[0] - expected[0]).abs() < 1e-6 && (point[1] - expected[1]).abs() < 1e-3);
        }
        assert_eq!(stiffness_line(&calibration, PAPER[1], range, &reference), None);
    }

    #[test]
    fn marks_carry_what_is_known_and_the_range_holds_them() {
        let mut study = fixture::study();
        study.lead.spec.reference = BTreeMap::from([("friction_angle_deg".to_owned(), 50.0)]);
        let pairs = all(&study, &study.lead);
        let is_paper_s =
            |pair: &&JointPosterior| pair.parameters.each_ref().map(|p| p.name.as_str()) == PAPER[1];
        let pair = pairs.iter().find(is_paper_s).expect("the job has both");
        let kinds: Vec<MarkKind> = pair.marks.iter().map(|m| m.kind).collect();
        let all = [
            MarkKind::MaximumLikelihood,
            MarkKind::PointEstimate,
            MarkKind::Reference,
        ];
        assert_eq!(kinds, all);
        assert_eq!(pair.marks[2].at, [None, Some(50.0)].into());
        assert_eq!(pair.marks[1].label, "GA optimum");
        assert!(pair.range[1][1] >= 50.0 && *pair.grid[1].last().unwrap() <= 45.0);
        assert_eq!((pair.density.len(), pair.density[0].len()), (GRID, GRID));
        let shares: Vec<f64> = pair.contours.iter().map(|c| c.density).collect();
        assert!(
            shares.is_sorted() && shares.iter().all(|s| (0.0..=1.0).contains(s)),
            "{shares:?}"
        );
    }
}

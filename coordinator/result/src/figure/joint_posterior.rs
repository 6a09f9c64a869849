//! Figure of the joint density of each pair of parameters, with point estimates and reference values (the source paper's Fig. 6).

use std::collections::BTreeMap;

use inference::diagnostics;

use super::axis_parameter::AxisParameter;
use super::mark::{Mark, MarkKind, PlanePoint};
use super::reference;
use super::stiffness_line::{LabelledLine, MODULI, stiffness_line};
use super::thinned::{five_digits, thinned_draws};
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

const GRID: usize = 32;
/// Maximum number of pairs: all pairs of ten parameters.
const MAX_PAIRS: usize = 45;
/// Shares of the posterior that the contours enclose.
const SHARES: [f64; 5] = [0.95, 0.8, 0.6, 0.4, 0.2];
/// Margin of the grid on each side, as a share of the range of the draws.
const MARGIN: f64 = 0.15;

/// The joint posterior density of two parameters.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct JointPosterior {
    /// The parameters, the horizontal one first.
    pub parameters: [AxisParameter; 2],
    /// Number of equally weighted draws that the density is estimated from.
    pub draws: usize,
    /// Ends of both axes, which contain the density and all marks.
    pub range: [[f64; 2]; 2],
    /// Values of each parameter at which the density is given.
    pub grid: [Vec<f64>; 2],
    /// Density divided by its maximum, rounded to 1e-4; one row for each value of the second parameter.
    pub density: Vec<Vec<f64>>,
    /// Maximum of the density, in 1 over the product of the units.
    pub highest: f64,
    /// Contours, the widest first.
    pub contours: Vec<Contour>,
    /// Rank correlation of the draws, -1 to 1.
    pub rank_correlation: f64,
    /// Labelled points.
    pub marks: Vec<Mark<PlanePoint>>,
    /// Labelled lines.
    pub lines: Vec<LabelledLine>,
}

/// A highest-density contour.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct Contour {
    /// Share of the posterior that it encloses.
    pub share: f64,
    /// Density on the contour divided by the maximum.
    pub density: f64,
}

/// Returns the joint density of each pair of parameters in the order of the job, or of the [`MAX_PAIRS`] most correlated pairs. At most a
/// fixed number of draws enters, which bounds the cost. Pairs whose draws lie on a line have no density and are left out.
pub(super) fn all(study: &Study, sample: &FinishedCalibration) -> Vec<JointPosterior> {
    let draws = thinned_draws(sample);
    let correlation =
        |[i, j]: [usize; 2]| diagnostics::rank_correlation(&draws[i], &draws[j]).map_or(0.0, f64::abs);
    let pairs = (0..draws.len()).flat_map(|i| (i + 1..draws.len()).map(move |j| [i, j]));
    let mut pairs: Vec<([usize; 2], f64)> = pairs.map(|pair| (pair, correlation(pair))).collect();
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    pairs.truncate(MAX_PAIRS);
    pairs.sort_by_key(|(pair, _)| *pair);
    let reference = reference::values(&sample.spec);
    let joint = |(pair, _)| joint_posterior(study, sample, &draws, pair, &reference);
    pairs
        .into_iter()
        .filter_map(joint)
        .map(JointPosterior::rounded)
        .collect()
}

impl JointPosterior {
    /// Rounds densities to five digits, which are more than a figure shows. Coordinates keep all digits, because a narrow posterior may
    /// lie within the fifth.
    fn rounded(mut self) -> Self {
        self.highest = five_digits(self.highest);
        for contour in &mut self.contours {
            contour.density = five_digits(contour.density);
        }
        self.rank_correlation = five_digits(self.rank_correlation);
        self
    }
}

fn joint_posterior(
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
        // The last point is exactly the upper end. Rounding could put a computed point beyond the bound, where the density is 0.
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

/// Returns the ends of the grid: the range of the draws with a margin, limited to the support.
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
    // An independent test measures k*, which is a line in the plane of k_c and k_phi, not a point.
    if at != [None, None] && names != MODULI {
        marks.push(Mark::new(MarkKind::Reference, "bevameter", at.into()));
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn marks_carry_what_is_known_and_the_range_holds_them() {
        let mut study = fixture::study();
        study.lead.spec.reference = BTreeMap::from([("friction_angle_deg".to_owned(), 50.0)]);
        let pairs = all(&study, &study.lead);
        let is_searched = |pair: &&JointPosterior| {
            pair.parameters.each_ref().map(|p| p.name.as_str()) == ["n", "friction_angle_deg"]
        };
        let pair = pairs.iter().find(is_searched).expect("the job has both");
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

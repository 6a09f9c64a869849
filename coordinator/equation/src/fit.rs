//! The fit of one formula to a curve, and its evidence by Laplace's approximation.

use nalgebra::{Matrix4, Vector4};

use crate::curve::LocatedCurve;
use crate::link::Link;
use crate::prior::{CONSTANT_SD, PARAMETERS, STRENGTH_SD, log_normal};
use crate::program::{ConstantRole, Program};
use crate::start::starts;
use crate::tree::CONSTANTS;

/// Starts from which a fit begins.
const BEGUN: usize = 3;
const FIRST_STEPS: usize = 5;
const STEPS: usize = 30;
/// A fit ends where a step gains less.
const LEAST_GAIN: f64 = 1e-5;
const FIRST_DAMPING: f64 = 1e-2;
const MAX_DAMPING: f64 = 1e8;

/// A formula, fitted to a curve.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// Strength, in units of the formula's root mean square, and coordinates of the constants. A link without a strength has 1 in its place.
    pub(crate) place: [f64; PARAMETERS],
    pub(crate) log_evidence: f64,
    /// Half the squares of residuals.
    pub(crate) misfit: f64,
    pub(crate) covariance: Matrix4<f64>,
}

/// A formula with what it is fitted to.
pub(crate) struct Problem<'a> {
    pub(crate) curve: &'a LocatedCurve,
    pub(crate) program: &'a Program,
    pub(crate) link: Link,
}

/// Residuals and derivatives at one place.
struct Slope {
    objective: f64,
    gradient: Vector4<f64>,
    hessian: Matrix4<f64>,
}

impl Problem<'_> {
    /// Returns the constants of coordinates: sinh of a coefficient's, the exponent itself, a threshold within the range.
    pub(crate) fn constants(&self, place: &[f64; PARAMETERS]) -> [f64; CONSTANTS] {
        let mut constants = [0.0; CONSTANTS];
        for (k, role) in self.program.roles.iter().enumerate() {
            constants[k] = match role {
                ConstantRole::Coefficient => libm::sinh(place[k + 1]),
                ConstantRole::Exponent | ConstantRole::Threshold => place[k + 1],
            };
        }
        constants
    }

    /// Returns the derivatives of the constants by their coordinates.
    fn stretches(&self, place: &[f64; PARAMETERS]) -> [f64; CONSTANTS] {
        let mut stretches = [1.0; CONSTANTS];
        for (k, role) in self.program.roles.iter().enumerate() {
            if *role == ConstantRole::Coefficient {
                stretches[k] = libm::cosh(place[k + 1]);
            }
        }
        stretches
    }

    pub(crate) fn strength_sd(&self) -> f64 {
        STRENGTH_SD * self.curve.size.max(f64::MIN_POSITIVE)
    }

    /// Half the squares of the coordinates over their prior sds.
    fn penalty(&self, place: &[f64; PARAMETERS]) -> f64 {
        let strength = match self.link.has_strength() {
            true => place[0] / self.strength_sd(),
            false => 0.0,
        };
        let fitted = self.program.roles.iter().zip(&place[1..]);
        let fitted = fitted.filter(|(role, _)| **role != ConstantRole::Threshold);
        let squares: f64 = fitted.map(|(_, t)| (t / CONSTANT_SD) * (t / CONSTANT_SD)).sum();
        0.5 * (strength * strength + squares)
    }

    /// Returns the values of the formula over their root mean square, and that; of a link without a strength the values alone, and 1.
    fn shape(&self, constants: &[f64; CONSTANTS]) -> Option<(Vec<f64>, f64)> {
        let at_end = self.at_end(constants);
        let points = self.curve.points.iter();
        let value = |x: &f64| self.link.anchored(self.program.value(*x, constants), at_end);
        let mut values: Vec<f64> = points.map(value).collect();
        let size = root_mean_square(values.iter().copied())?;
        if !self.link.has_strength() {
            return Some((values, 1.0));
        }
        values.iter_mut().for_each(|value| *value /= size);
        Some((values, size))
    }

    /// Returns the formula's value at the end at which it vanishes; 0 without an end.
    pub(crate) fn at_end(&self, constants: &[f64; CONSTANTS]) -> f64 {
        let end = self.link.end();
        end.map_or(0.0, |end| end.value(self.program, constants))
    }

    fn linked(&self, value: f64) -> f64 {
        match self.link {
            Link::Relative => libm::log(1.0 + value),
            _ => value,
        }
    }

    fn misfit(&self, strength: f64, shape: &[f64]) -> f64 {
        let predicted: Vec<f64> = shape.iter().map(|g| self.linked(strength * g)).collect();
        let whitened = self.curve.whiten(&predicted);
        let pairs = whitened.iter().zip(&self.curve.whitened);
        let squares: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
        if squares.is_finite() {
            0.5 * squares
        } else {
            f64::INFINITY
        }
    }

    /// Completes a start by the best strength, and returns it with its objective.
    fn start(&self, mut place: [f64; PARAMETERS]) -> Option<(f64, [f64; PARAMETERS])> {
        let (shape, _) = self.shape(&self.constants(&place))?;
        if !self.link.has_strength() {
            place[0] = 1.0;
            let objective = self.misfit(1.0, &shape) + self.penalty(&place);
            return objective.is_finite().then_some((objective, place));
        }
        let whitened = self.curve.whiten(&shape);
        let least = 1.0 / (self.strength_sd() * self.strength_sd());
        let target = match self.link {
            Link::Relative => {
                let changes: Vec<f64> = self.curve.values.iter().map(|y| libm::expm1(*y)).collect();
                self.curve.whiten(&changes)
            }
            _ => self.curve.whitened.clone(),
        };
        let products: f64 = whitened.iter().zip(&target).map(|(a, b)| a * b).sum();
        let squares: f64 = whitened.iter().map(|a| a * a).sum();
        place[0] = products / (squares + least);
        if self.link == Link::Relative {
            // The factor stays positive.
            let lowest = shape.iter().fold(0.0_f64, |lowest, g| lowest.min(place[0] * g));
            place[0] *= (0.9 / -lowest).min(1.0);
        }
        let objective = self.misfit(place[0], &shape) + self.penalty(&place);
        objective.is_finite().then_some((objective, place))
    }

    /// Fits the formula; `None` where it is undefined or has a pole within the range from every start.
    pub(crate) fn fit(&self) -> Option<Fit> {
        let mut starts: Vec<(f64, [f64; PARAMETERS])> = starts(&self.program.roles, &self.curve.points)
            .into_iter()
            .filter_map(|place| self.start(place))
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.truncate(BEGUN);
        let mut fits: Vec<_> = starts
            .into_iter()
            .filter_map(|(_, place)| self.descended(place, FIRST_STEPS))
            .filter(|(place, _)| self.is_regular(place))
            .collect();
        fits.sort_by(|a, b| a.1.objective.total_cmp(&b.1.objective));
        let (place, _) = fits.into_iter().next()?;
        let (place, slope) = self.descended(place, STEPS)?;
        if !self.is_regular(&place) {
            return None;
        }
        self.described(place, &slope)
    }

    /// Describes a fit at a place; `None` where the curve does not determine it.
    fn described(&self, place: [f64; PARAMETERS], slope: &Slope) -> Option<Fit> {
        let cholesky = slope.hessian.cholesky()?;
        let log_root: f64 = (0..PARAMETERS).map(|k| libm::log(cholesky.l()[(k, k)])).sum();
        let roles = self.program.roles.iter();
        let widths: f64 = roles
            .map(|role| match role {
                // One gap of all: the curve does not say where within it.
                ConstantRole::Threshold => libm::log((self.curve.points.len() - 1) as f64),
                _ => libm::log(CONSTANT_SD),
            })
            .sum();
        let (shape, _) = self.shape(&self.constants(&place))?;
        let mut covariance = cholesky.inverse();
        let strength_width = match self.link.has_strength() {
            true => libm::log(self.strength_sd()),
            false => {
                covariance[(0, 0)] = 0.0;
                0.0
            }
        };
        Some(Fit {
            place,
            log_evidence: -slope.objective - strength_width - widths - log_root,
            misfit: self.misfit(place[0], &shape),
            covariance,
        })
    }

    /// Describes the formula at a place that other data determined; `None` where it is undefined or has a pole within the range.
    pub(crate) fn at(&self, place: [f64; PARAMETERS]) -> Option<Fit> {
        let slope = self.is_regular(&place).then(|| self.slope(&place))??;
        self.described(place, &slope)
    }

    /// Descends by damped Gauss–Newton steps (Levenberg 1944, Marquardt 1963).
    fn descended(&self, start: [f64; PARAMETERS], steps: usize) -> Option<([f64; PARAMETERS], Slope)> {
        let mut place = start;
        let mut slope = self.slope(&place)?;
        let mut damping = FIRST_DAMPING;
        for _ in 0..steps {
            let mut damped = slope.hessian;
            for k in 0..PARAMETERS {
                damped[(k, k)] *= 1.0 + damping;
            }
            let step = damped.cholesky()?.solve(&slope.gradient);
            let mut next = place;
            for (value, by) in next.iter_mut().zip(step.iter()) {
                *value -= by;
            }
            match self
                .slope(&next)
                .filter(|reached| reached.objective < slope.objective)
            {
                Some(reached) => {
                    let gain = slope.objective - reached.objective;
                    (place, slope) = (next, reached);
                    damping *= 0.1;
                    if gain < LEAST_GAIN {
                        break;
                    }
                }
                None if damping > MAX_DAMPING => break,
                None => damping = (10.0 * damping).max(FIRST_DAMPING),
            }
        }
        Some((place, slope))
    }

    /// Returns the objective with its gradient and Gauss–Newton matrix; the unit matrix beyond the formula's parameters.
    fn slope(&self, place: &[f64; PARAMETERS]) -> Option<Slope> {
        let (constants, stretches) = (self.constants(place), self.stretches(place));
        let at_end = self.link.at_end(self.program, &constants);
        let points = self.curve.points.iter();
        let duals = points.map(|x| self.link.anchored_dual(self.program.dual(*x, &constants), at_end));
        let duals: Vec<_> = duals.collect();
        let count = duals.len() as f64;
        let mut size = root_mean_square(duals.iter().map(|dual| dual.value))?;
        let used = self.program.roles.len();
        let mut size_by = [0.0; CONSTANTS];
        if !self.link.has_strength() {
            size = 1.0;
        }
        for (k, by) in size_by
            .iter_mut()
            .enumerate()
            .take(if self.link.has_strength() { used } else { 0 })
        {
            *by = duals.iter().map(|dual| dual.value * dual.by[k]).sum::<f64>() / (size * count);
        }
        let mut predicted = Vec::with_capacity(duals.len());
        let mut columns: [Vec<f64>; PARAMETERS] = std::array::from_fn(|_| Vec::with_capacity(duals.len()));
        for dual in &duals {
            let shape = dual.value / size;
            let inner = place[0] * shape;
            let link_slope = match self.link {
                Link::Relative => 1.0 / (1.0 + inner),
                _ => 1.0,
            };
            predicted.push(self.linked(inner));
            columns[0].push(link_slope * shape);
            for k in 0..used {
                let shape_by = (dual.by[k] - shape * size_by[k]) / size;
                columns[k + 1].push(link_slope * place[0] * shape_by * stretches[k]);
            }
        }
        let whitened = self.curve.whiten(&predicted);
        let residuals: Vec<f64> = whitened
            .iter()
            .zip(&self.curve.whitened)
            .map(|(a, b)| a - b)
            .collect();
        let columns: Vec<Vec<f64>> = columns[..=used]
            .iter()
            .map(|column| self.curve.whiten(column))
            .collect();
        let (mut gradient, mut hessian) = (Vector4::zeros(), Matrix4::identity());
        let is_fixed = |j: usize| match j {
            0 => !self.link.has_strength(),
            j => self.program.roles[j - 1] == ConstantRole::Threshold,
        };
        for (j, column) in columns.iter().enumerate() {
            if is_fixed(j) {
                continue;
            }
            let sd = if j == 0 { self.strength_sd() } else { CONSTANT_SD };
            gradient[j] = dot(column, &residuals) + place[j] / (sd * sd);
            for k in (0..=j).filter(|k| !is_fixed(*k)) {
                hessian[(j, k)] = dot(column, &columns[k]);
                hessian[(k, j)] = hessian[(j, k)];
            }
            hessian[(j, j)] += 1.0 / (sd * sd);
        }
        let objective = 0.5 * dot(&residuals, &residuals) + self.penalty(place);
        let is_finite = objective.is_finite()
            && hessian
                .iter()
                .chain(gradient.iter())
                .all(|value| value.is_finite());
        is_finite.then_some(Slope {
            objective,
            gradient,
            hessian,
        })
    }

    /// Returns whether the law is defined over the whole range: no divisor changes its sign, and a factor stays positive.
    pub(crate) fn is_regular(&self, place: &[f64; PARAMETERS]) -> bool {
        let constants = self.constants(place);
        let Some((_, size)) = self.shape(&constants) else {
            return false;
        };
        let at_end = self.at_end(&constants);
        let anchored = self
            .link
            .anchored_values(self.program, &constants, &self.curve.points);
        if anchored.is_none() {
            return false;
        }
        let mut signs: Vec<f64> = Vec::new();
        self.curve.grid.iter().all(|x| {
            let (mut index, mut is_pole) = (0, false);
            let value = self.program.guarded(*x, &constants, &mut |divisor| {
                if index == signs.len() {
                    signs.push(divisor);
                }
                is_pole |= divisor * signs[index] <= 0.0;
                index += 1;
            });
            !is_pole
                && self
                    .linked(place[0] * self.link.anchored(value, at_end) / size)
                    .is_finite()
        })
    }

    /// Returns the law at a point of the variable over its scale; for a factor its logarithm. NaN where it is undefined.
    pub(crate) fn law(&self, place: &[f64; PARAMETERS], size: f64, x: f64) -> f64 {
        let constants = self.constants(place);
        let value = self
            .link
            .anchored(self.program.value(x, &constants), self.at_end(&constants));
        self.linked(place[0] * value / size)
    }

    /// Returns the law at the points at which formulas are compared.
    pub(crate) fn on_grid(&self, place: &[f64; PARAMETERS]) -> Vec<f64> {
        let size = self.size(place);
        let grid = self.curve.grid.iter();
        grid.map(|x| self.law(place, size, *x)).collect()
    }

    /// Returns the log prior density of a constant: of a threshold it is uniform over the range, all over the scale of the variable.
    ///
    /// # Arguments
    /// - `constant`: its index.
    pub(crate) fn log_prior(&self, place: &[f64; PARAMETERS], constant: usize) -> f64 {
        let coordinate = place[constant + 1];
        let points = &self.curve.points;
        let of_normal = log_normal(coordinate, CONSTANT_SD);
        match self.program.roles[constant] {
            ConstantRole::Coefficient => of_normal - libm::log(self.stretches(place)[constant]),
            ConstantRole::Exponent => of_normal,
            ConstantRole::Threshold => -libm::log(points[points.len() - 1] - points[0]),
        }
    }

    /// Returns the coordinate of a constant.
    pub(crate) fn coordinate(&self, constant: usize, value: f64) -> f64 {
        match self.program.roles[constant] {
            ConstantRole::Coefficient => libm::asinh(value),
            ConstantRole::Exponent | ConstantRole::Threshold => value,
        }
    }

    /// Returns the root mean square of the formula over the points of the curve.
    pub(crate) fn size(&self, place: &[f64; PARAMETERS]) -> f64 {
        self.shape(&self.constants(place))
            .map_or(f64::NAN, |(_, size)| size)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the root mean square; `None` where it is 0 or not finite.
fn root_mean_square(values: impl ExactSizeIterator<Item = f64>) -> Option<f64> {
    let count = values.len() as f64;
    let size = (values.map(|value| value * value).sum::<f64>() / count).sqrt();
    (size > 1e-12 && size < 1e12).then_some(size)
}

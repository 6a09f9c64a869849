//! `SurfaceDesign`: the least-squares problem of a response surface at a set of points, which many outputs share.

use nalgebra::DMatrix;

use super::degree::Degree;
use super::error::ResponseSurfaceError;

/// The smallest admissible ratio of the diagonal elements of R: below it the points do not determine every term.
const MIN_PIVOT_RATIO: f64 = 1e-10;
/// The smallest admissible weight of a point that is left out, 1 − h.
const MIN_LEFT_OUT: f64 = 1e-9;

/// A factorised least-squares problem.
///
/// # Equation
/// X = Q R with the terms of each point as a row of X. The coefficients of outputs y are R⁻¹ Qᵀ y, and the leverage h of a point is the
/// sum of squares of its row of Q. The error at a point that is left out of the fit is (y − f) / (1 − h), with the fit f to all points
/// (Allen 1974, doi:10.1080/00401706.1974.10489157); no other fit is needed for it.
#[derive(Debug, Clone)]
pub struct SurfaceDesign {
    q: DMatrix<f64>,
    r: DMatrix<f64>,
    leverages: Vec<f64>,
}

/// The surface of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSurface {
    /// Coefficients in the order of [`Degree::terms`], in the unit of the output.
    pub coefficients: Vec<f64>,
    /// Error of the surface at each point when the point is left out of the fit, in the unit of the output.
    pub left_out_errors: Vec<f64>,
}

impl SurfaceDesign {
    /// Factorises the problem at the given points.
    ///
    /// # Arguments
    /// - `points`: distinct points in [whitened](super::Whitening) coordinates.
    ///
    /// # Errors
    /// [`ResponseSurfaceError::TooFewDraws`] with fewer points than [`Degree::min_draws`]; [`ResponseSurfaceError::Dependent`] if the points
    /// do not determine every term.
    pub fn new(points: &[Vec<f64>], degree: Degree) -> Result<Self, ResponseSurfaceError> {
        let parameters = points.first().map_or(0, Vec::len);
        let needed = degree.min_draws(parameters);
        if points.len() < needed {
            return Err(ResponseSurfaceError::TooFewDraws {
                parameters,
                draws: points.len(),
                needed,
            });
        }
        let rows: Vec<f64> = points.iter().flat_map(|point| degree.terms(point)).collect();
        let terms = degree.term_count(parameters);
        let (q, r) = DMatrix::from_row_slice(points.len(), terms, &rows).qr().unpack();
        let pivots: Vec<f64> = r.diagonal().iter().map(|x| x.abs()).collect();
        let largest = pivots.iter().copied().fold(0.0, f64::max);
        let leverages: Vec<f64> = (0..points.len())
            .map(|i| q.row(i).iter().map(|x| x * x).sum())
            .collect();
        let is_determined = pivots.iter().all(|pivot| *pivot > MIN_PIVOT_RATIO * largest);
        let can_be_left_out = leverages.iter().all(|h| 1.0 - h > MIN_LEFT_OUT);
        if !(is_determined && can_be_left_out) {
            return Err(ResponseSurfaceError::Dependent { parameters });
        }
        Ok(SurfaceDesign { q, r, leverages })
    }

    /// Fits the surface of one output.
    ///
    /// # Arguments
    /// - `outputs`: value of the output at each point of the design.
    #[must_use]
    pub fn fit(&self, outputs: &[f64]) -> OutputSurface {
        let terms = self.r.ncols();
        let projected: Vec<f64> = (0..terms)
            .map(|k| self.q.column(k).iter().zip(outputs).map(|(q, y)| q * y).sum())
            .collect();
        let mut coefficients = vec![0.0; terms];
        for k in (0..terms).rev() {
            let after: f64 = (k + 1..terms).map(|l| self.r[(k, l)] * coefficients[l]).sum();
            coefficients[k] = (projected[k] - after) / self.r[(k, k)];
        }
        let left_out_error = |(i, y): (usize, &f64)| {
            let fitted: f64 = (0..terms).map(|k| self.q[(i, k)] * projected[k]).sum();
            (y - fitted) / (1.0 - self.leverages[i])
        };
        OutputSurface {
            coefficients,
            left_out_errors: outputs.iter().enumerate().map(left_out_error).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use statistics::rng::Stream;

    use super::*;

    /// Returns standard normal points.
    fn points(count: usize, parameters: usize) -> Vec<Vec<f64>> {
        let mut stream = Stream::new(7, 0, 0, 0);
        (0..count).map(|_| stream.normals(parameters)).collect()
    }

    fn quadratic(u: &[f64]) -> f64 {
        3.0 - 2.0 * u[0] + 0.5 * u[2] + 1.5 * u[0] * u[1] - 0.25 * u[2] * u[2]
    }

    #[test]
    fn a_quadratic_function_is_reproduced() {
        let points = points(60, 3);
        let design = SurfaceDesign::new(&points, Degree::Quadratic).unwrap();
        let outputs: Vec<f64> = points.iter().map(|u| quadratic(u)).collect();
        let surface = design.fit(&outputs);
        let expected = [3.0, -2.0, 0.0, 0.5, 0.0, 1.5, 0.0, 0.0, 0.0, -0.25];
        for (found, expected) in surface.coefficients.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{:?}", surface.coefficients);
        }
        assert!(surface.left_out_errors.iter().all(|error| error.abs() < 1e-11));
    }

    #[test]
    fn the_error_of_a_cubic_function_is_that_of_fits_without_each_point() {
        let points = points(30, 2);
        let cubic = |u: &[f64]| u[0] * u[0] * u[0] - 0.3 * u[0] * u[1];
        let outputs: Vec<f64> = points.iter().map(|u| cubic(u)).collect();
        let all = SurfaceDesign::new(&points, Degree::Quadratic)
            .unwrap()
            .fit(&outputs);
        for left_out in 0..points.len() {
            let (mut others, mut values) = (points.clone(), outputs.clone());
            let (point, value) = (others.remove(left_out), values.remove(left_out));
            let surface = SurfaceDesign::new(&others, Degree::Quadratic)
                .unwrap()
                .fit(&values);
            let terms = Degree::Quadratic.terms(&point);
            let predicted: f64 = terms.iter().zip(&surface.coefficients).map(|(t, c)| t * c).sum();
            let error = value - predicted;
            assert!(
                (all.left_out_errors[left_out] - error).abs() < 1e-9 * (1.0 + error.abs()),
                "point {left_out}: {} and {error}",
                all.left_out_errors[left_out]
            );
        }
        let largest = all.left_out_errors.iter().fold(0.0_f64, |l, e| l.max(e.abs()));
        assert!(largest > 0.1, "{largest}");
    }

    #[test]
    fn too_few_points_are_refused_with_their_number() {
        let error = SurfaceDesign::new(&points(14, 3), Degree::Quadratic).unwrap_err();
        assert_eq!(
            error.to_string(),
            "response surface of 3 parameters: 14 draws with outputs, at least 15 are needed"
        );
    }

    #[test]
    fn points_on_a_plane_and_a_point_that_alone_determines_a_term_are_refused() {
        let flat: Vec<Vec<f64>> = points(40, 2)
            .into_iter()
            .map(|u| vec![u[0], u[0] + 1.0])
            .collect();
        let mut single = vec![vec![0.0, 1.0]; 40];
        for (k, point) in single.iter_mut().enumerate() {
            point[1] = k as f64 / 10.0;
        }
        single[7][0] = 1.0;
        for (points, degree) in [(flat, Degree::Quadratic), (single, Degree::Linear)] {
            let error = SurfaceDesign::new(&points, degree).unwrap_err();
            assert_eq!(error, ResponseSurfaceError::Dependent { parameters: 2 });
        }
    }
}

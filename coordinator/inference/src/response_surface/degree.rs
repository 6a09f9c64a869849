//! `Degree`: the terms of a polynomial, and how many draws they need.

use serde::{Deserialize, Serialize};

use super::error::ResponseSurfaceError;

/// The degree of a response surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Degree {
    /// A constant and a slope for each coordinate.
    Linear,
    /// The linear terms, and the products of all pairs of coordinates.
    Quadratic,
}

impl Degree {
    /// Returns the highest degree for which there are enough draws.
    ///
    /// # Errors
    /// [`ResponseSurfaceError::TooFewDraws`] if they do not suffice for a linear surface.
    pub fn for_draws(draws: usize, parameters: usize) -> Result<Self, ResponseSurfaceError> {
        let degrees = [Degree::Quadratic, Degree::Linear];
        let found = degrees
            .into_iter()
            .find(|degree| draws >= degree.min_draws(parameters));
        found.ok_or(ResponseSurfaceError::TooFewDraws {
            parameters,
            draws,
            needed: Degree::Linear.min_draws(parameters),
        })
    }

    /// Returns the name, as in results: `quadratic`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Degree::Linear => "linear",
            Degree::Quadratic => "quadratic",
        }
    }

    /// Returns the number of terms: 1 + d, or 1 + d + d (d + 1) / 2.
    #[must_use]
    pub fn term_count(self, parameters: usize) -> usize {
        match self {
            Degree::Linear => 1 + parameters,
            Degree::Quadratic => 1 + parameters + parameters * (parameters + 1) / 2,
        }
    }

    /// Returns the smallest number of draws: three for every two terms, so that the errors of left-out draws mean something.
    #[must_use]
    pub fn min_draws(self, parameters: usize) -> usize {
        (3 * self.term_count(parameters)).div_ceil(2)
    }

    /// Returns the terms at a point: 1, then the coordinates, then for a quadratic surface `u_i u_j` for `i <= j`, row by row.
    #[must_use]
    pub fn terms(self, point: &[f64]) -> Vec<f64> {
        let mut terms = vec![1.0];
        terms.extend(point);
        if self == Degree::Quadratic {
            for (i, a) in point.iter().enumerate() {
                terms.extend(point[i..].iter().map(|b| a * b));
            }
        }
        terms
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_terms_stand_in_their_order() {
        assert_eq!(
            Degree::Quadratic.terms(&[2.0, 3.0, 5.0]),
            [1.0, 2.0, 3.0, 5.0, 4.0, 6.0, 10.0, 9.0, 15.0, 25.0]
        );
        assert_eq!(Degree::Linear.terms(&[2.0, 3.0]), [1.0, 2.0, 3.0]);
        for (degree, parameters) in [(Degree::Quadratic, 8), (Degree::Linear, 8)] {
            let terms = degree.terms(&vec![0.5; parameters]);
            assert_eq!(terms.len(), degree.term_count(parameters));
        }
    }

    #[test]
    fn fewer_draws_lower_the_degree_and_too_few_are_refused_with_their_number() {
        assert_eq!(Degree::for_draws(68, 8), Ok(Degree::Quadratic));
        assert_eq!(Degree::for_draws(67, 8), Ok(Degree::Linear));
        let error = Degree::for_draws(13, 8).unwrap_err();
        assert_eq!(
            error.to_string(),
            "response surface of 8 parameters: 13 draws with outputs, at least 14 are needed"
        );
    }
}

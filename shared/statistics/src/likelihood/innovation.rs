//! Errors that are autocorrelated along the travel of a run, as sums of innovations.

use super::datum::{ErrorSd, LikelihoodError};

/// An innovation of the autocorrelated error of a history: it enters at one point and decays along the travel.
///
/// # Equation
/// The error of a history is an Ornstein-Uhlenbeck process of the travel x: the covariance of its values at two points is
/// `s^2 exp(-|x_i - x_j| / l)`, with s its sd [unit of the data] and l its correlation length \[m\]. For K points in the order of travel
/// this covariance is `sum_k v_k v_k'` with
/// `v_k[j] = s sqrt(1 - rho_k^2) exp(-(x_j - x_k) / l)` for `j >= k`, else 0, and `rho_k = exp(-(x_k - x_{k-1}) / l)`, `rho_1 = 0`.
/// The `v_k` are the columns of its Cholesky factor. At two points with one coordinate `rho_k` is 1, and the innovation is 0.
///
/// # Source
/// Uhlenbeck & Ornstein 1930, doi:10.1103/PhysRev.36.823. Checked by `autocorrelation::a_history_has_the_density_of_its_kernel`.
#[derive(Debug, Clone, PartialEq)]
pub struct Innovation {
    /// Stationary standard deviation of the error, in the unit of the data, >= 0.
    pub sd: ErrorSd,
    /// Correlation length \[m\], known or inferred, > 0.
    pub correlation_length_m: ErrorSd,
    /// Distance of its point from the previous point \[m\], >= 0; `None` at the first point.
    pub spacing_m: Option<f64>,
    /// Distance of each datum past its point \[m\], >= 0, in the order of the data.
    pub distances_m: Vec<f64>,
}

impl Innovation {
    /// Returns the innovations of a history, one for each point; each affects the data from its point on.
    ///
    /// # Arguments
    /// - `coordinates_m`: travel of each datum \[m\], ascending; equal coordinates are allowed.
    ///
    /// # Errors
    /// [`LikelihoodError::Setting`] for a coordinate that is not finite or below the previous one.
    pub(super) fn of_history(
        coordinates_m: &[f64],
        sd: ErrorSd,
        correlation_length_m: ErrorSd,
    ) -> Result<Vec<Self>, LikelihoodError> {
        let mut innovations = Vec::with_capacity(coordinates_m.len());
        for (k, &at) in coordinates_m.iter().enumerate() {
            let spacing_m = k.checked_sub(1).map(|before| at - coordinates_m[before]);
            if !at.is_finite() || spacing_m.is_some_and(|spacing| spacing < 0.0) {
                return Err(LikelihoodError::Setting {
                    name: "coordinate of an autocorrelated error [m]",
                    value: at,
                    bound: "a finite number of at least the previous coordinate",
                });
            }
            innovations.push(Self {
                sd,
                correlation_length_m,
                spacing_m,
                distances_m: coordinates_m[k..].iter().map(|x| x - at).collect(),
            });
        }
        Ok(innovations)
    }

    /// Returns the sd of the innovation, `s sqrt(1 - rho^2)`, in the unit of the data.
    ///
    /// # Errors
    /// As for [`Innovation::shifts`].
    pub fn sd_at_point(&self, theta: &[f64]) -> Result<f64, LikelihoodError> {
        let (sd, length_m) = self.scales(theta)?;
        Ok(match self.spacing_m {
            Some(spacing_m) => sd * (-libm::expm1(-2.0 * spacing_m / length_m)).sqrt(),
            None => sd,
        })
    }

    /// Returns the shift of each datum by one sd of the innovation, in the unit of the data and in their order.
    ///
    /// # Arguments
    /// - `theta`: holds the inferred sd and correlation length.
    ///
    /// # Errors
    /// [`LikelihoodError::Setting`] for an inferred sd that is not finite and >= 0, or an inferred correlation length that is not finite
    /// and > 0; [`LikelihoodError::MissingParameter`]. Checked by `autocorrelation::scales_out_of_bounds_are_refused`.
    pub fn shifts(&self, theta: &[f64]) -> Result<Vec<f64>, LikelihoodError> {
        let at_point = self.sd_at_point(theta)?;
        let (_, length_m) = self.scales(theta)?;
        let decayed = |distance_m: &f64| at_point * libm::exp(-distance_m / length_m);
        Ok(self.distances_m.iter().map(decayed).collect())
    }

    /// Returns the sd and the correlation length \[m\] within their bounds.
    fn scales(&self, theta: &[f64]) -> Result<(f64, f64), LikelihoodError> {
        let (sd, length_m) = (self.sd.value(theta)?, self.correlation_length_m.value(theta)?);
        check_sd(sd)?;
        check_length(length_m)?;
        Ok((sd, length_m))
    }

    /// Refuses known scales out of their bounds, and distances that do not fit to the data.
    ///
    /// # Arguments
    /// - `count`: of the data that it affects.
    pub(super) fn check(&self, count: usize) -> Result<(), LikelihoodError> {
        if self.distances_m.len() != count {
            return Err(LikelihoodError::Distances {
                expected: count,
                given: self.distances_m.len(),
            });
        }
        if let ErrorSd::Known(length_m) = self.correlation_length_m {
            check_length(length_m)?;
        }
        let distances = self.distances_m.iter().chain(&self.spacing_m);
        for &value in distances {
            if !(value.is_finite() && value >= 0.0) {
                return Err(LikelihoodError::Setting {
                    name: "distance of an autocorrelated error [m]",
                    value,
                    bound: "a finite number of at least 0",
                });
            }
        }
        Ok(())
    }

    /// Returns the same innovation on some of its data.
    ///
    /// # Arguments
    /// - `places`: of the remaining data among its data.
    pub(super) fn on(&self, places: &[usize]) -> Self {
        Self {
            distances_m: places.iter().map(|&place| self.distances_m[place]).collect(),
            ..*self
        }
    }
}

/// Refuses an sd of a common error that is not finite and >= 0.
pub(super) fn check_sd(value: f64) -> Result<(), LikelihoodError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(LikelihoodError::Setting {
        name: "sd of a common error",
        value,
        bound: "a finite number of at least 0",
    })
}

fn check_length(value: f64) -> Result<(), LikelihoodError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(LikelihoodError::Setting {
        name: "correlation length of an autocorrelated error [m]",
        value,
        bound: "a finite number above 0",
    })
}

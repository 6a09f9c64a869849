//! Classes of effects that the data cannot distinguish.

use nalgebra::DMatrix;

/// Smallest `|cos|` between projected changes of one class.
const ALIKE: f64 = 0.98;
/// Log Bayes factors of fits to a model with numerical noise differ by this amount \[nats\].
const NOISE_OF_FITS: f64 = 3.0;

/// Returns how far the log Bayes factor of a class member may lie below that of another with `nats`, although both fit alike
/// \[nats\]: the cost of the angle between their changes, at least the difference that fits have anyway.
pub(crate) fn log_bayes_factor_deficit(nats: f64) -> f64 {
    (nats * (1.0 - ALIKE * ALIKE)).max(NOISE_OF_FITS)
}

/// Forms classes by complete linkage: each candidate joins the first class with `|cos| > 0.98` to every member.
///
/// # Arguments
/// - `products`: inner products of the projected changes, `[n_candidates, n_candidates]`.
/// - `limit_of`: for each limit, the candidate whose parameter has it. A limit belongs to the class of that candidate, whatever the
///   angle between them is.
///
/// # Returns
/// The class of each candidate, from 0. A change of length zero is a class of its own.
pub(super) fn classes(products: &DMatrix<f64>, limit_of: &[Option<usize>]) -> Vec<usize> {
    let count = products.nrows();
    let alike = |i: usize, j: usize| {
        let lengths = products[(i, i)].max(0.0) * products[(j, j)].max(0.0);
        products[(i, j)].abs() > ALIKE * lengths.sqrt()
    };
    let mut members: Vec<Vec<usize>> = Vec::new();
    let mut class = vec![0; count];
    for i in (0..count).filter(|i| limit_of[*i].is_none()) {
        let joined = members
            .iter()
            .position(|class| class.iter().all(|&j| alike(i, j)));
        class[i] = joined.unwrap_or(members.len());
        match joined {
            Some(k) => members[k].push(i),
            None => members.push(vec![i]),
        }
    }
    for (i, of) in limit_of.iter().enumerate() {
        if let Some(of) = of {
            class[i] = class[*of];
        }
    }
    class
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_like_every_member_joins() {
        // Angles 0, 8 and 16 degrees: neighbours are alike, the ends are not; opposite signs are alike.
        let angles = [0.0_f64, 8.0, 16.0, 180.0].map(f64::to_radians);
        let products = DMatrix::from_fn(4, 4, |i, j| libm::cos(angles[i] - angles[j]) * 9.0);
        assert_eq!(classes(&products, &[None; 4]), [0, 0, 1, 0]);
    }

    #[test]
    fn what_changes_nothing_is_a_class_of_its_own() {
        assert_eq!(classes(&DMatrix::zeros(2, 2), &[None; 2]), [0, 1]);
    }

    #[test]
    fn a_limit_is_in_the_class_of_its_parameter_and_admits_nobody() {
        // The limit points as the first does, and belongs to the last.
        let angles = [0.0_f64, 0.0, 90.0].map(f64::to_radians);
        let products = DMatrix::from_fn(3, 3, |i, j| libm::cos(angles[i] - angles[j]));
        assert_eq!(classes(&products, &[None, Some(2), None]), [0, 1, 1]);
    }
}

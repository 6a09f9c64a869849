//! Group effects that the data cannot tell apart.

use nalgebra::DMatrix;

/// Effects whose changes are more alike than this, after projection, are of one class.
const ALIKE: f64 = 0.98;

/// Classes by complete linkage, in the order of the candidates: one joins the first class with whose members all it has
/// `|cos| > 0.98`.
///
/// # Arguments
/// - `products`: of the projected changes, `[n_candidates, n_candidates]`.
///
/// # Returns
/// The class of each, from 0. A change of length zero is like no other.
pub(crate) fn classes(products: &DMatrix<f64>) -> Vec<usize> {
    let count = products.nrows();
    let alike = |i: usize, j: usize| {
        let lengths = products[(i, i)].max(0.0) * products[(j, j)].max(0.0);
        products[(i, j)].abs() > ALIKE * lengths.sqrt()
    };
    let mut members: Vec<Vec<usize>> = Vec::new();
    let mut class = Vec::with_capacity(count);
    for i in 0..count {
        let own = members
            .iter()
            .position(|others| others.iter().all(|&j| alike(i, j)));
        class.push(own.unwrap_or(members.len()));
        match own {
            Some(k) => members[k].push(i),
            None => members.push(vec![i]),
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
        assert_eq!(classes(&products), [0, 0, 1, 0]);
    }

    #[test]
    fn what_changes_nothing_is_a_class_of_its_own() {
        assert_eq!(classes(&DMatrix::zeros(2, 2)), [0, 1]);
    }
}

//! Groups of formulas that measurements cannot tell apart.

/// Formulas of one class differ by at most this share of a curve's sd.
const CLASS: f64 = 0.5;

/// Returns the class of each formula, numbered from 0: a formula joins the first class whose best it resembles.
///
/// # Arguments
/// - `count`: the number of formulas, the most probable first. `resembles`: whether a formula resembles the best of a class, by indices.
pub fn classes(count: usize, resembles: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut bests: Vec<usize> = Vec::new();
    let joined = (0..count).map(|index| {
        let class = bests.iter().position(|best| resembles(*best, index));
        class.unwrap_or_else(|| {
            bests.push(index);
            bests.len() - 1
        })
    });
    joined.collect()
}

/// Returns whether two laws differ by at most half a standard deviation of their curve everywhere.
pub fn is_within(sds: &[f64], a: &[f64], b: &[f64]) -> bool {
    let mut pairs = a.iter().zip(b).zip(sds);
    pairs.all(|((a, b), sd)| (a - b).abs() <= CLASS * sd)
}

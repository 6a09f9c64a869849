//! The selection of points that represent many.

/// Values within this share of the range are one level.
const ONE_LEVEL: f64 = 0.1;

/// Returns the smallest value of each level of a coordinate over its range, ascending. A value further than [`ONE_LEVEL`] above
/// the start of a level begins the next, so values without a gap form many levels.
pub(super) fn levels(points: &[&[f64]], coordinate: usize) -> Vec<f64> {
    let mut values: Vec<f64> = points.iter().map(|point| point[coordinate]).collect();
    values.sort_by(f64::total_cmp);
    let mut levels: Vec<f64> = Vec::new();
    for value in values {
        if levels.last().is_none_or(|first| value - first > ONE_LEVEL) {
            levels.push(value);
        }
    }
    levels
}

/// Returns the ascending numbers of at most `max` points that represent every level of every coordinate. The next point is the
/// one whose least represented level is represented least; among equals the one whose levels together are; then the first.
pub(crate) fn representative(points: &[&[f64]], max: usize) -> Vec<usize> {
    if points.len() <= max {
        return (0..points.len()).collect();
    }
    let dimension = points.first().map_or(0, |point| point.len());
    let starts: Vec<Vec<f64>> = (0..dimension).map(|k| levels(points, k)).collect();
    let place = |point: &[f64], k: usize| starts[k].partition_point(|start| *start <= point[k]);
    let places: Vec<Vec<usize>> = points
        .iter()
        .map(|point| (0..dimension).map(|k| place(point, k)).collect())
        .collect();
    let mut chosen_at: Vec<Vec<usize>> = starts.iter().map(|levels| vec![0; levels.len() + 1]).collect();
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut chosen = Vec::new();
    for _ in 0..max {
        let counts = |i: usize| places[i].iter().zip(&chosen_at).map(|(&at, counts)| counts[at]);
        let next = (0..left.len()).min_by_key(|&k| (counts(left[k]).min(), counts(left[k]).sum::<usize>()));
        let Some(next) = next.map(|k| left.remove(k)) else {
            break;
        };
        for (&at, counts) in places[next].iter().zip(&mut chosen_at) {
            counts[at] += 1;
        }
        chosen.push(next);
    }
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slices(points: &[Vec<f64>]) -> Vec<&[f64]> {
        points.iter().map(Vec::as_slice).collect()
    }

    #[test]
    fn values_that_scatter_about_two_levels_are_two_and_those_without_a_gap_many() {
        let count = |values: &[f64]| {
            let points: Vec<Vec<f64>> = values.iter().map(|&x| vec![x]).collect();
            levels(&slices(&points), 0).len()
        };
        assert_eq!(count(&[0.06, 0.0, 0.97, 0.03, 1.0]), 2);
        let dense: Vec<f64> = (0..=25).map(|i| 0.04 * f64::from(i)).collect();
        assert!(count(&dense) >= 5);
    }

    #[test]
    fn of_many_points_those_that_choose_have_every_level() {
        // In this order every second one, and every third one, is at one level of the second coordinate.
        let at = |i: u32| vec![f64::from(i / 6 % 5) / 4.0, f64::from(i % 6) / 5.0];
        let all: Vec<Vec<f64>> = (0..360).map(at).collect();
        let chosen = representative(&slices(&all), 150);
        assert_eq!(chosen.len(), 150);
        for (coordinate, count) in [(0, 30), (1, 25)] {
            for level in levels(&slices(&all), coordinate) {
                let points = chosen
                    .iter()
                    .filter(|&&i| (all[i][coordinate] - level).abs() < 0.01);
                assert_eq!(points.count(), count, "coordinate {coordinate} at {level}");
            }
        }
        assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
        // A level of one point among thousands.
        let mut rare = all;
        rare[77][1] = 1.7;
        assert!(
            representative(&slices(&rare), 20)
                .iter()
                .any(|&i| rare[i][1] > 1.5)
        );
    }
}

//! The unit range: coordinates divided by their range.

/// The least value and the range of each coordinate of some points.
#[derive(Debug, Clone)]
pub(crate) struct UnitRange {
    origin: Vec<f64>,
    range: Vec<f64>,
}

impl UnitRange {
    /// Returns the range of points that all have the coordinates of the first.
    pub(crate) fn new(points: &[&[f64]]) -> Self {
        let dimension = points.first().map_or(0, |point| point.len());
        let extreme = |k: usize, pick: fn(f64, f64) -> f64| {
            let values = points.iter().map(|point| point[k]);
            values.reduce(pick).unwrap_or_default()
        };
        let origin: Vec<f64> = (0..dimension).map(|k| extreme(k, f64::min)).collect();
        let range = (0..dimension).map(|k| extreme(k, f64::max) - origin[k]).collect();
        UnitRange { origin, range }
    }

    /// Returns a point, 0 at the least value of each coordinate and 1 at the greatest.
    pub(crate) fn scaled(&self, point: &[f64]) -> Vec<f64> {
        let scaled = point.iter().zip(&self.origin).zip(&self.range);
        scaled.map(|((x, origin), range)| (x - origin) / range).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_each_coordinate_are_0_and_1() {
        let unit = UnitRange::new(&[&[-0.7, 60.0], &[0.9, 0.0], &[0.1, 15.0]]);
        assert_eq!(unit.scaled(&[-0.7, 0.0]), [0.0, 0.0]);
        assert_eq!(unit.scaled(&[0.9, 60.0]), [1.0, 1.0]);
        let beyond = unit.scaled(&[2.5, 90.0]);
        assert!((beyond[0] - 2.0).abs() < 1e-12 && (beyond[1] - 1.5).abs() < 1e-12);
    }
}

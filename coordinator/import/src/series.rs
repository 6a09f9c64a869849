//! A series of samples in time: its means over intervals, and its usual step.

/// Largest interval between two samples that a straight line bridges, in usual steps.
const BRIDGED_STEPS: f64 = 5.0;

/// Samples `(t_s, value)` whose times ascend.
pub(crate) struct Series {
    samples: Vec<(f64, f64)>,
    /// Longest interval that a straight line bridges `[s]`.
    bridged_s: f64,
}

impl Series {
    /// Returns a series that bridges five steps of this length.
    pub(crate) fn new(samples: Vec<(f64, f64)>, step_s: f64) -> Self {
        Series {
            samples,
            bridged_s: BRIDGED_STEPS * step_s,
        }
    }

    /// Returns the means over intervals `[from, to]` in s, whose ends both ascend.
    ///
    /// The mean is ∫ y dt / (to − from) of the straight lines y between the samples, and the value of the line where both ends are one time. It
    /// is `None` where the interval leaves the series or reaches into a gap of more than five steps. Both series and means are thereby free of
    /// the steps: samples that lie denser than the intervals are averaged, others interpolated. Checked by
    /// `tests::means_are_those_of_the_straight_lines`.
    pub(crate) fn means(&self, intervals: impl Iterator<Item = (f64, f64)>) -> Vec<Option<f64>> {
        let mut at = 0;
        let mean = |(from, to)| self.mean(&mut at, (from, to));
        intervals.map(mean).collect()
    }

    /// Returns the mean over one interval; `at` is the sample from which the next interval is sought.
    fn mean(&self, at: &mut usize, (from, to): (f64, f64)) -> Option<f64> {
        if self.samples.first().is_none_or(|first| from < first.0) {
            return None;
        }
        while self.samples.get(*at + 1).is_some_and(|next| next.0 < from) {
            *at += 1;
        }
        let mut area = 0.0;
        for pair in self.samples.get(*at..)?.windows(2) {
            let [(begin, left), (end, right)] = [pair[0], pair[1]];
            // An interval that begins at the end of a gap lies beyond it.
            if end <= from && (from < to || end - begin > self.bridged_s) {
                continue;
            }
            let line = |t: f64| left + (right - left) * (t - begin) / (end - begin);
            let (a, b) = (from.max(begin), to.min(end));
            if end - begin > self.bridged_s {
                return None;
            }
            if from >= to {
                return (from <= end).then(|| line(from));
            }
            area += (line(a) + line(b)) / 2.0 * (b - a);
            if to <= end {
                return Some(area / (to - from));
            }
        }
        None
    }
}

/// Returns the median of the steps between times, the upper one of two; `None` for fewer than two times.
pub(crate) fn usual_step(t_s: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = t_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn means(samples: &[(f64, f64)], intervals: &[(f64, f64)]) -> Vec<Option<f64>> {
        Series::new(samples.to_vec(), 1.0).means(intervals.iter().copied())
    }

    #[test]
    fn means_are_those_of_the_straight_lines() {
        // A line is kept at any spacing: its mean is its value in the middle.
        let line: Vec<(f64, f64)> = [0.0, 0.3, 1.1, 1.2, 2.9, 4.0]
            .map(|t| (t, 2.0 * t - 1.0))
            .to_vec();
        let intervals = [(0.0, 0.5), (0.2, 1.15), (1.5, 1.5), (2.0, 4.0)];
        for (mean, (from, to)) in means(&line, &intervals).into_iter().zip(intervals) {
            let expected = from + to - 1.0;
            assert!((mean.unwrap() - expected).abs() < 1e-12, "{mean:?} {expected}");
        }
        // A triangle of base 2 and height 1 has the area 1.
        let triangle = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)];
        assert_eq!(
            means(&triangle, &[(0.0, 2.0), (0.5, 1.5)]),
            [Some(0.5), Some(0.75)]
        );
    }

    #[test]
    fn nothing_is_said_outside_of_the_samples_and_in_gaps() {
        let samples = [(1.0, 3.0), (2.0, 3.0), (8.0, 3.0), (9.0, 3.0)];
        let intervals = [
            (0.5, 1.5),
            (1.0, 2.0),
            (1.5, 2.5),
            (3.0, 4.0),
            (8.0, 9.0),
            (8.5, 9.1),
            (9.5, 9.5),
        ];
        let expected = [None, Some(3.0), None, None, Some(3.0), None, None];
        assert_eq!(means(&samples, &intervals), expected);
        assert_eq!(
            means(&[(1.0, 3.0)], &[(1.0, 1.0)]),
            [None],
            "one sample has no line"
        );
        assert_eq!(usual_step(&[0.0, 1.0, 1.5, 3.5]), Some(1.0));
        assert_eq!(usual_step(&[0.0]), None);
    }
}

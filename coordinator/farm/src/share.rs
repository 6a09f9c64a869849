//! The division of a worker's leases among calibrations.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Deals leases to calibrations, the oldest first: each goes to one of those that have the fewest leases out, so that a small
/// calibration waits for no large one, and calibrations of slow and of fast evaluations get the same share of the workers' time.
///
/// # Arguments
/// - `queues`: for each calibration, the number of leases that are out and of evaluations that wait.
/// - `want`: the largest number of leases to deal.
///
/// # Returns
/// The number of leases of each calibration.
pub(super) fn deal(queues: &[(usize, usize)], want: usize) -> Vec<usize> {
    let mut dealt = vec![0; queues.len()];
    let waiting = queues.iter().enumerate().filter(|(_, (_, waiting))| *waiting > 0);
    let mut fewest: BinaryHeap<_> = waiting.map(|(place, &(out, _))| Reverse((out, place))).collect();
    for _ in 0..want {
        let Some(Reverse((out, place))) = fewest.pop() else {
            break;
        };
        dealt[place] += 1;
        if dealt[place] < queues[place].1 {
            fewest.push(Reverse((out + 1, place)));
        }
    }
    dealt
}

#[cfg(test)]
mod tests {
    use super::deal;

    #[test]
    fn whoever_has_the_fewest_leases_out_comes_first_and_nothing_is_left_over() {
        assert_eq!(deal(&[(0, 100)], 7), [7]);
        assert_eq!(deal(&[(0, 100), (0, 100)], 7), [4, 3], "the oldest first");
        assert_eq!(deal(&[(60, 100), (0, 5)], 7), [2, 5], "what the small one leaves");
        assert_eq!(deal(&[(2, 9), (0, 9), (1, 0), (9, 9)], 6), [2, 4, 0, 0]);
        assert_eq!(deal(&[(0, 2), (0, 1)], 9), [2, 1]);
        assert!(deal(&[], 9).is_empty());
    }
}

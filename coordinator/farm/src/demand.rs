//! The amount of work, for programs that start workers.

use shared::api::WorkDemand;

use super::farm::Farm;
use super::progress;

impl Farm {
    /// Returns the work of all calibrations that are neither over nor paused.
    pub fn demand(&self) -> WorkDemand {
        let open = || {
            let calibrations = self.calibrations.values().map(|entry| &entry.calibration);
            calibrations.filter(|calibration| calibration.is_open())
        };
        let metrics = self.metrics();
        let able = self
            .workers
            .iter()
            .filter(|(name, _)| self.quarantined(name).is_none());
        let timed = able.clone().filter_map(|(_, worker)| {
            // All results have the same weight, whichever worker computed them.
            Some((worker.evaluation_s?, worker.completed.max(1) as f64))
        });
        let (time_s, count) = timed.fold((0.0, 0.0), |(time_s, count), (mean_s, results)| {
            (time_s + mean_s * results, count + results)
        });
        let left = |calibration| progress::evaluations_left(calibration).unwrap_or_default() as u64;
        WorkDemand {
            queued: metrics.queued,
            leased: metrics.leased as u64,
            evaluations_left: open().map(left).sum::<u64>().max(metrics.queued),
            in_hand: open().count() as u64,
            workers: self.able_workers() as u64,
            threads: able.map(|(_, worker)| u64::from(worker.threads)).sum(),
            evaluation_s: (count > 0.0).then_some(time_s / count),
            completed_in_queues: self.counters.completed_in_queues,
        }
    }
}

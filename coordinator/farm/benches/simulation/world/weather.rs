//! The weather of a schedule: the probability of each fault.

use statistics::rng::Stream;

/// The probability of each fault at one occasion.
#[derive(Debug, Clone, Default)]
pub(crate) struct Weather {
    /// A message is lost.
    pub(crate) loss: f64,
    /// A request arrives twice.
    pub(crate) twice: f64,
    /// A message is held up for longer than a lease.
    pub(crate) delay: f64,
    /// The coordinator dies.
    pub(crate) crash: f64,
    /// The coordinator restarts with an older file.
    pub(crate) restore: f64,
    /// A worker dies.
    pub(crate) death: f64,
    /// A worker stands still for longer than a lease.
    pub(crate) stop: f64,
    /// An evaluation takes longer.
    pub(crate) slow: f64,
    /// A machine fails at an evaluation.
    pub(crate) fault: f64,
    /// A lease is returned.
    pub(crate) returned: f64,
    /// A worker does not renew its leases.
    pub(crate) unrenewed: f64,
    /// The clock jumps ahead.
    pub(crate) jump: f64,
    /// A user pauses or resumes.
    pub(crate) user: f64,
    /// A user cancels.
    pub(crate) cancel: f64,
    /// A foreign or forged message is sent.
    pub(crate) forged: f64,
    /// A worker answers again, with other values.
    pub(crate) lie: f64,
}

/// Draws whether an event of this probability happens.
pub(crate) fn chance(stream: &mut Stream, probability: f64) -> bool {
    probability > 0.0 && stream.uniform() < probability
}

impl Weather {
    /// Draws a weather: each fault is absent in half of the schedules, else its probability is drawn from rare to frequent.
    pub(crate) fn draw(stream: &mut Stream) -> Weather {
        let mut often = |max: f64| {
            if stream.uniform() < 0.5 {
                0.0
            } else {
                max * libm::exp(-3.0 * stream.uniform())
            }
        };
        let mut weather = Weather {
            loss: often(0.4),
            twice: often(0.3),
            delay: often(0.1),
            crash: often(0.4),
            restore: often(1.0),
            death: often(0.2),
            stop: often(0.2),
            slow: often(0.6),
            fault: often(0.05),
            returned: often(0.1),
            unrenewed: often(0.5),
            jump: often(0.1),
            user: often(0.2),
            cancel: often(0.01),
            forged: often(0.4),
            lie: often(0.3),
        };
        // After a restored backup, a lie may be the first answer, which cannot be distinguished from the truth.
        if weather.lie > 0.0 {
            weather.restore = 0.0;
        }
        weather
    }
}

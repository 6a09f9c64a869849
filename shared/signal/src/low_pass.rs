//! A low-pass filter that does not shift a history in time.
//!
//! The filter is implemented here for the same bits on every machine: filter crates take the tangent of the cut-off from the
//! platform as soon as any crate of a build enables `std`, or do not expose the state that the ends of a history need.

use super::error::{SignalError, require};

/// Number of samples by which a history is extended at each end.
const PAD: usize = 9;

/// A Butterworth low-pass of second order that runs forward and backward over a history.
///
/// `H(s) = 1 / (s² + √2 s + 1)` by the bilinear transform with prewarped cut-off. Both passes together have the gain
/// `|H(f)|² = 1 / (1 + (tan(π f / f_s) / tan(π f_c / f_s))⁴)` and no phase: 1/2 at the cut-off `f_c`, 1 at rest.
///
/// # Source
/// Butterworth 1930; forward and backward with the ends of `scipy.signal.filtfilt(*butter(2, f_c, fs=f_s), x)`: odd
/// extension by nine samples, initial state at rest on the first of them. Checked by
/// `sines_keep_their_phase_and_are_weakened_by_the_gain_squared`, `a_constant_comes_through_and_a_ramp_nearly`,
/// `figures_of_an_independent_filter_are_met`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowPass {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Designs the filter.
    ///
    /// # Arguments
    /// - `cutoff_hz`: `f_c` \[Hz\], above 0 and below half the sampling rate, else [`SignalError::OutOfBounds`]. Use
    ///   [`LowPass::unless_zero`] if 0 means no filter.
    /// - `sample_hz`: `f_s` \[Hz\], > 0.
    pub fn new(cutoff_hz: f64, sample_hz: f64) -> Result<Self, SignalError> {
        let (half, unit) = (0.5 * sample_hz, "Hz");
        require(sample_hz > 0.0, "sample_hz", sample_hz, unit, "above", 0.0)?;
        require(cutoff_hz > 0.0, "lowpass_hz", cutoff_hz, unit, "above", 0.0)?;
        require(cutoff_hz < half, "lowpass_hz", cutoff_hz, unit, "below", half)?;
        let w = libm::tan(core::f64::consts::PI * cutoff_hz / sample_hz);
        let (w2, root_2_w) = (w * w, core::f64::consts::SQRT_2 * w);
        let norm = 1.0 / (1.0 + root_2_w + w2);
        Ok(LowPass {
            b: [w2 * norm, 2.0 * w2 * norm, w2 * norm],
            a: [2.0 * (w2 - 1.0) * norm, (1.0 - root_2_w + w2) * norm],
        })
    }

    /// Designs a filter like [`LowPass::new`], but a cut-off of 0 Hz means no filter, as in the protocol of an experiment.
    pub fn unless_zero(cutoff_hz: f64, sample_hz: f64) -> Result<Option<Self>, SignalError> {
        if cutoff_hz == 0.0 {
            return Ok(None);
        }
        LowPass::new(cutoff_hz, sample_hz).map(Some)
    }

    /// Filters a history in place.
    ///
    /// The history is extended at each end by point reflection, `2 x_0 − x_k`, for nine samples, or one less than its
    /// length. So a constant is unchanged, and the ends cause no jump.
    ///
    /// # Arguments
    /// - `history`: samples at the filter's rate, in any unit. An empty history stays empty.
    ///
    /// # Validity
    /// Within about `1 / f_c` of an end the result depends on the extension. A value that is not finite spreads.
    pub fn apply(&self, history: &mut [f64]) {
        let Some(last) = history.len().checked_sub(1) else {
            return;
        };
        let pad = PAD.min(last);
        let mut tail = [0.0; PAD];
        for (k, x) in tail[..pad].iter_mut().enumerate() {
            *x = 2.0 * history[last] - history[last - 1 - k];
        }
        let before = |k: usize| 2.0 * history[0] - history[k];
        let mut forward = self.at_rest_on(before(pad));
        for k in (1..=pad).rev() {
            forward.next(before(k));
        }
        for x in history.iter_mut().chain(&mut tail[..pad]) {
            *x = forward.next(*x);
        }
        let end = if pad > 0 { tail[pad - 1] } else { history[last] };
        let mut backward = self.at_rest_on(end);
        // The output before the first sample is not needed, so the backward pass ends there.
        for x in tail[..pad].iter_mut().rev() {
            backward.next(*x);
        }
        for x in history.iter_mut().rev() {
            *x = backward.next(*x);
        }
    }

    /// Returns the state of the filter after a constant input of this value.
    fn at_rest_on(&self, x: f64) -> State<'_> {
        State {
            filter: self,
            s: [(1.0 - self.b[0]) * x, (self.b[2] - self.a[1]) * x],
        }
    }
}

/// The state of a filter (transposed direct form II).
struct State<'a> {
    filter: &'a LowPass,
    s: [f64; 2],
}

impl State<'_> {
    #[inline]
    fn next(&mut self, x: f64) -> f64 {
        let LowPass { b, a } = self.filter;
        let y = b[0] * x + self.s[0];
        self.s = [b[1] * x - a[0] * y + self.s[1], b[2] * x - a[1] * y];
        y
    }
}

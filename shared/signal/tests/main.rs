//! Averages of histories, compared with hand-computed sums, the analytic gain, and scipy.

use core::f64::consts::PI;

use signal::{INTERVAL_S, LowPass, SampledSignal, Window, average, intervals, period_mean, resample};

const RATE_HZ: f64 = 10.0;

/// Returns steps of 50 to 149 ms with pseudo-random lengths.
fn uneven_edges(steps: u32) -> Vec<f64> {
    let mut t = 3.0;
    let lengths = (0..steps).map(|i| 0.05 + f64::from((i * 37) % 100) * 1e-3);
    let mut edges = vec![t];
    edges.extend(lengths.map(|length| {
        t += length;
        t
    }));
    edges
}

#[test]
fn a_step_that_ends_within_an_interval_counts_by_its_time() {
    // 2 for 0.05 s, 4 for 0.1 s, 8 for 0.25 s; 0.15 s of interval 0.1 … 0.4 are 8
    let edges = [0.0, 0.05, 0.15, 0.4];
    let mut out = [f64::NAN; 5];
    assert_eq!(resample(&edges, &[2.0, 4.0, 8.0], INTERVAL_S, &mut out), Ok(4));
    for (got, expected) in out[..4].iter().zip([3.0, 6.0, 8.0, 8.0]) {
        assert!((got - expected).abs() < 1e-14, "{out:?}");
    }
    assert!(out[4].is_nan());
}

#[test]
fn means_over_intervals_keep_the_integral() {
    let edges = uneven_edges(500);
    let values: Vec<f64> = (0..500_u32).map(|i| f64::from((i * i) % 91)).collect();
    for interval in [0.02, 0.1, 1.7] {
        let count = intervals(&edges, interval);
        let mut out = vec![0.0; count];
        assert_eq!(resample(&edges, &values, interval, &mut out), Ok(count));
        let end = edges[0] + count as f64 * interval;
        assert!(edges[500] - end < interval && edges[500] >= end - 1e-9);
        let expected: f64 = values
            .iter()
            .zip(edges.windows(2))
            .map(|(v, e)| v * (e[1].min(end) - e[0].min(end)))
            .sum();
        let got = out.iter().sum::<f64>() * interval;
        assert!(
            (got / expected - 1.0).abs() < 1e-12,
            "{interval}: {got} {expected}"
        );
    }
}

#[test]
fn a_regular_history_comes_through_and_its_last_interval_is_not_lost_to_rounding() {
    let edges: Vec<f64> = (0..=700_u32).map(|i| 0.3 + f64::from(i) * 0.1).collect();
    let values: Vec<f64> = (0..700_u32).map(|i| f64::from(i % 7)).collect();
    let mut out = vec![0.0; 700];
    assert_eq!(resample(&edges, &values, INTERVAL_S, &mut out), Ok(700));
    for (got, expected) in out.iter().zip(&values) {
        assert!((got - expected).abs() < 1e-10);
    }
}

#[test]
fn histories_that_are_none_are_refused_by_position_and_length() {
    let mut out = [0.0; 8];
    for (edges, values, message) in [
        (
            &[0.0, 0.5, 0.4][..],
            &[1.0, 2.0][..],
            "time 0.4 s at position 2 does not lie after 0.5 s",
        ),
        (&[0.0, 0.5], &[1.0, 2.0], "edges_s has 2 entries, 3 are needed"),
        (&[0.0, 0.9], &[1.0], "out has 8 entries, 9 are needed"),
    ] {
        let refused = resample(edges, values, INTERVAL_S, &mut out).unwrap_err();
        assert_eq!(refused.to_string(), message);
    }
    assert!(resample(&[0.0, f64::NAN], &[1.0], INTERVAL_S, &mut out).is_err());
    assert_eq!(resample(&[0.0], &[], INTERVAL_S, &mut out), Ok(0));
    // The history is shorter than one interval.
    assert_eq!(resample(&[0.0, 0.05], &[1.0], INTERVAL_S, &mut out), Ok(0));
}

#[test]
fn figures_of_an_independent_filter_are_met() {
    // scipy 1.17.1: signal.filtfilt(*signal.butter(2, f_c, fs=10.0), x), x_i = ((7 i² + 3 i) mod 23) / 4
    let input: Vec<f64> = (0..30_u32)
        .map(|i| f64::from((7 * i * i + 3 * i) % 23) / 4.0)
        .collect();
    // position, and value with a cut-off of 0.5 Hz and of 2 Hz
    for (i, slow, fast) in [
        (0, 0.096_136_747_615_719_16, -0.000_111_500_303_437_539_47),
        (1, 0.689_670_578_833_247, 1.677_008_472_763_129_4),
        (14, 2.424_488_123_670_505, 1.890_807_187_443_842),
        (28, 3.750_172_265_844_465_6, 2.471_380_059_978_904_4),
        (29, 4.242_588_417_150_084, 4.249_983_668_503_765),
    ] {
        for (cutoff_hz, figure) in [(0.5, slow), (2.0, fast)] {
            let mut history = input.clone();
            LowPass::new(cutoff_hz, RATE_HZ).unwrap().apply(&mut history);
            assert!(
                (history[i] - figure).abs() < 1e-13,
                "{i}: {} {figure}",
                history[i]
            );
        }
    }
    // The history is shorter than the usual extension: padlen = 3.
    let mut short = [1.0, -2.0, 4.0, 0.5];
    LowPass::new(2.0, RATE_HZ).unwrap().apply(&mut short);
    let figures = [
        1.071_875_218_295_991_2,
        0.941_532_722_451_081_4,
        0.929_204_338_286_643,
        0.469_570_095_925_837_76,
    ];
    for (got, figure) in short.iter().zip(figures) {
        assert!((got - figure).abs() < 1e-14, "{short:?}");
    }
}

#[test]
fn sines_keep_their_phase_and_are_weakened_by_the_gain_squared() {
    let cutoff_hz = 0.5;
    let filter = LowPass::new(cutoff_hz, RATE_HZ).unwrap();
    for frequency_hz in [0.05, 0.15, 0.5, 1.3, 3.0] {
        let sine = |i: u32| libm::sin(2.0 * PI * frequency_hz * f64::from(i) / RATE_HZ + 0.4);
        let mut history: Vec<f64> = (0..2000).map(sine).collect();
        filter.apply(&mut history);
        let ratio = libm::tan(PI * frequency_hz / RATE_HZ) / libm::tan(PI * cutoff_hz / RATE_HZ);
        let gain = 1.0 / (1.0 + ratio * ratio * ratio * ratio);
        // The samples are far from the ends, where the extension has no effect.
        for i in 500..1500 {
            let expected = gain * sine(i);
            let got = history[i as usize];
            assert!((got - expected).abs() < 1e-10, "{frequency_hz} Hz at {i}: {got}");
        }
    }
}

#[test]
fn a_constant_comes_through_and_a_ramp_nearly() {
    for samples in [1_usize, 2, 5, 10, 11, 500] {
        let mut constant = vec![38.25; samples];
        LowPass::new(0.5, RATE_HZ).unwrap().apply(&mut constant);
        assert!(constant.iter().all(|x| (x - 38.25).abs() < 1e-11), "{constant:?}");
    }
    // The forward pass starts unsteady on a ramp; a fast filter is steady after nine samples.
    let mut ramp: Vec<f64> = (0..200_u32).map(f64::from).collect();
    LowPass::new(3.0, RATE_HZ).unwrap().apply(&mut ramp);
    for (i, x) in ramp.iter().enumerate() {
        assert!((x - i as f64).abs() < 1e-2, "{i}: {x}");
    }
    LowPass::new(0.5, RATE_HZ).unwrap().apply(&mut []);
}

#[test]
fn a_cut_off_that_the_rate_cannot_carry_is_refused() {
    let message = |cutoff_hz: f64| LowPass::new(cutoff_hz, RATE_HZ).unwrap_err().to_string();
    assert_eq!(message(5.0), "lowpass_hz = 5 Hz must be below 5 Hz");
    assert_eq!(message(0.0), "lowpass_hz = 0 Hz must be above 0 Hz");
    assert!(message(f64::NAN).starts_with("lowpass_hz = NaN Hz"));
}

/// Returns exact means of `mean + amplitude sin(2 π t / period + 0.7)` over 0.1 s each, from 0 s.
fn swinging(mean: f64, amplitude: f64, period_s: f64, count: u32) -> Vec<f64> {
    let omega = 2.0 * PI / period_s;
    let cosine = |i: u32| libm::cos(omega * f64::from(i) * 0.1 + 0.7);
    (0..count)
        .map(|i| mean + amplitude * (cosine(i) - cosine(i + 1)) / (omega * 0.1))
        .collect()
}

/// Returns a history that starts at a time `[s]`.
fn from(start_s: f64, samples: &[f64]) -> SampledSignal<'_> {
    SampledSignal {
        start_s,
        interval_s: INTERVAL_S,
        samples,
    }
}

fn window(from_s: f64, to_s: f64, period_s: Option<f64>) -> Window {
    Window {
        from_s,
        to_s,
        period_s,
    }
}

fn mean_of(samples: &[f64], from_s: f64, to_s: f64, period_s: Option<f64>) -> (f64, u32, f64) {
    let got = period_mean(&from(0.0, samples), &window(from_s, to_s, period_s));
    let got = got.expect("a window within the history");
    (got.mean, got.periods, got.covered_s)
}

#[test]
fn a_mean_over_whole_periods_is_free_of_the_swing() {
    let samples = swinging(38.0, 13.0, 6.5, 500);
    // 30 s hold four periods of 6.5 s.
    let (mean, periods, covered) = mean_of(&samples, 20.0, 50.0, Some(6.5));
    assert_eq!(periods, 4);
    assert!(
        (covered - 26.0).abs() < 1e-12 && (mean - 38.0).abs() < 1e-12,
        "{mean}"
    );
    // 28 s hold four periods and 2 s, which change the mean by up to A / (π N) = 1 N.
    let (off, none, covered) = mean_of(&samples, 20.0, 48.0, None);
    assert_eq!(none, 0);
    assert!((covered - 28.0).abs() < 1e-12, "{covered}");
    assert!((off - 38.661_641_547_852).abs() < 1e-9, "{off}");
    assert!((mean_of(&samples, 20.0, 48.0, Some(6.5)).0 - 38.0).abs() < 1e-12);
    // A period that is not a multiple of the interval leaves at most π A dt² / (4 N P²): 7e-4 N of 13 N for P = 6.53 s.
    let samples = swinging(38.0, 13.0, 6.53, 500);
    let (mean, periods, _) = mean_of(&samples, 20.0, 50.0, Some(6.53));
    let bound = PI * 13.0 * 0.01 / (4.0 * 4.0 * 6.53 * 6.53);
    assert!(periods == 4 && (mean - 38.0).abs() < bound, "{mean} {bound}");
}

#[test]
fn a_period_that_just_fits_counts_and_one_too_long_takes_the_window() {
    let samples = swinging(2.0, 1.0, 0.3, 300);
    // 30 s / 0.3 s is 100 up to rounding.
    assert_eq!(mean_of(&samples, 0.0, 30.0, Some(0.3)).1, 100);
    let (mean, periods, covered) = mean_of(&samples, 0.0, 30.0, Some(31.0));
    assert_eq!(periods, 0);
    assert!((covered - 30.0).abs() < 1e-12);
    assert!((mean - samples.iter().sum::<f64>() / 300.0).abs() < 1e-12);
    // A partial interval counts by its part: 0.05 s of 1 and 0.1 s of 4.
    let (mean, _, _) = mean_of(&[1.0, 4.0], 0.05, 0.2, None);
    assert!((mean - 3.0).abs() < 1e-12, "{mean}");
}

#[test]
fn windows_outside_the_history_are_refused() {
    for (window, message) in [
        (window(0.5, 2.0, None), "from_s = 0.5 s must be at least 1 s"),
        (window(1.5, 4.0, None), "to_s = 4 s must be at most 3 s"),
        (window(2.0, 2.0, None), "to_s = 2 s must be above 2 s"),
        (window(1.0, 3.0, Some(0.0)), "period_s = 0 s must be above 0 s"),
    ] {
        let refused = period_mean(&from(1.0, &[1.0; 20]), &window).unwrap_err();
        assert_eq!(refused.to_string(), message);
    }
}

#[test]
fn an_average_is_filter_cut_and_mean_in_this_order() {
    let raw: Vec<f64> = (0..300)
        .map(|k| 5.0 + libm::sin(f64::from(k) * 0.11) + 40.0 * libm::exp(-0.2 * f64::from(k)))
        .collect();
    let filter = LowPass::new(0.5, RATE_HZ).unwrap();
    let mut filtered = raw.clone();
    filter.apply(&mut filtered);
    let history = from(0.0, &filtered);
    let expected = period_mean(&history, &window(8.0, history.end_s(), Some(6.5))).unwrap();
    let mut samples = raw.clone();
    let got = average(&mut samples, INTERVAL_S, Some(&filter), 8.0, Some(6.5)).unwrap();
    assert_eq!(got, expected);
    assert_eq!(samples, filtered);
    assert_eq!(got.periods, 3);
    let mut unfiltered = raw.clone();
    let plain = average(&mut unfiltered, INTERVAL_S, None, 8.0, Some(6.5)).unwrap();
    assert_eq!(unfiltered, raw);
    assert!(plain.mean.to_bits() != got.mean.to_bits());
    assert_eq!(LowPass::unless_zero(0.0, RATE_HZ), Ok(None));
    assert_eq!(LowPass::unless_zero(0.5, RATE_HZ), Ok(Some(filter)));
    assert!(average(&mut unfiltered, INTERVAL_S, None, 30.0, None).is_err());
}

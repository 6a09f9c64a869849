//! The recorded time history of a run, and its averages.

use signal::{LowPass, SignalError, average};

use super::settings::AveragingProtocol;
use super::table::{self, Columns};
use super::wheel::WheelGeometry;
use crate::channel::Channel;
use crate::file::FileError;

/// The maximum number of samples of a history: a day at 10 Hz.
const MAX_SAMPLES: usize = 864_000;

/// Relative tolerance of each time step against the first one, because loggers round their times.
const UNEVEN: f64 = 0.01;

/// The recording of a run: the samples of its file, filtered and averaged by the experiment's protocol.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredHistory {
    /// Name of the file.
    pub file: String,
    /// End of the averaging interval of each sample `[s]`.
    pub t_s: Vec<f64>,
    /// Length of an interval `[s]`.
    pub interval_s: f64,
    /// Time cut from the beginning before averaging `[s]`.
    pub transient_s: f64,
    /// The recordings by channel; `None` = not recorded.
    recorded: [Option<Recorded>; 4],
}

/// One channel of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Samples of the file [channel's unit].
    pub raw: Vec<f64>,
    /// Samples after the protocol's low-pass [channel's unit].
    pub filtered: Vec<f64>,
    /// Mean of the filtered samples over whole grouser periods after the transient [channel's unit].
    pub average: f64,
    /// Number of periods; 0: the whole recording, because the wheel has no grousers or no period fits.
    pub periods: u32,
    /// The length of time that the average covers `[s]`.
    pub covered_s: f64,
}

impl MeasuredHistory {
    /// Returns a channel's recording, if there is one.
    pub fn channel(&self, channel: Channel) -> Option<&Recorded> {
        self.recorded[channel.index()].as_ref()
    }

    /// Returns the channels that are recorded, in the order of all tables.
    pub fn channels(&self) -> impl Iterator<Item = (Channel, &Recorded)> {
        Channel::ALL
            .into_iter()
            .filter_map(|c| self.channel(c).map(|recorded| (c, recorded)))
    }
}

/// Parses a history and averages it by the protocol, with the same filter, cut and mean as simulated histories.
///
/// The columns are `t_s`, the end of each sample's averaging interval, and channels; `wheel_load_n`, which
/// `worker simulate --histories` writes, is allowed and not averaged. `(slip, sled speed)` give the period.
///
/// A [`FileError`] names file, line and column: times that do not ascend by equal steps, fields that are blank or not
/// finite, a sinkage beyond the wheel's diameter; a cut-off or a transient for which the recording is too slow or too short.
/// Checked by `tests::malformed_histories_are_refused_with_their_mistake`.
pub(super) fn averaged(
    file: &str,
    text: &str,
    wheel: &WheelGeometry,
    protocol: &AveragingProtocol,
    (slip, sled_speed_m_s): (f64, f64),
) -> Result<MeasuredHistory, FileError> {
    let mut allowed = vec!["t_s"];
    allowed.extend(Channel::ALL.iter().map(|c| c.column()));
    allowed.push("wheel_load_n");
    let columns = Columns {
        allowed,
        required: &["t_s"],
        max_rows: MAX_SAMPLES,
    };
    let mut lines = Vec::new();
    let mut samples: [Vec<f64>; 4] = Default::default();
    let t_s = table::rows(file, text, &columns, |row, line| {
        for (channel, samples) in Channel::ALL.into_iter().zip(&mut samples) {
            if row.has(channel.column()) {
                let sample = row.required(channel.column())?;
                if channel == Channel::Sinkage {
                    wheel.check_sinkage(sample)?;
                }
                samples.push(sample);
            }
        }
        lines.push(line);
        row.required("t_s")
    })?;
    let whole = |message: String| FileError::whole(file, message);
    let interval_s = interval(&t_s).map_err(|(position, message)| match lines.get(position) {
        Some(&line) => FileError::at(file, line, message),
        None => whole(message),
    })?;
    if samples.iter().all(Vec::is_empty) {
        let channels = Channel::ALL.map(Channel::column).join(", ");
        return Err(whole(format!("no column of a channel: {channels}")));
    }
    let length_s = t_s.len() as f64 * interval_s;
    if protocol.measured_transient_s >= length_s {
        return Err(whole(format!(
            "[protocol] measured_transient_s {} s must be < {length_s:.6} s, the length of the recording",
            protocol.measured_transient_s
        )));
    }
    let in_protocol = |e: SignalError| whole(format!("[protocol] {e}"));
    let filter = LowPass::unless_zero(protocol.lowpass_hz, 1.0 / interval_s).map_err(in_protocol)?;
    let period_s = wheel.grouser_period_s(slip, sled_speed_m_s);
    let mut recorded: [Option<Recorded>; 4] = Default::default();
    for (recorded, raw) in recorded.iter_mut().zip(samples) {
        if raw.is_empty() {
            continue;
        }
        let mut filtered = raw.clone();
        let cut_s = protocol.measured_transient_s;
        let mean =
            average(&mut filtered, interval_s, filter.as_ref(), cut_s, period_s).map_err(in_protocol)?;
        *recorded = Some(Recorded {
            raw,
            filtered,
            average: mean.mean,
            periods: mean.periods,
            covered_s: mean.covered_s,
        });
    }
    Ok(MeasuredHistory {
        file: file.to_owned(),
        t_s,
        interval_s,
        transient_s: protocol.measured_transient_s,
        recorded,
    })
}

/// Returns the equal step between the times `[s]`, or the position of the wrong time with a message.
fn interval(t_s: &[f64]) -> Result<f64, (usize, String)> {
    let [first, second, .., last] = t_s else {
        return Err((
            usize::MAX,
            format!("{} samples are too few: at least 3", t_s.len()),
        ));
    };
    let mean = (last - first) / (t_s.len() - 1) as f64;
    for (i, pair) in t_s.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        if step <= 0.0 {
            let message = format!("t_s {} s must lie after {} s", pair[1], pair[0]);
            return Err((i + 1, message));
        }
        // The reference is the first step: a missing sample would shift the mean.
        let expected = second - first;
        if (step - expected).abs() > UNEVEN * expected {
            let message = format!(
                "t_s {} s comes {step:.6} s after the one before, the first two are {expected:.6} s apart: steps must be equal",
                pair[1]
            );
            return Err((i + 1, message));
        }
    }
    Ok(mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;

    /// 2 pi 0.125 m / 12 / 10 mm/s = 6.545 s from grouser to grouser at this slip and speed.
    const MOTION: (f64, f64) = (0.2, 0.008);

    fn wheel() -> WheelGeometry {
        WheelGeometry {
            radius_m: 0.125,
            width_m: 0.112,
            grouser_count: 12,
            grouser_height_m: 0.009,
            grouser_thickness_m: 0.002,
            rig_radius_m: 0.125,
            mesh: None,
            tread: None,
        }
    }

    fn read(text: &str, protocol: &AveragingProtocol) -> Result<MeasuredHistory, String> {
        averaged("h.csv", text, &wheel(), protocol, MOTION).map_err(|e| e.to_string())
    }

    /// Returns sixty seconds at 10 Hz: a pull that oscillates by 3 N with the passing grousers, after a transient.
    fn recording() -> String {
        let mut text = "# a rig\nt_s,drawbar_pull_n,sinkage_m,wheel_load_n\n".to_owned();
        for k in 1..=600 {
            let t = 0.1 * f64::from(k);
            let swung = swing(t / 6.544_984_694_978_736);
            let start = if t < 35.0 { 50.0 } else { 0.0 };
            text += &format!("{t:.1},{},0.005,100\n", 20.0 + 3.0 * swung + start);
        }
        text
    }

    /// Returns an oscillation of period 1 and mean 0.
    fn swing(x: f64) -> f64 {
        (std::f64::consts::TAU * x).sin()
    }

    #[test]
    fn the_transient_is_cut_and_whole_grouser_periods_are_averaged() {
        let history = read(&recording(), &AveragingProtocol::default()).unwrap();
        let pull = history.channel(Channel::DrawbarPull).unwrap();
        // 20 s after the transient hold three periods of 6.545 s; over these the oscillation cancels
        assert_eq!(pull.periods, 3);
        assert!((pull.covered_s - 19.634_954).abs() < 1e-6);
        assert!((pull.average - 20.0).abs() < 0.02, "{}", pull.average);
        assert_eq!((pull.raw.len(), pull.filtered.len()), (600, 600));
        assert!(pull.raw != pull.filtered);
        let sinkage = history.channel(Channel::Sinkage).unwrap();
        assert!((sinkage.average - 0.005).abs() < 1e-12);
        assert!(history.channel(Channel::Torque).is_none());
        let raw = AveragingProtocol {
            lowpass_hz: 0.0,
            ..AveragingProtocol::default()
        };
        let unfiltered = read(&recording(), &raw).unwrap();
        let pull = unfiltered.channel(Channel::DrawbarPull).unwrap();
        assert_eq!(pull.raw, pull.filtered);
    }

    #[test]
    fn malformed_histories_are_refused_with_their_mistake() {
        let steady = AveragingProtocol {
            measured_transient_s: 0.0,
            ..AveragingProtocol::default()
        };
        // a table's line has a slash where the file begins a new line
        let refused =
            |text: &str, protocol: &AveragingProtocol| read(&text.replace('/', "\n"), protocol).unwrap_err();
        for (wrong, message) in cases(
            r#"
            0.1,0/0.2,0/0.2,0/0.3,0 => h.csv line 4: t_s 0.2 s must lie after 0.2 s
            0.1,0/0.2,0/0.4,0 => h.csv line 4: t_s 0.4 s comes 0.200000 s after the one before, the first two are 0.100000 s apart: steps must be equal
            0.1,0/0.2,/0.3,0 => h.csv line 3: sinkage_m is blank
            0.1,0/0.2,inf/0.3,0 => h.csv line 3: sinkage_m inf is not a finite number
            0.1,0/0.2,5/0.3,0 => h.csv line 3: sinkage_m 5 m is more than the wheel's diameter 0.25 m: metres are expected, were these millimetres or centimetres?
            0.1,0/0.2,0 => h.csv: 2 samples are too few: at least 3
            1,0/2,0/3,0 => h.csv: [protocol] lowpass_hz = 0.5 Hz must be below 0.5 Hz"#,
        ) {
            assert_eq!(refused(&format!("t_s,sinkage_m/{wrong}/"), &steady), message);
        }
        for (text, message) in cases(
            r#"
            t_s/0.1/0.2/0.3/ => h.csv: no column of a channel: drawbar_pull_n, torque_n_m, sinkage_m, lateral_force_n
            t_s,torqe_n_m/ => h.csv line 1: unknown column "torqe_n_m"; the nearest known is "torque_n_m""#,
        ) {
            assert_eq!(refused(text, &steady), message);
        }
        let short = refused("t_s,sinkage_m/0.1,0/0.2,0/0.3,0/", &AveragingProtocol::default());
        let message =
            "[protocol] measured_transient_s 40 s must be < 0.300000 s, the length of the recording";
        assert_eq!(short, format!("h.csv: {message}"));
    }
}

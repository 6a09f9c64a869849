//! The protocol of a run: when it ends, and what is averaged.

use super::record::{Record, Windows};
use super::result::SpatialRun;
use super::rolling::Rolling;
use super::track::count;
use crate::Condition;
use crate::effects::case::Case;
use crate::rejection::Rejection;
use crate::spatial::scene::Scene;
use crate::spatial::settings::{Protocol, RunSettings};
use signal::{INTERVAL_S, LowPass, average};

/// Roll the wheel by the settings' protocol, pass after pass; the last one counts.
///
/// `case`: where effects are active, soil, wheel and condition after them, as in scene and condition.
pub(crate) fn roll(
    scene: &Scene,
    condition: &Condition,
    case: Option<&Case>,
    settings: RunSettings,
) -> Result<SpatialRun, Rejection> {
    let track = match settings.protocol {
        Protocol::Steady { most_travel_m, .. } => most_travel_m,
        Protocol::Fixed { duration_s, .. } => duration_s * condition.sled_speed_m_s,
    };
    let mut rolling = Rolling::new(scene, condition, case, settings, track)?;
    let steps = count(rolling.track, &rolling.steps, condition)?;
    for _ in 1..condition.pass {
        rolling.lower()?;
        for _ in 0..steps {
            rolling.step()?;
        }
        rolling.start_again();
    }
    let mut record = Record::new(rolling.steps.time, steps);
    let lowered = rolling.lower()?;
    record.push(&mut rolling, &lowered)?;
    let (windows, settled_to) = match settings.protocol {
        Protocol::Steady { tolerance, .. } => steady(&mut rolling, &mut record, condition, tolerance, steps)?,
        Protocol::Fixed {
            transient_force_s,
            transient_sinkage_s,
            lowpass_hz,
            ..
        } => {
            for _ in 0..steps {
                let step = rolling.step()?;
                record.push(&mut rolling, &step)?;
            }
            let cut = [transient_force_s, transient_sinkage_s];
            (fixed(&rolling, &record, cut, lowpass_hz)?, None)
        }
    };
    record.finish(&rolling, condition, windows, settled_to)
}

/// Roll until the means of two windows in a row agree. A window is a whole number of grouser periods no shorter than
/// the contact, or a whole number of columns where there are none.
fn steady(
    rolling: &mut Rolling,
    record: &mut Record,
    condition: &Condition,
    tolerance: f64,
    most_steps: usize,
) -> Result<(Windows, Option<f64>), Rejection> {
    let (load, radius) = (condition.wheel_load_n, rolling.radius());
    let period = rolling.grouser_period_s().map(|p| p / rolling.steps.time); // in steps
    let mut last: Option<([f64; 4], f64)> = None;
    let mut window = 0.0; // in steps
    let mut end = 0.0;
    for taken in 0..=most_steps {
        if taken > 0 {
            let step = rolling.step()?;
            record.push(rolling, &step)?;
        }
        if (taken as f64) < end {
            continue;
        }
        let means = (taken > 0)
            .then(|| record.own_means(end - window, end))
            .transpose()?;
        if let (Some(means), Some((before, _))) = (means, last) {
            let scales = [load, load * radius, means[2].abs().max(1e-3 * radius), load];
            let change = (0..4).fold(0.0_f64, |most, i| {
                most.max((means[i] - before[i]).abs() / scales[i])
            });
            last = Some((means, change));
            if change <= tolerance {
                break;
            }
        } else if let Some(means) = means {
            last = Some((means, f64::INFINITY));
        }
        // the next window: as long as the contact has become
        let contact = record.contact_length_m.last().copied().unwrap_or(0.0) / rolling.steps.travel;
        // in whole periods, or whole columns, over which the grid's own ripple drops out; so many that two windows fit
        let whole = period.unwrap_or(rolling.steps.to_column as f64);
        let most = libm::floor(0.5 * most_steps as f64 / whole).max(1.0);
        let wanted = whole * libm::ceil(contact / whole).max(1.0).min(most);
        // no window is cut: part of a period does not represent the whole
        if end + wanted > most_steps as f64 {
            break;
        }
        (window, end) = (wanted, end + wanted);
    }
    let settled = last.filter(|(_, change)| change.is_finite());
    let (_, change) = settled.ok_or(Rejection::InvalidParameter {
        name: "most_travel_m",
        value: most_steps as f64 * rolling.steps.travel,
        unit: "m",
        bound: "long enough for two windows of averages",
    })?;
    let means = record.means(end - window, end)?;
    let first_step = (end - window).max(0.0) as usize;
    Ok((Windows { means, first_step }, Some(change)))
}

/// Averages of histories at 10 Hz, filtered, with their transients cut.
fn fixed(rolling: &Rolling, record: &Record, cut_s: [f64; 2], lowpass_hz: f64) -> Result<Windows, Rejection> {
    let filter = LowPass::unless_zero(lowpass_hz, 1.0 / INTERVAL_S)?;
    let step = rolling.steps.time;
    let edges: Vec<f64> = (0..record.history.len()).map(|i| i as f64 * step).collect();
    let mut samples = vec![0.0; signal::intervals(&edges, INTERVAL_S)];
    let mut means = [0.0; 4];
    for (i, channel) in record.history.channels().into_iter().take(4).enumerate() {
        signal::resample(&edges, &channel[1..], INTERVAL_S, &mut samples)?;
        let cut_s = if i == 2 { cut_s[1] } else { cut_s[0] };
        let period_s = rolling.grouser_period_s();
        means[i] = average(&mut samples, INTERVAL_S, filter.as_ref(), cut_s, period_s)?.mean;
    }
    Ok(Windows {
        means,
        first_step: (cut_s[0] / step) as usize,
    })
}

//! The protocol of a run: its end, and the averaged steps.

use super::record::{Record, Windows};
use super::result::SpatialRun;
use super::rolling::Rolling;
use super::series::Series;
use super::track::count;
use crate::Condition;
use crate::effects::case::Case;
use crate::rejection::Rejection;
use crate::spatial::scene::Scene;
use crate::spatial::settings::{Protocol, RunSettings};
use signal::{INTERVAL_S, LowPass, average};

/// Rolls the wheel by the settings' protocol, pass after pass, and averages the last one.
///
/// `case`: with active effects, soil, wheel and condition after them, as in scene and condition.
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

/// Rolls until the means of a window hardly depend on its start.
///
/// A window holds an even number of grouser periods, or whole columns without grousers, and is no shorter than the contact.
/// The disturbance by the lowering of the wheel decays to about e^−2 within a contact length: the means of windows that
/// begin one, two, three … contact lengths after the start form a geometric series. Three of them give its limit, which is
/// the average, and the distance of the last from the limit, which must be within the tolerance. Windows begin closer
/// together if the travel does not hold two contact lengths and a window. Checked by `spatial::steady`.
fn steady(
    rolling: &mut Rolling,
    record: &mut Record,
    condition: &Condition,
    tolerance: f64,
    max_steps: usize,
) -> Result<(Windows, Option<f64>), Rejection> {
    let (load, radius) = (condition.wheel_load_n, rolling.radius());
    let period = rolling.grouser_period_s().map(|p| p / rolling.steps.time); // in steps
    let mut settled = None;
    let mut contacts = 2.0;
    for taken in 0..=max_steps {
        if taken > 0 {
            let step = rolling.step()?;
            record.push(rolling, &step)?;
        }
        let contact = record.contact_length() / rolling.steps.travel;
        let window = window(contact, period, rolling.steps.to_column, max_steps);
        let shift = contact.min(0.5 * (max_steps as f64 - window));
        let first = contacts * shift;
        if settled.is_some() && first + window > max_steps as f64 {
            break;
        }
        if shift < 1.0 || first + window > taken as f64 {
            continue;
        }
        let three = [2.0, 1.0, 0.0].map(|before| first - before * shift);
        let soil = three.map(|from| record.soil_means(from, from + window));
        let measured = three.map(|from| record.means(from, from + window));
        let [soil, measured] = [series(soil)?, series(measured)?];
        let sinkage = soil[2].last.abs().max(1e-3 * radius);
        let scales = [load, load * radius, sinkage, load];
        let left = soil
            .iter()
            .zip(scales)
            .map(|(series, scale)| series.left() / scale);
        // The remaining change is scaled to a contact length if the windows begin closer together.
        let left = left.fold(0.0, f64::max) * (contact / shift);
        let means = measured.map(|series| series.limit());
        let first_step = first as usize;
        settled = Some((Windows { means, first_step }, Some(left)));
        if left <= tolerance {
            break;
        }
        contacts += 1.0;
    }
    settled.ok_or(Rejection::InvalidParameter {
        name: "most_travel_m",
        value: max_steps as f64 * rolling.steps.travel,
        unit: "m",
        bound: "long enough for a window of averages",
    })
}

/// Returns the length of a window in steps, from a contact and a grouser period in steps: long enough that the grid's
/// ripple cancels.
fn window(contact: f64, period: Option<f64>, to_column: usize, max_steps: usize) -> f64 {
    let whole = match period {
        Some(period) if 4.0 * period <= max_steps as f64 => 2.0 * period,
        Some(period) => period,
        None => to_column as f64,
    };
    let max_count = libm::floor(0.5 * max_steps as f64 / whole).max(1.0);
    whole * libm::ceil(contact / whole).max(1.0).min(max_count)
}

/// Returns the means of the four channels over three windows, channel by channel.
fn series(means: [Result<[f64; 4], Rejection>; 3]) -> Result<[Series; 4], Rejection> {
    let [first, second, last] = means;
    let (first, second, last) = (first?, second?, last?);
    Ok(core::array::from_fn(|channel| Series {
        changes: [second[channel] - first[channel], last[channel] - second[channel]],
        last: last[channel],
    }))
}

/// Averages histories at 10 Hz, filtered, with their transients cut.
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

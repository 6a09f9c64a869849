//! Observables as bytes: little-endian `f64`, one vector after the other.
//!
//! Four channels and five diagnostics of each run come first; nothing else stands in the oldest form. A second form adds
//! `settled_to`: then a not-a-number ends the bytes. The third holds anything more: then an infinity ends them, with
//! what there is before it. No observable is either. The fourth form is any of these with histories behind it: then a negative
//! infinity ends the bytes, before it the number of runs and of the samples of each.
//!
//! A model that is not ours has channels alone, and not all of them: their vectors, and one byte that has a bit for each.

use shared::channel::Channel;
use shared::outcome::{Observables, SimulatedHistory};

use super::error::StoreError;

/// Vectors per run that always stand there.
const VECTORS: usize = 9;

/// Numbers before the infinity that ends the third form: runs, whether `settled_to` and the four derivatives stand there
/// (0 or 1), plates, rings.
const TRAILER: usize = 5;

/// The bytes of numbers.
pub(super) fn encode(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// The bytes of observables.
pub(super) fn encode_whole(o: &Observables) -> Vec<u8> {
    if o.simulated_travel_m.is_empty() && Channel::ALL.iter().any(|c| !o.channel(*c).is_empty()) {
        return encode_channels(o);
    }
    let mut bytes = encode_averages(o);
    if o.histories.is_empty() {
        return bytes;
    }
    for history in &o.histories {
        for channel in Channel::ALL {
            bytes.extend(encode(history.channel(channel)));
        }
    }
    let samples = o.histories.iter().map(|h| h.sinkage_m.len() as f64);
    let runs = o.histories.len() as f64;
    bytes.extend(encode(
        &samples.chain([runs, f64::NEG_INFINITY]).collect::<Vec<_>>(),
    ));
    bytes
}

/// The bytes of channels without anything else.
fn encode_channels(o: &Observables) -> Vec<u8> {
    let there = |c: &Channel| !o.channel(*c).is_empty();
    let vectors = Channel::ALL.iter().filter(|c| there(c));
    let mut bytes: Vec<u8> = vectors.flat_map(|c| encode(o.channel(*c))).collect();
    let bit = |c: &Channel| u8::from(there(c)) << c.index();
    bytes.push(Channel::ALL.iter().map(bit).sum());
    bytes
}

/// The channels of bytes that end with the byte of which are there.
fn decode_channels(words: &[[u8; 8]], there: u8) -> Option<Observables> {
    let mut o = Observables::default();
    let channels = Channel::ALL.into_iter().filter(|c| there & (1 << c.index()) != 0);
    let count = channels.clone().count();
    if count == 0 || there >= 1 << Channel::ALL.len() || !words.len().is_multiple_of(count) {
        return None;
    }
    let runs = words.len() / count;
    for (channel, vector) in channels.zip(words.chunks(runs.max(1))) {
        *o.channel_mut(channel) = vector.iter().map(|word| f64::from_le_bytes(*word)).collect();
    }
    Some(o)
}

/// The bytes of everything but histories.
fn encode_averages(o: &Observables) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(o.sinkage_m.len() * VECTORS * 8);
    let mut push = |values: &[f64]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    push(&o.drawbar_pull_n);
    push(&o.torque_n_m);
    push(&o.sinkage_m);
    push(&o.lateral_force_n);
    push(&o.b_eff_m);
    push(&o.contact_length_m);
    push(&o.residual_load_n);
    push(
        &o.nodes_in_contact
            .iter()
            .map(|&n| f64::from(n))
            .collect::<Vec<_>>(),
    );
    push(&o.simulated_travel_m);
    push(&o.settled_to);
    let derivatives = Channel::ALL.map(|c| o.sensitivity(c));
    let more = [derivatives[0], &o.plate_pressure_pa, &o.shear_stress_pa];
    if more.iter().all(|v| v.is_empty()) {
        if !o.settled_to.is_empty() {
            push(&[f64::NAN]);
        }
        return bytes;
    }
    derivatives.into_iter().for_each(&mut push);
    push(&o.plate_pressure_pa);
    push(&o.shear_stress_pa);
    let there = |v: &[f64]| f64::from(u8::from(!v.is_empty()));
    let count = |v: &[f64]| v.len() as f64;
    push(&[
        count(&o.sinkage_m),
        there(&o.settled_to),
        there(derivatives[0]),
        count(&o.plate_pressure_pa),
        count(&o.shear_stress_pa),
        f64::INFINITY,
    ]);
    bytes
}

/// The numbers of bytes.
pub(super) fn decode_values(bytes: &[u8]) -> Result<Vec<f64>, StoreError> {
    let (words, rest) = bytes.as_chunks::<8>();
    if rest.is_empty() {
        Ok(words.iter().map(|w| f64::from_le_bytes(*w)).collect())
    } else {
        Err(StoreError::Corrupt(format!("a vector of {} bytes", bytes.len())))
    }
}

/// Lengths of what stands in the bytes.
struct Extent {
    runs: usize,
    settled: bool,
    derivatives: bool,
    plates: usize,
    rings: usize,
}

impl Extent {
    fn words(&self) -> Option<usize> {
        let vectors = VECTORS + usize::from(self.settled) + 4 * usize::from(self.derivatives);
        self.runs
            .checked_mul(vectors)?
            .checked_add(self.plates)?
            .checked_add(self.rings)
    }

    /// Splits the end off: what stands there, and the words before it.
    fn split(words: &[f64]) -> Option<(Extent, &[f64])> {
        let of_runs = |words: &[f64], settled: bool| {
            let vectors = VECTORS + usize::from(settled);
            words.len().is_multiple_of(vectors).then(|| Extent {
                runs: words.len() / vectors,
                settled,
                derivatives: false,
                plates: 0,
                rings: 0,
            })
        };
        match words {
            [words @ .., last] if last.is_nan() => Some((of_runs(words, true)?, words)),
            [words @ .., last] if last.is_infinite() => {
                let (words, trailer) = words.split_at_checked(words.len().checked_sub(TRAILER)?)?;
                // Written from counts, so the conversion back is exact; of anything else the sum is wrong.
                let &[runs, settled, derivatives, plates, rings] = trailer else {
                    return None;
                };
                let extent = Extent {
                    runs: runs as usize,
                    settled: settled > 0.0,
                    derivatives: derivatives > 0.0,
                    plates: plates as usize,
                    rings: rings as usize,
                };
                (extent.words() == Some(words.len())).then_some((extent, words))
            }
            words => Some((of_runs(words, false)?, words)),
        }
    }
}

/// The observables of bytes.
pub(super) fn decode(bytes: &[u8]) -> Result<Observables, StoreError> {
    if let (words, &[there]) = bytes.as_chunks::<8>() {
        let corrupt = || StoreError::Corrupt(format!("channels of {} bytes", bytes.len()));
        return decode_channels(words, there).ok_or_else(corrupt);
    }
    let corrupt = || StoreError::Corrupt(format!("observables of {} bytes", bytes.len()));
    let words = decode_values(bytes).map_err(|_| corrupt())?;
    let (words, histories) = split_histories(&words).ok_or_else(corrupt)?;
    let (extent, values) = Extent::split(words).ok_or_else(corrupt)?;
    let mut rest = values;
    let mut take = |count: usize| {
        let (vector, behind) = rest.split_at(count);
        rest = behind;
        vector.to_vec()
    };
    let runs = extent.runs;
    let optional = |there: bool| if there { runs } else { 0 };
    Ok(Observables {
        drawbar_pull_n: take(runs),
        torque_n_m: take(runs),
        sinkage_m: take(runs),
        lateral_force_n: take(runs),
        b_eff_m: take(runs),
        contact_length_m: take(runs),
        residual_load_n: take(runs),
        // Written from u32, so the conversion back is exact.
        nodes_in_contact: take(runs).into_iter().map(|n| n as u32).collect(),
        simulated_travel_m: take(runs),
        settled_to: take(optional(extent.settled)),
        d_drawbar_pull_n: take(optional(extent.derivatives)),
        d_torque_n_m: take(optional(extent.derivatives)),
        d_sinkage_m: take(optional(extent.derivatives)),
        d_lateral_force_n: take(optional(extent.derivatives)),
        plate_pressure_pa: take(extent.plates),
        shear_stress_pa: take(extent.rings),
        // kept beside, and only of what is fitted
        coarse: None,
        histories,
    })
}

/// Splits histories off the end, where there are any.
fn split_histories(all: &[f64]) -> Option<(&[f64], Vec<SimulatedHistory>)> {
    let [words @ .., runs, f64::NEG_INFINITY] = all else {
        return Some((all, Vec::new()));
    };
    // Written from counts, so the conversion back is exact; of anything else the lengths are wrong.
    let (words, samples) = words.split_at_checked(words.len().checked_sub(*runs as usize)?)?;
    let count: f64 = samples.iter().sum();
    let (words, mut rest) = words.split_at_checked(words.len().checked_sub(4 * count as usize)?)?;
    let mut histories = Vec::new();
    for &samples in samples {
        let mut take = || {
            let (channel, behind) = rest.split_at_checked(samples as usize)?;
            rest = behind;
            Some(channel.to_vec())
        };
        histories.push(SimulatedHistory {
            drawbar_pull_n: take()?,
            torque_n_m: take()?,
            sinkage_m: take()?,
            lateral_force_n: take()?,
        });
    }
    Some((words, histories))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decode_inverts_encode_to_the_bit() {
        let mut observables = Observables {
            drawbar_pull_n: vec![1.5, -0.0],
            torque_n_m: vec![0.1, 1e-300],
            sinkage_m: vec![0.3, 0.2],
            lateral_force_n: vec![0.0, 7.0],
            b_eff_m: vec![0.03, 0.04],
            contact_length_m: vec![0.05, 0.06],
            residual_load_n: vec![1e-12, 0.0],
            nodes_in_contact: vec![16, 24],
            simulated_travel_m: vec![0.0, 1.0],
            ..Observables::default()
        };
        assert_eq!(encode_whole(&observables).len(), 9 * 2 * 8);
        assert_eq!(decode(&encode_whole(&observables)).unwrap(), observables);
        observables.settled_to = vec![0.003, 0.004];
        assert_eq!(decode(&encode_whole(&observables)).unwrap(), observables);
        assert_eq!(encode_whole(&observables).len(), 21 * 8);
        for settled_to in [vec![0.003, 0.004], Vec::new()] {
            observables.settled_to = settled_to;
            observables.plate_pressure_pa = vec![1e4, 2e4, 3e4];
            assert_eq!(decode(&encode_whole(&observables)).unwrap(), observables);
            observables.d_drawbar_pull_n = vec![-1.0, -2.0];
            observables.d_torque_n_m = vec![0.1, 0.2];
            observables.d_sinkage_m = vec![-0.01, -0.02];
            observables.d_lateral_force_n = vec![0.0, -0.0];
            assert_eq!(decode(&encode_whole(&observables)).unwrap(), observables);
            let bytes = encode_whole(&observables);
            assert!(decode(&bytes[8..]).is_err());
            observables.d_drawbar_pull_n.clear();
            observables.d_torque_n_m.clear();
            observables.d_sinkage_m.clear();
            observables.d_lateral_force_n.clear();
        }
        let history = |samples: usize, x: f64| SimulatedHistory {
            drawbar_pull_n: vec![x; samples],
            torque_n_m: vec![2.0 * x; samples],
            sinkage_m: vec![-x; samples],
            lateral_force_n: vec![0.0; samples],
        };
        for settled_to in [vec![0.003, 0.004], Vec::new()] {
            observables.settled_to = settled_to;
            for plates in [Vec::new(), vec![1e4]] {
                observables.plate_pressure_pa = plates;
                observables.histories = vec![history(3, 0.25), history(5, 1e-3)];
                let bytes = encode_whole(&observables);
                assert_eq!(decode(&bytes).unwrap(), observables);
                assert!(decode(&bytes[8 * 14..]).is_err());
            }
        }
        let bevameter = Observables {
            shear_stress_pa: vec![7.0],
            ..Observables::default()
        };
        assert_eq!(decode(&encode_whole(&bevameter)).unwrap(), bevameter);
        assert!(decode(&[0; 10]).is_err());
    }
}

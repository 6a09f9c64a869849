//! The binary form of observables: a mark, the lengths of their vectors and histories as MessagePack, then all numbers. Rows without the
//! mark were written by earlier versions.

use shared::channel::Channel;
use shared::outcome::Observables;

use super::blob::{self, Lengths, VECTORS, numbers, vectors};
use super::error::StoreError;
use super::older_blob;

/// The mark: a not-a-number with which no earlier form begins.
const MARK: [u8; 8] = 0x7ff8_0000_0000_0001_u64.to_le_bytes();

/// The number of vectors of versions without transients.
const BEFORE_TRANSIENTS: usize = 16;

/// Encodes observables as bytes.
pub(super) fn encode(o: &Observables) -> Vec<u8> {
    let vectors = vectors(o);
    let lengths = vectors.each_ref().map(|vector| vector.len());
    let samples: Vec<usize> = o
        .histories
        .iter()
        .map(|history| history.sinkage_m.len())
        .collect();
    let header = rmp_serde::to_vec(&(&lengths[..], samples)).expect("numbers have a MessagePack form");
    let mut bytes = [&MARK[..], &header].concat();
    vectors
        .iter()
        .for_each(|vector| bytes.extend(blob::encode(vector)));
    for history in &o.histories {
        let channels = Channel::ALL.iter();
        channels.for_each(|channel| bytes.extend(blob::encode(history.channel(*channel))));
    }
    bytes
}

/// Decodes observables from bytes, in this form or an earlier one.
pub(super) fn decode(bytes: &[u8]) -> Result<Observables, StoreError> {
    let observables = match bytes.strip_prefix(&MARK) {
        Some(described) => decode_described(described),
        None => older_blob::decode(bytes),
    };
    observables.ok_or_else(|| StoreError::Corrupt(format!("observables of {} bytes", bytes.len())))
}

fn decode_described(mut bytes: &[u8]) -> Option<Observables> {
    let (lengths, samples): (Vec<usize>, Vec<usize>) = rmp_serde::from_read(&mut bytes).ok()?;
    let mut vectors = [0; VECTORS];
    match lengths.len() {
        // rows of versions without transients
        count @ (BEFORE_TRANSIENTS | VECTORS) => vectors[..count].copy_from_slice(&lengths),
        _ => return None,
    }
    Lengths { vectors, samples }.split(&numbers(bytes)?)
}

#[cfg(test)]
mod tests {
    use shared::outcome::SimulatedHistory;

    use super::*;

    fn history(samples: usize, x: f64) -> SimulatedHistory {
        SimulatedHistory {
            drawbar_pull_n: vec![x; samples],
            torque_n_m: vec![2.0 * x; samples],
            sinkage_m: vec![-x; samples],
            lateral_force_n: vec![0.0; samples],
        }
    }

    #[test]
    fn rows_of_versions_without_transients_are_read() {
        let observables = Observables {
            sinkage_m: vec![0.3, 0.2],
            ..Observables::default()
        };
        let lengths = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0_usize];
        let header = rmp_serde::to_vec(&(&lengths[..], Vec::<usize>::new())).unwrap();
        let bytes = [&MARK[..], &header, &blob::encode(&[0.3, 0.2])].concat();
        assert_eq!(decode(&bytes).unwrap(), observables);
    }

    #[test]
    fn decode_inverts_encode_to_the_bit_whatever_is_there() {
        let wheel = Observables {
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
        // Nine vectors; a mark, lengths and their number.
        assert_eq!(encode(&wheel).len(), 9 * 2 * 8 + 8 + 22);
        let settled = Observables {
            settled_to: vec![0.003, 0.004],
            histories: vec![history(3, 0.25), history(500, 1e-3)],
            ..wheel.clone()
        };
        let everything = Observables {
            d_drawbar_pull_n: vec![-1.0, -2.0],
            d_torque_n_m: vec![0.1, 0.2],
            d_sinkage_m: vec![-0.01, -0.02],
            d_lateral_force_n: vec![0.0, -0.0],
            plate_pressure_pa: vec![1e4, 2e4, 3e4],
            ..settled.clone()
        };
        let bevameter = Observables {
            shear_stress_pa: vec![7.0],
            transient_sinkage_m: vec![0.02, 0.03],
            ..Observables::default()
        };
        let channel = Observables {
            sinkage_m: vec![0.1],
            ..Observables::default()
        };
        for observables in [
            wheel,
            settled,
            everything,
            bevameter,
            channel,
            Observables::default(),
        ] {
            let bytes = encode(&observables);
            let decoded = decode(&bytes).unwrap();
            assert_eq!(decoded, observables);
            assert_eq!(encode(&decoded), bytes);
            for damaged in [
                &bytes[..bytes.len() - 1],
                &bytes[..12],
                &[&bytes[..], &[0; 8]].concat(),
            ] {
                assert!(decode(damaged).is_err(), "{observables:?}");
            }
        }
    }
}

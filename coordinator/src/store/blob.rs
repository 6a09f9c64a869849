//! Observables as bytes: little-endian `f64`, one vector after the other.

use shared::outcome::Observables;

use super::StoreError;

/// Vectors per run: four channels and five diagnostics. A tenth, `settled_to`, stands only where there is one; then a
/// not-a-number ends the bytes, which no observable can be.
const VECTORS: usize = 9;

/// The bytes of numbers.
pub(super) fn encode(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// The bytes of observables.
pub(super) fn encode_whole(o: &Observables) -> Vec<u8> {
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
    if !o.settled_to.is_empty() {
        push(&o.settled_to);
        push(&[f64::NAN]);
    }
    bytes
}

/// The numbers of bytes.
pub(super) fn decode_values(bytes: &[u8]) -> Result<Vec<f64>, StoreError> {
    let (words, rest) = bytes.as_chunks::<8>();
    if rest.is_empty() {
        Ok(words.iter().map(|w| f64::from_le_bytes(*w)).collect())
    } else {
        Err(StoreError::Corrupt(format!(
            "fitted values of {} bytes",
            bytes.len()
        )))
    }
}

/// The observables of bytes.
pub(super) fn decode(bytes: &[u8]) -> Result<Observables, StoreError> {
    let (words, rest) = bytes.as_chunks::<8>();
    let (words, vectors) = match words {
        [words @ .., last] if f64::from_le_bytes(*last).is_nan() => (words, VECTORS + 1),
        words => (words, VECTORS),
    };
    if !rest.is_empty() || words.len() % vectors != 0 {
        return Err(StoreError::Corrupt(format!(
            "observables of {} bytes",
            bytes.len()
        )));
    }
    let values: Vec<f64> = words.iter().map(|w| f64::from_le_bytes(*w)).collect();
    let runs = values.len() / vectors;
    let vector = |k: usize| values[k * runs..(k + 1) * runs].to_vec();
    Ok(Observables {
        drawbar_pull_n: vector(0),
        torque_n_m: vector(1),
        sinkage_m: vector(2),
        lateral_force_n: vector(3),
        b_eff_m: vector(4),
        contact_length_m: vector(5),
        residual_load_n: vector(6),
        // Written from u32, so the conversion back is exact.
        nodes_in_contact: vector(7).into_iter().map(|n| n as u32).collect(),
        simulated_travel_m: vector(8),
        settled_to: if vectors > VECTORS {
            vector(VECTORS)
        } else {
            Vec::new()
        },
    })
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
            settled_to: Vec::new(),
        };
        assert_eq!(decode(&encode_whole(&observables)).unwrap(), observables);
        observables.settled_to = vec![0.003, 0.004];
        assert_eq!(decode(&encode_whole(&observables)).unwrap(), observables);
        assert!(decode(&[0; 10]).is_err());
    }
}

//! The form of blobs: vectors of numbers as little-endian `f64`.

use std::borrow::Cow;

use shared::outcome::{Observables, SimulatedHistory};

use super::error::StoreError;

/// The number of vectors in [`Observables`].
pub(super) const VECTORS: usize = 17;

/// The lengths of the vectors, in their order, and the number of samples of each history.
pub(super) struct Lengths {
    pub(super) vectors: [usize; VECTORS],
    pub(super) samples: Vec<usize>,
}

/// Encodes numbers as bytes.
pub(super) fn encode(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Decodes numbers from bytes.
pub(super) fn decode_values(bytes: &[u8]) -> Result<Vec<f64>, StoreError> {
    let corrupt = || StoreError::Corrupt(format!("a vector of {} bytes", bytes.len()));
    numbers(bytes).ok_or_else(corrupt)
}

/// Decodes numbers from bytes. Returns `None` where the last number is incomplete.
pub(super) fn numbers(bytes: &[u8]) -> Option<Vec<f64>> {
    let (words, rest) = bytes.as_chunks::<8>();
    let numbers = words.iter().map(|word| f64::from_le_bytes(*word));
    rest.is_empty().then(|| numbers.collect())
}

impl Lengths {
    /// Splits the concatenated numbers into observables. Returns `None` where there are too many or too few numbers.
    pub(super) fn split(&self, numbers: &[f64]) -> Option<Observables> {
        let mut rest = numbers;
        let mut take = |count: usize| {
            let (vector, behind) = rest.split_at_checked(count)?;
            rest = behind;
            Some(vector.to_vec())
        };
        let vectors: Option<Vec<Vec<f64>>> = self.vectors.iter().map(|length| take(*length)).collect();
        let mut observables = observables(vectors?.try_into().ok()?);
        for &samples in &self.samples {
            observables.histories.push(SimulatedHistory {
                drawbar_pull_n: take(samples)?,
                torque_n_m: take(samples)?,
                sinkage_m: take(samples)?,
                lateral_force_n: take(samples)?,
            });
        }
        rest.is_empty().then_some(observables)
    }
}

/// Returns the vectors of observables in the order in which they are stored.
pub(super) fn vectors(o: &Observables) -> [Cow<'_, [f64]>; VECTORS] {
    let nodes: Vec<f64> = o.nodes_in_contact.iter().map(|&n| f64::from(n)).collect();
    [
        (&o.drawbar_pull_n).into(),
        (&o.torque_n_m).into(),
        (&o.sinkage_m).into(),
        (&o.lateral_force_n).into(),
        (&o.b_eff_m).into(),
        (&o.contact_length_m).into(),
        (&o.residual_load_n).into(),
        nodes.into(),
        (&o.simulated_travel_m).into(),
        (&o.settled_to).into(),
        (&o.d_drawbar_pull_n).into(),
        (&o.d_torque_n_m).into(),
        (&o.d_sinkage_m).into(),
        (&o.d_lateral_force_n).into(),
        (&o.plate_pressure_pa).into(),
        (&o.shear_stress_pa).into(),
        (&o.transient_sinkage_m).into(),
    ]
}

/// Makes observables from their vectors in this order.
fn observables(vectors: [Vec<f64>; VECTORS]) -> Observables {
    let mut vectors = vectors.into_iter();
    let mut next = || vectors.next().unwrap_or_default();
    Observables {
        drawbar_pull_n: next(),
        torque_n_m: next(),
        sinkage_m: next(),
        lateral_force_n: next(),
        b_eff_m: next(),
        contact_length_m: next(),
        residual_load_n: next(),
        // The numbers were written from `u32`, so the conversion back is exact.
        nodes_in_contact: next().into_iter().map(|n| n as u32).collect(),
        simulated_travel_m: next(),
        settled_to: next(),
        d_drawbar_pull_n: next(),
        d_torque_n_m: next(),
        d_sinkage_m: next(),
        d_lateral_force_n: next(),
        plate_pressure_pa: next(),
        shear_stress_pa: next(),
        transient_sinkage_m: next(),
        // These values have a column of their own, and only fitted runs have them.
        histories: Vec::new(),
    }
}

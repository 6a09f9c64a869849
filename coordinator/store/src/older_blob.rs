//! The binary forms of observables that earlier versions wrote: numbers alone, distinguished by the last eight bytes.
//!
//! All forms begin with the first nine vectors of each run. A not-a-number at the end adds `settled_to`. An infinity at the end adds
//! further vectors, preceded by numbers that list them. A negative infinity at the end adds histories to any of these forms, preceded by
//! the number of samples of each history and the number of histories. No observable has one of these values. Channels of an external model
//! have a form of their own: their vectors, and one byte with a bit for each.

use shared::channel::Channel;
use shared::outcome::Observables;

use super::blob::{Lengths, VECTORS, numbers};

/// The number of vectors that every form has.
const ALWAYS: usize = 9;
/// The index of `settled_to` in the order of the vectors; the derivatives, plates and rings follow.
const SETTLED: usize = 9;
const PLATES: usize = 14;
const RINGS: usize = 15;

/// Decodes observables from bytes.
pub(super) fn decode(bytes: &[u8]) -> Option<Observables> {
    let mut vectors = [0; VECTORS];
    if let (words, &[channels]) = bytes.as_chunks::<8>() {
        if channels == 0 || channels >= 1 << Channel::ALL.len() {
            return None;
        }
        for channel in Channel::ALL
            .into_iter()
            .filter(|c| channels & (1 << c.index()) != 0)
        {
            vectors[channel.index()] = words.len() / channels.count_ones() as usize;
        }
        let samples = Vec::new();
        return Lengths { vectors, samples }.split(&numbers(words.as_flattened())?);
    }
    let all = numbers(bytes)?;
    let (words, samples) = split_samples(&all)?;
    let count = samples
        .iter()
        .try_fold(0_usize, |sum, &count| sum.checked_add(count))?;
    let before = words.len().checked_sub(count.checked_mul(Channel::ALL.len())?)?;
    let (averages, histories) = words.split_at(before);
    let averages = match averages {
        [rest @ .., end] if end.is_nan() => {
            vectors[..=SETTLED].fill(rest.len() / (ALWAYS + 1));
            rest
        }
        // The lengths were written from counts, so the conversion back is exact. In bytes of another form their sum is wrong.
        &[
            ref rest @ ..,
            runs,
            settled,
            derivatives,
            plates,
            rings,
            f64::INFINITY,
        ] => {
            let runs_if = |is_there: f64| if is_there > 0.0 { runs as usize } else { 0 };
            vectors[..ALWAYS].fill(runs as usize);
            vectors[SETTLED] = runs_if(settled);
            vectors[SETTLED + 1..PLATES].fill(runs_if(derivatives));
            vectors[PLATES] = plates as usize;
            vectors[RINGS] = rings as usize;
            rest
        }
        rest => {
            vectors[..ALWAYS].fill(rest.len() / ALWAYS);
            rest
        }
    };
    Lengths { vectors, samples }.split(&[averages, histories].concat())
}

/// Splits the lengths of the histories off the end, where there are histories.
fn split_samples(all: &[f64]) -> Option<(&[f64], Vec<usize>)> {
    let [words @ .., histories, f64::NEG_INFINITY] = all else {
        return Some((all, Vec::new()));
    };
    // The lengths were written from counts, so the conversion back is exact. In bytes of another form they are wrong.
    let (words, samples) = words.split_at_checked(words.len().checked_sub(*histories as usize)?)?;
    Some((words, samples.iter().map(|&count| count as usize).collect()))
}

#[cfg(test)]
mod tests {
    use shared::outcome::SimulatedHistory;

    use super::super::blob::encode;
    use super::*;

    /// Makes nine vectors of two runs: 1, 1, 2, 2, … 9, 9.
    fn nine() -> Vec<f64> {
        (1..=9).flat_map(|i| [f64::from(i); 2]).collect()
    }

    fn wheel() -> Observables {
        Observables {
            drawbar_pull_n: vec![1.0; 2],
            torque_n_m: vec![2.0; 2],
            sinkage_m: vec![3.0; 2],
            lateral_force_n: vec![4.0; 2],
            b_eff_m: vec![5.0; 2],
            contact_length_m: vec![6.0; 2],
            residual_load_n: vec![7.0; 2],
            nodes_in_contact: vec![8; 2],
            simulated_travel_m: vec![9.0; 2],
            ..Observables::default()
        }
    }

    #[track_caller]
    fn is(numbers: &[&[f64]], observables: &Observables) {
        let bytes = encode(&numbers.concat());
        assert_eq!(decode(&bytes).unwrap(), *observables);
        assert!(decode(&bytes[8..]).is_none());
    }

    #[test]
    fn nine_vectors_stand_alone_or_with_what_runs_had_settled_to() {
        is(&[&nine()], &wheel());
        let settled = Observables {
            settled_to: vec![0.1, 0.2],
            ..wheel()
        };
        is(&[&nine(), &[0.1, 0.2, f64::NAN]], &settled);
    }

    #[test]
    fn an_infinity_ends_anything_more() {
        let with_plates = Observables {
            plate_pressure_pa: vec![1e4],
            shear_stress_pa: vec![2e4, 3e4],
            ..wheel()
        };
        let end = [2.0, 0.0, 0.0, 1.0, 2.0, f64::INFINITY];
        is(&[&nine(), &[1e4, 2e4, 3e4], &end], &with_plates);
        let with_derivatives = Observables {
            settled_to: vec![0.1, 0.2],
            d_drawbar_pull_n: vec![10.0; 2],
            d_torque_n_m: vec![11.0; 2],
            d_sinkage_m: vec![12.0; 2],
            d_lateral_force_n: vec![13.0; 2],
            ..wheel()
        };
        let derivatives: Vec<f64> = (10..14).flat_map(|i| [f64::from(i); 2]).collect();
        let end = [2.0, 1.0, 1.0, 0.0, 0.0, f64::INFINITY];
        is(&[&nine(), &[0.1, 0.2], &derivatives, &end], &with_derivatives);
    }

    #[test]
    fn a_negative_infinity_ends_histories() {
        let history = |x: f64, samples: usize| SimulatedHistory {
            drawbar_pull_n: vec![x; samples],
            torque_n_m: vec![x + 1.0; samples],
            sinkage_m: vec![x + 2.0; samples],
            lateral_force_n: vec![x + 3.0; samples],
        };
        let samples: Vec<f64> = (0..4).map(|i| 0.5 + f64::from(i)).collect();
        let more: Vec<f64> = (0..4).flat_map(|i| [20.0 + f64::from(i); 3]).collect();
        let with_histories = Observables {
            histories: vec![history(0.5, 1), history(20.0, 3)],
            ..wheel()
        };
        let end = [1.0, 3.0, 2.0, f64::NEG_INFINITY];
        is(&[&nine(), &samples, &more, &end], &with_histories);
        let settled = Observables {
            settled_to: vec![0.1, 0.2],
            ..with_histories
        };
        is(&[&nine(), &[0.1, 0.2, f64::NAN], &samples, &more, &end], &settled);
    }

    #[test]
    fn channels_of_a_model_that_is_not_ours_end_with_a_byte() {
        let mut bytes = encode(&[1.0, 2.0, 3.0, 4.0]);
        bytes.push(0b101);
        let channels = Observables {
            drawbar_pull_n: vec![1.0, 2.0],
            sinkage_m: vec![3.0, 4.0],
            ..Observables::default()
        };
        assert_eq!(decode(&bytes).unwrap(), channels);
        for wrong in [0, 0b111, 0b1_0000] {
            bytes.pop();
            bytes.push(wrong);
            assert!(decode(&bytes).is_none(), "{wrong}");
        }
        assert!(decode(&[0; 10]).is_none());
    }
}

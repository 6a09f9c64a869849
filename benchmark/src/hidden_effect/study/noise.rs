//! Gaussian noise of the measured channels.

use statistics::rng::Stream;

use super::design::CHANNELS;

/// The values of a run, in the order of the channels.
pub type RunValues = [f64; CHANNELS];

/// Returns noise sds that are a share of the root mean square of each channel.
pub fn noise_sds<'a>(share: f64, values: impl Iterator<Item = &'a RunValues> + Clone) -> RunValues {
    let count = values.clone().count() as f64;
    std::array::from_fn(|channel| {
        let squares: f64 = values.clone().map(|run| run[channel] * run[channel]).sum();
        share * (squares / count).sqrt()
    })
}

/// Adds noise to all values, with one normal number for each in their order.
pub fn add_noise(values: &mut [RunValues], sds: RunValues, stream: &mut Stream) {
    let normals = stream.normals(values.as_flattened().len());
    let sds = sds.into_iter().cycle();
    for ((x, sd), z) in values.as_flattened_mut().iter_mut().zip(sds).zip(normals) {
        *x += sd * z;
    }
}

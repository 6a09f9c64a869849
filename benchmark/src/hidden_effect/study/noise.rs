//! Noise of the measured channels.

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

/// Adds Gaussian noise to all values, with one normal number for each in their order.
pub fn add_noise(values: &mut [RunValues], sds: RunValues, stream: &mut Stream) {
    let normals = stream.normals(values.as_flattened().len());
    let sds = sds.into_iter().cycle();
    for ((x, sd), z) in values.as_flattened_mut().iter_mut().zip(sds).zip(normals) {
        *x += sd * z;
    }
}

/// Adds noise with the density of Student's t with three degrees of freedom, scaled to these sds.
pub fn add_heavy_noise(values: &mut [RunValues], sds: RunValues, stream: &mut Stream) {
    let values = values.as_flattened_mut();
    let normals = stream.normals(4 * values.len());
    let sds = sds.into_iter().cycle();
    for ((x, sd), z) in values.iter_mut().zip(sds).zip(normals.as_chunks::<4>().0) {
        // t = z0 / sqrt((z1^2 + z2^2 + z3^2) / 3) has a variance of 3.
        *x += sd * z[0] / (z[1] * z[1] + z[2] * z[2] + z[3] * z[3]).sqrt();
    }
}

//! A flag: something that deserves attention.

/// Something that deserves attention.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Flag {
    /// `trend`, `chi2`, `outlier`, `conflict`, `bound`, `not_equilibrated`, `no_information`, `rejections`; later versions
    /// add others.
    pub kind: String,
    /// The channel it is about.
    pub channel: Option<String>,
    /// The condition it varies with: `constant`, `slip`, `wheel_load`, `sled_speed`, `slip_x_sled_speed`.
    pub against: Option<String>,
    /// Probability of the observation if nothing were wrong.
    pub p: Option<f64>,
    /// What it means.
    pub text: String,
}

impl Flag {
    /// A flag that is about no channel and no probability.
    pub(crate) fn plain(kind: &str, text: String) -> Self {
        Flag {
            kind: kind.into(),
            channel: None,
            against: None,
            p: None,
            text,
        }
    }
}

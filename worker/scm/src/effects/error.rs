//! Why a model cannot express an effect.

/// Why a model cannot express an effect.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FormError {
    /// The effect has neither formulas nor a mechanism that the model knows.
    #[error("effect {effect} has no form in {model}")]
    NoForm {
        /// Name of the effect.
        effect: String,
        /// Name of the model.
        model: &'static str,
    },
    /// The mechanism takes different parameters.
    #[error("effect {effect}: mechanism {mechanism} takes the parameters {expected}, in this order")]
    Parameters {
        /// Name of the effect.
        effect: String,
        /// Name of the mechanism.
        mechanism: &'static str,
        /// The parameters that it takes.
        expected: String,
    },
}

//! Why a model cannot express an effect.

/// Why a model cannot express an effect.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FormError {
    /// The effect has neither formulas nor a mechanism that the model knows.
    #[error("effect {effect} has no form in {model}")]
    NoForm {
        /// The effect.
        effect: String,
        /// The model.
        model: &'static str,
    },
    /// The mechanism takes other parameters.
    #[error("effect {effect}: mechanism {mechanism} takes the parameters {expected}, in this order")]
    Parameters {
        /// The effect.
        effect: String,
        /// The mechanism.
        mechanism: &'static str,
        /// The parameters that it takes.
        expected: String,
    },
}

//! The question of an evaluation: variant and parameters.

/// The question that a lease asks.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Hash of the variant.
    pub variant: &'a str,
    /// The parameters of the model.
    pub theta: &'a [f64],
}

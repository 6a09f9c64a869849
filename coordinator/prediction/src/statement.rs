//! The statements whose probabilities a request asks for.

use job::Statement;

use crate::error::PredictionError;

/// Largest number of statements: each is evaluated for every error of every draw of every run.
const MAX_STATEMENTS: usize = 50;

/// Reads the statements of a request.
///
/// # Errors
/// [`PredictionError::Request`] has the number of the statements and its bound, or names the statement and its mistake.
/// Checked by `tests::as_many_statements_as_the_bound_are_read`.
pub fn read_statements(texts: &[String]) -> Result<Vec<Statement>, PredictionError> {
    let count = texts.len();
    if count > MAX_STATEMENTS {
        let message = format!("{count} statements must be at most {MAX_STATEMENTS}");
        return Err(PredictionError::Request(message));
    }
    let read = |text: &String| {
        let fail = |e: String| PredictionError::Request(format!("statement \"{text}\": {e}"));
        Statement::read(text).map_err(fail)
    };
    texts.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_statements_as_the_bound_are_read() {
        let mut texts = vec!["slip > 0.1".to_owned(); MAX_STATEMENTS];
        assert_eq!(read_statements(&texts).unwrap().len(), MAX_STATEMENTS);
        texts.push("slip > 0.2".into());
        let error = read_statements(&texts).unwrap_err().to_string();
        assert_eq!(error, "51 statements must be at most 50");
        let error = read_statements(&["pull>1".into()]).unwrap_err().to_string();
        assert!(
            error.starts_with("statement \"pull>1\": character 1: "),
            "{error}"
        );
    }
}

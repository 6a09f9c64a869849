//! Computations beside the threads that answer requests.

use super::error::ServiceError;

/// Computes outside the threads of the runtime: validating files, drawing a large population and replaying a calibration take seconds of
/// CPU time. A panic is an error of this computation alone.
pub(crate) async fn in_background<T, E>(
    compute: impl FnOnce() -> Result<T, E> + Send + 'static,
) -> Result<T, E>
where
    T: Send + 'static,
    E: From<ServiceError> + Send + 'static,
{
    let computed = tokio::task::spawn_blocking(compute).await;
    computed.map_err(ServiceError::not_ended)?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_replay_that_panics_does_not_stop_the_service() {
        let replay: fn() -> Result<(), ServiceError> = || panic!("in a step");
        let error = in_background(replay).await.unwrap_err();
        // Every error but `Stopped` leaves one calibration alone.
        assert!(matches!(error, ServiceError::Panicked(_)), "{error}");
        assert!(error.to_string().contains("in a step"), "{error}");
    }

    #[tokio::test]
    async fn a_computation_that_was_cancelled_is_answered_as_stopped() {
        let endless = tokio::spawn(std::future::pending::<()>());
        endless.abort();
        let error = endless.await.unwrap_err();
        assert!(matches!(ServiceError::not_ended(error), ServiceError::Stopped(_)));
    }
}

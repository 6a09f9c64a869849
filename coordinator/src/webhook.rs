//! Web hooks: messages about the pause or end of a calibration, posted to a URL that was submitted with its job.
//!
//! They are posted only to hosts that the operator lists, without following redirects, so that no user can make the coordinator send
//! requests to other machines of its network.

use std::time::Duration;

use reqwest::redirect::Policy;
use reqwest::{Client, Url};
use serde::Serialize;
use shared::api::CalibrationState;

/// The pauses before each attempt to deliver.
const PAUSES: [Duration; 3] = [Duration::ZERO, Duration::from_secs(2), Duration::from_secs(20)];
/// The longest duration of an attempt.
const TIMEOUT: Duration = Duration::from_secs(10);
/// The longest URL `[bytes]`.
const LONGEST: usize = 2000;
/// The largest part of a wrong URL or of an unknown host that a message shows \[characters\].
const SHOWN: usize = 200;

/// The reason why nothing is posted to a URL.
#[derive(Debug, thiserror::Error)]
pub enum WebhookError {
    /// The text is not a valid URL.
    #[error("webhook {0}: {1}")]
    Url(String, String),
    /// The operator does not list its host.
    #[error("webhook host {0}: the service posts to hosts of its --webhook-host alone")]
    Host(String),
    /// The receiver did not accept it.
    #[error("webhook host {0}: {1}")]
    Refused(String, String),
}

/// The posted message, as JSON.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Announcement {
    pub study: i64,
    pub calibration: i64,
    /// Name of the calibration.
    pub name: String,
    /// New state of the calibration: paused, finished, failed or cancelled.
    pub state: CalibrationState,
    /// The reason of a pause or a failure.
    pub message: Option<String>,
}

/// The hosts to which web hooks may be posted.
#[derive(Debug, Clone, Default)]
pub struct WebhookHosts(pub Vec<String>);

impl WebhookHosts {
    /// Parses a URL and checks that its host is allowed.
    ///
    /// # Errors
    /// [`WebhookError::Url`] and [`WebhookError::Host`].
    pub fn check(&self, url: &str) -> Result<Url, WebhookError> {
        let wrong = |what: String| WebhookError::Url(url.chars().take(SHOWN).collect(), what);
        if url.len() > LONGEST {
            return Err(wrong(format!(
                "{} bytes must be at most {LONGEST} bytes",
                url.len()
            )));
        }
        let parsed = Url::parse(url).map_err(|e| wrong(e.to_string()))?;
        if !["http", "https"].contains(&parsed.scheme()) {
            return Err(wrong(format!(
                "scheme {} is neither http nor https",
                parsed.scheme()
            )));
        }
        let host = parsed.host_str().unwrap_or_default();
        match self.0.iter().any(|listed| listed.eq_ignore_ascii_case(host)) {
            true => Ok(parsed),
            false => Err(WebhookError::Host(host.chars().take(SHOWN).collect())),
        }
    }

    /// Posts an announcement, with repeated attempts if it is not accepted.
    ///
    /// # Errors
    /// [`WebhookError`] of the last attempt.
    pub async fn post(&self, url: &str, announcement: &Announcement) -> Result<(), WebhookError> {
        let target = self.check(url)?;
        // The log states only the host, because path and query may contain a key.
        let host = target.host_str().unwrap_or_default().to_owned();
        let refused = |what: String| WebhookError::Refused(host.clone(), what);
        let client = Client::builder().redirect(Policy::none()).timeout(TIMEOUT);
        let client = match target.scheme() {
            // Without TLS the certificates of the machine are not read, because there may be none.
            "http" => client.tls_certs_only([]),
            _ => client,
        };
        let client = client.build().map_err(|e| refused(e.to_string()))?;
        let mut last = String::new();
        for pause in PAUSES {
            tokio::time::sleep(pause).await;
            match client.post(target.clone()).json(announcement).send().await {
                Ok(answer) if answer.status().is_success() => return Ok(()),
                Ok(answer) => last = format!("status {}", answer.status()),
                Err(error) => last = error.without_url().to_string(),
            }
        }
        Err(refused(last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_listed_host_is_posted_to_and_no_other() {
        let hosts = WebhookHosts(vec!["hooks.example".into()]);
        for url in [
            "https://hooks.example/grouser",
            "http://HOOKS.example:8080/?key=1",
        ] {
            assert!(hosts.check(url).is_ok(), "{url}");
        }
        for url in [
            "https://hooks.example.evil.example/",
            "https://hooks.example@evil.example/",
            "http://169.254.169.254/",
            "file:///etc/passwd",
            "hooks.example",
            "",
        ] {
            assert!(hosts.check(url).is_err(), "{url}");
        }
        let error = WebhookHosts::default()
            .check("http://127.0.0.1/?key=secret")
            .unwrap_err();
        assert!(error.to_string().contains("127.0.0.1"), "{error}");
        assert!(!error.to_string().contains("secret"), "{error}");
    }
}

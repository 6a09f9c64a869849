//! The messages of an exchange in bytes: MessagePack between the programs, JSON for human readers.
//!
//! Both forms have the same keys. MessagePack keeps the bits of every number and costs a fraction of JSON's digits.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::exchange::{ExchangeRequest, ExchangeResponse};
use crate::outcome::Outcome;
use crate::sentence::one_line;

/// A form of the messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WireForm {
    /// JSON text.
    Json,
    /// MessagePack, <https://msgpack.org>, with structures as maps.
    MessagePack,
}

/// Why bytes are not a message.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WireError {
    /// The bytes are malformed, or another message.
    #[error("the body is no such message in {form}: {reason}")]
    Malformed {
        /// The declared form.
        form: WireForm,
        /// The parser's reason.
        reason: String,
    },
    /// The message holds a number that is not finite.
    #[error("the result of lease {lease} holds a number that is not finite")]
    NotFinite {
        /// Number of the lease.
        lease: u64,
    },
}

impl WireForm {
    /// Every form.
    pub const ALL: [WireForm; 2] = [WireForm::Json, WireForm::MessagePack];

    /// Returns the name of the form: `json`, `msgpack`.
    pub fn name(self) -> &'static str {
        ["json", "msgpack"][self as usize]
    }

    /// Returns the media type of the form.
    pub fn media_type(self) -> &'static str {
        ["application/json", "application/vnd.msgpack"][self as usize]
    }

    /// Finds the form of a media type, ignoring its parameters.
    pub fn from_media_type(text: &str) -> Option<Self> {
        let essence = text.split(';').next().unwrap_or_default().trim();
        let named = |form: &Self| essence.eq_ignore_ascii_case(form.media_type());
        Self::ALL.into_iter().find(named)
    }

    fn write(self, message: &impl Serialize) -> Result<Vec<u8>, WireError> {
        match self {
            WireForm::Json => serde_json::to_vec(message).map_err(|e| self.malformed(e)),
            WireForm::MessagePack => rmp_serde::to_vec_named(message).map_err(|e| self.malformed(e)),
        }
    }

    fn read<T: DeserializeOwned>(self, bytes: &[u8]) -> Result<T, WireError> {
        match self {
            WireForm::Json => serde_json::from_slice(bytes).map_err(|e| self.malformed(e)),
            WireForm::MessagePack => {
                let mut rest = bytes;
                let message = rmp_serde::from_read(&mut rest).map_err(|e| self.malformed(e))?;
                if rest.is_empty() {
                    Ok(message)
                } else {
                    Err(self.malformed(format!("{} bytes follow the message", rest.len())))
                }
            }
        }
    }

    fn malformed(self, reason: impl fmt::Display) -> WireError {
        WireError::Malformed {
            form: self,
            reason: one_line(&reason.to_string()).into_owned(),
        }
    }
}

impl fmt::Display for WireForm {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for WireForm {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let form = Self::ALL.into_iter().find(|form| form.name() == word);
        form.ok_or_else(|| format!("\"{word}\" is neither json nor msgpack"))
    }
}

// These functions are not generic, so that they are compiled in this crate with full optimisation.

impl ExchangeRequest {
    /// Encodes the message; [`WireError::Malformed`] if it cannot be written.
    pub fn to_bytes(&self, form: WireForm) -> Result<Vec<u8>, WireError> {
        form.write(self)
    }

    /// Decodes a message; [`WireError`] if the bytes are malformed, or a result holds NaN or an infinity.
    pub fn from_bytes(bytes: &[u8], form: WireForm) -> Result<Self, WireError> {
        let request: Self = form.read(bytes)?;
        for result in &request.results {
            let outcome = match &result.outcome {
                Outcome::Evaluated(observables) => observables.is_finite(),
                Outcome::Rejected(_) | Outcome::Fault(_) => true,
            };
            if !outcome || result.repeated.is_some_and(|repeated| !repeated.is_valid()) {
                return Err(WireError::NotFinite { lease: result.lease });
            }
        }
        Ok(request)
    }
}

impl ExchangeResponse {
    /// Encodes the message; [`WireError::Malformed`] if it cannot be written.
    pub fn to_bytes(&self, form: WireForm) -> Result<Vec<u8>, WireError> {
        form.write(self)
    }

    /// Decodes a message; [`WireError::Malformed`] if the bytes are malformed.
    pub fn from_bytes(bytes: &[u8], form: WireForm) -> Result<Self, WireError> {
        form.read(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exchange::{Lease, PROTOCOL_VERSION, WorkResult};
    use crate::outcome::Observables;

    /// Numbers whose digits or bits are easily lost in conversion.
    const AWKWARD: [f64; 8] = [
        -0.0,
        5e-324,
        f64::MIN_POSITIVE,
        0.1 + 0.2,
        1.0 / 3.0,
        f64::MAX,
        3.0,
        1e23,
    ];

    fn request(values: &[f64]) -> ExchangeRequest {
        let observables = Observables {
            sinkage_m: values.to_vec(),
            nodes_in_contact: vec![0, u32::MAX],
            ..Observables::default()
        };
        ExchangeRequest {
            worker: "w".into(),
            protocol: PROTOCOL_VERSION,
            model_version: "scm".into(),
            models: Default::default(),
            queue_job: None,
            threads: 1,
            evaluation_s: None,
            results: vec![WorkResult {
                lease: u64::MAX,
                calibration: -1,
                evaluation: 7,
                seal: "0a".into(),
                outcome: Outcome::Evaluated(observables),
                repeated: None,
            }],
            holding: vec![9],
            returned: Vec::new(),
            started: vec![9],
            received: 9,
            want: 16,
            wait_ms: 20_000,
        }
    }

    fn response() -> ExchangeResponse {
        ExchangeResponse {
            leases: vec![Lease {
                lease: 1,
                calibration: 2,
                evaluation: 3,
                seal: "0a".into(),
                variant: "00ff".into(),
                theta: AWKWARD.to_vec(),
                announce: false,
            }],
            lease_ms: 15_000,
            remaining: 5,
            in_hand: 2,
            workers: 1,
            duplicates: 0,
            refused: None,
        }
    }

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    #[test]
    fn numbers_keep_their_bits_in_both_forms() {
        for form in WireForm::ALL {
            let sent = request(&AWKWARD);
            let read = ExchangeRequest::from_bytes(&sent.to_bytes(form).unwrap(), form).unwrap();
            assert_eq!(read, sent);
            let Outcome::Evaluated(observables) = &read.results[0].outcome else {
                panic!("{read:?}")
            };
            assert_eq!(bits(&observables.sinkage_m), bits(&AWKWARD), "{form}");
            let read = ExchangeResponse::from_bytes(&response().to_bytes(form).unwrap(), form).unwrap();
            assert_eq!(bits(&read.leases[0].theta), bits(&AWKWARD), "{form}");
            assert_eq!(read, response());
        }
    }

    #[test]
    fn truncated_or_extended_bytes_are_no_message() {
        for form in WireForm::ALL {
            let whole = request(&AWKWARD).to_bytes(form).unwrap();
            for end in 0..whole.len() {
                assert!(
                    ExchangeRequest::from_bytes(&whole[..end], form).is_err(),
                    "{form} {end}"
                );
            }
            let extended = [whole.as_slice(), &[0x01]].concat();
            assert!(ExchangeRequest::from_bytes(&extended, form).is_err(), "{form}");
        }
    }

    #[test]
    fn no_changed_byte_leads_to_a_panic_or_a_number_that_is_not_finite() {
        let whole = request(&AWKWARD).to_bytes(WireForm::MessagePack).unwrap();
        for place in 0..whole.len() {
            for byte in 0..=u8::MAX {
                let mut changed = whole.clone();
                changed[place] = byte;
                let read = ExchangeRequest::from_bytes(&changed, WireForm::MessagePack);
                for result in read.into_iter().flat_map(|read| read.results) {
                    if let Outcome::Evaluated(observables) = &result.outcome {
                        assert!(observables.is_finite());
                    }
                }
            }
        }
    }

    #[test]
    fn a_result_that_is_not_finite_is_named() {
        let sent = request(&[1.0, f64::NAN]).to_bytes(WireForm::MessagePack).unwrap();
        let refused = ExchangeRequest::from_bytes(&sent, WireForm::MessagePack);
        assert_eq!(refused, Err(WireError::NotFinite { lease: u64::MAX }));
    }

    #[test]
    fn a_form_is_known_by_its_media_type_and_its_word() {
        for form in WireForm::ALL {
            assert_eq!(WireForm::from_media_type(form.media_type()), Some(form));
            assert_eq!(form.name().parse(), Ok(form));
        }
        let with = WireForm::from_media_type("Application/JSON; charset=utf-8");
        assert_eq!(with, Some(WireForm::Json));
        assert_eq!(WireForm::from_media_type("application/cbor"), None);
        assert!("xml".parse::<WireForm>().is_err());
    }
}

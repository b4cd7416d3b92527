//! `data:` URIs (RFC 2397).

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

use super::resolve::ResolveError;
use super::resolve::quoted;

/// Exporters are divided over padding; nothing is lost by taking both.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Decodes what follows `data:`. The media type must be empty or in `media`; `limit` is checked before decoding.
pub(super) fn decode(rest: &str, media: &[&str], limit: u64) -> Result<Vec<u8>, ResolveError> {
    let (head, body) = rest.split_once(',').ok_or_else(|| ResolveError::Data("no comma before the data".into()))?;
    let mut fields = head.split(';');
    let kind = fields.next().unwrap_or("").trim();
    if !kind.is_empty() && !media.iter().any(|m| m.eq_ignore_ascii_case(kind)) {
        return Err(ResolveError::Data(format!("media type {}, expected {}", quoted(kind), media.join(" or "))));
    }
    let base64 = fields.any(|field| field.trim().eq_ignore_ascii_case("base64"));
    let bytes = if base64 { body.len() as u64 / 4 * 3 } else { body.len() as u64 / 3 };
    if bytes > limit {
        return Err(ResolveError::TooLarge { uri: "data URI".into(), bytes, limit });
    }
    if base64 {
        BASE64.decode(body).map_err(|e| ResolveError::Data(format!("bad base64: {e}")))
    } else {
        Ok(percent_decode_str(body).collect())
    }
}

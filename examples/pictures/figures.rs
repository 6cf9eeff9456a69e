//! x
use std::path::Path;
pub fn write(_folder: &Path) -> Result<(), String> { Ok(()) }

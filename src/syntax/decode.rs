//! From the bytes of a file to its text.

use crate::diag::{Code, Diagnostic};

/// The text of a file, without a byte order mark; or the reason why it is not text.
pub fn decode(name: &str, bytes: &[u8]) -> Result<String, Diagnostic> {
    let refused = |offset: usize, why: String| {
        let line = bytes[..offset].iter().filter(|b| **b == b'\n').count() + 1;
        Diagnostic::new(Code::E0102, format!("`{name}` is not UTF-8 text: {why} at byte {offset}, line {line}"))
            .help("save it as UTF-8 text")
    };
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let byte = bytes.get(e.valid_up_to()).copied().unwrap_or(0);
        refused(e.valid_up_to(), format!("unexpected byte 0x{byte:02X}"))
    })?;
    if let Some(offset) = text.find('\0') {
        return Err(refused(offset, "NUL character".to_owned()));
    }
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_order_mark_is_left_out() {
        assert_eq!(decode("a.track", b"\xEF\xBB\xBFuse std\r\n").unwrap(), "use std\r\n");
        assert_eq!(decode("a.track", b"").unwrap(), "");
    }

    #[test]
    fn what_is_not_text_is_refused_with_its_place() {
        let latin = decode("a.track", b"// L\xE4nge").unwrap_err();
        assert_eq!(
            (latin.code, latin.message.as_str()),
            (Code::E0102, "`a.track` is not UTF-8 text: unexpected byte 0xE4 at byte 4, line 1")
        );
        let nul = decode("a.track", b"use std\n\0").unwrap_err();
        assert_eq!(nul.message, "`a.track` is not UTF-8 text: NUL character at byte 8, line 2");
    }
}

//! Sealed files: bytes with a label and a checksum over both, so that reading gives the stored bytes or an error.
//!
//! ```text
//! trackbed 1 <SHA-256 of all that follows this line>
//! {"kind":"checkpoint","version":"0.1.0","key":"..."}
//! the bytes themselves
//! ```

use super::{StoreError, sha256};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// First words of a sealed file; the number is the number of the format.
const MAGIC: &str = "trackbed 1 ";

/// Label of a sealed file: its kind, and the key of the stored item.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seal<'a> {
    pub kind: &'a str,
    pub key: &'a str,
}

#[derive(Serialize, Deserialize)]
struct Label<'a> {
    kind: &'a str,
    version: &'a str,
    key: &'a str,
}

impl Seal<'_> {
    /// The bytes of a sealed file.
    pub fn close(&self, payload: &[u8]) -> Vec<u8> {
        let label = Label { kind: self.kind, version: version(), key: self.key };
        // a label of three texts can always be written
        let mut sealed = serde_json::to_vec(&label).unwrap_or_default();
        sealed.push(b'\n');
        sealed.extend_from_slice(payload);
        [format!("{MAGIC}{}\n", sha256(&sealed)).as_bytes(), &sealed].concat()
    }

    /// Content of a sealed file. Fails if it is damaged, or if it has another kind, version or key; `path` is for the
    /// error.
    pub fn open<'b>(&self, path: &Path, bytes: &'b [u8]) -> Result<&'b [u8], StoreError> {
        let broken = || StoreError::damaged(path, "the file is damaged: its checksum does not match its content");
        let rest = bytes.strip_prefix(MAGIC.as_bytes());
        let rest = rest.ok_or_else(|| {
            StoreError::damaged(path, "the file does not start with the header that this program writes")
        })?;
        let (hash, sealed) = line(rest).ok_or_else(broken)?;
        if sha256(sealed).as_bytes() != hash {
            return Err(broken());
        }
        let (label, payload) = line(sealed).ok_or_else(broken)?;
        let label: Label<'_> = serde_json::from_slice(label).map_err(|cause| StoreError::damaged(path, cause))?;
        let found = || path.to_owned();
        if label.kind != self.kind {
            return Err(StoreError::damaged(path, format!("the file holds a {}, not a {}", label.kind, self.kind)));
        }
        if label.version != version() {
            let (expected, other) = (version().to_owned(), label.version.to_owned());
            return Err(StoreError::OtherVersion { path: found(), expected, found: other });
        }
        if label.key != self.key {
            let (expected, other) = (self.key.to_owned(), label.key.to_owned());
            return Err(StoreError::OtherScene { path: found(), expected, found: other });
        }
        Ok(payload)
    }

    /// A sealed file of a value as JSON. Fails if a number is not finite, because JSON cannot represent it and reading
    /// the value would fail.
    pub fn close_json<T: Serialize + DeserializeOwned>(&self, path: &Path, value: &T) -> Result<Vec<u8>, StoreError> {
        let payload = serde_json::to_vec(value).map_err(|cause| StoreError::unwritable(path, cause))?;
        serde_json::from_slice::<T>(&payload).map_err(|cause| {
            let why = format!("the state could not be read back: a number is not finite ({cause})");
            StoreError::unwritable(path, why)
        })?;
        Ok(self.close(&payload))
    }

    /// The value of a sealed file of JSON.
    pub fn open_json<T: DeserializeOwned>(&self, path: &Path, bytes: &[u8]) -> Result<T, StoreError> {
        serde_json::from_slice(self.open(path, bytes)?).map_err(|cause| StoreError::damaged(path, cause))
    }
}

/// The bytes before and after the first line break.
fn line(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

pub(super) fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEAL: Seal<'_> = Seal { kind: "checkpoint", key: "abc" };

    #[test]
    fn no_bit_can_change_unseen() {
        let sealed = SEAL.close(b"[1.5,\n2.5]");
        assert_eq!(SEAL.open(Path::new("c"), &sealed).unwrap(), b"[1.5,\n2.5]");
        for bit in 0..8 * sealed.len() {
            let mut changed = sealed.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert!(SEAL.open(Path::new("c"), &changed).is_err(), "bit {bit}");
        }
        for length in 0..sealed.len() {
            assert!(SEAL.open(Path::new("c"), &sealed[..length]).is_err(), "cut to {length}");
        }
    }

    #[test]
    fn another_kind_and_another_key_are_told_apart() {
        let other = Seal { kind: "bed", ..SEAL }.close(b"");
        assert!(matches!(SEAL.open(Path::new("c"), &other), Err(StoreError::Damaged { .. })));
        let other = Seal { key: "abd", ..SEAL }.close(b"");
        assert!(matches!(SEAL.open(Path::new("c"), &other), Err(StoreError::OtherScene { .. })));
    }
}

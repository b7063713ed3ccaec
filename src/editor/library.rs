//! The standard library as files, so that an editor can show the definition of a name.

use crate::check::LIBRARY;
use std::path::Path;
use std::{fs, io};

/// Writes the library of this program below a folder.
pub fn lay_down(folder: &Path) -> io::Result<()> {
    let folder = folder.join("std");
    fs::create_dir_all(&folder)?;
    for (module, text) in LIBRARY {
        let file = folder.join(format!("{module}.track"));
        if fs::read(&file).ok().as_deref() != Some(text.as_bytes()) {
            fs::write(&file, text)?;
        }
    }
    Ok(())
}

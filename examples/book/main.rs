//! The documents as a book with search: a page for each document, question of the cookbook, shipped scene (with its
//! picture), kind, module of the standard library, rule and code.
//!
//! ```sh
//! cargo install mdbook --locked --no-default-features --features search
//! cargo run --release --example book
//! ```
//!
//! The pages go to `target/book/src` and the book to `target/book/html`; another folder than `target/book` may be
//! given. Every link is followed; a link that leads nowhere is an error.

mod links;
mod pages;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    let folder = std::env::args().nth(1).map_or_else(|| PathBuf::from("target/book"), PathBuf::from);
    match build(Path::new(env!("CARGO_MANIFEST_DIR")), &folder) {
        Ok(told) => {
            println!("{told}");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

fn build(root: &Path, folder: &Path) -> Result<String, String> {
    let count = pages::write(root, folder).map_err(|error| format!("cannot write the pages: {error}"))?;
    let html = folder.join("html");
    let built = Command::new("mdbook").arg("build").arg(folder).status();
    match built {
        Ok(status) if status.success() => {}
        Ok(status) => return Err(format!("mdbook ended with {status}")),
        Err(error) => {
            return Err(format!("mdbook does not start ({error}); install it with `cargo install mdbook --locked`"));
        }
    }
    let found = links::follow(&html).map_err(|error| format!("cannot read the book: {error}"))?;
    if !found.broken.is_empty() {
        return Err(format!("links that lead nowhere:\n{}", found.broken.join("\n")));
    }
    let size = found.bytes as f64 / 1e6;
    Ok(format!(
        "{count} pages, {} links, all resolve, {size:.1} MB: {}",
        found.links,
        html.join("index.html").display()
    ))
}

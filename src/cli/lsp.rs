//! `trackbed lsp`: the language server, which an editor starts.

use super::{Outcome, terminal};
use crate::editor::{Settings, serve_stdio};
use std::path::PathBuf;

/// Help an editor while somebody types: it speaks the language server protocol on standard input and output
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed lsp")]
pub(super) struct Arguments {
    /// What editors say by habit: standard input and output are used in any case.
    #[arg(long, hide = true)]
    stdio: bool,
    /// Where the standard library is laid down so that the editor can show it; a folder for caches where it is left
    /// out.
    #[arg(long, value_name = "FOLDER")]
    library: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Arguments { stdio: _, library } = arguments;
    let library = library.clone().unwrap_or_else(cache);
    match serve_stdio(Settings { library }) {
        Ok(()) => Outcome::Fine,
        Err(why) => {
            terminal::error(&format!("the editor is gone or speaks another protocol: {why}"));
            Outcome::Failed
        }
    }
}

/// A folder of the user's for what can be made again, else one of this process.
fn cache() -> PathBuf {
    let named = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let caches = named("XDG_CACHE_HOME").or_else(|| named("LOCALAPPDATA"));
    let caches = caches.or_else(|| named("HOME").map(|home| home.join(".cache")));
    let own = || std::env::temp_dir().join(format!("trackbed-{}", std::process::id()));
    caches.map_or_else(own, |folder| folder.join("trackbed")).join(env!("CARGO_PKG_VERSION"))
}

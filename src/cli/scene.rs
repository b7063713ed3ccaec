//! Reads and compiles the scene that a command works on, and shows what is wrong with it.

use super::{Outcome, terminal};
use crate::check::{self, Folder, Modules, Override, Remembered};
use crate::compile::{Compiled, compile_with};
use crate::diag;
use crate::lower::{NoSuchPass, Planner};
use crate::store::write_atomically;
use crate::syntax;
use std::io;
use std::path::{Path, PathBuf};

/// The scene a command works on.
#[derive(clap::Args, Clone)]
pub(super) struct SceneArguments {
    /// The scene: a `.track` file.
    pub file: PathBuf,
    /// Acts as if that line of the file were edited, e.g. `--set open.spacing='0.65 m'`.
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = Override::parse)]
    pub set: Vec<Override>,
}

/// What a run is drawn from.
#[derive(clap::Args, Default)]
pub(super) struct SeedArgument {
    /// The seed of all that is random, as `--set solve.seed=N`.
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
}

impl SeedArgument {
    /// The argument that names a seed.
    pub fn with(seed: u64) -> SeedArgument {
        SeedArgument { seed: u32::try_from(seed).ok() }
    }
}

/// Which passes of the planner are left out.
#[derive(clap::Args, Clone)]
pub(super) struct PassArguments {
    /// Leave out a pass of the planner, so that its error can be measured; `trackbed plan` names them.
    #[arg(long, value_name = "PASS")]
    pub without: Vec<String>,
}

impl PassArguments {
    /// The planner without these passes; `None` where one cannot be left out, which has been said.
    pub fn planner(&self) -> Option<Planner> {
        let without = self.without.iter().try_fold(Planner::default(), |planner, name| planner.without(name));
        match without {
            Ok(planner) => Some(planner),
            Err(NoSuchPass { name, optional }) => {
                let optional = optional.join("`, `");
                terminal::error(&format!("no pass `{name}` can be left out: write one of `{optional}`"));
                None
            }
        }
    }
}

/// The name of a file without its folder, for a text of the language.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().replace(['"', '\\'], "'"))
}

impl SceneArguments {
    /// The same with another seed.
    pub fn with_seed(&self, argument: &SeedArgument) -> SceneArguments {
        let seed = argument.seed.map(|n| Override { path: "solve.seed".into(), value: n.to_string() });
        SceneArguments { file: self.file.clone(), set: self.set.iter().cloned().chain(seed).collect() }
    }

    /// Writes an answer to a file, which must not be the scene; or says why not.
    pub fn write_beside(&self, out: &Path, bytes: &[u8]) -> Result<(), String> {
        self.is_beside(out)?;
        write_atomically(out, bytes).map_err(|error| error.to_string())
    }

    /// Fails if a file is the scene, or its folder does not exist.
    pub fn is_beside(&self, out: &Path) -> Result<(), String> {
        let is_scene = self.file.canonicalize().is_ok_and(|scene| out.canonicalize().is_ok_and(|out| out == scene));
        if is_scene {
            return Err(format!("`{}` is the scene itself; name another file", out.display()));
        }
        let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(format!("cannot write `{}`: there is no folder `{}`", out.display(), folder.display()));
        }
        Ok(())
    }

    /// Where its modules and data lie.
    fn folder(&self) -> Folder {
        Folder(self.file.parent().unwrap_or(Path::new("")).to_path_buf())
    }

    /// The same, for a scene that is compiled more than once.
    pub fn remembered(&self) -> Remembered<Folder> {
        Remembered::new(self.folder())
    }

    /// The scene as one file; `None` where there is none.
    pub fn resolve(&self) -> Option<String> {
        self.resolve_as(&self.file.display().to_string())
    }

    /// The same under the name of its file alone, so that equal scenes leave equal results wherever they lie.
    pub fn resolved_in_place(&self) -> Option<String> {
        self.resolve_as(&self.file.file_name()?.to_string_lossy())
    }

    fn resolve_as(&self, name: &str) -> Option<String> {
        let text = syntax::decode(name, &check::read_bounded(&self.file).ok()?).ok()?;
        check::resolve(name, &text, &self.folder(), &self.set)
    }

    /// Reads and compiles the file; `None` where it cannot be read, which has been said.
    pub fn compile(&self) -> Option<Compiled> {
        self.compile_with(&self.folder())
    }

    /// The same with modules that are asked again later.
    pub fn compile_with(&self, modules: &dyn Modules) -> Option<Compiled> {
        self.compile_by(&Planner::default(), modules)
    }

    /// The same without some passes; `None` too where one cannot be left out.
    pub fn compile_without(&self, passes: &PassArguments) -> Option<Compiled> {
        self.compile_by(&passes.planner()?, &self.folder())
    }

    fn compile_by(&self, planner: &Planner, modules: &dyn Modules) -> Option<Compiled> {
        let name = self.file.display().to_string();
        let bytes = match read(&self.file) {
            Ok(bytes) => bytes,
            Err(error) => {
                terminal::error(&format!("cannot read `{name}`: {error}"));
                return None;
            }
        };
        Some(match syntax::decode(&name, &bytes) {
            Ok(text) => compile_with(planner, &name, &text, modules, &self.set),
            Err(mistake) => Compiled::unread(mistake),
        })
    }
}

/// The name that stands for standard input.
const STANDARD_INPUT: &str = "-";

/// Reads a file, or standard input.
fn read(file: &Path) -> io::Result<Vec<u8>> {
    if file == Path::new(STANDARD_INPUT) { check::read_all(io::stdin().lock()) } else { check::read_bounded(file) }
}

/// Shows diagnostics on standard error.
pub(super) fn show(compiled: &Compiled) {
    terminal::diagnostics(&compiled.diagnostics, &compiled.sources);
}

/// Whether anything stands against a run.
pub(super) fn failed(compiled: &Compiled) -> bool {
    diag::has_errors(&compiled.diagnostics)
}

/// Says why a scene that has no errors has no plan: holes and missing loads are warnings to `check`.
pub(super) fn not_yet(compiled: &Compiled) -> Outcome {
    if !failed(compiled) {
        let reason =
            if compiled.diagnostics.is_empty() { "a file without a `track` is a library" } else { "see above" };
        terminal::error(&format!("the scene cannot be run yet: {reason}"));
    }
    Outcome::Failed
}

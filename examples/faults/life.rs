//! One directory of a work, and the lives of the programs that bring it to its end.

use crate::scenes::Work;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A directory with a scene, the results of the work on it, and beds of its own, so that packing is killed too.
pub struct Subject<'a> {
    work: &'a Work,
    folder: tempfile::TempDir,
}

impl<'a> Subject<'a> {
    pub fn new(work: &'a Work) -> Result<Subject<'a>, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        // results that differ are left to look at
        fs::write(folder.path().join("scene.track"), &work.scene).map_err(|error| error.to_string())?;
        Ok(Subject { work, folder })
    }

    /// The directory of results.
    pub fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    /// Leaves the directory to be looked at.
    pub fn keep(self) -> PathBuf {
        self.folder.keep()
    }

    fn start(&self) -> Result<Child, String> {
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut command = Command::new(program);
        command.arg(self.work.command).arg(self.folder.path().join("scene.track"));
        command.arg("--out").arg(self.out()).arg("--resume").args(self.work.more);
        command.env("TRACKBED_CACHE", self.folder.path().join("beds")).env("NO_COLOR", "1");
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(|error| error.to_string())
    }

    /// Goes on with it to its end.
    pub fn finish(&self) -> Result<(), String> {
        let mut last = String::new();
        for _ in 0..3 {
            let output = self.start()?.wait_with_output().map_err(|error| error.to_string())?;
            if output.status.success() {
                return Ok(());
            }
            // what has lost its task on a cluster three times is given again by the next command
            if !self.work.on_slurm {
                return Err(format!("it does not go on: {}", said(&output)));
            }
            last = said(&output);
        }
        Err(format!("a cluster does not bring it to its end: {last}"))
    }

    /// Lets it go on for so long (s) and kills it; `false` where it has ended before.
    pub fn kill(&self, after: f64) -> Result<bool, String> {
        let mut child = self.start()?;
        sleep(Duration::from_secs_f64(after));
        if self.work.on_slurm && ((after * 1e3) as u64).is_multiple_of(2) {
            self.kill_worker();
        }
        let ended = child.try_wait().map_err(|error| error.to_string())?.is_some();
        if !ended {
            child.kill().map_err(|error| error.to_string())?;
        }
        let output = child.wait_with_output().map_err(|error| error.to_string())?;
        match ended && !output.status.success() && !self.work.on_slurm {
            true => Err(format!("it ended by itself: {}", said(&output))),
            false => Ok(!ended),
        }
    }

    /// Kills what Slurm runs for it, if it runs anything: the oldest process whose words name this very directory.
    fn kill_worker(&self) {
        let words = format!("work {}", self.out().display());
        let _ = Command::new("pkill").args(["-KILL", "--oldest", "--full", &words]).status();
    }

    /// Lets it go on for so long (s), asks it to stop, and gives the seconds until it has; `None` where it had ended
    /// before.
    pub fn stop(&self, after: f64, signal: &str) -> Result<Option<f64>, String> {
        let mut child = self.start()?;
        sleep(Duration::from_secs_f64(after));
        if child.try_wait().map_err(|error| error.to_string())?.is_some() {
            return Ok(None);
        }
        let asked = Instant::now();
        Command::new("kill").args([signal, &child.id().to_string()]).status().map_err(|error| error.to_string())?;
        let output = child.wait_with_output().map_err(|error| error.to_string())?;
        let seconds = asked.elapsed().as_secs_f64();
        // before it listens, and while it writes its last files, a signal is like a kill or comes too late
        match output.status.code() {
            None | Some(0) => Ok(None),
            Some(_) if said(&output).contains("`--resume`") => Ok(Some(seconds)),
            Some(_) => Err(format!("it does not say how to go on: {}", said(&output))),
        }
    }
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Fails with the first file that one directory of results has and the other has not, or has with other bytes.
pub fn same_files(one: &Path, other: &Path) -> Result<(), String> {
    let [one, other] = [one, other].map(|root| {
        let mut files = BTreeMap::new();
        collect(root, root, &mut files).map(|()| files)
    });
    let (one, other) = (one.map_err(|error| error.to_string())?, other.map_err(|error| error.to_string())?);
    let names = one.keys().chain(other.keys());
    match names.into_iter().find(|name| one.get(*name) != other.get(*name)) {
        Some(name) => Err(format!("`{name}` differs")),
        None => Ok(()),
    }
}

/// All files below a folder but hidden ones, which are no results, and timings.
fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        let last = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if last.starts_with('.') || last == "timings.json" {
            continue;
        }
        if path.is_dir() {
            collect(root, &path, files)?;
        } else {
            files.insert(name, fs::read(&path)?);
        }
    }
    Ok(())
}

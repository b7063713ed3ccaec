//! Kills at every operation of a directory, changed files on the disk, and two processes with the same directory.

use super::*;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;
use std::rc::Rc;

/// A disk that fails at an operation and leaves it incomplete.
#[derive(Debug, Clone)]
struct Mortal {
    left: Rc<Cell<usize>>,
}

impl Mortal {
    fn after(operations: usize) -> Mortal {
        Mortal { left: Rc::new(Cell::new(operations)) }
    }

    /// Does not wait for the disk, either.
    fn immortal() -> Mortal {
        Mortal::after(usize::MAX - 1)
    }

    /// Does an operation; the last operation is done only in part.
    fn step(&self, whole: impl FnOnce() -> io::Result<()>, half: impl FnOnce()) -> io::Result<()> {
        match self.left.get() {
            usize::MAX => return Err(io::Error::other("dead")),
            0 => {
                half();
                self.left.set(usize::MAX);
                return Err(io::Error::other("killed"));
            }
            left => self.left.set(left - 1),
        }
        whole()
    }
}

impl Disk for Mortal {
    fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.step(|| FileSystem.create_folder(path), || {})
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.step(|| fs::write(path, bytes), || drop(fs::write(path, &bytes[..bytes.len() / 2])))
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.step(|| FileSystem.rename(from, to), || {})
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        self.step(|| FileSystem.remove_file(path), || {})
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        let half = || {
            let first = path.read_dir().ok().and_then(|mut entries| entries.next()).and_then(Result::ok);
            first.map(|entry| fs::remove_file(entry.path()));
        };
        self.step(|| FileSystem.remove_folder(path), half)
    }

    fn sync_folder(&self, _: &Path) -> io::Result<()> {
        self.step(|| Ok(()), || {})
    }
}

fn work(scene: &str) -> Work {
    Work { name: "run".to_owned(), scene_sha256: scene.to_owned() }
}

/// Files of two results: one name in both with different content, one name in each alone, one file in a folder.
const OLD: [(&str, &str); 3] = [("summary.json", "old"), ("trains.csv", "old trains"), ("states/1.vtp", "old state")];
const NEW: [(&str, &str); 3] = [("summary.json", "new"), ("laws.csv", "new laws"), ("states/2.vtp", "new state")];

fn write_all<D: Disk>(disk: D, path: &Path, scene: &str, mode: Mode, files: &[(&str, &str)]) -> Result<(), StoreError> {
    let mut directory = Directory::open_on(disk, path, work(scene), mode)?;
    let part = directory.keep("histories.1", b"rows")?;
    directory.write_checkpoint(&(1.5, part))?;
    files.iter().try_for_each(|(name, text)| directory.stage(name, text.as_bytes()))?;
    directory.commit().map(drop)
}

/// The results of a directory by name, after recovery from a kill; checked against the manifest.
fn results(path: &Path) -> Option<BTreeMap<String, String>> {
    // as a reader would, who finds nothing left to do then
    recovery::recover(&Mortal::immortal(), &layout::Layout { root: path.to_owned() }).unwrap();
    let finished = Finished::open(path).unwrap()?;
    let content = |name: &str| String::from_utf8(finished.read(name).unwrap().unwrap()).unwrap();
    Some(finished.manifest().files.iter().map(|file| (file.name.clone(), content(&file.name))).collect())
}

/// Every visible file below a directory, except the manifest.
fn visible(root: &Path) -> BTreeMap<String, String> {
    fn walk(root: &Path, folder: &Path, found: &mut BTreeMap<String, String>) {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
            match path.is_dir() {
                _ if name.starts_with('.') || name == "manifest.json" => {}
                true => walk(root, &path, found),
                false => drop(found.insert(name, fs::read_to_string(&path).unwrap())),
            }
        }
    }
    let mut found = BTreeMap::new();
    walk(root, root, &mut found);
    found
}

fn map(files: &[(&str, &str)]) -> BTreeMap<String, String> {
    files.iter().map(|(name, text)| (name.to_string(), text.to_string())).collect()
}

#[test]
fn a_kill_at_any_operation_leaves_the_old_results_or_the_new_ones() {
    let (mut old, mut new, mut ended) = (0, 0, false);
    for operations in 0.. {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path();
        write_all(Mortal::immortal(), path, "a", Mode::New, &OLD).unwrap();
        fs::write(path.join("notes.txt"), "mine").unwrap();
        let done = write_all(Mortal::after(operations), path, "b", Mode::Force, &NEW);
        ended |= done.is_ok();
        let found = results(path).unwrap();
        let which = if found == map(&NEW) { &NEW } else { &OLD };
        assert_eq!(found, map(which), "killed at operation {operations}");
        let mut all = map(which);
        all.insert("notes.txt".to_owned(), "mine".to_owned());
        assert_eq!(visible(path), all, "killed at operation {operations}");
        if which == &NEW {
            new += 1
        } else {
            old += 1
        }
        // whatever was left, work goes on from it
        write_all(Mortal::immortal(), path, "b", Mode::Force, &NEW).unwrap();
        assert_eq!(results(path).unwrap(), map(&NEW));
        if ended {
            break;
        }
    }
    assert!(old > 10 && new > 10, "{old} old, {new} new");
}

#[test]
fn a_kill_while_a_kill_is_mended_does_no_harm() {
    let open = |path: &Path, disk| Directory::open_on(disk, path, work("b"), Mode::Resume).map(drop);
    for operations in 0.. {
        let mut mended = false;
        let mut ended = false;
        for further in 0.. {
            let directory = tempfile::tempdir().unwrap();
            let path = directory.path();
            write_all(Mortal::immortal(), path, "a", Mode::New, &OLD).unwrap();
            ended |= write_all(Mortal::after(operations), path, "b", Mode::Force, &NEW).is_ok();
            mended |= open(path, Mortal::after(further)).is_ok() || further > 40;
            let found = results(path).unwrap();
            assert!(found == map(&NEW) || found == map(&OLD), "killed at {operations} and {further}: {found:?}");
            assert_eq!(visible(path), found, "killed at {operations} and {further}");
            if mended {
                break;
            }
        }
        if ended {
            break;
        }
    }
}

#[test]
fn a_first_work_is_resumed_or_finished_from_any_kill() {
    for operations in 0.. {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("out");
        let done = write_all(Mortal::after(operations), &path, "b", Mode::New, &NEW).is_ok();
        let resumed = Directory::open(&path, work("b"), Mode::Resume).unwrap();
        if resumed.finished().is_none() {
            if let Some((state, piece)) = resumed.read_checkpoint::<(f64, Piece)>().unwrap() {
                assert_eq!(state, 1.5);
                assert_eq!(resumed.read_piece(&piece).unwrap(), b"rows");
            }
            drop(resumed);
            write_all(Mortal::immortal(), &path, "b", Mode::Resume, &NEW).unwrap();
        } else {
            drop(resumed);
        }
        assert_eq!(results(&path).unwrap(), map(&NEW), "killed at operation {operations}");
        assert!(!path.join(".trackbed/checkpoint").exists() && !path.join(".trackbed/pieces").exists());
        if done {
            break;
        }
    }
}

#[test]
fn a_directory_is_opened_for_what_it_holds_only() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let open = |scene: &str, mode| Directory::open(path, work(scene), mode);
    fs::write(path.join("notes.txt"), "mine").unwrap();
    let told = open("a", Mode::New).unwrap_err();
    assert!(matches!(told, StoreError::Foreign { .. }) && told.to_string().contains("`notes.txt`"), "{told}");
    assert!(matches!(open("a", Mode::Resume), Err(StoreError::Foreign { .. })));
    assert!(!path.join(".trackbed").exists(), "nothing is made where nothing may be done");
    fs::remove_file(path.join("notes.txt")).unwrap();

    let unfinished = open("a", Mode::New).unwrap();
    assert!(matches!(open("a", Mode::Force), Err(StoreError::Busy { .. })), "two at a time");
    unfinished.write_checkpoint(&1.0).unwrap();
    drop(unfinished);
    assert!(matches!(open("a", Mode::New), Err(StoreError::Unfinished { .. })));
    assert!(matches!(open("b", Mode::Resume), Err(StoreError::OtherScene { .. })));
    let study = Work { name: "study".to_owned(), ..work("a") };
    assert!(matches!(Directory::open(path, study, Mode::Resume), Err(StoreError::OtherWork { .. })));

    let mut resumed = open("a", Mode::Resume).unwrap();
    assert_eq!(resumed.read_checkpoint::<f64>().unwrap(), Some(1.0));
    resumed.stage("summary.json", b"{}").unwrap();
    resumed.commit().unwrap();
    assert!(matches!(open("a", Mode::New), Err(StoreError::Finished { .. })));
    assert!(matches!(open("b", Mode::Resume), Err(StoreError::OtherScene { .. })));
    assert!(open("a", Mode::Resume).unwrap().finished().is_some());
}

#[test]
fn every_changed_bit_is_told_with_its_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    write_all(Mortal::immortal(), path, "a", Mode::New, &OLD).unwrap();
    for name in ["summary.json", "trains.csv", "states/1.vtp", "manifest.json"] {
        let file = path.join(name);
        let whole = fs::read(&file).unwrap();
        for bit in (0..8 * whole.len()).step_by(if name == "manifest.json" { 7 } else { 1 }) {
            let mut changed = whole.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            fs::write(&file, &changed).unwrap();
            // a space that becomes another one says the same
            let same = serde_json::from_slice::<Manifest>(&changed).ok() == serde_json::from_slice(&whole).ok();
            let told = Finished::open(path).and_then(|finished| finished.unwrap().verify());
            let named = told.as_ref().is_err_and(|told| told.to_string().contains(name.rsplit('/').next().unwrap()));
            assert!(named || name == "manifest.json" && same, "bit {bit} of {name}: {told:?}");
        }
        fs::write(&file, &whole).unwrap();
    }
    fs::remove_file(path.join("trains.csv")).unwrap();
    let told = Directory::open(path, work("a"), Mode::Resume).unwrap_err().to_string();
    assert!(told.contains("trains.csv"), "{told}");
}

#[test]
fn a_checkpoint_goes_with_its_pieces() {
    let directory = tempfile::tempdir().unwrap();
    let open = |mode| Directory::open(directory.path(), work("a"), mode).unwrap();
    let run = open(Mode::New);
    let first = run.keep("histories.1", b"rows").unwrap();
    run.write_checkpoint(&first).unwrap();
    assert!(run.write_checkpoint(&f64::NAN).unwrap_err().to_string().contains("not finite"));
    run.keep("histories.1", b"other rows").unwrap(); // after the checkpoint, then killed
    drop(run);
    let run = open(Mode::Resume);
    let named: Piece = run.read_checkpoint().unwrap().unwrap();
    assert!(run.read_piece(&named).unwrap_err().to_string().contains("histories.1"));
    fs::remove_dir_all(directory.path().join(".trackbed/pieces")).unwrap();
    assert!(run.read_piece(&named).unwrap_err().to_string().contains("histories.1"));
    assert_eq!(run.kept("histories.2").unwrap(), None);
    assert!(run.keep("../x", b"").is_err() && run.keep("", b"").is_err());
}

#[test]
fn files_are_added_to_finished_work() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    assert!(Directory::amend(path).is_err() && !path.join(".trackbed").exists());
    write_all(Mortal::immortal(), path, "a", Mode::New, &OLD).unwrap();
    let mut amended = Directory::amend(path).unwrap();
    assert!(amended.stage("../summary.json", b"").is_err() && amended.stage(".trackbed/lock", b"").is_err());
    amended.stage("report.html", b"page").unwrap();
    amended.stage_changing("timings.json", b"{}").unwrap();
    let finished = amended.commit().unwrap();
    assert_eq!(finished.manifest().files.len(), 5);
    fs::write(path.join("timings.json"), "{ }").unwrap();
    finished.verify().unwrap();
    let run = Directory::open(path, work("b"), Mode::Force).unwrap();
    run.write_checkpoint(&1).unwrap();
    drop(run);
    assert!(matches!(Directory::amend(path), Err(StoreError::Unfinished { .. })), "a commit would end that work");
}

#[test]
fn equal_work_leaves_equal_manifests() {
    let manifest = |timings: &[u8]| {
        let directory = tempfile::tempdir().unwrap();
        let mut run = Directory::open(directory.path(), work("a"), Mode::New).unwrap();
        run.stage_changing("timings.json", timings).unwrap();
        run.stage("summary.json", b"{}").unwrap();
        run.commit().unwrap();
        fs::read(directory.path().join("manifest.json")).unwrap()
    };
    assert!(manifest(b"1") == manifest(b"2"));
}

#[test]
fn work_under_way_is_read_while_its_lock_is_held_and_its_page_goes_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert!(Unfinished::open(path).unwrap().is_none());
    let mut directory = Directory::open(path, work("a"), Mode::New).unwrap();
    assert!(Unfinished::open(path).unwrap().is_none(), "nothing is kept yet");
    let piece = directory.keep("rows", b"first").unwrap();
    directory.write_checkpoint(&(1.5, piece.clone())).unwrap();

    let unfinished = Unfinished::open(path).unwrap().unwrap();
    assert_eq!(unfinished.work(), &work("a"));
    assert_eq!(unfinished.read_checkpoint::<(f64, Piece)>().unwrap(), Some((1.5, piece.clone())));
    assert_eq!(unfinished.read_piece(&piece).unwrap(), b"first");
    directory.keep("rows", b"other").unwrap();
    assert!(unfinished.read_piece(&piece).unwrap_err().to_string().contains("the file does not match the checkpoint"));

    let page = unfinished.show(b"so far").unwrap();
    assert_eq!(fs::read(&page).unwrap(), b"so far");
    directory.stage("summary.json", b"done").unwrap();
    directory.commit().unwrap();
    assert!(!page.exists());
    assert!(Unfinished::open(path).unwrap().is_none());
}

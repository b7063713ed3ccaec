//! Disks that are full, disks that may only be read, and files whose dates are wrong.

use super::{Place, on_a_law, refused, results, same_results};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};

/// A script in which `$T` is the program and `$D` an empty disk of so many kB that only the script sees; `None`, with a
/// word, where this machine gives nobody a disk of their own.
fn with_disk(folder: &Path, kilobytes: u32, script: &str) -> Option<Output> {
    let disk = folder.join("disk");
    fs::create_dir_all(&disk).unwrap();
    let unshared = |script: &str| {
        let mut command = Command::new("unshare");
        command.args(["--map-root-user", "--mount", "sh", "-c", script]);
        command.env("T", env!("CARGO_BIN_EXE_trackbed")).env("D", &disk).env("F", folder).env("NO_COLOR", "1");
        command.env("TRACKBED_CACHE", folder.join("beds")).output()
    };
    let mount = format!("mount -t tmpfs -o size={kilobytes}k none \"$D\"");
    if !unshared(&mount).is_ok_and(|output| output.status.success()) {
        println!("skipped: this machine mounts no disk for a test (`unshare --map-root-user --mount`)");
        return None;
    }
    Some(unshared(&format!("{mount} || exit 9\n{script}")).unwrap())
}

/// The old results hold while the new ones find no room, and the new ones come as soon as there is some.
#[test]
fn a_full_disk_is_told_and_loses_nothing() {
    let place = Place::new(&on_a_law(40));
    fs::write(place.path("other.track"), on_a_law(80)).unwrap();
    let script = "
        \"$T\" run \"$F/scene.track\" --out \"$D/out\" >/dev/null || exit 9
        dd if=/dev/zero of=\"$D/ballast\" bs=1k 2>/dev/null
        cp -r \"$D/out\" \"$F/before\"
        \"$T\" run \"$F/other.track\" --out \"$D/out\" --force; code=$?
        cp -r \"$D/out\" \"$F/full\"
        rm \"$D/ballast\"
        \"$T\" run \"$F/other.track\" --out \"$D/out\" --force >/dev/null || exit 9
        cp -r \"$D/out\" \"$F/after\"
        exit $code";
    let Some(output) = with_disk(&place.path(""), 4000, script) else { return };
    refused(&output, &["E0802", "cannot write", "No space left on device", "make space in this one"]);
    same_results(&place.path("before"), &place.path("full"));
    fs::copy(place.path("other.track"), place.path("scene.track")).unwrap();
    place.finish("whole", &[]);
    // the name of the scene stands in what it makes
    let [after, whole] = ["after", "whole"].map(|name| results(&place.path(name)));
    assert!(after["sleepers.csv"] == whole["sleepers.csv"] && after["blocks.csv"] == whole["blocks.csv"]);
}

/// The disk fills up while the run goes on: its last state stays, and it goes on from there.
#[test]
fn a_disk_that_fills_up_ends_a_run_that_goes_on_later() {
    let place = Place::new(&on_a_law(400));
    place.killed("cut");
    let script = "
        cp -r \"$F/cut\" \"$D/out\"
        dd if=/dev/zero of=\"$D/ballast\" bs=1k 2>/dev/null
        \"$T\" run \"$F/scene.track\" --out \"$D/out\" --resume; code=$?
        rm \"$D/ballast\"
        \"$T\" run \"$F/scene.track\" --out \"$D/out\" --resume >/dev/null || exit 9
        cp -r \"$D/out\" \"$F/after\"
        exit $code";
    let Some(output) = with_disk(&place.path(""), 8000, script) else { return };
    refused(&output, &["E0802", "No space left on device"]);
    place.finish("whole", &[]);
    same_results(&place.path("whole"), &place.path("after"));
}

#[test]
fn a_disk_that_may_only_be_read_is_told_and_read() {
    let place = Place::new(&on_a_law(40));
    let script = "
        \"$T\" run \"$F/scene.track\" --out \"$D/out\" >/dev/null || exit 9
        mount -o remount,ro \"$D\" || exit 8
        \"$T\" run \"$F/scene.track\" --out \"$D/new\"; echo \"new: $?\"
        \"$T\" run \"$F/scene.track\" --out \"$D/out\" --force; echo \"forced: $?\"
        \"$T\" run \"$F/scene.track\" --out \"$F/copy\" >/dev/null; echo \"elsewhere: $?\"
        \"$T\" report \"$D/out\"; echo \"report: $?\"";
    let Some(output) = with_disk(&place.path(""), 4000, script) else { return };
    assert_eq!(output.status.code(), Some(0), "{}", super::in_one_line(&output));
    let told = super::in_one_line(&output);
    for words in ["new: 1", "forced: 1", "elsewhere: 0", "report: 2", "E0802", "Read-only file system"] {
        assert!(told.contains(words), "{words}: {told}");
    }
}

/// Files that are kept may be of tomorrow, where the clock has gone back since: nothing is decided by a date.
#[test]
fn a_clock_that_goes_back_changes_nothing() {
    let place = Place::new(&on_a_law(400));
    place.killed("cut");
    let tomorrow = SystemTime::now() + Duration::from_secs(86_400);
    for file in ["work", "checkpoint", "lock"] {
        let file = fs::File::options().write(true).open(place.path("cut/.trackbed").join(file)).unwrap();
        file.set_modified(tomorrow).unwrap();
    }
    place.finish("cut", &["--resume"]);
    place.finish("whole", &[]);
    same_results(&place.path("whole"), &place.path("cut"));
}

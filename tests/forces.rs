//! Forces of a test load from a file: the file is checked as any other, and waits for grains as a cyclic force does.

use std::path::Path;
use trackbed::check::{DataError, Modules, resolve};
use trackbed::compile;
use trackbed::diag::Code;
use trackbed::scenario::{Force, Loading};

/// A file of forces beside the scene.
struct File(&'static str);

impl Modules for File {
    fn read(&self, _: &Path) -> Option<Vec<u8>> {
        None
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        (relative == Path::new("force.csv")).then(|| self.0.into()).ok_or(DataError::Missing)
    }
}

fn scene(force: &str) -> String {
    format!(
        "use std
trackform seats {{ rail = rails.UIC60, pad = pads.soft, spacing = 0.6 m, support = rigid }}
track bench {{ sections = [seats: 20 sleepers] }}
load jack {{ on = rail, at = 10 sleepers, force = {force}, total = 100 cycles }}
"
    )
}

const RISE: &str = "time_s,force_kN\n0,5\n0.1,60\n0.2,5\n";

/// Codes and messages, but for the warning that only grains can run it.
fn mistakes(force: &str, file: &'static str) -> Vec<(Code, String)> {
    let compiled = compile("scene.track", &scene(force), &File(file), &[]);
    assert!(compiled.runnable().is_none());
    let (waits, wrong): (Vec<_>, Vec<_>) = compiled.diagnostics.iter().partition(|d| d.code == Code::E0604);
    // what a model refuses is said of scenes that are understood
    assert_eq!(waits.is_empty(), wrong.iter().any(|d| d.is_error()), "it waits for grains");
    wrong.iter().map(|d| (d.code, d.message.clone())).collect()
}

#[test]
fn a_file_of_forces_is_read_and_waits_for_grains() {
    assert_eq!(mistakes("file(\"force.csv\") per rail", RISE), []);
    assert_eq!(mistakes("file(\"force.csv\", column = b) per track", "a_kN,time_ms,b_N\n1,0,100\n2,1,200\n"), []);
    let scenario = compile("scene.track", &scene("file(\"force.csv\") per track"), &File(RISE), &[]).scenario.unwrap();
    let Some(Loading::Rig(loads)) = &scenario.loading else { panic!("{:?}", scenario.loading) };
    assert_eq!(loads[0].force, Force::History(vec![[0.0, 2.5e3], [0.1, 30e3], [0.2, 2.5e3]]), "of one rail");
    let text = resolve("scene.track", &scene("file(\"force.csv\") per rail"), &File(RISE), &[]).unwrap();
    assert!(text.contains("file(name = \"force.csv\") per rail"), "{text}");
}

#[test]
fn a_file_of_something_else_is_told_at_its_row() {
    let whole = "file(\"force.csv\") per rail";
    for (force, file, code, message) in [
        ("file(\"force.csv\")", RISE, Code::E0304, "a basis"),
        ("file(\"force.csv\") per seat", RISE, Code::E0304, "a load on the rail is `per rail`"),
        ("file(\"other.csv\") per rail", RISE, Code::E0508, "no file `other.csv`"),
        (whole, "time_s,level_mm\n0,5\n1,6\n", Code::E0509, "no column of forces"),
        (whole, "x_m,force_kN\n0,5\n1,6\n", Code::E0509, "no column of times"),
        (whole, "time_s,a_kN,b_kN\n0,5,5\n1,6,6\n", Code::E0509, "several columns of forces"),
        (whole, "time_s,force_kN\n0,5\n0,6\n", Code::E0510, "ascend"),
        (whole, "time_s,force_kN\n0,5\n1,-6\n", Code::E0405, "found -6 kN"),
        (whole, "time_s,force_kN\n0,5\n", Code::E0510, "two rows"),
        (whole, "time_s,force_kN\n0,five\n1,6\n", Code::E0510, "found `five`"),
    ] {
        let found = mistakes(force, file);
        assert!(matches!(found.as_slice(), [(c, text)] if *c == code && text.contains(message)), "{force}: {found:?}");
    }
}

//! Kept states and beds that are damaged, cut, empty, or of another version.

use super::program::trackbed;
use super::{Place, in_one_line, on_a_law, refused, same_results};
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;

/// What can happen to a file.
fn damages(whole: &[u8]) -> Vec<(&'static str, Vec<u8>)> {
    let mut flipped = whole.to_vec();
    flipped[whole.len() / 2] ^= 1;
    vec![
        ("a bit is flipped", flipped),
        ("its end is missing", whole[..whole.len() / 2].to_vec()),
        ("it is empty", Vec::new()),
        ("it is of a later format", [b"trackbed 2 ", &whole[b"trackbed 1 ".len()..]].concat()),
    ]
}

/// The same sealed file as another version of the program would have written it.
fn of_version(whole: &[u8], version: &str) -> Vec<u8> {
    let end = whole.iter().position(|byte| *byte == b'\n').unwrap();
    let own = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    let (label, place) = (own.as_bytes(), &whole[end + 1..]);
    let start = place.windows(label.len()).position(|window| window == label).expect("a label with its version");
    let other = format!("\"version\":\"{version}\"");
    let sealed = [&place[..start], other.as_bytes(), &place[start + label.len()..]].concat();
    let hash: String = Sha256::digest(&sealed).iter().map(|byte| format!("{byte:02x}")).collect();
    [format!("trackbed 1 {hash}\n").as_bytes(), &sealed].concat()
}

fn copied(from: &Path, to: &Path) {
    let _ = fs::remove_dir_all(to);
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let (path, to) = (entry.as_ref().unwrap().path(), to.join(entry.unwrap().file_name()));
        if path.is_dir() { copied(&path, &to) } else { fs::copy(&path, &to).map(drop).unwrap() }
    }
}

#[test]
fn a_damaged_state_is_named_and_not_gone_on_from() {
    let place = Place::new(&on_a_law(400));
    place.killed("cut");
    place.finish("whole", &[]);
    for name in ["work", "checkpoint", "pieces/histories-0000"] {
        let whole = fs::read(place.path("cut/.trackbed").join(name)).unwrap();
        for (how, bytes) in damages(&whole) {
            copied(&place.path("cut"), &place.path("damaged"));
            fs::write(place.path("damaged/.trackbed").join(name), bytes).unwrap();
            let output = place.run("damaged", &["--resume"]);
            refused(&output, &["E0802", name, "run again with `--force`"]);
            assert!(!in_one_line(&output).contains("panicked"), "{name}: {how}");
        }
        copied(&place.path("cut"), &place.path("damaged"));
        fs::write(place.path("damaged/.trackbed").join(name), of_version(&whole, "0.0.9")).unwrap();
        let words = ["E0809", "was written by another version: expected 0.1.0, found 0.0.9", "`--force`"];
        refused(&place.run("damaged", &["--resume"]), &words);
    }
    place.finish("damaged", &["--force"]);
    same_results(&place.path("whole"), &place.path("damaged"));
}

/// Results that another version has finished are shown, and not taken for those of this one without a word.
#[test]
fn results_of_an_older_version_are_read() {
    let place = Place::new(&on_a_law(40));
    place.finish("out", &[]);
    let path = place.path("out/manifest.json");
    let mut older: trackbed::store::Manifest = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    older.version = "0.0.9".to_owned();
    let compact = serde_json::to_string(&older).unwrap();
    let (bare, hash) = compact.rsplit_once("\"sha256\":\"").unwrap();
    let old_hash = hash.trim_end_matches("\"}");
    let bare = format!("{bare}\"sha256\":\"\"}}");
    let hash: String = Sha256::digest(bare.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    fs::write(&path, compact.replace(old_hash, &hash)).unwrap();
    let shown = trackbed(&["report", place.path("out").to_str().unwrap()]);
    assert!(shown.status.success(), "{}", in_one_line(&shown));
    let words = ["E0802", "holds the results of a finished run"];
    refused(&place.run("out", &[]), &words);
    let resumed = place.run("out", &["--resume"]);
    let told = in_one_line(&resumed);
    assert!(
        resumed.status.success() && told.contains("finished before by version 0.0.9: `--force` runs it anew"),
        "{told}"
    );
    place.finish("out", &["--force"]);
}

//! The extension for Visual Studio Code packs, as far as this machine has npm. It installs some hundred packages and
//! takes minutes, so it runs when it is asked for: `cargo test --test extension -- --ignored --nocapture`.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Runs a program in a folder; what it printed where it fails.
fn run(folder: &Path, program: &str, arguments: &[&str]) -> Result<(), String> {
    let output = Command::new(program).args(arguments).current_dir(folder).output().map_err(|e| e.to_string())?;
    let said = || format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(()) } else { Err(said()) }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        match path.is_dir() {
            true if entry.file_name() == "node_modules" => {}
            true => copy(&path, &target),
            false => {
                fs::copy(path, target).unwrap();
            }
        }
    }
}

#[test]
#[ignore = "npm installs some hundred packages, which takes minutes"]
fn the_extension_can_be_packed() {
    if let Err(why) = run(Path::new("."), "npm", &["--version"]) {
        println!("skipped: npm is not here ({why})");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    copy(Path::new("editors/vscode"), folder.path());
    run(folder.path(), "npm", &["install", "--no-audit", "--no-fund"]).unwrap();
    run(folder.path(), "node", &["--check", "extension.js"]).unwrap();
    run(folder.path(), "npx", &["--no-install", "vsce", "package", "--allow-missing-repository", "--skip-license"])
        .unwrap();
    let packed = fs::metadata(folder.path().join("trackbed-0.1.0.vsix")).unwrap();
    assert!(packed.len() > 100_000, "the language client is in it");
}

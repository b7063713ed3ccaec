//! The grammar on whole files.
use trackbed::diag::FileId;
use trackbed::syntax::parse;

#[test]
fn scenes() {
    for entry in std::fs::read_dir("tests/scenes").unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let (tree, d) = parse(FileId(0), &text);
        println!("{} items {d:?}", tree.items.len());
        assert!(d.is_empty());
    }
}

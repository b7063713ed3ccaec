//! The language server through its protocol: a client process opens scenes, types them character by character, damages
//! them, and asks.

use serde_json::{Value, json};
use std::fs;

mod common {
    pub mod editor;
}
use common::editor::{Editor, address, behind, edited, position};

const SCENE: &str = include_str!("../scenarios/transition.track");

/// A scene whose pads stand in a module.
const WITH_MODULE: &str = "use std
use site.parts

/// Pads as measured.
let factor = 2

trackform open {
  rail    = rails.UIC60
  pad     = parts.ours { damping_time = 0.1 ms }
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = factor * 25 MN/m per seat, damping_time = 1 ms }
}
trackform deck : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 42 m, deck: 24 m] }
vehicle heavy : vehicles.ore_wagon_30t {}
train ore { vehicles = heavy, speed = 60 km/h }
traffic { trains = ore, total = 400 axles }
";
const MODULE: &str = "/// A pad of the site.\npad ours {\n  stiffness = 60 MN/m\n  damping_time = 0.2 ms\n}\n";

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Place {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("site")).unwrap();
        fs::write(folder.path().join("site/parts.track"), MODULE).unwrap();
        fs::write(folder.path().join("scene.track"), WITH_MODULE).unwrap();
        Place { folder }
    }

    fn file(&self, name: &str) -> String {
        address(&self.folder.path().join(name))
    }

    /// An editor with the scene open.
    fn editor(&self) -> (Editor, String) {
        let mut editor = Editor::start(self.folder.path());
        let scene = self.file("scene.track");
        editor.open(&scene, WITH_MODULE);
        (editor, scene)
    }
}

fn labels(items: &Value) -> Vec<&str> {
    items.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap()).collect()
}

#[test]
fn a_session_begins_and_ends() {
    let place = Place::new();
    let mut editor = Editor::start(place.folder.path());
    let able = &editor.abilities["capabilities"];
    for ability in [
        "hoverProvider",
        "completionProvider",
        "definitionProvider",
        "referencesProvider",
        "renameProvider",
        "documentSymbolProvider",
        "documentFormattingProvider",
        "semanticTokensProvider",
        "codeActionProvider",
        "inlayHintProvider",
    ] {
        assert!(!able[ability].is_null(), "{ability}");
    }
    let unknown = editor.reply("textDocument/declaration", json!({}));
    assert_eq!(unknown["error"]["code"], -32601);
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn shipped_scenes_open_without_errors() {
    let place = Place::new();
    let mut editor = Editor::start(place.folder.path());
    let mut paths: Vec<_> = fs::read_dir("scenarios").unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "track"));
    paths.sort();
    assert!(paths.len() >= 20);
    for path in paths {
        let file = address(&path.canonicalize().unwrap());
        let text = fs::read_to_string(&path).unwrap();
        editor.open(&file, &text);
        let found = editor.diagnostics(&file, 1, |_| true);
        let errors: Vec<&Value> = found.iter().filter(|d| d["severity"] == 1).collect();
        assert!(errors.is_empty(), "{file}: {errors:?}");
        let symbols = editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": file } }));
        assert!(!symbols.as_array().unwrap().is_empty(), "{file}");
        editor.tell("textDocument/didClose", json!({ "textDocument": { "uri": file } }));
    }
    assert_eq!(editor.end(), Some(0));
}

/// A short scene with most kinds of values.
const SHORT: &str = "use std
/// Größe in µm
let k = 40 MN/m
trackform open {
  rail = rails.UIC60, pad = { stiffness = 2 * k, damping_time = 0.1 ms }
  sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = ramp(40 .. 60 MN/m) per seat, damping_time = 1 ms }
}
track line { sections = [open: 60 m] }
record { at = [3, 5] sleepers, quantities = [rail_seat_load] }
";

#[test]
fn a_scene_that_is_typed_character_by_character_always_has_an_answer() {
    let place = Place::new();
    let mut editor = Editor::start(place.folder.path());
    let file = place.file("typed.track");
    editor.open(&file, "");
    let mut version = 1;
    for (offset, c) in SHORT.char_indices() {
        let at = position(SHORT, offset);
        version += 1;
        editor.change(&file, version, json!([{ "range": { "start": at, "end": at }, "text": c.to_string() }]));
        let cursor = position(SHORT, offset + c.len_utf8());
        editor.ask_at("textDocument/completion", &file, cursor.clone());
        if offset % 16 == 0 {
            editor.ask_at("textDocument/hover", &file, cursor);
            editor.ask("textDocument/semanticTokens/full", json!({ "textDocument": { "uri": file } }));
        }
    }
    let typed = editor.diagnostics(&file, version, |_| true);
    assert!(typed.iter().all(|d| d["severity"] != 1), "what was typed is the scene: {typed:?}");
    // and taken away again from the front, two characters at once
    let mut left = SHORT;
    while left.chars().count() > 2 {
        let two: usize = left.chars().take(2).map(char::len_utf8).sum();
        let range = json!({ "start": position(left, 0), "end": position(left, two) });
        left = &left[two..];
        version += 1;
        editor.change(&file, version, json!([{ "range": range, "text": "" }]));
    }
    editor.ask_at("textDocument/completion", &file, json!({ "line": 0, "character": 0 }));
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn a_damaged_scene_still_has_answers() {
    let place = Place::new();
    let mut editor = Editor::start(place.folder.path());
    let file = place.file("damaged.track");
    editor.open(&file, SCENE);
    let (pieces, mut version) = (32, 1);
    for piece in 0..pieces {
        // a hole in the text, each time elsewhere
        let start = (SCENE.len() * piece / pieces..).find(|i| SCENE.is_char_boundary(*i)).unwrap();
        let end = (start + 7..).find(|i| SCENE.is_char_boundary(*i) || *i >= SCENE.len()).unwrap().min(SCENE.len());
        let text = format!("{}{}", &SCENE[..start], &SCENE[end..]);
        version += 1;
        editor.replace(&file, version, &text);
        let at = position(&text, start);
        for method in ["completion", "hover", "definition", "documentHighlight", "prepareRename"] {
            editor.ask_at(&format!("textDocument/{method}"), &file, at.clone());
        }
        let document = json!({ "textDocument": { "uri": file } });
        let outline = editor.ask("textDocument/documentSymbol", document.clone());
        assert!(outline.as_array().unwrap().len() >= 8, "most declarations are there: {text}");
        editor.ask("textDocument/semanticTokens/full", document);
        let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
        let range = json!({ "textDocument": { "uri": file }, "range": whole, "context": { "diagnostics": [] } });
        editor.ask("textDocument/inlayHint", range.clone());
        editor.ask("textDocument/codeAction", range);
    }
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn a_mistake_is_shown_as_it_is_typed_and_goes_when_it_is_mended() {
    let (place, broken) = (Place::new(), SCENE.replace("spacing = 0.6 m", "spacin = 0.6"));
    let mut editor = Editor::start(place.folder.path());
    let file = place.file("transition.track");
    editor.open(&file, &broken);
    let found = editor.diagnostics(&file, 1, |_| true);
    let codes: Vec<&str> = found.iter().map(|d| d["code"].as_str().unwrap()).collect();
    assert!(codes.contains(&"E0402"), "{codes:?}");
    assert_eq!(found[0]["range"]["start"], position(&broken, broken.find("spacin").unwrap()));
    let action =
        json!({ "textDocument": { "uri": file }, "range": found[0]["range"], "context": { "diagnostics": [] } });
    let actions = editor.ask("textDocument/codeAction", action);
    let edits = &actions[0]["edit"]["changes"][&file];
    let mended = edited(&broken, edits);
    assert!(mended.contains("spacing = 0.6\n"), "{actions}");
    editor.replace(&file, 2, &mended);
    let found = editor.diagnostics(&file, 2, |_| true);
    assert_eq!(found[0]["code"], "E0301", "the number still lacks its unit: {found:?}");
    editor.replace(&file, 3, SCENE);
    // the physics rules over the plan speak a moment later
    let found = editor.diagnostics(&file, 3, |found| found.iter().any(|d| d["code"] == "L1001"));
    assert!(found.iter().all(|d| d["severity"] != 1), "{found:?}");
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn words_are_explained_with_what_they_hold() {
    let place = Place::new();
    let (mut editor, file) = place.editor();
    let mut said = |part: &str| {
        let answer = editor.ask_at("textDocument/hover", &file, behind(WITH_MODULE, part));
        answer["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    let field = said("{ stiffness");
    assert!(field.contains("MN/m per seat | sleeper, 1 .. 1000"), "unit and range: {field}");
    assert!(field.contains("here `50 MN/m per seat`, from line 12"), "value and origin: {field}");
    let default = said("  spacin");
    assert!(default.contains("here `0.6 m`"), "{default}");
    let entry = said("rails.UIC60");
    assert!(entry.contains("std/rails.track") && entry.contains("kg/m"), "an entry with its numbers: {entry}");
    let pad = said("parts.ours");
    assert!(
        pad.contains("A pad of the site") && pad.contains("`stiffness = 60 MN/m` from `site/parts.track`"),
        "{pad}"
    );
    assert!(said("60 km/h").contains("a speed") || said("60 km/h").contains("velocity"), "a unit");
    assert!(said("trackfor").contains("(kind)"));
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn half_typed_text_is_completed() {
    let place = Place::new();
    let mut editor = Editor::start(place.folder.path());
    let file = place.file("half.track");
    editor.open(&file, "");
    let mut version = 1;
    let mut offered = |text: &str| {
        version += 1;
        let (before, after) = text.split_once('|').unwrap();
        let whole = format!("{before}{after}");
        editor.replace(&file, version, &whole);
        editor.ask_at("textDocument/completion", &file, position(&whole, before.len()))
    };
    for (text, expected) in [
        ("use std\ntrack|", "trackform"),
        ("usp soft {\n  bedding_modulus = 100 MN/|\n}\n", "MN/m^3"),
        ("usp soft {\n  bedding = 100 MN/|", "N/mm^3"),
        ("pad soft { stiffness = 40 MN/m, da|", "damping_time"),
        ("support s { stiffness = 40 MN/m per |", "seat"),
        ("use std\npad soft : pads.|", "medium"),
        ("use std\ntrackform open { rail = |", "rails.UIC60"),
        ("trackform open { rail = |", "rails.UIC60"),
        ("trackform open {}\ntrack line { sections = [|", "open"),
        ("track line { rail_ends = |", "clamped"),
        ("expect { that = [max(settl|", "settlement"),
        ("scenario { deny = [|", "critical_speed"),
        ("use site.|", "parts"),
        ("pad ours { stiffness = 40 MN/m }\nstudy s { vary = [ours.|", "stiffness"),
        ("pad broken {\n  stiffness = 40\ntrack line {\n  sec|", "sections"),
    ] {
        let items = offered(text);
        assert!(labels(&items).contains(&expected), "{text}: {:?}", labels(&items));
    }
    let items = offered("trackform open { pad = |");
    let medium = items.as_array().unwrap().iter().find(|item| item["label"] == "pads.medium").unwrap();
    assert!(medium["detail"].as_str().unwrap().contains("stiffness 175 MN/m"), "{medium}");
    assert_eq!(medium["additionalTextEdits"][0]["newText"], "use std\n", "its module comes with it");
    assert!(!labels(&offered("pad a { stiffness = 1 MN/m, |")).contains(&"stiffness"), "what is said is not offered");
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn names_lead_to_their_place() {
    let place = Place::new();
    let (mut editor, file) = place.editor();
    let mut leads = |part: &str| editor.ask_at("textDocument/definition", &file, behind(WITH_MODULE, part));
    let own = leads("[open");
    assert_eq!((own["uri"].as_str(), &own["range"]["start"]["line"]), (Some(file.as_str()), &json!(6)));
    let module = leads("parts.ours");
    assert_eq!(module["uri"], place.file("site/parts.track"));
    assert_eq!(module["range"]["start"], json!({ "line": 1, "character": 4 }));
    let library = leads("sleepers.B70");
    let path = library["uri"].as_str().unwrap().strip_prefix("file://").unwrap();
    let laid_down = fs::read_to_string(path).unwrap();
    let line = laid_down.lines().nth(library["range"]["start"]["line"].as_u64().unwrap() as usize).unwrap();
    assert!(line.starts_with("sleeper B70"), "{line}");
    assert_eq!(leads("use site.parts")["uri"], place.file("site/parts.track"));
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn a_name_is_found_and_changed_everywhere() {
    let place = Place::new();
    let (mut editor, file) = place.editor();
    let at = |text: &str, part: &str| json!({ "textDocument": { "uri": file }, "position": behind(text, part) });
    let mut params = at(WITH_MODULE, "trackform open");
    params["context"] = json!({ "includeDeclaration": true });
    let found = editor.ask("textDocument/references", params);
    assert_eq!(found.as_array().unwrap().len(), 3, "{found}");
    let mut params = at(WITH_MODULE, "trackform open");
    params["newName"] = json!("ballasted");
    let changes = editor.ask("textDocument/rename", params)["changes"].clone();
    let renamed = edited(WITH_MODULE, &changes[&file]);
    assert!(renamed.contains("trackform deck : ballasted {") && renamed.contains("[ballasted: 42 m"), "{renamed}");
    assert!(!renamed.contains("open"), "{renamed}");
    // a name of a module changes in the module and in what uses it
    let mut params = at(WITH_MODULE, "parts.ours");
    params["newName"] = json!("measured");
    let changes = editor.ask("textDocument/rename", params)["changes"].clone();
    assert!(edited(WITH_MODULE, &changes[&file]).contains("parts.measured {"));
    assert!(edited(MODULE, &changes[place.file("site/parts.track")]).contains("pad measured {"));
    // names of the library stay, and so do words of the language
    let mut params = at(WITH_MODULE, "rails.UIC60");
    params["newName"] = json!("mine");
    assert!(editor.reply("textDocument/rename", params)["error"]["message"].as_str().unwrap().contains("library"));
    let mut params = at(WITH_MODULE, "trackform open");
    params["newName"] = json!("none");
    assert!(editor.reply("textDocument/rename", params)["error"]["message"].as_str().unwrap().contains("word"));
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn a_scene_has_an_outline_a_layout_colours_and_hints() {
    let place = Place::new();
    let (mut editor, file) = place.editor();
    let document = json!({ "textDocument": { "uri": file } });
    let outline = editor.ask("textDocument/documentSymbol", document.clone());
    let names: Vec<&str> = outline.as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["factor", "open", "deck", "line", "heavy", "ore", "traffic"]);
    assert_eq!(outline[1]["children"][4]["children"].as_array().unwrap().len(), 2, "fields of an object");
    let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
    let hints = editor.ask("textDocument/inlayHint", json!({ "textDocument": { "uri": file }, "range": whole }));
    let said: Vec<&str> = hints.as_array().unwrap().iter().map(|hint| hint["label"].as_str().unwrap()).collect();
    assert!(said.contains(&"axle load 29.49 t"), "{said:?}");
    let colours = editor.ask("textDocument/semanticTokens/full", document.clone());
    let data: Vec<u64> = colours["data"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    assert_eq!(data.len() % 5, 0);
    assert!(data.len() / 5 > 60, "{}", data.len() / 5);
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let layout = json!({ "textDocument": { "uri": file }, "options": options });
    assert_eq!(editor.ask("textDocument/formatting", layout.clone()), json!([]), "it is laid out");
    let untidy = WITH_MODULE.replace("  spacing = 0.6 m", "spacing=0.6 m");
    editor.replace(&file, 2, &untidy);
    let edits = editor.ask("textDocument/formatting", layout);
    assert_eq!(edited(&untidy, &edits), WITH_MODULE);
    let drawing = editor.ask("trackbed/draw", document);
    assert!(drawing["svg"].as_str().unwrap().contains("<svg"), "{drawing}");
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn a_module_that_changes_in_the_editor_changes_its_scene() {
    let place = Place::new();
    let (mut editor, file) = place.editor();
    editor.diagnostics(&file, 1, |_| true);
    let module = place.file("site/parts.track");
    editor.open(&module, &MODULE.replace("pad ours", "pad theirs"));
    let found = editor.diagnostics(&file, 1, |found| found.iter().any(|d| d["code"] == "E0201"));
    assert!(found.iter().any(|d| d["message"].as_str().unwrap().contains("has no `ours`")), "{found:?}");
    assert_eq!(editor.end(), Some(0));
}

#[test]
fn the_grammar_of_the_extension_is_made_from_the_vocabulary() {
    let shipped = fs::read_to_string("editors/vscode/syntaxes/track.tmLanguage.json").unwrap();
    let made = trackbed::editor::textmate();
    assert!(shipped == made, "`trackbed docs --format textmate` writes the grammar of editors/vscode/syntaxes anew");
}

#[test]
fn snippets_are_scenes_and_parts_of_scenes_without_a_mistake_of_the_text() {
    let snippets: Value =
        serde_json::from_str(&fs::read_to_string("editors/vscode/snippets/track.json").unwrap()).unwrap();
    for (name, snippet) in snippets.as_object().unwrap() {
        let lines: Vec<&str> = snippet["body"].as_array().unwrap().iter().map(|line| line.as_str().unwrap()).collect();
        let text = filled(&lines.join("\n"));
        assert!(trackbed::syntax::format(&text).is_ok(), "{name}:\n{text}");
        if name == "Scene" {
            let compiled = trackbed::compile("scene.track", &text, &trackbed::check::NoModules, &[]);
            assert!(compiled.diagnostics.is_empty(), "{:?}", compiled.diagnostics);
        }
    }
}

/// A snippet as it stands before anything is typed into it: `${1:text}` is `text`.
fn filled(body: &str) -> String {
    let mut parts = body.split("${");
    let mut text = parts.next().unwrap().to_owned();
    for part in parts {
        let (hole, rest) = part.split_once('}').unwrap();
        text.push_str(hole.split_once(':').unwrap().1);
        text.push_str(rest);
    }
    text
}

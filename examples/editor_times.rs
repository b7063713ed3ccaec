//! How long the language server takes, request by request, on scenes of 100, 1,000 and 10,000 lines; the table of
//! docs/editor.md.
//!
//! ```sh
//! cargo run --release --example editor_times
//! ```

use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::time::{Duration, Instant};
use trackbed::editor::{Settings, serve};

const ADDRESS: &str = "file:///nowhere/scene.track";
/// Of each request, the median of so many.
const TIMES: usize = 15;

/// A scene of about so many lines: trackforms that extend each other, a `let` for each, all of them used.
fn scene(lines: usize) -> String {
    let mut text = String::from(
        "use std\n\nscenario { title = \"Generated\", allow = [stiffness_jump: \"generated\"] }\n\ntrackform f0 {\n  rail = rails.UIC60\n  \
         pad = pads.medium\n  sleeper = sleepers.B70\n  spacing = 0.6 m\n  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }\n}\n\n",
    );
    let links = lines.saturating_sub(25) / 7;
    let mut sections = Vec::new();
    for i in 1..=links {
        // names that lead to names are followed about sixty deep
        let base = if i % 40 == 1 { 0 } else { i - 1 };
        let stiffness = 60 + i % 40;
        text.push_str(&format!(
            "/// Pads of step {i}.\nlet k{i} = {stiffness} MN/m\ntrackform f{i} : f{base} {{\n  pad.stiffness = 2 * k{i}\n  \
             support.damping_time = 1.{} ms\n}}\n\n",
            i % 10
        ));
        if i % 40 == 0 || i == links {
            sections.push(format!("f{i}: 12 m"));
        }
    }
    let edges: Vec<String> = (1..sections.len()).map(|i| format!("e{i}: soft_to_stiff")).collect();
    let transitions = if edges.len() > 1 { format!("\n  transitions = [{}]", edges.join(", ")) } else { String::new() };
    text.push_str(&format!("track line {{\n  sections = [{}]{transitions}\n}}\n", sections.join(", ")));
    text
}

struct Client {
    connection: Connection,
    version: i32,
    asked: i32,
}

impl Client {
    fn ask(&mut self, method: &str, params: Value) -> (Duration, Value) {
        self.asked += 1;
        let id = RequestId::from(self.asked);
        let begun = Instant::now();
        let request = Request::new(id.clone(), method.to_owned(), params);
        self.connection.sender.send(Message::Request(request)).expect("the server listens");
        loop {
            match self.connection.receiver.recv().expect("the server answers") {
                Message::Response(response) if response.id == id => {
                    return (begun.elapsed(), response.response_result.unwrap_or_default());
                }
                _ => {}
            }
        }
    }

    fn tell(&self, method: &str, params: Value) {
        let notification = Notification::new(method.to_owned(), params);
        self.connection.sender.send(Message::Notification(notification)).expect("the server listens");
    }

    /// Types one character and waits for the diagnostics of the new text.
    fn key(&mut self, line: u32, column: u32, text: &str) -> Duration {
        self.version += 1;
        let place = json!({ "line": line, "character": column });
        let change = json!([{ "range": { "start": place, "end": place }, "text": text }]);
        let begun = Instant::now();
        self.tell(
            "textDocument/didChange",
            json!({ "textDocument": { "uri": ADDRESS, "version": self.version }, "contentChanges": change }),
        );
        self.shown();
        begun.elapsed()
    }

    fn shown(&self) {
        loop {
            if let Message::Notification(told) = self.connection.receiver.recv().expect("the server answers")
                && told.method == "textDocument/publishDiagnostics"
                && told.params["version"] == self.version
            {
                return;
            }
        }
    }
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e3
}

/// Times of one scene, by what is done.
fn times(text: &str) -> Vec<(&'static str, f64)> {
    let (here, there) = Connection::memory();
    let library = std::env::temp_dir().join(format!("trackbed-editor-times-{}", std::process::id()));
    let laid = library.clone();
    let server = std::thread::spawn(move || serve(&there, Settings { library: laid }));
    let mut client = Client { connection: here, version: 1, asked: 0 };
    client.ask("initialize", json!({ "processId": null, "rootUri": null, "capabilities": {} }));
    client.tell("initialized", json!({}));
    let document = json!({ "uri": ADDRESS, "languageId": "track", "version": 1, "text": text });
    client.tell("textDocument/didOpen", json!({ "textDocument": document }));
    client.shown();
    let line_of = |part: &str| text[..text.rfind(part).expect("it stands there")].matches('\n').count() as u32;
    let line = line_of("  pad.stiffness");
    let mut found = Vec::new();
    // blanks behind a value change nothing; each is waited for
    let calm: Vec<Duration> = (0..TIMES).map(|_| client.key(line, 22, " ")).collect();
    found.push(("a key in a sound text: diagnostics", median(calm)));
    client.key(line, 2, "x");
    let unknown: Vec<Duration> = (0..TIMES).map(|_| client.key(line, 2, "x")).collect();
    found.push(("a key in a misspelt name: diagnostics", median(unknown)));
    client.key(line_of("trackform"), 0, "{ ");
    let damaged: Vec<Duration> = (0..TIMES).map(|_| client.key(line, 2, "x")).collect();
    found.push(("a key where a bracket is open: diagnostics", median(damaged)));
    client.version += 1;
    let whole = json!([{ "text": text }]);
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": ADDRESS, "version": client.version }, "contentChanges": whole }),
    );
    client.shown();
    let position = json!({ "line": line, "character": 8 });
    let place = json!({ "textDocument": { "uri": ADDRESS }, "position": position });
    let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 1_000_000, "character": 0 } });
    let document = json!({ "textDocument": { "uri": ADDRESS } });
    let name = json!({ "textDocument": { "uri": ADDRESS }, "position": { "line": line - 2, "character": 5 } });
    let with = |params: &Value, more: Value| {
        let mut params = params.clone();
        params.as_object_mut().expect("an object").extend(more.as_object().expect("an object").clone());
        params
    };
    let options = json!({ "options": { "tabSize": 2, "insertSpaces": true } });
    for (what, method, params) in [
        ("hover", "textDocument/hover", place.clone()),
        ("completion", "textDocument/completion", place.clone()),
        ("definition", "textDocument/definition", name.clone()),
        ("references", "textDocument/references", with(&name, json!({ "context": { "includeDeclaration": true } }))),
        ("rename", "textDocument/rename", with(&name, json!({ "newName": "other" }))),
        ("outline", "textDocument/documentSymbol", document.clone()),
        ("formatting", "textDocument/formatting", with(&document, options)),
        ("semantic colours", "textDocument/semanticTokens/full", document.clone()),
        ("inlay hints", "textDocument/inlayHint", with(&document, json!({ "range": all }))),
        (
            "quick fixes",
            "textDocument/codeAction",
            with(&document, json!({ "range": all, "context": { "diagnostics": [] } })),
        ),
    ] {
        let asked: Vec<Duration> = (0..TIMES).map(|_| client.ask(method, params.clone()).0).collect();
        found.push((what, median(asked)));
    }
    client.ask("shutdown", Value::Null);
    client.tell("exit", Value::Null);
    let ended = server.join();
    assert!(matches!(ended, Ok(Ok(()))), "the server ends well");
    let _ = std::fs::remove_dir_all(library);
    found
}

fn main() {
    let scenes = [100, 1_000, 10_000].map(scene);
    let columns: Vec<Vec<(&str, f64)>> = scenes.iter().map(|text| times(text)).collect();
    let heads: Vec<String> = scenes.iter().map(|text| format!("{} lines, ms", text.lines().count())).collect();
    println!("| | {} |\n|---|---:|---:|---:|", heads.join(" | "));
    for (row, (what, _)) in columns[0].iter().enumerate() {
        let cells: Vec<String> = columns.iter().map(|column| format!("{:.1}", column[row].1)).collect();
        println!("| {what} | {} |", cells.join(" | "));
    }
}

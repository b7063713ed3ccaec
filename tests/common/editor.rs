//! An editor as far as the language server can tell: it starts the program and speaks the protocol with it.

use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

pub struct Editor {
    process: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    asked: i64,
    /// Notifications that have come and were not looked at.
    told: VecDeque<Value>,
    /// What the server said it can do.
    pub abilities: Value,
}

impl Editor {
    /// Starts the server, with a folder as its workspace.
    pub fn start(folder: &Path) -> Editor {
        let mut process = Command::new(env!("CARGO_BIN_EXE_trackbed"))
            .args(["lsp", "--library"])
            .arg(folder.join("library"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = process.stdin.take();
        let output = BufReader::new(process.stdout.take().unwrap());
        let mut editor = Editor { process, input, output, asked: 0, told: VecDeque::new(), abilities: Value::Null };
        let root = address(folder);
        editor.abilities = editor.ask("initialize", json!({ "processId": null, "rootUri": root, "capabilities": {} }));
        editor.tell("initialized", json!({}));
        editor
    }

    fn send(&mut self, message: &Value) {
        let body = message.to_string();
        let input = self.input.as_mut().unwrap();
        write!(input, "Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
        input.flush().unwrap();
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "the server has gone");
            match line.trim().split_once(": ") {
                Some(("Content-Length", value)) => length = value.parse().unwrap(),
                _ if line.trim().is_empty() => break,
                _ => {}
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }

    pub fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// The whole answer to a request.
    pub fn reply(&mut self, method: &str, params: Value) -> Value {
        self.asked += 1;
        let id = self.asked;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.receive();
            if message["id"] == id {
                return message;
            }
            self.told.push_back(message);
        }
    }

    /// The result of a request.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let answer = self.reply(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    pub fn open(&mut self, address: &str, text: &str) {
        let document = json!({ "uri": address, "languageId": "track", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// The whole text anew.
    pub fn replace(&mut self, address: &str, version: i64, text: &str) {
        self.change(address, version, json!([{ "text": text }]));
    }

    pub fn change(&mut self, address: &str, version: i64, changes: Value) {
        let document = json!({ "uri": address, "version": version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    }

    /// The next diagnostics of a version of a document that `wanted` takes.
    pub fn diagnostics(&mut self, address: &str, version: i64, wanted: impl Fn(&[Value]) -> bool) -> Vec<Value> {
        loop {
            let message = self.told.pop_front().unwrap_or_else(|| self.receive());
            let params = &message["params"];
            let here = message["method"] == "textDocument/publishDiagnostics" && params["uri"] == address;
            let found = params["diagnostics"].as_array().cloned().unwrap_or_default();
            if here && params["version"] == version && wanted(&found) {
                return found;
            }
        }
    }

    /// A request about a place of a document, which `|` marks in its text.
    pub fn ask_at(&mut self, method: &str, address: &str, position: Value) -> Value {
        self.ask(method, json!({ "textDocument": { "uri": address }, "position": position }))
    }

    /// Says goodbye; the code with which the server ends.
    pub fn end(mut self) -> Option<i32> {
        self.ask("shutdown", Value::Null);
        self.tell("exit", Value::Null);
        drop(self.input.take());
        self.process.wait().unwrap().code()
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        // a test that fails leaves no process behind
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The address of a file.
pub fn address(path: &Path) -> String {
    format!("file://{}", path.to_str().unwrap())
}

/// The position of the end of a part of a text, in lines and UTF-16 columns.
pub fn behind(text: &str, part: &str) -> Value {
    let end = text.find(part).unwrap_or_else(|| panic!("`{part}` stands in the text")) + part.len();
    position(text, end)
}

/// The position of an offset.
pub fn position(text: &str, offset: usize) -> Value {
    let before = &text[..offset];
    let line = before.rsplit('\n').next().unwrap();
    json!({ "line": before.matches('\n').count(), "character": line.encode_utf16().count() })
}

/// A text after edits of the protocol.
pub fn edited(text: &str, edits: &Value) -> String {
    let offset = |place: &Value| {
        let line = place["line"].as_u64().unwrap() as usize;
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let mut units = 0;
        let wanted = place["character"].as_u64().unwrap() as usize;
        let rest = &text[start..];
        let reached = rest.char_indices().find(|(_, c)| {
            let here = units >= wanted;
            units += c.len_utf16();
            here
        });
        start + reached.map_or(rest.len(), |(i, _)| i)
    };
    let mut parts: Vec<(usize, usize, String)> = edits
        .as_array()
        .unwrap()
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            (offset(&range["start"]), offset(&range["end"]), edit["newText"].as_str().unwrap().to_owned())
        })
        .collect();
    parts.sort();
    let mut out = text.to_owned();
    for (start, end, new) in parts.into_iter().rev() {
        out.replace_range(start..end, &new);
    }
    out
}

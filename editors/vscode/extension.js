// Starts the language server, and draws the scene of the text beside it.

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;
/** The panel with the picture, and the document that it follows. */
let panel;
let drawn;
let waiting;

/** Milliseconds without a key after which the picture is drawn anew. */
const PAUSE = 300;

async function activate(context) {
  const command = vscode.workspace.getConfiguration("trackbed").get("path");
  const watcher = vscode.workspace.createFileSystemWatcher("**/*.{track,csv,stl}");
  client = new LanguageClient(
    "trackbed",
    "Trackbed",
    { command, args: ["lsp"] },
    { documentSelector: [{ language: "track" }], synchronize: { fileEvents: watcher } },
  );
  context.subscriptions.push(
    watcher,
    vscode.commands.registerCommand("trackbed.draw", draw),
    vscode.workspace.onDidChangeTextDocument((event) => {
      if (panel && event.document.uri.toString() === drawn) {
        clearTimeout(waiting);
        waiting = setTimeout(show, PAUSE);
      }
    }),
    vscode.window.onDidChangeActiveTextEditor((editor) => {
      if (panel && editor && editor.document.languageId === "track") {
        drawn = editor.document.uri.toString();
        show();
      }
    }),
  );
  try {
    await client.start();
  } catch (error) {
    vscode.window.showErrorMessage(`\`${command} lsp\` does not start: ${error}. Set \`trackbed.path\` in the settings.`);
  }
}

function draw() {
  const editor = vscode.window.activeTextEditor;
  if (!editor || editor.document.languageId !== "track") {
    vscode.window.showInformationMessage("Open a .track file to draw its scene.");
    return;
  }
  drawn = editor.document.uri.toString();
  if (!panel) {
    const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    panel = vscode.window.createWebviewPanel("trackbed.drawing", "Scene", place, { enableScripts: false });
    panel.onDidDispose(() => {
      panel = undefined;
    });
  }
  return show();
}

async function show() {
  const asked = drawn;
  const answer = await client.sendRequest("trackbed/draw", { textDocument: { uri: asked } });
  // another document may have come in between
  if (!panel || asked !== drawn) {
    return;
  }
  if (answer.svg) {
    panel.webview.html = page(answer.svg);
    panel.title = "Scene";
  } else {
    // the last picture stays, with a word on what is missing
    panel.title = `Scene (${answer.problem})`;
    if (!panel.webview.html) {
      panel.webview.html = page("");
    }
  }
}

function page(svg) {
  const rules = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";
  return `<!DOCTYPE html><html><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${rules}">
<style>body { background: white; margin: 0 } svg { width: 100%; height: auto }</style></head><body>${svg}</body></html>`;
}

function deactivate() {
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };

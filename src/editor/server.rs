//! The protocol: one thread answers requests in their order. It computes diagnostics when no message is waiting, so
//! that only the newest text is checked during fast typing.

use super::session::Session;
use super::tokens::legend;
use super::worker::Board;
use lsp_server::{Connection, ErrorCode, ExtractError, Message, Notification, Request, Response};
use lsp_types::notification::{
    DidChangeTextDocument, DidChangeWatchedFiles, DidCloseTextDocument, DidOpenTextDocument, Notification as _,
};
use lsp_types::request::{
    CodeActionRequest, Completion, DocumentHighlightRequest, DocumentSymbolRequest, Formatting, GotoDefinition,
    HoverRequest, InlayHintRequest, PrepareRenameRequest, References, Rename, Request as _, SemanticTokensFullRequest,
};
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeActionOrCommand, CodeActionProviderCapability, CompletionOptions,
    CompletionResponse, DocumentSymbolResponse, GotoDefinitionResponse, HoverProviderCapability, InitializeParams,
    OneOf, PrepareRenameResponse, RenameOptions, SemanticTokens, SemanticTokensFullOptions, SemanticTokensOptions,
    SemanticTokensResult, ServerCapabilities, TextDocumentIdentifier, TextDocumentSyncCapability, TextDocumentSyncKind,
    WorkDoneProgressOptions,
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

/// Settings of the server.
pub struct Settings {
    /// A folder for the files of the standard library.
    pub library: PathBuf,
}

/// Serves an editor over standard input and output until it shuts the server down. Fails with a message.
pub fn serve_stdio(settings: Settings) -> Result<(), String> {
    let (connection, threads) = Connection::stdio();
    serve(&connection, settings)?;
    drop(connection);
    threads.join().map_err(|error| error.to_string())
}

/// Serves an editor over any connection.
pub fn serve(connection: &Connection, settings: Settings) -> Result<(), String> {
    let (id, params) = connection.initialize_start().map_err(|error| error.to_string())?;
    let params: InitializeParams = serde_json::from_value(params).map_err(|error| error.to_string())?;
    let about = json!({
        "capabilities": capabilities(),
        "serverInfo": { "name": "trackbed", "version": env!("CARGO_PKG_VERSION") },
    });
    connection.initialize_finish(id, about).map_err(|error| error.to_string())?;
    let sender = connection.sender.clone();
    // a disconnected client reads nothing more, and the loop below ends
    let board = Board::new(Arc::new(move |message| drop(sender.send(message))));
    let mut session = Session::new(settings.library, roots(&params), board);
    while let Some(message) = next(connection, &mut session) {
        match message {
            Message::Request(request) => {
                if connection.handle_shutdown(&request).map_err(|error| error.to_string())? {
                    return Ok(());
                }
                let response = answer(&mut session, request);
                connection.sender.send(Message::Response(response)).map_err(|error| error.to_string())?;
            }
            Message::Notification(notification) => notice(&mut session, notification),
            Message::Response(_) => {}
        }
    }
    Ok(())
}

/// The next message; diagnostics are computed while there is none. `None` when the client has disconnected.
fn next(connection: &Connection, session: &mut Session) -> Option<Message> {
    while session.is_stale() {
        match connection.receiver.try_recv() {
            Ok(message) => return Some(message),
            Err(_) => session.refresh(),
        }
    }
    connection.receiver.recv().ok()
}

fn roots(params: &InitializeParams) -> Vec<PathBuf> {
    let folders = params.workspace_folders.iter().flatten().map(|folder| folder.uri.clone());
    #[allow(deprecated, reason = "sent by clients without workspace folders")]
    let root = params.root_uri.clone();
    let folders: Vec<PathBuf> = folders.filter_map(|uri| uri.to_file_path().ok()).collect();
    if folders.is_empty() { root.and_then(|uri| uri.to_file_path().ok()).into_iter().collect() } else { folders }
}

fn capabilities() -> ServerCapabilities {
    let triggers = [".", "=", " ", "[", "{", "(", ":", "/"].map(str::to_owned).to_vec();
    let colours = SemanticTokensOptions {
        legend: legend(),
        full: Some(SemanticTokensFullOptions::Bool(true)),
        ..SemanticTokensOptions::default()
    };
    let fixes =
        CodeActionOptions { code_action_kinds: Some(vec![CodeActionKind::QUICKFIX]), ..CodeActionOptions::default() };
    let rename =
        RenameOptions { prepare_provider: Some(true), work_done_progress_options: WorkDoneProgressOptions::default() };
    ServerCapabilities {
        text_document_sync: Some(TextDocumentSyncCapability::Kind(TextDocumentSyncKind::INCREMENTAL)),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(triggers),
            ..CompletionOptions::default()
        }),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        document_highlight_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(rename)),
        document_symbol_provider: Some(OneOf::Left(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        semantic_tokens_provider: Some(colours.into()),
        code_action_provider: Some(CodeActionProviderCapability::Options(fixes)),
        inlay_hint_provider: Some(OneOf::Left(true)),
        ..ServerCapabilities::default()
    }
}

fn notice(session: &mut Session, notification: Notification) {
    match notification.method.as_str() {
        DidOpenTextDocument::METHOD => heard::<DidOpenTextDocument>(notification, |params| {
            let document = params.text_document;
            session.open(document.uri, document.version, &document.text);
        }),
        DidChangeTextDocument::METHOD => heard::<DidChangeTextDocument>(notification, |params| {
            session.edit(&params.text_document.uri, params.text_document.version, &params.content_changes);
        }),
        DidCloseTextDocument::METHOD => {
            heard::<DidCloseTextDocument>(notification, |params| session.close(&params.text_document.uri));
        }
        DidChangeWatchedFiles::METHOD => session.changed_on_disk(),
        _ => {}
    }
}

/// Reads a notification; one that cannot be read is ignored, because notifications have no response.
fn heard<N: lsp_types::notification::Notification>(notification: Notification, act: impl FnOnce(N::Params)) {
    if let Ok(params) = notification.extract::<N::Params>(N::METHOD) {
        act(params);
    }
}

/// The drawing of a scene, a request that is not in the standard protocol.
enum Draw {}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct DrawParams {
    text_document: TextDocumentIdentifier,
}

#[derive(Serialize, Deserialize)]
struct Drawing {
    svg: Option<String>,
    problem: Option<String>,
}

impl lsp_types::request::Request for Draw {
    type Params = DrawParams;
    type Result = Drawing;
    const METHOD: &'static str = "trackbed/draw";
}

fn answer(session: &mut Session, request: Request) -> Response {
    match request.method.as_str() {
        HoverRequest::METHOD => reply::<HoverRequest>(request, |p| {
            let at = p.text_document_position_params;
            Ok(session.hover(&at.text_document.uri, at.position))
        }),
        Completion::METHOD => reply::<Completion>(request, |p| {
            let at = p.text_document_position;
            Ok(Some(CompletionResponse::Array(session.completion(&at.text_document.uri, at.position))))
        }),
        GotoDefinition::METHOD => reply::<GotoDefinition>(request, |p| {
            let at = p.text_document_position_params;
            Ok(session.definition(&at.text_document.uri, at.position).map(GotoDefinitionResponse::Scalar))
        }),
        References::METHOD => reply::<References>(request, |p| {
            let at = p.text_document_position;
            Ok(Some(session.references(&at.text_document.uri, at.position)))
        }),
        DocumentHighlightRequest::METHOD => reply::<DocumentHighlightRequest>(request, |p| {
            let at = p.text_document_position_params;
            Ok(Some(session.highlights(&at.text_document.uri, at.position)))
        }),
        PrepareRenameRequest::METHOD => reply::<PrepareRenameRequest>(request, |p| {
            Ok(session.renamable(&p.text_document.uri, p.position).ok().map(PrepareRenameResponse::Range))
        }),
        Rename::METHOD => reply::<Rename>(request, |p| {
            let at = p.text_document_position;
            session.rename(&at.text_document.uri, at.position, &p.new_name).map(Some)
        }),
        _ => answer_of_document(session, request),
    }
}

/// Requests about a document or a part of it.
fn answer_of_document(session: &mut Session, request: Request) -> Response {
    match request.method.as_str() {
        DocumentSymbolRequest::METHOD => reply::<DocumentSymbolRequest>(request, |p| {
            Ok(Some(DocumentSymbolResponse::Nested(session.outline(&p.text_document.uri))))
        }),
        Formatting::METHOD => reply::<Formatting>(request, |p| Ok(Some(session.layout(&p.text_document.uri)))),
        SemanticTokensFullRequest::METHOD => reply::<SemanticTokensFullRequest>(request, |p| {
            let data = session.colours(&p.text_document.uri);
            Ok(Some(SemanticTokensResult::Tokens(SemanticTokens { result_id: None, data })))
        }),
        CodeActionRequest::METHOD => reply::<CodeActionRequest>(request, |p| {
            // the diagnostics of the newest text are needed
            while session.is_stale() {
                session.refresh();
            }
            let actions = session.actions(&p.text_document.uri, p.range);
            Ok(Some(actions.into_iter().map(CodeActionOrCommand::CodeAction).collect()))
        }),
        InlayHintRequest::METHOD => {
            reply::<InlayHintRequest>(request, |p| Ok(Some(session.hints(&p.text_document.uri, p.range))))
        }
        Draw::METHOD => reply::<Draw>(request, |p| {
            let (svg, problem) = match session.drawing(&p.text_document.uri) {
                Ok(svg) => (Some(svg), None),
                Err(problem) => (None, Some(problem)),
            };
            Ok(Drawing { svg, problem })
        }),
        method => {
            let message = format!("`{method}` is not supported");
            Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message)
        }
    }
}

/// Reads a request, and makes a response from its result.
fn reply<R: lsp_types::request::Request>(
    request: Request,
    act: impl FnOnce(R::Params) -> Result<R::Result, String>,
) -> Response
where
    R::Params: DeserializeOwned,
{
    let id = request.id.clone();
    match request.extract::<R::Params>(R::METHOD) {
        Ok((id, params)) => match act(params) {
            Ok(result) => Response::new_ok(id, result),
            Err(message) => Response::new_err(id, ErrorCode::RequestFailed as i32, message),
        },
        Err(ExtractError::JsonError { error, .. }) => {
            Response::new_err(id, ErrorCode::InvalidParams as i32, error.to_string())
        }
        Err(ExtractError::MethodMismatch(_)) => Response::new_err(
            id,
            ErrorCode::InternalError as i32,
            "internal error: a request was sent to the wrong handler".into(),
        ),
    }
}

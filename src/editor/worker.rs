//! Longer computations in a separate thread: the plan of a valid scene, and the physics rules for it. Only the newest
//! text of a document is computed, and a late result is not shown.

use super::diagnostics::shown;
use super::files::{Beside, Places};
use crate::compile::compile;
use lsp_server::{Message, Notification};
use lsp_types::notification::{Notification as _, PublishDiagnostics};
use lsp_types::{Diagnostic, PublishDiagnosticsParams, Url};
use std::collections::BTreeMap;
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Sends a message to the editor.
pub type Send = Arc<dyn Fn(Message) + std::marker::Send + Sync>;

/// The diagnostics that a document shows.
#[derive(Default, Clone)]
pub struct Shown {
    pub version: i32,
    pub diagnostics: Vec<Diagnostic>,
    /// Diagnostics that need the plan.
    pub of_plan: Vec<Diagnostic>,
}

/// The shown diagnostics of every document. Both threads send only while they hold it, so that old diagnostics never
/// come last.
#[derive(Clone)]
pub struct Board {
    documents: Arc<Mutex<BTreeMap<Url, Shown>>>,
    send: Send,
}

impl Board {
    /// Starts without diagnostics.
    pub fn new(send: Send) -> Board {
        Board { documents: Arc::default(), send }
    }

    // a panic elsewhere leaves the map valid: only finished entries are put into it
    fn documents(&self) -> MutexGuard<'_, BTreeMap<Url, Shown>> {
        self.documents.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The shown diagnostics of a document.
    pub fn shown(&self, address: &Url) -> Shown {
        self.documents().get(address).cloned().unwrap_or_default()
    }

    /// Shows the diagnostics of a document; diagnostics of a plan only if the document has not changed.
    pub fn show(&self, address: &Url, shown: Shown, late: bool) {
        let mut documents = self.documents();
        if late && documents.get(address).is_none_or(|known| known.version != shown.version) {
            return;
        }
        self.publish(address, shown.diagnostics.clone(), Some(shown.version));
        documents.insert(address.clone(), shown);
    }

    /// Stores the moved diagnostics of the plan after an edit.
    pub fn keep(&self, address: &Url, of_plan: Vec<Diagnostic>) {
        if let Some(shown) = self.documents().get_mut(address) {
            shown.of_plan = of_plan;
        }
    }

    /// Removes the diagnostics of a document.
    pub fn close(&self, address: &Url) {
        let mut documents = self.documents();
        documents.remove(address);
        self.publish(address, Vec::new(), None);
    }

    fn publish(&self, address: &Url, diagnostics: Vec<Diagnostic>, version: Option<i32>) {
        let params = PublishDiagnosticsParams { uri: address.clone(), diagnostics, version };
        (self.send)(Message::Notification(Notification::new(PublishDiagnostics::METHOD.to_owned(), params)));
    }
}

/// A text to compile.
pub struct Job {
    pub address: Url,
    pub version: i32,
    pub name: String,
    pub text: Arc<str>,
    pub modules: Beside,
    pub places: Places,
}

/// The thread that compiles.
pub struct Worker {
    jobs: Sender<Job>,
}

impl Worker {
    /// Starts the thread. It ends with the program; it has no state to save.
    pub fn start(board: Board) -> Worker {
        let (jobs, received) = mpsc::channel();
        thread::spawn(move || work(&received, &board));
        Worker { jobs }
    }

    /// Sends a text to the thread.
    pub fn compile(&self, job: Job) {
        // if the worker has panicked, the diagnostics of the check are still shown
        let _ = self.jobs.send(job);
    }
}

fn work(received: &Receiver<Job>, board: &Board) {
    let mut waiting: BTreeMap<Url, Job> = BTreeMap::new();
    loop {
        if waiting.is_empty() {
            let Ok(job) = received.recv() else { return };
            waiting.insert(job.address.clone(), job);
        }
        waiting.extend(received.try_iter().map(|job| (job.address.clone(), job)));
        if let Some((_, job)) = waiting.pop_first() {
            compiled(&job, board);
        }
    }
}

fn compiled(job: &Job, board: &Board) {
    if board.shown(&job.address).version != job.version {
        return;
    }
    let compiled = compile(&job.name, &job.text, &job.modules, &[]);
    let diagnostics = shown(&compiled.diagnostics, &compiled.sources, &job.places);
    let before = board.shown(&job.address);
    let of_check = |d: &Diagnostic| before.diagnostics.contains(d) && !before.of_plan.contains(d);
    let of_plan = diagnostics.iter().filter(|d| !of_check(d)).cloned().collect();
    board.show(&job.address, Shown { version: job.version, diagnostics, of_plan }, true);
}

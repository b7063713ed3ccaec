//! The vocabulary of the language for `trackbed docs`: all topics, one topic by name, or the topics with a word; as
//! text and as JSON.

mod data;
mod find;
mod text;

use crate::check::{Entry, LIBRARY, library};
use crate::diag::Code;
use crate::diag::nearest::nearest;
use crate::scenario::response::Response;
use crate::schema::{self, Field, KINDS, Kind};
pub use data::everything as vocabulary;
use serde_json::Value;

/// One item of the vocabulary.
#[derive(Debug, Clone)]
pub enum Topic {
    Kind(&'static Kind),
    Field(&'static Kind, &'static Field),
    /// A module of the standard library, with its entries.
    Module(&'static str, Vec<Entry>),
    Entry(Entry),
    Response(Response),
    Code(Code),
}

impl Topic {
    /// The topic with this name: `usp`, `usp.bedding_modulus`, `usps`, `usps.medium`, `settlement`, `E0302`,
    /// `stiffness_jump`.
    pub fn named(name: &str) -> Option<Topic> {
        let kind = || schema::kind(name).map(Topic::Kind);
        let module = || {
            let (module, _) = LIBRARY.iter().find(|(module, _)| *module == name)?;
            Some(Topic::Module(module, library().into_iter().filter(|entry| entry.module == *module).collect()))
        };
        let part = || {
            let (whole, part) = name.split_once('.')?;
            let field = schema::kind(whole).and_then(|kind| Some(Topic::Field(kind, kind.field(part)?)));
            let entry = || library().into_iter().find(|entry| entry.module == whole && entry.name == part);
            field.or_else(|| entry().map(Topic::Entry))
        };
        let response = || Response::ALL.iter().find(|response| response.name() == name).copied().map(Topic::Response);
        let code = || Code::parse(name).or_else(|| Code::of_rule(name)).map(Topic::Code);
        kind().or_else(module).or_else(part).or_else(response).or_else(code)
    }

    /// Topics with this word in their name or meaning, names first.
    pub fn found(word: &str) -> Vec<Topic> {
        find::found(word)
    }

    /// The name for [`Topic::named`].
    pub fn name(&self) -> String {
        match self {
            Topic::Kind(kind) => kind.name.into(),
            Topic::Field(kind, field) => format!("{}.{}", kind.name, field.name),
            Topic::Module(module, _) => (*module).into(),
            Topic::Entry(entry) => format!("{}.{}", entry.module, entry.name),
            Topic::Response(response) => response.name().into(),
            Topic::Code(code) => code.as_str().into(),
        }
    }

    /// The meaning in one line.
    pub fn meaning(&self) -> String {
        match self {
            Topic::Kind(kind) => kind.doc.into(),
            Topic::Field(_, field) => field.doc.into(),
            Topic::Module(module, entries) => {
                format!("{} entries of the standard library: `use std.{module}`", entries.len())
            }
            Topic::Entry(entry) => entry.doc.clone(),
            Topic::Response(response) => format!("{} (response, {})", response.doc(), unit(response)),
            Topic::Code(code) => match code.rule() {
                Some(rule) => format!("{} (rule `{rule}`)", code.title()),
                None => code.title().into(),
            },
        }
    }

    /// The whole text about the topic.
    pub fn page(&self) -> String {
        text::page(self)
    }

    /// The same as JSON.
    pub fn data(&self) -> Value {
        data::topic(self)
    }
}

/// One line per topic, under a heading for each kind of topic.
pub fn listing(topics: &[Topic]) -> String {
    text::listing(topics)
}

/// The name of the topic that is nearest to a misspelt name.
pub fn nearest_topic(name: &str) -> Option<String> {
    let kinds = KINDS.iter().map(|kind| kind.name.to_string());
    let modules = LIBRARY.iter().map(|(module, _)| (*module).to_string());
    let entries = library().into_iter().map(|entry| format!("{}.{}", entry.module, entry.name));
    let responses = Response::ALL.iter().map(|response| response.name().to_string());
    let all: Vec<String> = kinds.chain(modules).chain(entries).chain(responses).collect();
    nearest(name, all.iter().map(String::as_str)).map(str::to_string)
}

/// The unit of a response in tables, in words.
fn unit(response: &Response) -> String {
    match response.unit() {
        "1" => "a number".into(),
        unit => format!("tables in {unit}"),
    }
}

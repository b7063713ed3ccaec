//! Differences between whole scenes, value by value, under the names that `--set` takes.

use super::Subject;
use crate::diag::{FileId, Span};
use crate::syntax;
use crate::syntax::tree::{Declaration, Field, Item, ValueKind};
use serde::Serialize;
use std::collections::BTreeMap;

/// A value that is not the same in all scenes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Edit {
    /// The name that `--set` takes: `open.support.stiffness`.
    pub path: String,
    /// The text in each scene; `None` if it has no such value.
    pub texts: Vec<Option<String>>,
}

/// The differences; `None` if not every result has its whole scene.
pub fn edits(subjects: &[Subject]) -> Option<Vec<Edit>> {
    let scenes: Vec<&str> = subjects.iter().map(|subject| subject.resolved.as_deref()).collect::<Option<_>>()?;
    Some(between(&scenes))
}

/// Differences between the texts of whole scenes, in the order of the first scene that has the value.
fn between(scenes: &[&str]) -> Vec<Edit> {
    let values: Vec<Values> = scenes.iter().map(|scene| Values::read(scene)).collect();
    let mut paths: Vec<&String> = Vec::new();
    let mut known = std::collections::HashSet::new();
    for path in values.iter().flat_map(|values| &values.order) {
        if known.insert(path) {
            paths.push(path);
        }
    }
    let texts = |path: &String| values.iter().map(|values| values.texts.get(path).cloned()).collect::<Vec<_>>();
    let edit = |path: &String| Edit { path: path.clone(), texts: texts(path) };
    let differs = |edit: &Edit| edit.texts.iter().any(|text| *text != edit.texts[0]);
    paths.into_iter().map(edit).filter(differs).collect()
}

/// The values of a scene by their paths.
#[derive(Default)]
struct Values {
    texts: BTreeMap<String, String>,
    /// The paths as they stand in the file.
    order: Vec<String>,
}

impl Values {
    fn read(scene: &str) -> Values {
        let (tree, _) = syntax::parse(FileId(0), scene);
        let mut values = Values::default();
        for item in &tree.items {
            match item {
                Item::Declaration(declaration) => values.declaration(scene, declaration),
                Item::Let(declared) => values.put(declared.name.text.clone(), text(scene, declared.value.span)),
                Item::Use(_) => {}
            }
        }
        values
    }

    fn declaration(&mut self, scene: &str, declaration: &Declaration) {
        let name = declaration.name.as_ref().unwrap_or(&declaration.kind);
        if let Some(base) = &declaration.base {
            self.put(format!("{} :", name.text), &base.text());
        }
        self.fields(scene, &name.text, &declaration.fields);
    }

    fn fields(&mut self, scene: &str, path: &str, fields: &[Field]) {
        for field in fields {
            let path = format!("{path}.{}", field.path.text());
            match &field.value.kind {
                ValueKind::Object { base, fields } => {
                    if let Some(base) = base {
                        self.put(path.clone(), &base.text());
                    }
                    self.fields(scene, &path, fields);
                }
                _ => self.put(path, text(scene, field.value.span)),
            }
        }
    }

    fn put(&mut self, path: String, text: &str) {
        self.order.push(path.clone());
        self.texts.insert(path, plain(text));
    }
}

/// A piece of a scene.
fn text(scene: &str, span: Span) -> &str {
    scene.get(span.start as usize..span.end as usize).unwrap_or_default()
}

/// A value on one line, without comments.
fn plain(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or(""));
    lines.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_the_name_that_set_takes() {
        let before = "track line { sections = [open: 42 m] } // the way\ntrackform open { spacing = 0.6 m, support = { \
                      stiffness = 50 MN/m per seat // soft\n } }\nsolve { seed = 1 }\n";
        let after = "track line { sections = [open: 42 m] }\ntrackform open { spacing = 0.6 m, usp = medium, support = \
                     { stiffness = 80 MN/m per seat } }\nsolve { seed = 1 }\n";
        let edit = |path: &str, one: Option<&str>, other: Option<&str>| Edit {
            path: path.to_owned(),
            texts: vec![one.map(str::to_owned), other.map(str::to_owned)],
        };
        let expected = [
            edit("open.support.stiffness", Some("50 MN/m per seat"), Some("80 MN/m per seat")),
            edit("open.usp", None, Some("medium")),
        ];
        assert_eq!(between(&[before, after]), expected);
        assert_eq!(between(&[before, before]), []);
    }
}

//! Profiles from data files: which columns hold the places and the values, and whether they fit the field.

use super::evaluator::Evaluator;
use super::number::{Number, Raw};
use super::shape::ShapeKind;
use super::written::{Per, looks_like};
use crate::check::text::table::{Cell, Table};
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Help, Span};
use crate::schema::{Form, Measure};
use crate::syntax::tree::{Argument, Name, Value, ValueKind};
use crate::units::Dimension;

impl Evaluator<'_> {
    /// `file("level.csv")`, or `file("survey.csv", column = level)`
    pub fn data_profile(
        &mut self,
        measure: &'static Measure,
        word: &Name,
        arguments: &[Argument],
        per: Per,
        whole: Span,
    ) -> Option<ShapeKind> {
        self.arguments_of(word, arguments, &["column"])?;
        let Some((ValueKind::Text(name), span)) = arguments.first().map(|a| (&a.value.kind, a.value.span)) else {
            let first = arguments.first().map(|a| &a.value);
            // unreadable text has been reported
            if first.is_some_and(|value| value.kind == ValueKind::Error) {
                return None;
            }
            let help = match first.map(|value| &value.kind) {
                Some(ValueKind::Path(path)) => {
                    Help::write(format!("\"{}\"", path.text())).after("write the name of a file in quotes: ")
                }
                _ => Help::say("write something like `file(\"level.csv\")`"),
            };
            self.findings.report(
                Diagnostic::new(Code::E0403, "`file` needs the name of a data file")
                    .label(word.span, "no file given")
                    .advise(first.map_or(word.span, |value| value.span), help),
            );
            return None;
        };
        let wanted = match arguments.get(1).map(|a| &a.value) {
            None => None,
            Some(Value { kind: ValueKind::Path(path), span }) if path.names.len() == 1 => Some((path.text(), *span)),
            Some(other) => {
                self.wrong_form(&Form::Name, looks_like(&other.kind), other.span);
                return None;
            }
        };
        let table = self.files.table(name, span, &mut self.findings)?;
        let (place, value) = self.columns(&table, name, wanted, span)?;
        let column = &table.columns[value];
        let dimension = column.unit.dimension;
        let raw = Raw { value: column.unit.factor, dimension, basis: per.clone(), span: whole, bare: false };
        if dimension != Dimension::of_unit(measure.unit) {
            let expected = format!("expected {}", Form::Number(*measure).describe());
            self.wrong_dimension(&Raw { span: column.span, ..raw }, &[measure], &expected);
            return None;
        }
        self.basis(measure, &raw)?;
        self.rows(measure, &table, [place, value], per, span)
    }

    /// The columns of the places and of the values.
    fn columns(
        &mut self,
        table: &Table,
        file: &str,
        wanted: Option<(String, Span)>,
        span: Span,
    ) -> Option<(usize, usize)> {
        let list = || table.columns.iter().map(|c| format!("`{}`", c.name)).collect::<Vec<_>>().join(", ");
        let Some(place) = table.column("x").filter(|i| table.columns[*i].unit.dimension == Dimension::LENGTH) else {
            self.findings.report(
                Diagnostic::new(Code::E0509, format!("`{file}` has no column `x` of places"))
                    .label(table.header, format!("has {}", list()))
                    .label(span, "read here")
                    .help("name the column of chainages `x_m`"),
            );
            return None;
        };
        let others: Vec<usize> = (0..table.columns.len()).filter(|i| *i != place).collect();
        let found = match &wanted {
            Some((name, _)) => table.column(name).filter(|i| *i != place),
            None => others.first().copied().filter(|_| others.len() == 1),
        };
        if let Some(value) = found {
            return Some((place, value));
        }
        let mistake = match (&wanted, others.is_empty()) {
            (Some((name, asked)), _) => Diagnostic::new(Code::E0509, format!("`{file}` has no column `{name}`"))
                .label(table.header, format!("has {}", list()))
                .label(*asked, "asked for here")
                .maybe_help(
                    nearest(name, table.columns.iter().map(|c| c.name.as_str()))
                        .map(|n| format!("did you mean `{n}`?")),
                ),
            (None, true) => Diagnostic::new(Code::E0509, format!("`{file}` has places but no values"))
                .label(table.header, "one column only")
                .label(span, "read here"),
            (None, false) => Diagnostic::new(Code::E0509, format!("`{file}` has several columns of values"))
                .label(table.header, format!("has {}", list()))
                .label(span, "read here")
                .help(format!("name one: `file(\"{file}\", column = {})`", table.columns[others[0]].name)),
        };
        self.findings.report(mistake);
        None
    }

    /// Places that ascend, each with a value that fits the field.
    fn rows(
        &mut self,
        measure: &'static Measure,
        table: &Table,
        [place, value]: [usize; 2],
        per: Per,
        span: Span,
    ) -> Option<ShapeKind> {
        let mut rows: Vec<(f64, Number)> = Vec::new();
        let mut ends: Option<[Span; 2]> = None;
        let mut sound = true;
        let mut last: Option<Cell> = None;
        for cells in table.rows() {
            let x = cells[place];
            if let Some(before) = last.filter(|before| before.value >= x.value) {
                self.findings.report(
                    Diagnostic::new(Code::E0510, "the places of a data file must ascend from row to row")
                        .label(x.span, "not greater than in the row before")
                        .label(before.span, "the row before")
                        .label(span, "read here"),
                );
                return None;
            }
            last = Some(x);
            let dimension = table.columns[value].unit.dimension;
            let basis = per.clone();
            let raw = Raw { value: cells[value].value, dimension, basis, span: cells[value].span, bare: false };
            match self.hold(measure, raw) {
                Some(held) => rows.push((x.value, held)),
                None => sound = false,
            }
            ends = Some([ends.map_or(x.span, |e| e[0]), x.span]);
        }
        if rows.len() < 2 && sound {
            self.findings.report(
                Diagnostic::new(Code::E0510, format!("expected at least two rows of numbers, found {}", rows.len()))
                    .label(table.header, "too few rows below")
                    .label(span, "read here"),
            );
            return None;
        }
        let column = table.columns[value].name.clone();
        Some(ShapeKind::Table { column, rows, ends: ends? }).filter(|_| sound)
    }
}

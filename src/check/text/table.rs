//! Data files: numbers in columns, comma separated, each column with its unit in the header (`x_m,level_mm`). Every
//! mistake of a file is reported at its line and column.

use crate::diag::{Code, Diagnostic, FileId, Span};
use crate::units::{Unit, parse_unit};

/// A data file as read.
pub struct Table {
    /// The place of the header.
    pub header: Span,
    pub columns: Vec<Column>,
    /// Row by row, as many cells as columns.
    cells: Vec<Cell>,
}

/// A column of a data file, by its header.
pub struct Column {
    pub name: String,
    pub unit: Unit,
    pub span: Span,
}

/// A number in SI and its place.
#[derive(Clone, Copy)]
pub struct Cell {
    pub value: f64,
    pub span: Span,
}

/// Number of mistakes of one file that are reported; further mistakes are counted.
const MOST_MISTAKES: usize = 20;

impl Table {
    /// Reads the text of a file, with its first mistakes; the last one gives the number of further mistakes.
    pub fn read(file: FileId, name: &str, text: &str) -> (Option<Table>, Vec<Diagnostic>) {
        let mut reader = Reader { file, mistakes: Vec::new() };
        let table = reader.table(text);
        let beyond = reader.mistakes.len().saturating_sub(MOST_MISTAKES);
        reader.mistakes.truncate(MOST_MISTAKES);
        if let Some(last) = reader.mistakes.last_mut().filter(|_| beyond > 0) {
            last.help = Some(format!("{beyond} further rows of `{name}` cannot be read"));
        }
        (table, reader.mistakes)
    }

    /// Row by row, as many cells as columns.
    pub fn rows(&self) -> impl Iterator<Item = &[Cell]> {
        self.cells.chunks(self.columns.len())
    }

    /// Index of a column by its name without the unit.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|c| c.name == name)
    }
}

/// Reads a text and collects its mistakes.
struct Reader {
    file: FileId,
    mistakes: Vec<Diagnostic>,
}

impl Reader {
    fn table(&mut self, text: &str) -> Option<Table> {
        let mut lines = lines(text).filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
        let Some((start, line)) = lines.next() else {
            let span = Span::new(self.file, 0, 0);
            self.mistakes.push(
                Diagnostic::new(Code::E0509, "the file is empty")
                    .label(span, "no header")
                    .help("begin it with the names and units of its columns, such as `x_m,level_mm`"),
            );
            return None;
        };
        let header = Span::new(self.file, start, start + line.trim_end().len());
        if line.contains(';') {
            let message = "separate columns by commas, and write numbers with a decimal point";
            self.mistakes.push(Diagnostic::new(Code::E0509, message).label(header, "separated by semicolons"));
            return None;
        }
        let columns: Vec<Option<Column>> = cells(start, line).map(|(at, text)| self.column(at, text)).collect();
        let columns: Vec<Column> = columns.into_iter().collect::<Option<_>>()?;
        let mut cells = Vec::new();
        for (start, line) in lines {
            self.row(start, line, &columns, &mut cells);
        }
        Some(Table { header, columns, cells })
    }

    /// `level_mm`: a name and its unit.
    fn column(&mut self, at: usize, text: &str) -> Option<Column> {
        let span = Span::new(self.file, at, at + text.len());
        let Some((name, unit)) = text.rsplit_once('_').filter(|(name, unit)| !name.is_empty() && !unit.is_empty())
        else {
            self.mistakes.push(
                Diagnostic::new(Code::E0509, format!("column `{text}` has no unit"))
                    .label(span, "expected name, `_` and unit")
                    .help("write the unit after the name, such as `x_m` or `level_mm`"),
            );
            return None;
        };
        match parse_unit(unit) {
            Ok(unit) => Some(Column { name: name.to_string(), unit, span }),
            Err(_) => {
                self.mistakes.push(
                    Diagnostic::new(Code::E0509, format!("column `{text}` has an unknown unit `{unit}`"))
                        .label(span, "not a unit"),
                );
                None
            }
        }
    }

    fn row(&mut self, start: usize, line: &str, columns: &[Column], into: &mut Vec<Cell>) {
        let found = cells(start, line).count();
        if found != columns.len() {
            let span = Span::new(self.file, start, start + line.trim_end().len());
            let message = format!("expected {} numbers in this row, found {found}", columns.len());
            self.mistakes.push(Diagnostic::new(Code::E0510, message).label(span, "expected one number per column"));
            return;
        }
        for ((at, text), column) in cells(start, line).zip(columns) {
            let span = Span::new(self.file, at, at + text.len());
            match text.parse::<f64>().ok().map(|value| value * column.unit.factor).filter(|value| value.is_finite()) {
                Some(value) => into.push(Cell { value, span }),
                None => {
                    // the row keeps its length; the table is dropped later
                    into.push(Cell { value: 0.0, span });
                    let message = format!("expected a number, found `{text}`");
                    self.mistakes.push(Diagnostic::new(Code::E0510, message).label(span, "not a number"));
                }
            }
        }
    }
}

/// Lines with the offsets at which they start.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_inclusive('\n').scan(0, |at, line| {
        let start = *at;
        *at += line.len();
        Some((start, line))
    })
}

/// The cells of a line without the blanks around them, with their offsets.
fn cells(start: usize, line: &str) -> impl Iterator<Item = (usize, &str)> {
    line.split(',').scan(start, |at, cell| {
        let text = cell.trim();
        let offset = *at + cell.find(text).unwrap_or(0);
        *at += cell.len() + 1;
        Some((offset, text))
    })
}

//! A measured settlement curve from the text of a CSV file: every line that cannot be used is named.

use crate::diag::{Code, Diagnostic, FileId, Span};
use crate::units::{Dimension, number, parse_unit};

/// Settlement against axles, as measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredCurve {
    /// Ascending, above 0.
    pub axles: Vec<u64>,
    /// m, positive down.
    pub settlement: Vec<f64>,
}

/// Reads columns `axles` and `settlement_UNIT`; other columns are ignored. At least `least` measurements are needed.
/// Without a curve there is at least one diagnostic.
pub fn measured_curve(file: FileId, text: &str, least: usize) -> (Option<MeasuredCurve>, Vec<Diagnostic>) {
    let mut reader = Reader { file, diagnostics: Vec::new() };
    let mut lines = lines(text).filter(|line| !line.text.trim().is_empty() && !line.text.trim_start().starts_with('#'));
    let Some(header) = lines.next() else {
        reader.refuse("the file holds no measurement", Span::new(file, 0, text.len().min(1)), "empty");
        return (None, reader.diagnostics);
    };
    let separator = [';', '\t', ','].into_iter().find(|s| header.text.contains(*s)).unwrap_or(',');
    let names = header.cells(separator);
    let axles = reader.axles_column(&names, &header);
    let settlement = reader.settlement_column(&names, &header);
    let (Some(axles), Some((settlement, size))) = (axles, settlement) else { return (None, reader.diagnostics) };
    let mut curve = MeasuredCurve::default();
    let mut before: Option<u64> = None;
    let mut rows = 0;
    for line in lines {
        rows += 1;
        let cells = line.cells(separator);
        if cells.len() != names.len() {
            let found = format!("expected {} columns, found {}", names.len(), cells.len());
            let help = "a decimal comma makes an additional column: write a decimal point";
            reader.refuse_with(&found, line.span(file), "this line", help);
            continue;
        }
        let count = reader.count(&cells[axles]);
        let value = reader.settlement(&cells[settlement], size);
        if let Some(count) = count {
            if let Some(before) = before.filter(|before| count <= *before) {
                let mistake = format!("axle counts must ascend: {count} comes after {before}");
                reader.refuse(&mistake, cells[axles].span(file), "does not ascend");
            }
            before = Some(count);
        }
        match (count, value) {
            (Some(0), Some(value)) if value != 0.0 => reader.refuse_with(
                "the settlement before the first axle is not 0",
                cells[settlement].span(file),
                "before the first axle",
                "give the settlement since the start of the count, so that it begins with 0",
            ),
            (Some(count), Some(value)) if count > 0 => {
                curve.axles.push(count);
                curve.settlement.push(value);
            }
            _ => {}
        }
    }
    if reader.diagnostics.is_empty() && curve.axles.len() < least {
        let mistake = format!("{} measurements are too few, at least {least} are needed", curve.axles.len());
        let help = "fit fewer parameters with `--fit`, or measure at more counts";
        reader.refuse_with(&mistake, header.span(file), &format!("{rows} lines below"), help);
    }
    (Some(curve).filter(|_| reader.diagnostics.is_empty()), reader.diagnostics)
}

/// A piece of the text with the offset of its first byte.
#[derive(Clone, Copy)]
struct Piece<'a> {
    text: &'a str,
    start: usize,
}

impl<'a> Piece<'a> {
    fn span(&self, file: FileId) -> Span {
        Span::new(file, self.start, self.start + self.text.len())
    }

    /// The cells of a line, without blanks and quotes around them.
    fn cells(&self, separator: char) -> Vec<Piece<'a>> {
        let base = self.text.as_ptr() as usize;
        let bare = |cell: &'a str| cell.trim().trim_matches('"').trim();
        let cells = self.text.split(separator).map(bare);
        cells.map(|cell| Piece { text: cell, start: self.start + (cell.as_ptr() as usize - base) }).collect()
    }
}

fn lines(text: &str) -> impl Iterator<Item = Piece<'_>> {
    let mut start = 0;
    text.split_inclusive('\n').map(move |line| {
        let piece = Piece { text: line.trim_end_matches(['\r', '\n']), start };
        start += line.len();
        piece
    })
}

struct Reader {
    file: FileId,
    diagnostics: Vec<Diagnostic>,
}

impl Reader {
    fn refuse(&mut self, message: &str, span: Span, label: &str) {
        self.diagnostics.push(Diagnostic::new(Code::E0805, message).label(span, label));
    }

    fn refuse_with(&mut self, message: &str, span: Span, label: &str, help: &str) {
        self.diagnostics.push(Diagnostic::new(Code::E0805, message).label(span, label).help(help));
    }

    fn axles_column(&mut self, names: &[Piece<'_>], header: &Piece<'_>) -> Option<usize> {
        let found = names.iter().position(|name| name.text.eq_ignore_ascii_case("axles"));
        if found.is_none() {
            let help = "the first line names the columns: `axles,settlement_mm`";
            self.refuse_with("the column `axles` is missing", header.span(self.file), "these are the columns", help);
        }
        found
    }

    /// The column of settlement, and the size of its unit in m.
    fn settlement_column(&mut self, names: &[Piece<'_>], header: &Piece<'_>) -> Option<(usize, f64)> {
        let help = "write the unit behind the name: `settlement_mm`";
        let lower = |name: &Piece<'_>| name.text.to_ascii_lowercase();
        let Some(column) = names.iter().position(|name| lower(name).starts_with("settlement")) else {
            self.refuse_with(
                "the column of settlement is missing",
                header.span(self.file),
                "these are the columns",
                help,
            );
            return None;
        };
        let name = &names[column];
        let unit = name.text["settlement".len()..].trim_matches([' ', '_', '[', ']', '(', ')']);
        match parse_unit(unit) {
            Ok(unit) if unit.dimension == Dimension::LENGTH => Some((column, unit.factor)),
            _ => {
                let mistake = format!("expected the settlement with its unit, found `{}`", name.text);
                self.refuse_with(&mistake, name.span(self.file), "in which unit?", help);
                None
            }
        }
    }

    fn number(&mut self, cell: &Piece<'_>) -> Option<f64> {
        match cell.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value),
            _ => {
                let decimal = cell.text.contains(',').then(|| cell.text.replace(',', "."));
                let help = decimal.filter(|text| text.parse::<f64>().is_ok()).map(|text| format!("write `{text}`"));
                let mistake = match cell.text {
                    "" => "expected a number, found nothing".to_string(),
                    text => format!("expected a number, found `{text}`"),
                };
                let place = if cell.text.is_empty() {
                    Span::new(self.file, cell.start.saturating_sub(1), cell.start)
                } else {
                    cell.span(self.file)
                };
                self.diagnostics
                    .push(Diagnostic::new(Code::E0805, mistake).label(place, "not a number").maybe_help(help));
                None
            }
        }
    }

    fn count(&mut self, cell: &Piece<'_>) -> Option<u64> {
        let value = self.number(cell)?;
        if value < 0.0 || value.fract() != 0.0 || value > 1e15 {
            let mistake = format!("expected a whole number of axles, found {}", number(value));
            self.refuse(&mistake, cell.span(self.file), "not a count");
            return None;
        }
        Some(value as u64)
    }

    fn settlement(&mut self, cell: &Piece<'_>, size: f64) -> Option<f64> {
        let value = self.number(cell)?;
        if value < 0.0 {
            let mistake = format!("expected a settlement of 0 or more, found {}", number(value));
            self.refuse_with(&mistake, cell.span(self.file), "upwards", "settlement is positive down");
            return None;
        }
        Some(value * size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Option<MeasuredCurve>, Vec<(String, usize)>) {
        let (curve, diagnostics) = measured_curve(FileId(0), text, 3);
        let line = |d: &Diagnostic| text[..d.labels[0].span.start as usize].matches('\n').count() + 1;
        (curve, diagnostics.iter().map(|d| (d.message.clone(), line(d))).collect())
    }

    #[test]
    fn a_curve_is_read_in_its_unit() {
        for text in [
            "axles,settlement_mm\n0,0\n10,0.5\n100, 1.5\n1000,2\n",
            "# a comment\r\n\"Axles\";\"Settlement [mm]\"\r\n10;0.5\r\n\r\n100;1.5\r\n1e3;2\r\n",
            "run\tsettlement_m\taxles\na\t0.0005\t10\nb\t0.0015\t100\nc\t0.002\t1000",
        ] {
            let (curve, mistakes) = read(text);
            assert_eq!(mistakes, []);
            let curve = curve.unwrap();
            assert_eq!(curve.axles, [10, 100, 1000]);
            let expected = [0.5e-3, 1.5e-3, 2e-3];
            assert!(curve.settlement.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-18));
        }
    }

    #[test]
    fn every_bad_line_is_named() {
        let (curve, mistakes) = read("axles,settlement_mm\n10,0.5\n5,0.7\n20,\n30.5,1\n40,-1\nx,1\n50,1,2\n60,1\n");
        assert!(curve.is_none());
        let expected = [
            ("axle counts must ascend: 5 comes after 10", 3),
            ("expected a number, found nothing", 4),
            ("expected a whole number of axles, found 30.5", 5),
            ("expected a settlement of 0 or more, found -1", 6),
            ("expected a number, found `x`", 7),
            ("expected 2 columns, found 3", 8),
        ];
        assert_eq!(mistakes, expected.map(|(m, l)| (m.to_string(), l)));
    }

    #[test]
    fn columns_and_units_are_asked_for() {
        let one = |text: &str| read(text).1;
        assert_eq!(one("n,settlement_mm\n1,1\n")[0].0, "the column `axles` is missing");
        assert_eq!(one("axles,s\n1,1\n")[0].0, "the column of settlement is missing");
        assert_eq!(one("axles,settlement\n1,1\n")[0].0, "expected the settlement with its unit, found `settlement`");
        assert_eq!(
            one("axles,settlement_kN\n1,1\n")[0].0,
            "expected the settlement with its unit, found `settlement_kN`"
        );
        assert_eq!(one("n,s\n").len(), 2);
        assert_eq!(one("")[0].0, "the file holds no measurement");
        assert_eq!(one("axles,settlement_mm\n1,1\n2,2\n")[0].0, "2 measurements are too few, at least 3 are needed");
        assert_eq!(one("axles;settlement_mm\n1;0,5\n")[0].0, "expected a number, found `0,5`");
        assert_eq!(one("axles,settlement_mm\n0,1\n")[0].0, "the settlement before the first axle is not 0");
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_survived(text in "\\PC{0,60}", rows in proptest::collection::vec("[0-9.,;\"\t e-]{0,12}", 0..6)) {
            measured_curve(FileId(0), &text, 3);
            measured_curve(FileId(0), &format!("axles,settlement_mm\n{}", rows.join("\n")), 3);
        }
    }
}

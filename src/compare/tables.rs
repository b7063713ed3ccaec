//! The tables of a comparison, for spreadsheets: `numbers.csv`, `seats.csv`, `points.csv` and `scenes.csv`. Values are
//! SI, but in `points.csv`, which keeps the units of the studies.

use super::{Comparison, Difference, NumberRow};

impl Comparison {
    /// Every table that has rows, with its file's name. Fails if a text cannot be written.
    pub fn tables(&self) -> Result<Vec<(String, Vec<u8>)>, csv::Error> {
        let tables = [
            ("scenes.csv", self.scene_rows()),
            ("numbers.csv", self.number_rows()),
            ("seats.csv", self.seat_rows()),
            ("points.csv", self.point_rows()),
        ];
        let filled = tables.into_iter().filter(|(_, rows)| rows.len() > 1);
        filled.map(|(name, rows)| Ok((name.to_owned(), csv_of(&rows)?))).collect()
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.subjects.iter().map(|subject| subject.name.as_str())
    }

    fn scene_rows(&self) -> Vec<Vec<String>> {
        let header = std::iter::once("path").chain(self.names()).map(str::to_owned).collect();
        let row = |edit: &super::Edit| {
            let texts = edit.texts.iter().map(|text| text.clone().unwrap_or_default());
            std::iter::once(edit.path.clone()).chain(texts).collect()
        };
        std::iter::once(header).chain(self.edits.iter().flatten().map(row)).collect()
    }

    fn number_rows(&self) -> Vec<Vec<String>> {
        let mut header: Vec<String> = vec!["name".to_owned(), "unit".to_owned()];
        for (index, name) in self.names().enumerate() {
            header.extend([name.to_owned(), format!("{name} confidence")]);
            if index > 0 {
                header.extend(difference_titles(name));
            }
        }
        let row = |row: &NumberRow| {
            let mut cells = vec![row.name.clone(), row.unit.clone()];
            for (index, value) in row.values.iter().enumerate() {
                cells.push(cell(value.map(|value| value.value)));
                cells.push(cell(value.and_then(|value| value.confidence)));
                if index > 0 {
                    cells.extend(difference_cells(value.and_then(|value| value.from_first)));
                }
            }
            cells
        };
        std::iter::once(header).chain(self.numbers.iter().map(row)).collect()
    }

    fn seat_rows(&self) -> Vec<Vec<String>> {
        let header =
            ["result", "column", "axles", "sleeper", "x_m", "first", "value", "difference", "rms_difference", "seats"];
        let row = |row: &super::SeatDifference| {
            let name = self.subjects[row.run].name.clone();
            let numbers = [row.x_m, row.first, row.value, row.difference, row.rms].map(|value| value.to_string());
            let [x, first, value, difference, rms] = numbers;
            let (axles, seats) = (row.axles.to_string(), row.seats.to_string());
            vec![name, row.column.to_owned(), axles, row.sleeper.clone(), x, first, value, difference, rms, seats]
        };
        std::iter::once(header.map(str::to_owned).to_vec()).chain(self.seats.iter().map(row)).collect()
    }

    fn point_rows(&self) -> Vec<Vec<String>> {
        let mut header: Vec<String> = ["point", "measured", "unit"].map(str::to_owned).to_vec();
        for (index, name) in self.names().enumerate() {
            header.push(name.to_owned());
            if index > 0 {
                header.extend(difference_titles(name));
            }
        }
        let row = |row: &super::PointRow| {
            let mut cells = vec![row.point.clone(), row.measured.clone(), row.unit.clone()];
            for (index, (value, from_first)) in row.values.iter().zip(&row.from_first).enumerate() {
                cells.push(cell(*value));
                if index > 0 {
                    cells.extend(difference_cells(*from_first));
                }
            }
            cells
        };
        std::iter::once(header).chain(self.points.iter().map(row)).collect()
    }
}

fn difference_titles(name: &str) -> [String; 2] {
    [format!("{name} difference"), format!("{name} difference confidence")]
}

fn difference_cells(difference: Option<Difference>) -> [String; 2] {
    [cell(difference.map(|of| of.difference)), cell(difference.and_then(|of| of.confidence))]
}

fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

fn csv_of(rows: &[Vec<String>]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| writer.write_record(row))?;
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

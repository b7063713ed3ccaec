//! The top of a grid of soil: facets with four corners, search for a facet, and interpolation between the corners.

/// The corners of a facet, counterclockwise seen from above, beginning at the smallest x and y: numbers of nodes.
pub type Facet = [u32; 4];

/// The uppermost faces of the columns of a grid. Steps between columns of different height have no facet.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    lines: [Lines; 2],
    facets: Vec<Facet>,
    /// Facet of each column, row by row along x; `None` if the column is empty.
    columns: Vec<Option<u32>>,
}

/// A place on the surface: its facet and its position between the lines of the facet, each -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    pub facet: usize,
    pub local: [f64; 2],
}

impl Surface {
    pub(super) fn new(lines: [Vec<f64>; 2], tops: Vec<Option<Facet>>) -> Surface {
        let mut facets = Vec::new();
        let mut number = |facet: Facet| {
            facets.push(facet);
            facets.len() as u32 - 1
        };
        let columns = tops.into_iter().map(|top| top.map(&mut number)).collect();
        Surface { lines: lines.map(Lines::new), facets, columns }
    }

    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// Grid lines along x (0) or y (1) \[m\].
    pub fn lines(&self, axis: usize) -> &[f64] {
        &self.lines[axis].places
    }

    /// The facet of the column between lines i and i + 1 along x, j and j + 1 along y.
    pub fn facet_of_column(&self, i: usize, j: usize) -> Option<usize> {
        let across = self.lines[1].places.len() - 1;
        (j < across).then(|| *self.columns.get(i * across + j)?).flatten().map(|facet| facet as usize)
    }

    /// Columns of lines along x (0) or y (1) that a span \[m\] touches: the first column and the last plus one.
    pub fn columns(&self, axis: usize, from: f64, to: f64) -> (usize, usize) {
        let lines = &self.lines[axis];
        let (first, last) = (lines.places[0], lines.places[lines.places.len() - 1]);
        if !(to >= first && from <= last) { (0, 0) } else { (lines.column(from), lines.column(to) + 1) }
    }

    /// The facet at a place \[m\] of the undeformed soil. Displacements are small, so the facets stay there. A place on
    /// a line belongs to the larger side.
    pub fn locate(&self, x: f64, y: f64) -> Option<Spot> {
        let (i, first) = self.lines[0].locate(x)?;
        let (j, second) = self.lines[1].locate(y)?;
        Some(Spot { facet: self.facet_of_column(i, j)?, local: [first, second] })
    }
}

impl Spot {
    /// Weight of each corner at a point of a facet: bilinear shape functions. They sum to 1; `Σ N x` is the point,
    /// `Σ N v` its velocity, and forces `N F` at the corners have the force, the moment and the power of F there.
    pub fn weights(local: [f64; 2]) -> [f64; 4] {
        let [x, y] = local;
        let [left, right, front, back] = [0.5 * (1.0 - x), 0.5 * (1.0 + x), 0.5 * (1.0 - y), 0.5 * (1.0 + y)];
        [left * front, right * front, right * back, left * back]
    }
}

/// Increasing positions along an axis, and the column at each of as many equal parts of the axis as there are columns.
#[derive(Debug, Clone, PartialEq)]
struct Lines {
    places: Vec<f64>,
    starts: Vec<u32>,
    parts_per_metre: f64,
}

impl Lines {
    fn new(places: Vec<f64>) -> Lines {
        let (first, last) = (places[0], places[places.len() - 1]);
        let columns = places.len() - 1;
        let parts_per_metre = columns as f64 / (last - first);
        let start = |part: usize| {
            let from = first + part as f64 / parts_per_metre;
            places.partition_point(|&line| line <= from).clamp(1, columns) as u32 - 1
        };
        let starts = (0..columns).map(start).collect();
        Lines { places, starts, parts_per_metre }
    }

    /// The column of a position; the first or the last column if it lies outside.
    fn column(&self, place: f64) -> usize {
        let columns = self.starts.len();
        let part = ((place - self.places[0]) * self.parts_per_metre) as usize;
        let mut column = self.starts[part.min(columns - 1)] as usize;
        while column + 1 < columns && self.places[column + 1] <= place {
            column += 1;
        }
        // the start of a part may have been rounded up
        while column > 0 && self.places[column] > place {
            column -= 1;
        }
        column
    }

    fn locate(&self, place: f64) -> Option<(usize, f64)> {
        if !(place >= self.places[0] && place <= self.places[self.places.len() - 1]) {
            return None;
        }
        let column = self.column(place);
        let (from, to) = (self.places[column], self.places[column + 1]);
        Some((column, ((place - from) - (to - place)) / (to - from)))
    }
}

//! A bed in a file: a line of text for each pebble, read one at a time, and copies of it side by side.
//!
//! The first line gives the limits of the bed: `# periodic x 1.2 m, y 1.2 m; rigid floor z = 0`, either half of which
//! may be absent. The others hold `x y z r` of a sphere or `clump x y z r` of a pebble, in m; the pebbles of a clump
//! stand together.

use crate::solvers::granular::clump::{Pebble, Template};
use crate::solvers::granular::{Bed, ContactLaws, Domain, Placed, Real, Sphere};
use rayon::prelude::*;
use std::collections::HashSet;
use std::fmt;
use std::io::{self, BufRead, Read};

/// Clumps whose mass properties are integrated together.
const BATCH: usize = 4096;
/// Bytes of a line, at most.
const LINE: u64 = 4096;
/// Pebbles of a bed, at most: their contacts are counted in 32 bits.
pub const MOST: u64 = 100_000_000;
/// Places are within so many m of the origin, so that cells can be counted.
const FAR: f64 = 1e5;
/// Radii that a bed may have \[m\].
const RADII: std::ops::RangeInclusive<f64> = 1e-5..=100.0;

/// Bodies of a file.
#[derive(Debug, Clone)]
pub struct Pile {
    /// Along x and y \[m\]; none if the bed is open.
    periods: [Option<f64>; 2],
    /// Level of a rigid floor \[m\].
    floor: Option<f64>,
    pieces: Vec<Piece>,
    pebbles: u64,
    clumps: u64,
}

#[derive(Debug, Clone)]
enum Piece {
    Sphere { centre: [f64; 3], radius: f64 },
    Clump(Template),
}

/// Why a file cannot be read as a bed.
#[derive(Debug)]
pub enum PileError {
    Unreadable(io::Error),
    /// `line` counts from 1.
    Malformed {
        line: u64,
        message: String,
    },
}

impl fmt::Display for PileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PileError::Unreadable(cause) => write!(f, "{cause}"),
            PileError::Malformed { line, message } => write!(f, "line {line}: {message}"),
        }
    }
}

impl std::error::Error for PileError {}

impl From<io::Error> for PileError {
    fn from(cause: io::Error) -> Self {
        PileError::Unreadable(cause)
    }
}

fn malformed<T>(line: u64, message: impl Into<String>) -> Result<T, PileError> {
    Err(PileError::Malformed { line, message: message.into() })
}

impl Pile {
    /// Reads a bed line by line.
    pub fn read(source: impl BufRead) -> Result<Pile, PileError> {
        let mut lines = Lines { source, number: 0, text: Vec::new() };
        let (periods, floor) = match lines.next()? {
            Some((_, first)) if first.starts_with('#') => header(first)?,
            _ => return malformed(1, NO_HEADER),
        };
        let mut pile = Pile { periods, floor, pieces: Vec::new(), pebbles: 0, clumps: 0 };
        let (mut clumps, mut seen, mut form) = (Vec::<Open>::new(), HashSet::new(), None);
        while let Some((line, text)) = lines.next()? {
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let (clump, pebble) = pebble(line, text)?;
            if *form.get_or_insert(clump.is_some()) != clump.is_some() {
                return malformed(line, "expected as many numbers as on the first line");
            }
            let Some(name) = clump else {
                pile.pieces.push(Piece::Sphere { centre: pebble.centre.into(), radius: pebble.radius });
                pile.pebbles += 1;
                continue;
            };
            match clumps.last_mut() {
                Some(open) if open.name == name => open.pebbles.push(pebble),
                _ if !seen.insert(name) => {
                    return malformed(
                        line,
                        format!(
                            "pebbles of clump {name} are on separate lines; write all its pebbles one after the other"
                        ),
                    );
                }
                _ => {
                    if clumps.len() >= BATCH {
                        pile.take_in(&mut clumps)?;
                    }
                    clumps.push(Open { name, line, pebbles: vec![pebble] });
                }
            }
        }
        pile.take_in(&mut clumps)?;
        if pile.pieces.is_empty() {
            return malformed(lines.number.max(1), "the file ends without a sphere: expected lines of `x y z r`");
        }
        let (shortest, largest) = (periods.into_iter().flatten().fold(f64::INFINITY, f64::min), pile.largest());
        if shortest < 4.0 * largest {
            // a sphere would meet a neighbour twice, from both sides
            return malformed(1, format!("a period of {shortest} m is too short for spheres of {largest} m radius"));
        }
        Ok(pile)
    }

    /// Takes in clumps whose pebbles have been read.
    fn take_in(&mut self, clumps: &mut Vec<Open>) -> Result<(), PileError> {
        let made: Vec<Result<Piece, PileError>> = clumps.par_drain(..).map(|clump| clump.piece()).collect();
        for piece in made {
            let piece = piece?;
            match &piece {
                Piece::Sphere { .. } => self.pebbles += 1,
                Piece::Clump(template) => {
                    self.pebbles += template.pebbles.len() as u64;
                    self.clumps += 1;
                }
            }
            self.pieces.push(piece);
        }
        Ok(())
    }

    pub fn bodies(&self) -> usize {
        self.pieces.len()
    }

    pub fn pebbles(&self) -> u64 {
        self.pebbles
    }

    /// Bodies of more than one pebble.
    pub fn clumps(&self) -> u64 {
        self.clumps
    }

    /// Whether copies can stand side by side along x (0) or y (1).
    pub fn repeats(&self, axis: usize) -> bool {
        self.periods[axis].is_some()
    }

    /// Largest radius \[m\].
    pub fn largest(&self) -> f64 {
        let radius = |piece: &Piece| match piece {
            Piece::Sphere { radius, .. } => *radius,
            Piece::Clump(template) => template.pebbles.iter().map(|p| p.radius).fold(0.0, f64::max),
        };
        self.pieces.iter().map(radius).fold(0.0, f64::max)
    }

    /// A bed of so many copies along x and y, at rest, on its floor, without gravity and step. Bodies of one copy
    /// follow each other, in the order of the file.
    pub fn bed<R: Real>(&self, copies: [u32; 2], laws: ContactLaws, density: f64) -> Bed<R> {
        let mut domain = Domain::open();
        for (axis, (period, copies)) in self.periods.into_iter().zip(copies).enumerate() {
            if let Some(period) = period {
                domain = domain.periodic(axis, period * f64::from(copies));
            }
        }
        let mut bed = Bed::new(domain, laws);
        if let Some(level) = self.floor {
            bed.add_plane([0.0, 0.0, level], [0.0, 0.0, 1.0], 0);
        }
        for i in 0..copies[0] {
            for j in 0..copies[1] {
                let shift = [(i, 0), (j, 1)].map(|(copy, axis)| f64::from(copy) * self.periods[axis].unwrap_or(0.0));
                self.pieces.iter().for_each(|piece| piece.put(&mut bed, shift, density));
            }
        }
        bed
    }
}

impl Piece {
    fn put<R: Real>(&self, bed: &mut Bed<R>, shift: [f64; 2], density: f64) {
        let moved = |[x, y, z]: [f64; 3]| [x + shift[0], y + shift[1], z];
        match self {
            Piece::Sphere { centre, radius } => {
                bed.add_sphere(&Sphere { centre: moved(*centre), radius: *radius, density, surface: 0 });
            }
            Piece::Clump(template) => {
                let centre = moved(template.centroid.into());
                bed.add_clump(&Placed { template, centre, attitude: template.axes, density, surface: 0 });
            }
        }
    }
}

/// A clump whose lines are being read.
struct Open {
    name: u64,
    /// Where it begins.
    line: u64,
    pebbles: Vec<Pebble>,
}

impl Open {
    fn piece(self) -> Result<Piece, PileError> {
        let Open { name, line, pebbles } = self;
        if let [pebble] = pebbles[..] {
            return Ok(Piece::Sphere { centre: pebble.centre.into(), radius: pebble.radius });
        }
        if pebbles.len() > usize::from(u16::MAX) {
            let (found, most) = (pebbles.len(), u16::MAX);
            return malformed(
                line,
                format!("clump {name}, which begins here, has {found} pebbles; at most {most} fit"),
            );
        }
        match Template::from_pebbles(&pebbles) {
            Ok(template) => Ok(Piece::Clump(template)),
            Err(error) => malformed(line, format!("clump {name}, which begins here: {error}")),
        }
    }
}

/// Lines with their numbers, one in memory at a time.
struct Lines<S> {
    source: S,
    number: u64,
    text: Vec<u8>,
}

impl<S: BufRead> Lines<S> {
    fn next(&mut self) -> Result<Option<(u64, &str)>, PileError> {
        self.text.clear();
        if self.source.by_ref().take(LINE).read_until(b'\n', &mut self.text)? == 0 {
            return Ok(None);
        }
        self.number += 1;
        match std::str::from_utf8(&self.text) {
            _ if self.text.len() as u64 == LINE => malformed(self.number, "expected a line of a few numbers"),
            Ok(text) => Ok(Some((self.number, text.trim()))),
            Err(_) => malformed(self.number, "expected text, found bytes that are not UTF-8 text"),
        }
    }
}

const NO_HEADER: &str = "expected the limits of the bed: `# periodic x 1.2 m, y 1.2 m; rigid floor z = 0`";

/// Periods along x and y, and the level of the floor.
fn header(text: &str) -> Result<([Option<f64>; 2], Option<f64>), PileError> {
    let (mut periods, mut floor) = ([None; 2], None);
    for part in text.trim_start_matches('#').split(';').map(str::trim) {
        if let Some(rest) = part.strip_prefix("periodic") {
            for item in rest.split(',') {
                let words: Vec<&str> = item.split_whitespace().collect();
                let &[axis, length, "m"] = &words[..] else { return malformed(1, NO_HEADER) };
                let axis = match axis {
                    "x" => 0,
                    "y" => 1,
                    other => return malformed(1, format!("a bed is periodic along x and y, found `{other}`")),
                };
                match length.parse::<f64>() {
                    Ok(period) if period > 0.0 && period <= FAR => periods[axis] = Some(period),
                    _ => return malformed(1, format!("expected a period of up to {FAR} m, found `{length}`")),
                }
            }
        } else if let Some(rest) = part.strip_prefix("rigid floor") {
            let level = rest.trim().strip_prefix('z').and_then(|r| r.trim().strip_prefix('='));
            let level = level.map(|l| l.trim().trim_end_matches('m').trim());
            match level.and_then(|l| l.parse::<f64>().ok()).filter(|l| l.abs() <= FAR) {
                Some(level) => floor = Some(level),
                None => return malformed(1, format!("expected `rigid floor z = 0`, found `{part}`")),
            }
        }
    }
    if periods == [None; 2] && floor.is_none() { malformed(1, NO_HEADER) } else { Ok((periods, floor)) }
}

/// A line's clump, if it names one, and pebble.
fn pebble(line: u64, text: &str) -> Result<(Option<u64>, Pebble), PileError> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let (clump, numbers) = match words.len() {
        4 => (None, &words[..]),
        5 => match words[0].parse() {
            Ok(clump) => (Some(clump), &words[1..]),
            Err(_) => return malformed(line, format!("expected the number of a clump, found `{}`", words[0])),
        },
        n => return malformed(line, format!("expected `x y z r` or `clump x y z r`, found {n} words")),
    };
    let mut values = [0.0; 4];
    for (value, word) in values.iter_mut().zip(numbers) {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => *value = number,
            _ => return malformed(line, format!("expected a number, found `{word}`")),
        }
    }
    let [x, y, z, radius] = values;
    if let Some(far) = [x, y, z].into_iter().find(|v| v.abs() > FAR) {
        return malformed(line, format!("expected a place within {FAR} m of the origin, found {far} m"));
    }
    if !RADII.contains(&radius) {
        let (least, most) = (RADII.start(), RADII.end());
        return malformed(line, format!("expected a radius from {least} m to {most} m, found {radius} m"));
    }
    Ok((clump, Pebble { centre: [x, y, z].into(), radius }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::granular::{ContactLaw, Dashpot, DashpotMode, FrictionLimit, Linear};

    fn laws() -> ContactLaws {
        ContactLaws::single(ContactLaw::Linear(Linear {
            normal_stiffness: 1e6,
            shear_stiffness: 1e6,
            friction: 0.5,
            dashpot: Dashpot::Constant { normal: 0.0, shear: 0.0 },
            mode: DashpotMode::Full,
            limit: FrictionLimit::Total,
        }))
    }

    fn wrong(text: &str) -> String {
        Pile::read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn copies_stand_side_by_side_in_a_larger_period() {
        let text = "# 2 grains; periodic x 0.5 m, y 0.4 m; rigid floor z = 0.1; columns clump x y z r [m]\n\
                    7 0.1 0.1 0.2 0.03\n7 0.12 0.1 0.2 0.03\n\n9 0.3 0.1 0.2 0.02\n";
        let pile = Pile::read(text.as_bytes()).unwrap();
        assert_eq!((pile.bodies(), pile.pebbles(), pile.clumps(), pile.largest()), (2, 3, 1, 0.03));
        let bed: Bed<f64> = pile.bed([3, 2], laws(), 2700.0);
        assert_eq!((bed.len(), bed.pebbles().count(), bed.walls().len()), (12, 18, 1));
        assert_eq!([0, 1, 2].map(|axis| bed.domain().period(axis)), [Some(1.5), Some(0.8), None]);
        let last: Vec<[f64; 3]> = bed.pebbles().skip(15).map(|p| p.place).collect();
        for (found, wanted) in last.iter().zip([[1.1, 0.5, 0.2], [1.12, 0.5, 0.2], [1.3, 0.5, 0.2]]) {
            assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-12), "{found:?}");
        }
    }

    #[test]
    fn a_bad_line_is_named() {
        let head = "# periodic x 1 m, y 1 m; rigid floor z = 0\n";
        assert!(wrong("").starts_with("line 1: expected the limits of the bed"));
        assert!(wrong("0 0 0 1\n").starts_with("line 1: expected the limits of the bed"));
        assert!(wrong("# periodic x -1 m\n").contains("line 1: expected a period"));
        assert!(wrong("# periodic z 1 m\n").contains("line 1: a bed is periodic along x and y"));
        assert!(wrong("# rigid floor at 0\n").contains("line 1: expected `rigid floor z = 0`"));
        assert!(wrong(head).contains("ends without a sphere"));
        let after = |line: &str| wrong(&format!("{head}0.1 0.1 0.1 0.1\n\n{line}\n"));
        assert_eq!(after("1 2 3"), "line 4: expected `x y z r` or `clump x y z r`, found 3 words");
        assert_eq!(after("1 2 x 0.1"), "line 4: expected a number, found `x`");
        assert_eq!(after("1 2 NaN 0.1"), "line 4: expected a number, found `NaN`");
        assert_eq!(after("1 2 3 0"), "line 4: expected a radius from 0.00001 m to 100 m, found 0 m");
        assert_eq!(after("1 1e9 3 0.1"), "line 4: expected a place within 100000 m of the origin, found 1000000000 m");
        assert_eq!(after("1 1 2 3 0.1"), "line 4: expected as many numbers as on the first line");
        assert_eq!(after(&"1 ".repeat(5000)), "line 4: expected a line of a few numbers");
        let clumps = |lines: &str| wrong(&format!("{head}{lines}\n"));
        assert!(clumps("a 1 2 3 0.1").contains("line 2: expected the number of a clump"));
        assert!(
            clumps("1 0 0 1 0.1\n2 1 0 1 0.1\n1 0 0 1 0.1")
                .starts_with("line 4: pebbles of clump 1 are on separate lines")
        );
        assert!(clumps("5 0 0 1 0.1\n6 0 0 1 0.1\n6 0 0 9 0.1").starts_with("line 3: clump 6, which begins here: "));
        assert!(
            Pile::read(&b"# periodic x 1 m\n\xff\n"[..]).unwrap_err().to_string().starts_with("line 2: expected text")
        );
    }
}

//! Beds of grains as VTK files of polygonal data (`.vtp`), which ParaView opens: pebbles as points, contacts as lines.
//!
//! XML with binary arrays in base64, uncompressed, after the "VTK XML file formats" page of the VTK manual. Places are
//! in double precision, all else in single. In ParaView, show the points as `Point Gaussian` or as glyphs scaled by
//! `radius`, the lines as tubes by `force`.

use super::grains::{Grain, Link, norm};
use std::io::{self, Write};

/// Writes pebbles as points with `radius` (m), `body`, `velocity` (m/s), `speed`, `coordination`, `largest_force` (N)
/// and, where every one has it, `displacement` (m).
pub fn bodies_vtk(grains: &[Grain], out: impl Write) -> io::Result<()> {
    let mut file = File { out };
    file.begin(grains.len(), 0)?;
    file.points(grains.iter().map(|g| g.place))?;
    file.cells("Verts", grains.len(), 1)?;
    file.open("PointData Scalars=\"radius\" Vectors=\"velocity\"")?;
    file.scalars("radius", grains, |g| g.radius)?;
    file.integers("body", grains, |g| g.body)?;
    file.vectors("velocity", grains, |g| g.velocity)?;
    file.scalars("speed", grains, |g| norm(g.velocity))?;
    if !grains.is_empty() && grains.iter().all(|g| g.displacement.is_some()) {
        file.vectors("displacement", grains, |g| g.displacement.unwrap_or_default())?;
    }
    file.integers("coordination", grains, |g| g.coordination)?;
    file.scalars("largest_force", grains, |g| g.largest_force)?;
    file.close("PointData")?;
    file.end()
}

/// Writes contacts as lines with `force` (magnitude, N), `normal_force` (N), `force_on_first` (N), `overlap` (m) and
/// `wall`, which is 1 where a wall takes part.
pub fn contacts_vtk(links: &[Link], out: impl Write) -> io::Result<()> {
    let mut file = File { out };
    file.begin(2 * links.len(), links.len())?;
    file.points(links.iter().flat_map(|l| [l.from, l.to]))?;
    file.cells("Lines", links.len(), 2)?;
    file.open("CellData Scalars=\"force\"")?;
    file.scalars("force", links, Link::size)?;
    file.scalars("normal_force", links, Link::normal_force)?;
    file.vectors("force_on_first", links, |l| l.force)?;
    file.scalars("overlap", links, |l| l.overlap)?;
    file.integers("wall", links, |l| u32::from(l.bodies.1.is_none()))?;
    file.close("CellData")?;
    file.end()
}

/// A file that is being written.
pub(super) struct File<W: Write> {
    pub out: W,
}

impl<W: Write> File<W> {
    /// Opens the one piece that the file has: lines, or points alone.
    fn begin(&mut self, points: usize, lines: usize) -> io::Result<()> {
        self.begin_piece([points, if lines == 0 { points } else { 0 }, lines, 0])
    }

    /// Opens the one piece that the file has: so many points, and cells that are points, lines and polygons.
    pub fn begin_piece(&mut self, [points, verts, lines, polys]: [usize; 4]) -> io::Result<()> {
        writeln!(
            self.out,
            concat!(
                "<?xml version=\"1.0\"?>\n",
                "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
                "<PolyData>\n",
                "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">"
            ),
            points, verts, lines, polys
        )
    }

    pub fn end(&mut self) -> io::Result<()> {
        writeln!(self.out, "</Piece>\n</PolyData>\n</VTKFile>")
    }

    pub fn open(&mut self, tag: &str) -> io::Result<()> {
        writeln!(self.out, "<{tag}>")
    }

    pub fn close(&mut self, tag: &str) -> io::Result<()> {
        writeln!(self.out, "</{tag}>")
    }

    pub fn points(&mut self, places: impl Iterator<Item = [f64; 3]>) -> io::Result<()> {
        self.open("Points")?;
        self.array("Float64", "Points", 3, places.flatten().flat_map(f64::to_le_bytes).collect())?;
        self.close("Points")
    }

    /// `count` cells, each of the next `each` points.
    pub fn cells(&mut self, tag: &str, count: usize, each: usize) -> io::Result<()> {
        self.connected(tag, 0..count * each, count, each)
    }

    /// `count` cells, each of `each` of these points in turn.
    pub fn connected(
        &mut self,
        tag: &str,
        mut points: impl Iterator<Item = usize>,
        count: usize,
        each: usize,
    ) -> io::Result<()> {
        let bytes = |numbers: &mut dyn Iterator<Item = usize>| numbers.flat_map(|n| (n as u64).to_le_bytes()).collect();
        self.open(tag)?;
        self.array("Int64", "connectivity", 1, bytes(&mut points))?;
        self.array("Int64", "offsets", 1, bytes(&mut (1..=count).map(|n| n * each)))?;
        self.close(tag)
    }

    pub fn scalars<T>(&mut self, name: &str, rows: &[T], of: impl Fn(&T) -> f64) -> io::Result<()> {
        self.array("Float32", name, 1, rows.iter().flat_map(|row| (of(row) as f32).to_le_bytes()).collect())
    }

    pub fn vectors<T>(&mut self, name: &str, rows: &[T], of: impl Fn(&T) -> [f64; 3]) -> io::Result<()> {
        self.array("Float32", name, 3, rows.iter().flat_map(of).flat_map(|c| (c as f32).to_le_bytes()).collect())
    }

    pub fn signed<T>(&mut self, name: &str, rows: &[T], of: impl Fn(&T) -> i32) -> io::Result<()> {
        self.array("Int32", name, 1, rows.iter().flat_map(|row| of(row).to_le_bytes()).collect())
    }

    fn integers<T>(&mut self, name: &str, rows: &[T], of: impl Fn(&T) -> u32) -> io::Result<()> {
        self.array("UInt32", name, 1, rows.iter().flat_map(|row| of(row).to_le_bytes()).collect())
    }

    fn array(&mut self, kind: &str, name: &str, components: usize, bytes: Vec<u8>) -> io::Result<()> {
        write!(
            self.out,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">"
        )?;
        // the length and the bytes are one stream of base64
        let length = (bytes.len() as u64).to_le_bytes();
        base64(&[&length[..], &bytes].concat(), &mut self.out)?;
        writeln!(self.out, "</DataArray>")
    }
}

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Bytes as base64 with padding (RFC 4648, section 4).
fn base64(bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    for part in bytes.chunks(3 * 1024) {
        let mut text = Vec::with_capacity(4 * 1024);
        for three in part.chunks(3) {
            let word = (0..3).fold(0u32, |word, k| word << 8 | u32::from(three.get(k).copied().unwrap_or(0)));
            let letter = |k: usize| match k <= three.len() {
                true => ALPHABET[(word >> (18 - 6 * k) & 63) as usize],
                false => b'=',
            };
            text.extend([0, 1, 2, 3].map(letter));
        }
        out.write_all(&text)?;
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::results::{grains, links, places};
    use crate::solvers::granular::{
        Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Gravity, Linear, Placed, Sphere,
        clump,
    };

    fn law() -> ContactLaw {
        ContactLaw::Linear(Linear {
            normal_stiffness: 1e6,
            shear_stiffness: 1e6,
            friction: 0.5,
            dashpot: Dashpot::Constant { normal: 100.0, shear: 0.0 },
            mode: DashpotMode::Full,
            limit: FrictionLimit::Spring,
        })
    }

    /// A sphere that touches the floor and, round the period, a clump of two that lies on the floor too.
    fn bed() -> Bed<f64> {
        let mut bed = Bed::new(Domain::open().periodic(0, 1.0), ContactLaws::single(law()));
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        bed.add_sphere(&Sphere { centre: [0.98, 0.0, 0.0999], radius: 0.1, density: 2700.0, surface: 0 });
        let pebble = |x: f64| clump::Pebble { centre: [x, 0.0, 0.0].into(), radius: 0.1 };
        let template = clump::Template::from_pebbles(&[pebble(-0.05), pebble(0.05)]).unwrap();
        let attitude = template.axes;
        let centre = [0.2299, 0.0, 0.0999];
        bed.add_clump(&Placed { template: &template, centre, attitude, density: 2700.0, surface: 0 });
        bed.set_time_step(1e-5);
        bed.set_gravity(Gravity::EARTH);
        bed
    }

    /// Numbers of an array, by the type that the file says.
    pub fn numbers(document: &roxmltree::Document, name: &str) -> Vec<f64> {
        let array =
            document.descendants().find(|n| n.attribute("Name") == Some(name)).unwrap_or_else(|| panic!("{name}"));
        let code = |c: u8| ALPHABET.iter().position(|a| *a == c).unwrap_or(0) as u32;
        let text = array.text().unwrap().as_bytes();
        let padding = text.iter().filter(|c| **c == b'=').count();
        let mut bytes: Vec<u8> = text
            .chunks(4)
            .flat_map(|four| four.iter().fold(0u32, |word, c| word << 6 | code(*c)).to_be_bytes()[1..].to_vec())
            .collect();
        bytes.truncate(bytes.len() - padding);
        let length = u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
        assert_eq!(length, bytes.len() - 8, "{name}");
        let bytes = &bytes[8..];
        match array.attribute("type").unwrap() {
            "Float64" => bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect(),
            "Float32" => bytes.chunks(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap()))).collect(),
            "Int32" => bytes.chunks(4).map(|b| f64::from(i32::from_le_bytes(b.try_into().unwrap()))).collect(),
            "UInt32" => bytes.chunks(4).map(|b| f64::from(u32::from_le_bytes(b.try_into().unwrap()))).collect(),
            "Int64" => bytes.chunks(8).map(|b| i64::from_le_bytes(b.try_into().unwrap()) as f64).collect(),
            other => panic!("{other}"),
        }
    }

    #[test]
    fn base64_is_that_of_the_standard() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            let mut out = Vec::new();
            base64(plain.as_bytes(), &mut out).unwrap();
            assert_eq!(String::from_utf8(out).unwrap(), coded);
        }
    }

    #[test]
    fn pebbles_come_back_from_the_file() {
        let mut bed = bed();
        let reference = places(&bed);
        bed.run(3).unwrap();
        let snapshot = bed.snapshot().unwrap();
        let rows = grains(&bed, &snapshot, Some(&reference));
        let mut file = Vec::new();
        bodies_vtk(&rows, &mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let piece = document.descendants().find(|n| n.has_tag_name("Piece")).unwrap();
        assert_eq!((piece.attribute("NumberOfPoints"), piece.attribute("NumberOfVerts")), (Some("3"), Some("3")));
        let points = numbers(&document, "Points");
        for (found, wanted) in points.chunks(3).zip([[0.98, 0.0, 0.0999], [0.1799, 0.0, 0.0999], [0.2799, 0.0, 0.0999]])
        {
            assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-6), "{found:?}");
        }
        assert_eq!(numbers(&document, "body"), [0.0, 1.0, 1.0]);
        assert_eq!(numbers(&document, "coordination"), [1.0, 1.0, 1.0]);
        assert!(numbers(&document, "radius").iter().all(|r| (r - 0.1).abs() < 1e-8));
        let (moved, velocity) = (numbers(&document, "displacement"), numbers(&document, "velocity"));
        assert_eq!((moved.len(), velocity.len()), (9, 9));
        // pushed apart across the end of the period, and down by gravity and up by the floor
        assert!(moved[0] < 0.0 && moved[3] > 0.0 && velocity[0] < 0.0 && velocity[3] > 0.0, "{moved:?}, {velocity:?}");
        assert!(numbers(&document, "largest_force").iter().all(|f| (90.0..200.0).contains(f)), "{text}");
        assert_eq!(numbers(&document, "connectivity"), [0.0, 1.0, 2.0]);
        assert_eq!(numbers(&document, "offsets"), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn contacts_come_back_from_the_file() {
        let mut bed = bed();
        let snapshot = bed.snapshot().unwrap();
        let rows = links(&bed, &snapshot);
        let mut file = Vec::new();
        contacts_vtk(&rows, &mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let piece = document.descendants().find(|n| n.has_tag_name("Piece")).unwrap();
        assert_eq!((piece.attribute("NumberOfPoints"), piece.attribute("NumberOfLines")), (Some("8"), Some("4")));
        assert_eq!(numbers(&document, "wall"), [0.0, 1.0, 1.0, 1.0]);
        let (force, overlap) = (numbers(&document, "force"), numbers(&document, "overlap"));
        // 0.1 mm in springs of 1 MN/m, at rest
        assert!(
            force.iter().all(|f| (f - 100.0).abs() < 0.01) && overlap.iter().all(|o| (o - 1e-4).abs() < 1e-8),
            "{force:?}"
        );
        assert_eq!(force, numbers(&document, "normal_force"));
        let points = numbers(&document, "Points");
        // from centroid to centroid, the short way round
        assert!(((points[3] - points[0]).abs() - 0.2499).abs() < 1e-9, "{points:?}");
        assert_eq!(numbers(&document, "offsets"), [2.0, 4.0, 6.0, 8.0]);
        assert_eq!(numbers(&document, "connectivity").len(), 8);
    }

    #[test]
    fn an_empty_bed_is_a_file_too() {
        let mut file = Vec::new();
        bodies_vtk(&[], &mut file).unwrap();
        contacts_vtk(&[], &mut file).unwrap();
        assert_eq!(String::from_utf8(file).unwrap().matches("NumberOfPoints=\"0\"").count(), 2);
    }
}

//! The spheres of a file: a line `x y z r` \[m\] each, and in a comment before them the period of the cell.

use std::fmt;

/// Where spheres stand at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Particles {
    /// \[m\]
    pub centres: Vec<[f64; 3]>,
    /// \[m\]
    pub radii: Vec<f64>,
    /// Period in x and y \[m\], where the file says so: `# periodic x 0.6 m, y 0.6 m; ...`.
    pub period: Option<[f64; 2]>,
}

/// A line that is no sphere.
#[derive(Debug, Clone, PartialEq)]
pub struct Unreadable {
    pub line: usize,
    pub found: String,
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "line {}: expected `x y z r` in m with r above 0, found `{}`", self.line, self.found)
    }
}

impl std::error::Error for Unreadable {}

impl Particles {
    pub fn read(text: &str) -> Result<Particles, Unreadable> {
        let mut particles = Particles { centres: Vec::new(), radii: Vec::new(), period: None };
        for (number, line) in text.lines().enumerate().map(|(number, line)| (number, line.trim())) {
            if let Some(comment) = line.strip_prefix('#') {
                particles.period = particles.period.or(period(comment));
            } else if !line.is_empty() {
                let values: Option<Vec<f64>> =
                    line.split_whitespace().map(|word| word.parse().ok().filter(|v: &f64| v.is_finite())).collect();
                let [x, y, z, r] = match values.as_deref() {
                    Some(&[x, y, z, r]) if r > 0.0 => [x, y, z, r],
                    _ => return Err(Unreadable { line: number + 1, found: line.to_owned() }),
                };
                particles.centres.push([x, y, z]);
                particles.radii.push(r);
            }
        }
        Ok(particles)
    }

    /// The same spheres, each coordinate moved by up to `way` \[m\]. Seed 0 leaves the file as it is.
    pub fn shaken(&self, seed: u64, way: f64) -> Particles {
        let mut moved = self.clone();
        if seed != 0 {
            let mut random = Random(seed);
            moved.centres.iter_mut().flatten().for_each(|x| *x += way * (2.0 * random.next() - 1.0));
        }
        moved
    }

    /// Sum over the spheres, overlaps counted twice \[m3\].
    pub fn solid_volume(&self) -> f64 {
        self.radii.iter().map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum()
    }

    /// Upper end of the highest sphere \[m\].
    pub fn top(&self) -> f64 {
        self.centres.iter().zip(&self.radii).map(|(c, r)| c[2] + r).fold(0.0, f64::max)
    }
}

/// The numbers after `x` and `y` of a comment that says `periodic`.
fn period(comment: &str) -> Option<[f64; 2]> {
    let words: Vec<&str> = comment.split_once("periodic")?.1.split_whitespace().collect();
    let after = |name: &str| {
        let at = words.iter().position(|word| *word == name)?;
        words.get(at + 1)?.trim_end_matches(',').parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0)
    };
    Some([after("x")?, after("y")?])
}

/// SplitMix64 (Steele, Lea and Flood 2014): one number of state, the same sequence everywhere.
struct Random(u64);

impl Random {
    /// From 0 to below 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

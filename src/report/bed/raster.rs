//! The covered part of a picture, on a raster finer than its pixels.

/// Cells of the raster at most.
const CELLS: f64 = 2e7;

/// The cells that are covered.
pub struct Raster {
    /// Cells a pixel.
    fine: f64,
    width: usize,
    height: usize,
    covered: Vec<bool>,
}

impl Raster {
    pub fn new(width: f64, height: f64) -> Raster {
        let fine = (CELLS / (width * height).max(1.0)).sqrt().min(5.0);
        let [width, height] = [width, height].map(|side| (side * fine).ceil().max(1.0) as usize);
        Raster { fine, width, height, covered: vec![false; width * height] }
    }

    /// Covers a disc, px. True if a part of the disc was not covered, or the disc is too small to check.
    pub fn cover(&mut self, x: f64, y: f64, radius: f64) -> bool {
        let [x, y, radius] = [x, y, radius].map(|v| v * self.fine);
        let (mut open, mut cells) = (false, 0);
        for row in within(y, radius, self.height) {
            let height = row as f64 + 0.5 - y;
            let half = (radius * radius - height * height).max(0.0).sqrt();
            for column in within(x, half, self.width) {
                let cell = &mut self.covered[row * self.width + column];
                open |= !*cell;
                *cell = true;
                cells += 1;
            }
        }
        open || cells == 0
    }
}

/// Cells whose middle is within `half` of `middle`.
fn within(middle: f64, half: f64, count: usize) -> std::ops::Range<usize> {
    let edge = |v: f64| (v - 0.5).ceil().clamp(0.0, count as f64) as usize;
    edge(middle - half)..edge(middle + half)
}

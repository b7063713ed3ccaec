//! Colours for a quantity from small to large: from dark blue over green to light yellow, in steps that look equal.
//!
//! The path is drawn in Oklab (Ottosson 2020), in which equal distances look about equally large. Lightness rises along
//! the whole path, so the colours can also be read in grey. The steps are equal lengths of the path.

/// Lightness, chroma and hue (degrees) along the path; straight between them.
const PATH: [[f64; 3]; 5] =
    [[0.27, 0.10, 288.0], [0.44, 0.10, 255.0], [0.60, 0.09, 200.0], [0.76, 0.14, 150.0], [0.93, 0.16, 105.0]];
/// Pieces that the path's length is measured in.
const PIECES: usize = 512;

/// `count` colours from small to large values, as red, green and blue.
pub(super) fn colours(count: usize) -> Vec<[u8; 3]> {
    let points: Vec<[f64; 3]> = (0..=PIECES).map(|k| oklab(k as f64 / PIECES as f64)).collect();
    let mut length = vec![0.0];
    for pair in points.windows(2) {
        length.push(length[length.len() - 1] + distance(pair[0], pair[1]));
    }
    let whole = length[PIECES];
    (0..count)
        .map(|k| {
            let wanted = whole * k as f64 / (count.max(2) - 1) as f64;
            let right = length.partition_point(|l| *l < wanted).clamp(1, PIECES);
            let share = (wanted - length[right - 1]) / (length[right] - length[right - 1]);
            oklab((right as f64 - 1.0 + share) / PIECES as f64)
        })
        .map(rgb)
        .collect()
}

/// `#1b2430`.
pub(super) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A colour nearer to white (above 0) or black (below 0) by a share.
pub(super) fn shade(colour: [u8; 3], share: f64) -> [u8; 3] {
    let goal = if share > 0.0 { 255.0 } else { 0.0 };
    colour.map(|c| (f64::from(c) + (goal - f64::from(c)) * share.abs()).round() as u8)
}

/// Lightness, green to red, blue to yellow at a share of the path.
fn oklab(at: f64) -> [f64; 3] {
    let at = at.clamp(0.0, 1.0) * (PATH.len() - 1) as f64;
    let left = (at.floor() as usize).min(PATH.len() - 2);
    let share = at - left as f64;
    let [l, c, h] = [0, 1, 2].map(|k| PATH[left][k] + share * (PATH[left + 1][k] - PATH[left][k]));
    let h = h.to_radians();
    [l, c * h.cos(), c * h.sin()]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Oklab to sRGB, the matrices of Ottosson's page.
fn linear([l, a, b]: [f64; 3]) -> [f64; 3] {
    let [l, m, s] = [
        l + 0.3963377774 * a + 0.2158037573 * b,
        l - 0.1055613458 * a - 0.0638541728 * b,
        l - 0.0894841775 * a - 1.2914855480 * b,
    ]
    .map(|c: f64| c.powi(3));
    [
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s,
    ]
}

fn rgb(lab: [f64; 3]) -> [u8; 3] {
    linear(lab).map(|c| {
        let c = c.clamp(0.0, 1.0);
        let coded = if c <= 0.0031308 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        (255.0 * coded).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sRGB to Oklab, by the inverse matrices of the same page.
    fn seen(colour: [u8; 3]) -> [f64; 3] {
        let [r, g, b] = colour.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        let [l, m, s] = [
            0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b,
            0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b,
            0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b,
        ]
        .map(f64::cbrt);
        [
            0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s,
        ]
    }

    #[test]
    fn steps_look_equal_and_grow_lighter() {
        let seen: Vec<[f64; 3]> = colours(17).into_iter().map(seen).collect();
        let steps: Vec<f64> = seen.windows(2).map(|pair| distance(pair[0], pair[1])).collect();
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        // the rest is the rounding of colours to bytes, and corners of the path
        assert!(steps.iter().all(|s| (s / mean - 1.0).abs() < 0.1), "{steps:?}");
        assert!(seen.windows(2).all(|pair| pair[1][0] > pair[0][0] + 0.02), "{seen:?}");
    }

    #[test]
    fn the_path_stays_among_the_colours_of_a_screen() {
        for k in 0..=100 {
            let colour = linear(oklab(f64::from(k) / 100.0));
            assert!(colour.iter().all(|c| (-1e-3..=1.001).contains(c)), "{k}: {colour:?}");
        }
        assert_eq!(hex(shade([0, 100, 255], 0.5)), "#80b2ff");
        assert_eq!(shade([0, 100, 255], -0.5), [0, 50, 128]);
    }
}

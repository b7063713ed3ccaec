//! The settlement of a homogeneous half-space by uniform pressure on a rectangle, in closed form.

/// Mean of `1 / r` between two equal rectangles, times the area of one, m: sides a and b, centres `(x, y)` apart.
///
/// With `G = x^2 y/2 asinh(y/|x|) + x y^2/2 asinh(x/|y|) - r^3/6`, whose fourth mixed derivative `G_xxyy` is `1/r`, the
/// fourfold integral is the second difference of G in both directions. For a rectangle with itself it is
/// `2 a asinh(b/a) + 2 b asinh(a/b) - 2/3 ((a^2 + b^2)^(3/2) - a^3 - b^3) / (a b)`.
pub(super) fn mean_inverse_distance([a, b]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    let second = [(-1.0, 1.0), (0.0, -2.0), (1.0, 1.0)];
    let differences = second
        .iter()
        .flat_map(|(i, ci)| second.iter().map(move |(j, cj)| ci * cj * antiderivative(x + i * a, y + j * b)));
    differences.sum::<f64>() / (a * b)
}

fn antiderivative(x: f64, y: f64) -> f64 {
    let r = x.hypot(y);
    // x^2 asinh(y / x) goes to zero with x
    let part = |x: f64, y: f64| if x == 0.0 { 0.0 } else { 0.5 * x * x * y * (y / x.abs()).asinh() };
    part(x, y) + part(y, x) - r * r * r / 6.0
}

/// Mean settlement under one of two equal rectangles per newton on the other, m/N.
pub(super) fn mean_settlement(sides: [f64; 2], apart: [f64; 2], youngs_modulus: f64, poisson_ratio: f64) -> f64 {
    let [a, b] = sides;
    let compliance = (1.0 - poisson_ratio * poisson_ratio) / (std::f64::consts::PI * youngs_modulus);
    compliance * mean_inverse_distance(sides, apart) / (a * b)
}

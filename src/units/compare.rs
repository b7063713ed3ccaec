//! Two dimensions side by side, factor by factor in aligned columns.

use super::Dimension;

/// Two aligned lines that show the different factors of `expected` and `found`:
///
/// ```text
/// expected  mass    x time^-2   [a stiffness]
/// found     mass x length x time^-2   [a force]
/// ```
pub fn compare(expected: Dimension, found: Dimension) -> String {
    let columns: Vec<&str> = {
        let mut names: Vec<&str> = expected.factors().map(|(n, _)| n).collect();
        names.extend(found.factors().map(|(n, _)| n).filter(|n| !expected.factors().any(|(m, _)| m == *n)));
        names
    };
    let cell = |d: Dimension, name: &str| {
        d.factors().find(|(n, _)| *n == name).map(|(n, e)| match e {
            100 => n.to_string(),
            e => format!("{n}^{}", super::number(f64::from(e) / 100.0)),
        })
    };
    let width =
        |name: &&str| [expected, found].iter().filter_map(|d| cell(*d, name)).map(|c| c.len()).max().unwrap_or(0);
    let widths: Vec<usize> = columns.iter().map(width).collect();
    let line = |d: Dimension| {
        let mut cells = String::new();
        let mut any = false;
        for (name, width) in columns.iter().zip(&widths) {
            let text = cell(d, name);
            let times = if any && text.is_some() {
                " x "
            } else if cells.is_empty() {
                ""
            } else {
                "   "
            };
            any |= text.is_some();
            cells.push_str(&format!("{times}{:<width$}", text.unwrap_or_default()));
        }
        if d.is_none() {
            cells = "no dimension".into();
        }
        let name = d.name().map_or(String::new(), |n| format!("   [{n}]"));
        format!("{}{name}", cells.trim_end())
    };
    format!("expected  {}\nfound     {}", line(expected), line(found))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_stand_under_each_other() {
        let text = compare(Dimension::of_unit("MN/m"), Dimension::of_unit("kN"));
        assert_eq!(text, "expected  mass x time^-2   [a stiffness]\nfound     mass x time^-2 x length   [a force]");
    }
}

//! Specimens of grains and the laws that are fitted to them: settlement against axles.

use super::curves::{Axis, Chart, Mark, Series};
use super::number::{plain, shown_unit};
use super::svg::{Anchor, Frame, Svg};
use crate::solvers::settlement::Power;
use crate::trials::specimens::{Curve, by_law};

/// Colours of the specimens.
const CLASSES: [&str; 10] = ["s0", "s1", "s2", "s3", "k5", "k2", "k0", "k4", "k1", "k3"];
const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 460.0;
/// Height of the title above a chart.
const TITLE: f64 = 26.0;

/// A law with its specimens.
pub struct Fitted<'a> {
    pub title: String,
    pub law: &'a Power,
    pub specimens: &'a [Curve],
    /// The specimen whose loads change, to which the law was not fitted.
    pub check: &'a Curve,
}

/// The picture of some laws, one below the other: dots are measured, thin lines are the law.
pub fn specimens_svg(laws: &[Fitted<'_>]) -> String {
    let mut svg = Svg::default();
    for (number, fitted) in laws.iter().enumerate() {
        let top = number as f64 * (TITLE + HEIGHT);
        svg.text("strong", (6.0, top + 16.0), Anchor::Start, &fitted.title);
        let frame = Frame { x: 0.0, y: top + TITLE, width: WIDTH, height: HEIGHT };
        chart(fitted).draw(&mut svg, &format!("plane-specimens-{number}"), frame);
    }
    svg.finish(WIDTH, laws.len() as f64 * (TITLE + HEIGHT), "Specimens of grains and their laws")
}

fn chart(fitted: &Fitted<'_>) -> Chart {
    let mut settlement = Axis::new("Settlement", shown_unit("m"));
    (settlement.downwards, settlement.from_zero) = (true, true);
    let mut chart = Chart::new(Axis::new("Axles", ("", 1.0)), settlement);
    let named = fitted.specimens.iter().map(|curve| (loaded(curve), curve));
    let all = named.chain([("changing loads (check)".to_owned(), fitted.check)]);
    for (number, (name, curve)) in all.enumerate() {
        let class = CLASSES[number % CLASSES.len()];
        chart.series.push(Series::new("", class, Mark::Faint, over_axles(curve, &by_law(fitted.law, curve))));
        chart.series.push(Series::new(&name, class, Mark::Dots, over_axles(curve, &curve.settled)));
    }
    chart
}

/// `38 kN, void 0.2 mm`
fn loaded(curve: &Curve) -> String {
    let first = curve.peaks.first().map_or(&[][..], Vec::as_slice);
    let force = first.iter().map(|peak| peak.force).sum::<f64>() / first.len().max(1) as f64;
    let void = curve.trials.first().map_or(0.0, |trial| trial.void);
    let load = format!("{} kN", plain(force / 1e3, 2));
    if void > 0.0 { format!("{load}, void {} mm", plain(void * 1e3, 2)) } else { load }
}

/// The values after each train, from nothing.
fn over_axles(curve: &Curve, values: &[f64]) -> Vec<(f64, f64)> {
    let mut axles = 0.0;
    let after = curve.peaks.iter().zip(values).map(|(peaks, value)| {
        axles += peaks.len() as f64;
        (axles, *value)
    });
    std::iter::once((0.0, 0.0)).chain(after).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::settlement::Peak;
    use crate::trials::specimens::Trial;

    #[test]
    fn a_picture_has_every_specimen_and_its_law() {
        let law = Power { a: 1e-4, m: 1.0, b: 0.5, g: 0.0, reference_force: 40e3 };
        let curve = |void: f64| Curve {
            trials: vec![Trial { factor: 1.0, void }; 2],
            peaks: vec![vec![Peak { force: 38.4e3, deflection: 1e-3, void }; 4]; 2],
            settled: vec![1e-4, 2e-4],
            stiffness: None,
        };
        let specimens = [curve(0.0), curve(0.2e-3)];
        let fitted = Fitted { title: "law a".to_owned(), law: &law, specimens: &specimens, check: &curve(0.1e-3) };
        let svg = specimens_svg(&[fitted]);
        assert!(roxmltree::Document::parse(&svg).is_ok());
        for text in ["law a", "38 kN", "38 kN, void 0.2 mm", "changing loads (check)"] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(over_axles(&specimens[0], &specimens[0].settled), [(0.0, 0.0), (4.0, 1e-4), (8.0, 2e-4)]);
    }
}

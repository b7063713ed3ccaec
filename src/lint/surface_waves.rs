//! L1035: a train on grains is nearly as fast as surface waves in a layer below it.
//!
//! The deflection under a load grows as its speed approaches the speed of Rayleigh waves. Bergmann's approximation is
//! c_R = c_S (0.862 + 1.14 nu) / (1 + nu) with c_S = sqrt(G / rho). The model is as wide as its bed, and its sides
//! reflect waves.

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Layer, Material, Scenario};
use crate::units::number;

/// Above this share of the wave speed the waves cause a considerable part of the deflection.
const LARGEST_SHARE: f64 = 0.6;
/// Porosity and Poisson's ratio of a layer of grains as a continuum.
const POROSITY: f64 = 0.38;
const OF_GRAINS: f64 = 0.2;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    if !graph.has_grains_under_track() {
        return Vec::new();
    }
    let track = &scenario.track;
    let parts = (0..track.sections.len()).flat_map(|section| track.ground(section));
    let layers = parts.flat_map(|part| {
        let middle = 0.5 * (part.start + part.end);
        part.layers.into_iter().filter_map(move |layer| Some((surface_wave(&layer, middle)?, layer.name.clone())))
    });
    let Some((wave, layer)) = layers.min_by(|a, b| a.0.total_cmp(&b.0)) else { return Vec::new() };
    let speed = traffic.train.speed;
    if *speed < LARGEST_SHARE * wave {
        return Vec::new();
    }
    let diagnostic = Diagnostic::new(
        Code::L1035,
        format!(
            "the speed of {} km/h is {} % of the speed of surface waves in layer `{layer}`, {} km/h",
            number((*speed * 3.6).round()),
            number((100.0 * *speed / wave).round()),
            number((wave * 3.6).round())
        ),
    )
    .help(format!(
        "the sides of the model reflect these waves: write a speed of {} km/h or less, or make the layer stiffer",
        number((LARGEST_SHARE * wave * 3.6).floor())
    ));
    vec![match speed.origin.span() {
        Some(span) => diagnostic.label(span, "near the speed of surface waves"),
        None => diagnostic,
    }]
}

/// Speed of surface waves in a layer, m/s; `None` for grains without a modulus.
fn surface_wave(layer: &Layer, x: f64) -> Option<f64> {
    let modulus = layer.youngs_modulus()?.value_at(x);
    let (density, poisson) = match &layer.material {
        Material::Granular(granular) => (*granular.density * (1.0 - POROSITY), OF_GRAINS),
        Material::Soil(soil) => (*soil.density, *soil.poisson_ratio),
    };
    let shear_wave = (modulus / (2.0 * (1.0 + poisson) * density)).sqrt();
    Some(shear_wave * of_shear_wave(poisson))
}

/// The ratio of the speed of surface waves to the speed of shear waves.
fn of_shear_wave(poisson: f64) -> f64 {
    (0.862 + 1.14 * poisson) / (1.0 + poisson)
}

#[cfg(test)]
mod tests {
    use super::of_shear_wave;

    /// The roots of Rayleigh's equation for three ratios of Poisson.
    #[test]
    fn surface_waves_are_a_little_slower_than_shear_waves() {
        for (poisson, exact) in [(0.0, 0.8740), (0.25, 0.9194), (0.5, 0.9553)] {
            let found = of_shear_wave(poisson);
            assert!((found / exact - 1.0).abs() < 0.015, "{poisson}: {found}");
        }
    }
}

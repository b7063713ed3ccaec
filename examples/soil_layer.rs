//! A rectangle of pressure on two layers on rock, at rest, and the same mesh as an input file of CalculiX.
//!
//!     cargo run --example soil_layer -- DIRECTORY SIZE
//!
//! writes `layer.inp` (elements C3D8I), and for each formulation `mean.csv` and `mixed.csv`: place and displacement of
//! every node. `benches/soil_calculix.py` runs both programs and compares them.

use std::fmt::Write;
use std::path::Path;
use trackbed::solvers::continuum::{Formulation, Material, Mesh, Settings, Side, Soil, SoilError, Spot, Support};

const PRESSURE: f64 = 100e3;
/// A quarter of the layers, and of the rectangle \[m\].
const BOX: [f64; 3] = [2.4, 2.0, 1.2];
const LOADED: [f64; 2] = [0.3, 0.5];
const LOWER_THICKNESS: f64 = 0.8;
const LOWER: Material = Material { density: 2100.0, youngs_modulus: 472e6, poisson_ratio: 0.25, strength: None };
const UPPER: Material = Material { density: 2000.0, youngs_modulus: 150e6, poisson_ratio: 0.2, strength: None };

fn layers(size: f64, formulation: Formulation) -> Result<(Soil, Vec<(usize, f64)>), SoilError> {
    let lines = BOX.map(|length| (0..=(length / size).round() as usize).map(|i| i as f64 * size).collect::<Vec<_>>());
    let upper = (LOWER_THICKNESS / size).round() as usize;
    let materials = vec![LOWER, UPPER];
    let mesh = Mesh::grid([&lines[0], &lines[1], &lines[2]], materials, |_, _, k| Some(usize::from(k >= upper)))?;
    let mut soil = Soil::new(mesh, Settings { formulation, ..Settings::default() })?;
    for side in [Side::XMin, Side::XMax, Side::YMin, Side::YMax] {
        soil.support(side, Support::Roller)?;
    }
    soil.support(Side::Bottom, Support::Fixed)?;
    let mut loads = vec![0.0; soil.masses().len()];
    let [along, across] = LOADED.map(|side| (side / size).round() as usize);
    let surface = soil.mesh().surface().into_iter();
    for (surface, (i, j)) in surface.flat_map(|s| (0..along).flat_map(move |i| (0..across).map(move |j| (s, (i, j))))) {
        let facet = surface.facet_of_column(i, j).map(|facet| surface.facets()[facet]).into_iter().flatten();
        for (node, share) in facet.zip(Spot::weights([0.0; 2])) {
            loads[node as usize] -= PRESSURE * size * size * share;
        }
    }
    let loads: Vec<(usize, f64)> = loads.into_iter().enumerate().filter(|(_, load)| *load != 0.0).collect();
    loads.iter().for_each(|&(node, load)| soil.add_force(node, [0.0, 0.0, load]));
    soil.rest(&[])?;
    Ok((soil, loads))
}

fn calculix(soil: &Soil, loads: &[(usize, f64)]) -> String {
    let mut text = String::from("*NODE, NSET=ALL\n");
    for (node, [x, y, z]) in soil.mesh().nodes().iter().enumerate() {
        let _ = writeln!(text, "{}, {x:.12}, {y:.12}, {z:.12}", node + 1);
    }
    for material in 0..2 {
        let _ = writeln!(text, "*ELEMENT, TYPE=C3D8I, ELSET=LAYER{material}");
        for (element, made) in soil.mesh().elements().iter().enumerate().filter(|(_, e)| e.material == material) {
            let nodes: Vec<String> = made.nodes.iter().map(|node| (node + 1).to_string()).collect();
            let _ = writeln!(text, "{}, {}", element + 1, nodes.join(", "));
        }
        let Material { youngs_modulus, poisson_ratio, .. } = soil.mesh().materials()[material as usize];
        let _ = writeln!(text, "*MATERIAL, NAME=SOIL{material}\n*ELASTIC\n{youngs_modulus}, {poisson_ratio}");
        let _ = writeln!(text, "*SOLID SECTION, ELSET=LAYER{material}, MATERIAL=SOIL{material}");
    }
    text.push_str("*BOUNDARY\n");
    for side in [Side::XMin, Side::XMax, Side::YMin, Side::YMax, Side::Bottom] {
        let (first, last) = if side == Side::Bottom { (1, 3) } else { (side.axis() + 1, side.axis() + 1) };
        for node in soil.side_nodes(side) {
            let _ = writeln!(text, "{}, {first}, {last}", node + 1);
        }
    }
    text.push_str("*STEP\n*STATIC\n*CLOAD\n");
    for (node, load) in loads {
        let _ = writeln!(text, "{}, 3, {load:.12}", node + 1);
    }
    text + "*NODE PRINT, NSET=ALL\nU\n*END STEP\n"
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory, size] = &arguments[..] else {
        return Err("expected a directory and the size of the elements, m".into());
    };
    let (directory, size) = (Path::new(directory), size.parse()?);
    for (formulation, name) in [(Formulation::MeanStrain, "mean"), (Formulation::MixedDiscretisation, "mixed")] {
        let (soil, loads) = layers(size, formulation)?;
        let mut text = String::from("x,y,z,u,v,w\n");
        for ([x, y, z], [u, v, w]) in soil.mesh().nodes().iter().zip(soil.displacements()) {
            let _ = writeln!(text, "{x},{y},{z},{u:e},{v:e},{w:e}");
        }
        std::fs::write(directory.join(format!("{name}.csv")), text)?;
        std::fs::write(directory.join("layer.inp"), calculix(&soil, &loads))?;
    }
    Ok(())
}

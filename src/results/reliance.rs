//! Limits of the results of a run, in sentences: warnings, assumptions, and confidence.

use super::{Parting, RunTables, Scalar, SleeperRow, compared_passage};
use crate::diag::{Code, Diagnostic, Severity, Sources, and_list};
use crate::graph::{GrainStretch, Graph, Model};
use crate::scenario::{Evidence, Loading, Material, Scenario, SettlementLaw, Track};
use crate::units::number;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Information that a reader needs before using a number. Sentences have source text in backticks.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Reliance {
    /// Confidence in the answer, and its basis.
    pub confidence: Vec<String>,
    /// Warnings of the check.
    pub warnings: Vec<Warned>,
    /// Rules that the scene silences.
    pub silenced: Vec<Silenced>,
    /// Assumptions of the model that affect the answer.
    pub assumptions: Vec<String>,
    /// Values of the library that were not checked against their source.
    pub unchecked: Vec<Unchecked>,
}

/// A warning of the check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warned {
    pub code: String,
    pub message: String,
    /// File and line: `bridge.track:34`; empty if no line is to blame.
    pub place: String,
}

/// A physics rule that the scene silences, and its reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Silenced {
    pub rule: String,
    /// Title of the rule.
    pub title: String,
    pub reason: String,
}

/// An entry of the library that has not been checked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unchecked {
    pub name: String,
    pub source: String,
}

impl Reliance {
    /// The reliance of a run with these `diagnostics` of `sources`, tables and scalars.
    pub fn new(
        scenario: &Scenario,
        graph: &Graph,
        (diagnostics, sources): (&[Diagnostic], &Sources),
        tables: &RunTables,
        scalars: &BTreeMap<String, Scalar>,
    ) -> Reliance {
        let warnings: Vec<Warned> =
            diagnostics.iter().filter(|d| d.severity == Severity::Warning).map(|d| warned(d, sources)).collect();
        Reliance {
            confidence: confidence(scenario, graph, &warnings, (tables, scalars)),
            silenced: silenced(scenario),
            assumptions: assumptions(scenario, graph, tables),
            unchecked: unchecked(scenario),
            warnings,
        }
    }
}

fn warned(diagnostic: &Diagnostic, sources: &Sources) -> Warned {
    let place = diagnostic.labels.first().map_or(String::new(), |label| {
        let (file, line) = (sources.get(label.span.file), sources.position(label.span.file, label.span.start).line);
        // the name alone: equal scenes give equal files wherever they lie
        format!("{}:{line}", file.name.rsplit(['/', '\\']).next().unwrap_or(&file.name))
    });
    Warned { code: diagnostic.code.to_string(), message: diagnostic.message.clone(), place }
}

fn silenced(scenario: &Scenario) -> Vec<Silenced> {
    let of_rule = |(rule, reason): &(String, String)| {
        let title = Code::of_rule(rule).map_or("", Code::title).to_owned();
        Silenced { rule: rule.clone(), title, reason: reason.clone() }
    };
    scenario.allow.iter().map(of_rule).collect()
}

fn unchecked(scenario: &Scenario) -> Vec<Unchecked> {
    let mut found: Vec<Unchecked> = Vec::new();
    for entry in scenario.library.iter().filter(|entry| entry.evidence == Evidence::Unchecked) {
        if found.iter().all(|known| known.name != entry.name) {
            found.push(Unchecked { name: entry.name.clone(), source: entry.source.clone() });
        }
    }
    found
}

/// Known errors: of the laws, of the exchanges, and of packings.
fn confidence(
    scenario: &Scenario,
    graph: &Graph,
    warnings: &[Warned],
    (tables, scalars): (&RunTables, &BTreeMap<String, Scalar>),
) -> Vec<String> {
    let mut told = Vec::new();
    if graph.has_grains_under_track() {
        let seed = scenario.solve.seed;
        let repeats = scenario.solve.grains.repeats;
        told.push(match repeats.are_several() {
            false => format!(
                "one packing of the grains under the track was run, seed {seed}: `repeats = 3 .. 12` runs as many \
                packings as its tolerance needs, and shows their scatter"
            ),
            true => format!("figures and tables show one packing, seed {seed}, of {repeats} packings asked for"),
        });
        told.extend(risen(tables));
    }
    if graph.nodes.iter().any(|node| matches!(node.model, Model::Cells(_))) {
        let error = scalars.get("update_error").filter(|error| error.value > 0.0);
        told.extend(error.map(|error| {
            format!(
                "the cells do not compute every train: the standard error of the settlement is {} at the worst sleeper{}",
                millimetres(error.value),
                worst_block(tables, error.value)
            )
        }));
    }
    if graph.laws().next().is_some() {
        told.push(spread_of_laws(scenario, warnings, scalars));
        let error = scalars.get("update_error").filter(|error| error.value > 0.0);
        told.extend(error.map(|error| {
            let error = millimetres(error.value);
            format!(
                "forces and settlement are exchanged only between blocks: this changes the settlement by about \
                {error}, as measured in the run"
            )
        }));
    }
    told.extend(tables.compared.as_ref().map(compared_passage));
    told.extend(Parting::of_rows(scenario, &tables.check).map(|parting| parting.sentence()));
    if let Some(repeats) = scalars.get("repeats") {
        told.push(match repeats.value as u64 {
            1 => "one packing: the scatter between packings is not known; `repeats = 3 .. 12` shows it".to_owned(),
            n => format!("means of {n} packings; the bands are 95 % confidence intervals of the mean"),
        });
    }
    told
}

/// The block that brings most of an error of the settlement, m, if one does.
fn worst_block(tables: &RunTables, error: f64) -> String {
    let worst = tables.blocks.iter().max_by(|a, b| a.error_m.total_cmp(&b.error_m)).filter(|b| b.error_m > 0.5 * error);
    worst.filter(|_| tables.blocks.len() > 2).map_or(String::new(), |block| {
        let direction = match block.error_m > DIRECTION * block.max_settlement_m {
            true => "; later results show the direction only",
            false => "",
        };
        let error = millimetres(block.error_m);
        format!(", {error} of it by the {} axles after {} axles{direction}", block.block_axles, block.axles)
    })
}

/// Rise of sleepers over grains under trains, if any.
fn risen(tables: &RunTables) -> Option<String> {
    let start = |row: &SleeperRow| tables.sleepers.iter().find(|first| first.sleeper == row.sleeper);
    let last = tables.sleepers.last()?.axles;
    let at_last = tables.sleepers.iter().filter(|row| row.axles == last);
    let risen = at_last.filter_map(|row| Some(start(row)?.settlement_m - row.settlement_m)).filter(|up| *up > RISEN);
    let (count, most) = risen.fold((0, 0.0_f64), |(count, most), up| (count + 1, most.max(up)));
    (count > 0).then(|| {
        format!(
            "{count} {} risen, by {} at most: densely packed grains hold more stress than their weight needs, and \
             release this stress under trains. Real ballast settles; a bed packed with more `packing.friction` is \
             looser",
            if count == 1 { "sleeper has" } else { "sleepers have" },
            millimetres(most)
        )
    })
}

/// Smallest rise of a sleeper that is reported, m.
const RISEN: f64 = 1e-6;
/// Error of a block / largest settlement beyond which later results show the direction only.
const DIRECTION: f64 = 0.25;

/// Spread between the laws of the scene, and the laws that are used outside their calibration.
fn spread_of_laws(scenario: &Scenario, warnings: &[Warned], scalars: &BTreeMap<String, Scalar>) -> String {
    let driving = scenario.driving_laws();
    let laws: Vec<&SettlementLaw> = driving.iter().copied().chain(&scenario.solve.other_laws).collect();
    let beyond = |law: &&&SettlementLaw| {
        let named = format!("law `{}`", law.name);
        warnings.iter().any(|warned| warned.code == Code::L1004.as_str() && warned.message.starts_with(&named))
    };
    let outside: Vec<String> = laws.iter().filter(beyond).map(|law| format!("`{}`", law.name)).collect();
    let outside = match outside.len() {
        0 => String::new(),
        1 => format!("; {} is outside its calibration", outside[0]),
        _ => format!("; {} are outside their calibration", and_list(&outside)),
    };
    let mut largest: Vec<(f64, &str)> = laws
        .iter()
        .filter_map(|law| Some((scalars.get(&format!("laws.{}.max_settlement", law.name))?.value, law.name.as_str())))
        .collect();
    largest.sort_by(|a, b| a.0.total_cmp(&b.0));
    match (&largest[..], scalars.get("law_spread")) {
        ([least, .., most], Some(spread)) => format!(
            "ratio of the largest to the smallest settlement of the {} laws: {}, from {} by `{}` to {} by \
            `{}`{outside}",
            largest.len(),
            number(rounded(spread.value)),
            millimetres(least.0),
            least.1,
            millimetres(most.0),
            most.1
        ),
        _ if driving.len() > 1 => format!(
            "settlement is computed by {} laws, each under its own sleepers: {}{outside}",
            driving.len(),
            and_list(&driving.iter().map(|law| format!("`{}`", law.name)).collect::<Vec<_>>())
        ),
        _ => format!(
            "settlement is computed by one law, `{}`, and published laws differ by a factor of ten and more{outside}: \
             use it to compare designs, and name several laws to see the spread",
            laws[0].name
        ),
    }
}

fn assumptions(scenario: &Scenario, graph: &Graph, tables: &RunTables) -> Vec<String> {
    let mut told = Vec::new();
    let traffic = matches!(scenario.loading, Some(Loading::Traffic(_)));
    if graph.laws().next().is_some() {
        let laws = scenario.driving_laws();
        let named: Vec<String> = laws.iter().map(|law| format!("`{}`", law.name)).collect();
        let by = match laws.iter().filter(|law| law.law.knows_forces_alone()).count() {
            0 => "deflection",
            n if n == laws.len() => "force",
            _ => "force or deflection",
        };
        let which = match named.as_slice() {
            [only] => format!("law {only}"),
            several => format!("one of the laws {}", and_list(several)),
        };
        told.push(format!(
            "each sleeper settles by {which}, from the {by} on its own ballast; the subgrade does not settle"
        ));
    }
    told.extend(supports(graph));
    if traffic && scenario.track.irregularity.is_none() {
        told.push(
            "the rail is level as built: wheel forces vary only because of stiffness, settlement and voids".to_owned(),
        );
    }
    if traffic {
        told.push("both rails are equal: one rail with half of each vehicle is computed".to_owned());
        told.extend(at_the_ends(&scenario.track, tables));
    }
    told.extend(shared(graph, tables));
    told.extend(coarse_grains(&scenario.track));
    told
}

/// The stiffness of the supports, and that it stays.
fn supports(graph: &Graph) -> Option<String> {
    let cells =
        graph.nodes.iter().find_map(|node| if let Model::Cells(cells) = &node.model { Some(cells) } else { None });
    if let Some(node) = cells {
        let bays = node.cells.first().map_or(0, |cell| cell.copies);
        return Some(format!(
            "{} periodic cells of grains of {} carry the sleepers at first, each under the forces of its own seat; a \
            sleeper gets its own cell when its forces differ from the others; grains do not move from one cell to the \
            next, and the soil below is a spring",
            node.cells.len(),
            if bays == 1 { "1 bay".to_owned() } else { format!("{bays} bays") },
        ));
    }
    let grains =
        graph.nodes.iter().find_map(|node| if let Model::Grains(grains) = &node.model { Some(grains) } else { None });
    if let Some(grains) = grains {
        let end = |stretch: &GrainStretch| {
            stretch.start + grains.beds[stretch.bed].numbers().plan[0] * f64::from(stretch.copies)
        };
        let metre = |x: f64| number((x * 1e3).round() / 1e3);
        let spans =
            grains.stretches.iter().map(|stretch| format!("{} to {} m", metre(stretch.start), metre(end(stretch))));
        let spans: Vec<String> = spans.collect();
        return Some(format!(
            "grains carry the sleepers from {}; beyond, springs have the stiffness and settlement of the nearest third \
            of these sleepers",
            spans.join(" and ")
        ));
    }
    let of_springs = |find: fn(f64, f64) -> f64, from: f64| {
        graph.supports.iter().filter_map(|node| node.support).map(|support| support.stiffness).fold(from, find)
    };
    let (least, most) = (of_springs(f64::min, f64::INFINITY), of_springs(f64::max, 0.0));
    if most == 0.0 {
        return None;
    }
    let (least, most) = (number(rounded(least / 1e6)), number(rounded(most / 1e6)));
    let range = if least == most { most } else { format!("{least} to {most}") };
    let how = graph.decisions.iter().find(|decision| decision.pass == "supports");
    let how = how.map_or(String::new(), |decision| format!(" ({})", decision.what));
    Some(format!("the sleepers stand on springs of {range} MN/m per seat with constant stiffness{how}"))
}

/// Number of computed passages, and of the trains that they represent.
fn shared(graph: &Graph, tables: &RunTables) -> Option<String> {
    let trains = graph.blocks()?.sequence.trains();
    let passages: u64 = tables.blocks.iter().map(|block| block.passages).sum();
    (1..trains).contains(&passages).then(|| {
        format!(
            "{passages} passages represent {trains} trains: all trains of one type in a block run over the same \
            settled track"
        )
    })
}

/// Seats that no train passes whole.
fn at_the_ends(track: &Track, tables: &RunTables) -> Option<String> {
    let last = tables.sleepers.iter().map(|row| row.axles).max()?;
    let partly: Vec<f64> =
        tables.sleepers.iter().filter(|row| row.axles == last && row.trains_passing == 0).map(|row| row.x_m).collect();
    let near = track.transitions.iter().find(|t| partly.iter().any(|x| (x - t.x).abs() < 5.0));
    let near = near.map_or(String::new(), |transition| {
        let name = if transition.name.is_empty() { String::new() } else { format!(" `{}`", transition.name) };
        format!("; transition{name} lies among these seats, so its results are not valid")
    });
    (!partly.is_empty()).then(|| {
        format!(
            "{} of {} seats near the ends are passed by only a part of each train: they take the mean of their \
            neighbours and are left out of extremes{near}",
            partly.len(),
            track.seats.len()
        )
    })
}

/// Layers whose grains are modelled larger than they are.
fn coarse_grains(track: &Track) -> Vec<String> {
    let mut told: Vec<String> = Vec::new();
    for layer in track.sections.iter().flat_map(|section| &section.layers) {
        let Material::Granular(granular) = &layer.material else { continue };
        if *granular.scale > 1.0 {
            let sentence =
                format!("grains of layer `{}` are modelled {} times larger than they are", layer.name, *granular.scale);
            if !told.contains(&sentence) {
                told.push(sentence);
            }
        }
    }
    told
}

fn millimetres(length: f64) -> String {
    format!("{} mm", number(rounded(length * 1e3)))
}

/// To two digits.
fn rounded(value: f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let size = 10f64.powi(1 - value.abs().log10().floor() as i32);
    (value * size).round() / size
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{BlockRow, example};

    fn row(axles: u64, sleeper: &str, settlement_m: f64) -> SleeperRow {
        SleeperRow {
            axles,
            sleeper: sleeper.into(),
            x_m: 0.0,
            settlement_m,
            void_m: 0.0,
            gravity_contact_force_N: 0.0,
            max_contact_force_N: 0.0,
            max_rail_seat_load_N: 0.0,
            max_sleeper_displacement_m: 0.0,
            support_stiffness_N_per_m: 0.0,
            contact_loss_s: 0.0,
            trains_passing: 1,
        }
    }

    #[test]
    fn a_block_that_brings_most_of_the_error_is_told() {
        let block = |axles: u64, error_m: f64| BlockRow {
            axles,
            block_axles: 20,
            error_m,
            max_settlement_m: 6e-3,
            ..example::transition().blocks[0].clone()
        };
        let tables = |errors: [f64; 3]| RunTables {
            blocks: (0..3).map(|at| block(20 * at as u64, errors[at])).collect(),
            ..RunTables::default()
        };
        assert_eq!(worst_block(&tables([0.1e-3, 0.1e-3, 0.1e-3]), 0.3e-3), "");
        let told = worst_block(&tables([0.1e-3, 0.1e-3, 0.4e-3]), 0.6e-3);
        assert_eq!(told, ", 0.4 mm of it by the 20 axles after 40 axles");
        let told = worst_block(&tables([0.1e-3, 0.1e-3, 4e-3]), 4.2e-3);
        assert_eq!(told, ", 4 mm of it by the 20 axles after 40 axles; later results show the direction only");
    }

    #[test]
    fn sleepers_that_have_risen_are_told() {
        let tables = |after: [f64; 2]| RunTables {
            sleepers: vec![row(0, "-2", 1e-3), row(0, "-1", 0.0), row(40, "-2", after[0]), row(40, "-1", after[1])],
            ..RunTables::default()
        };
        assert_eq!(risen(&tables([2e-3, 1e-3])), None);
        let told = risen(&tables([0.976e-3, 1e-3])).unwrap();
        assert!(told.starts_with("1 sleeper has risen, by 0.024 mm at most"), "{told}");
        assert_eq!(risen(&RunTables::default()), None);
    }
}

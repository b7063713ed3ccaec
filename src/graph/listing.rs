//! The graph for readers: text, JSON and DOT, generated from the nodes with their ports and from the edges.

use super::{
    ActuatorsNode, BedNode, BedPlan, Blocks, CellsNode, Cost, Decision, Edge, ExpectedError, GrainsNode, Graph,
    LawNode, Model, Node, Quantity, Schedule, SoilNode, StiffnessFrom, TestWork, Tests, TrackNode, Update, Work,
};
use crate::solvers::granular::Glue;
use crate::solvers::granular::rig::{Crib, Glued, Load};
use crate::solvers::track::Integrator;
use crate::units::{duration, number, percent};
use serde::Serialize;

/// A graph in names and sentences.
#[derive(Debug, Clone, Serialize)]
pub struct Listing {
    pub nodes: Vec<ListedNode>,
    pub edges: Vec<ListedEdge>,
    pub schedule: Vec<String>,
    pub passes: Vec<Decision>,
    pub cost: Cost,
    pub error: ExpectedError,
}

#[derive(Debug, Clone, Serialize)]
pub struct ListedNode {
    pub name: String,
    pub model: String,
    pub details: Vec<String>,
    pub gives: Vec<Quantity>,
    pub takes: Vec<Quantity>,
}

/// A quantity from node to node, as declared by the node that gives it.
#[derive(Debug, Clone, Serialize)]
pub struct ListedEdge {
    pub from: String,
    pub to: String,
    #[serde(flatten)]
    pub quantity: Quantity,
}

impl Graph {
    /// The graph in words.
    pub fn listing(&self) -> Listing {
        Listing {
            nodes: self.nodes.iter().map(listed).collect(),
            edges: self.edges.iter().filter_map(|edge| self.listed_edge(edge)).collect(),
            schedule: self.schedule_lines(),
            passes: self.decisions.clone(),
            cost: self.cost,
            error: self.error.clone(),
        }
    }

    fn listed_edge(&self, edge: &Edge) -> Option<ListedEdge> {
        let gives = self.node(&edge.from)?.ports().gives;
        let quantity = gives.into_iter().find(|quantity| quantity.name == edge.quantity)?;
        Some(ListedEdge { from: edge.from.clone(), to: edge.to.clone(), quantity })
    }

    fn schedule_lines(&self) -> Vec<String> {
        match &self.schedule {
            Schedule::Static { .. } => vec!["one static equilibrium under the test loads".to_string()],
            Schedule::Blocks(blocks) => block_lines(blocks, &self.cost),
            Schedule::Actuators(tests) => self.bed_under_actuators().map_or(Vec::new(), |(_, a)| test_lines(tests, a)),
            Schedule::Custom { kind, .. } => vec![format!("a schedule `{kind}` of another program")],
        }
    }
}

fn listed(node: &Node) -> ListedNode {
    let ports = node.ports();
    let (model, details) = match &node.model {
        Model::Riding(track) => (
            "2D finite element track with multibody vehicles, in the same time steps as the grains".into(),
            of_track(track),
        ),
        Model::Track(track) => (
            "2D finite element track with multibody vehicles, solved together by Newton's method".into(),
            of_track(track),
        ),
        Model::Springs(_) => ("supports as springs, without settlement".into(), Vec::new()),
        Model::Law(law) => (format!("tier law: {} under each sleeper", law.law.name), of_law(law)),
        Model::Bed(bed) => (format!("{} on a packed bed of grains", standing(bed)), of_bed(bed)),
        Model::Actuators(actuators) => ("loads of a test rig".into(), of_actuators(actuators)),
        Model::Grains(grains) => ("grains under the sleepers".into(), of_grains(grains)),
        Model::Cells(cells) => ("a periodic cell of grains for each distinct sleeper".into(), of_cells(cells)),
        Model::Check(cells) => {
            ("cells of grains that check the settlement of their sleepers".into(), of_checking_cells(cells))
        }
        Model::Soil(soil) => ("soil below the grains".into(), of_soil(soil)),
        Model::Custom(custom) => (format!("`{}` of another program", custom.kind), custom.details.clone()),
    };
    ListedNode { name: node.name.clone(), model, details, gives: ports.gives, takes: ports.takes }
}

fn of_track(track: &TrackNode) -> Vec<String> {
    let [start, end] = track.ends();
    let beam = if track.rail.iter().any(|rail| rail.shear.is_some()) { "Timoshenko" } else { "Euler-Bernoulli" };
    let mut details = vec![
        format!("rail: {beam}, {} elements per bay, {} m .. {} m", track.elements_per_bay, number(start), number(end)),
        format!("seats: {}", track.seats.len()),
    ];
    details.extend(track.sections.iter().enumerate().map(|(index, section)| {
        let seats = track.seats.iter().filter(|seat| seat.section == index).count();
        let foot = if section.slab_foundation.is_some() { "on a slab" } else { "on sleepers" };
        format!("section {}: {} m, {seats} seats {foot}", section.name, number(section.end - section.start))
    }));
    details
}

fn of_law(node: &LawNode) -> Vec<String> {
    let own = node.own.iter().map(|own| {
        let sleepers = if own.seats.len() == 1 { "sleeper" } else { "sleepers" };
        format!("{} under {} {sleepers}: {}", own.law.name, own.seats.len(), own.law.details)
    });
    let beside = node.followers.iter().map(|law| format!("also evaluated: {}, {}", law.name, law.details));
    std::iter::once(node.law.details.clone()).chain(own).chain(beside).collect()
}

fn standing(bed: &BedNode) -> String {
    match (bed.confinement, bed.plate, bed.bodies.len()) {
        (Some(_), ..) => "a plate".to_owned(),
        (None, Some(_), _) => "a plate".to_owned(),
        (None, None, 1) => "1 sleeper".to_owned(),
        (None, None, count) => format!("{count} sleepers"),
    }
}

fn of_bed(node: &BedNode) -> Vec<String> {
    node.bed.notes.clone()
}

fn of_actuators(actuators: &ActuatorsNode) -> Vec<String> {
    let mut details: Vec<String> = Vec::new();
    for load in &actuators.loads {
        let line = match load {
            Load::None => "no force".to_owned(),
            Load::Constant(force) => format!("constant {} kN", number(force / 1e3)),
            Load::Cyclic { range: [low, high], .. } => {
                format!("{} .. {} kN, {} Hz", number(low / 1e3), number(high / 1e3), number(1.0 / actuators.period))
            }
            Load::History(points) => format!("a force of {} points over {} s", points.len(), number(actuators.period)),
            Load::Strain(share) => {
                format!("drives the plate down by {} % in {} s", number(100.0 * share), number(actuators.period))
            }
        };
        if !details.contains(&line) {
            details.push(line);
        }
    }
    details
}

fn of_grains(grains: &GrainsNode) -> Vec<String> {
    let mut lines: Vec<String> = grains
        .window
        .iter()
        .map(|[a, b]| format!("grains requested from {} m to {} m", number(*a), number(*b)))
        .collect();
    lines.extend(grains.beds.iter().map(|bed| format!("bed of `{}`", bed.section)));
    for stretch in &grains.stretches {
        let bed = &grains.beds[stretch.bed];
        let [length, width] = bed.numbers().plan;
        let end = stretch.start + length * f64::from(stretch.copies);
        let buffers = stretch.sleepers.iter().filter(|sleeper| sleeper.buffer).count();
        let buffers = match buffers {
            0 => String::new(),
            count => format!(" ({count} of them on a buffer at the end, whose results are not used)"),
        };
        lines.push(format!(
            "grains from {} m to {} m: {} cells of `{}` of {} m x {} m, {} sleepers{buffers}",
            number(stretch.start),
            number(rounded_to_mm(end)),
            stretch.copies,
            bed.section,
            number(length),
            number(width),
            stretch.sleepers.len()
        ));
        lines.extend(stretch.crib.map(of_crib));
        lines.extend(stretch.glued.iter().map(|glued| of_glued(glued, bed, stretch.start)));
    }
    let stiffness = match grains.stiffness_from {
        StiffnessFrom::StaticLoad => "static loads on a copy of the grains",
        StiffnessFrom::Passage => "the forces of the last passage",
    };
    lines.push(format!(
        "stiffness of supports: from {stiffness}; sleepers beyond the grains are like the nearest third of the sleepers on grains"
    ));
    lines.push(match grains.headway {
        Some(headway) => format!("trains of a block follow each other at a distance of {} m", number(headway)),
        None => "trains run one by one, and the track comes to rest between two trains".into(),
    });
    lines
}

fn each_cell(node: &CellsNode) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for (index, cell) in node.cells.iter().enumerate() {
        let bed = &node.beds[cell.bed];
        let [length, width] = bed.numbers().plan;
        let bays = if cell.copies == 1 { "1 bay".to_owned() } else { format!("{} bays", cell.copies) };
        let sleepers = match node.seats_of(index) {
            1 => "1 sleeper".to_owned(),
            count => format!("{count} sleepers"),
        };
        let soil =
            cell.soil.map(|soil| format!(", on soil of {} MN/m", number((soil / 1e6).round()))).unwrap_or_default();
        lines.push(format!(
            "cell of `{}`, {bays} of {} m x {} m, loaded by the forces at {} m: for {sleepers}{soil}",
            bed.section,
            number(length),
            number(width),
            number(rounded_to_mm(cell.x))
        ));
        lines.extend(cell.crib.map(of_crib));
        lines.extend(cell.glued.iter().map(|glued| of_glued(glued, bed, 0.0)));
    }
    lines
}

fn of_cells(node: &CellsNode) -> Vec<String> {
    let mut lines = each_cell(node);
    lines.push(format!(
        "a sleeper gets its own cell if its load differs by more than {} % of the largest load",
        number((1e3 * node.tolerance).round() / 10.0)
    ));
    lines.push("stiffness of supports: from the forces of the last computed passage".into());
    lines.extend(trains_of_cells(node));
    lines
}

fn of_checking_cells(node: &CellsNode) -> Vec<String> {
    let mut lines = each_cell(node);
    lines.push("nothing returns to the track".into());
    lines.extend(trains_of_cells(node));
    lines
}

fn trains_of_cells(node: &CellsNode) -> [String; 2] {
    [
        match node.headway_time {
            Some(time) => {
                format!("trains of a block follow each other at an interval of {} s", number(rounded_to_mm(time)))
            }
            None => "trains run one by one, and the sleepers come to rest between two trains".into(),
        },
        format!(
            "trains are left out if a law that is fitted during the run has an error below {} % of the largest settlement so far, or of the compression under the train",
            number((1e3 * node.tolerance).round() / 10.0)
        ),
    ]
}

fn of_crib(crib: Crib) -> String {
    let mm = |length: f64| number(rounded_to_mm(length) * 1e3);
    let beyond = if crib.shoulder > 0.0 {
        format!(", and {} mm beyond the ends of the sleepers", mm(crib.shoulder))
    } else {
        String::new()
    };
    format!("grains between the sleepers, up to {} mm above the underside of the sleepers{beyond}", mm(crib.height))
}

/// A glued layer of a bed that begins at a chainage, m.
fn of_glued(glued: &Glued, bed: &BedPlan, start: f64) -> String {
    let layer = bed.numbers().layers.get(usize::from(glued.surface)).map_or("", |layer| &layer.name);
    let along = glued.along.map(|along| along.map(|place| number(rounded_to_mm(start + place))));
    let along = along.map(|[from, to]| format!(" from {from} m to {to} m")).unwrap_or_default();
    let Glue { tensile_strength, shear_strength, .. } = glued.glue;
    let [tensile, shear] = [tensile_strength, shear_strength].map(|strength| number(strength / 1e3));
    format!("grains of `{layer}` are glued{along}: bonds break at {tensile} kN in tension, {shear} kN in shear")
}

fn rounded_to_mm(length: f64) -> f64 {
    (length * 1e3).round() / 1e3
}

fn of_soil(soil: &SoilNode) -> Vec<String> {
    let line = |layer: &super::SoilLayer| {
        let (thickness, modulus) = (number(1e3 * layer.thickness), number(layer.youngs_modulus / 1e6));
        let strength = if layer.strength.is_some() { ", yields by Mohr-Coulomb" } else { "" };
        format!("{}: {thickness} mm, {modulus} MPa{strength}", layer.name)
    };
    let mut lines: Vec<String> = soil.layers.iter().map(line).collect();
    if let (Some(first), Some(last)) = (soil.blocks.first(), soil.blocks.last()) {
        let [start, end] = [first.start, last.end].map(|x| number(rounded_to_mm(x)));
        let mut names: Vec<&str> = soil.blocks.iter().flat_map(|b| &b.layers).map(|l| l.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        lines.push(format!(
            "different layers between {start} and {end} m, in {} blocks: {}",
            soil.blocks.len(),
            names.join(", ")
        ));
    }
    let base = if soil.quiet_base { "waves leave through its base" } else { "its base does not move" };
    lines.push(format!("elements of about {} mm; {base}", number(rounded_to_mm(soil.element) * 1e3)));
    lines
}

fn integrator(integrator: Integrator) -> String {
    match integrator {
        Integrator::GeneralisedAlpha { rho } => format!("generalised-alpha (rho {})", number(rho)),
        Integrator::Hht { alpha } => format!("Hilber-Hughes-Taylor (alpha {})", number(alpha)),
        Integrator::Newmark => "Newmark, average acceleration".into(),
    }
}

fn block_lines(blocks: &Blocks, cost: &Cost) -> Vec<String> {
    let mut lines = Vec::new();
    for ((train, plan), share) in blocks.kinds().zip(&blocks.sequence.shares) {
        let count = if blocks.others.is_empty() { String::new() } else { format!(", {} of them", share.trains) };
        lines.push(format!(
            "train {}: {} vehicles, {} axles, {} km/h{count}",
            train.name,
            train.vehicles.len(),
            train.axles(),
            number(train.speed * 3.6)
        ));
        lines.push(format!(
            "passage: wheels from {} m to {} m, {}, step {} ms{}",
            number(plan.left),
            number(plan.right),
            integrator(plan.integrator),
            number(plan.time_step * 1e3),
            if plan.adaptive.is_some() { " or shorter" } else { "" }
        ));
    }
    lines.push(block_line(blocks, cost));
    let each = match blocks.adaptive() {
        Some(_) => {
            "each block: static state -> passage -> settlement of half of the block -> passage -> settlement of the block"
        }
        None => "each block: static state -> passage -> settlement of the block",
    };
    lines.push(each.into());
    let recorded: Vec<String> = blocks.recorded.iter().map(u64::to_string).collect();
    lines.push(format!("recorded after {} axles", recorded.join(", ")));
    lines
}

/// `500 axles in 25 blocks, 20 axles each`
fn block_line(blocks: &Blocks, cost: &Cost) -> String {
    let total = blocks.total;
    match blocks.update {
        _ if !blocks.share => format!("{total} axles, every train a block"),
        Update::Adaptive { tolerance, cap } => {
            let cap = cap.map_or(String::new(), |cap| format!(" and a settlement of at most {} mm", number(cap * 1e3)));
            format!("{total} axles in blocks with an error of at most {} mm{cap}", number(tolerance * 1e3))
        }
        Update::Fixed { axles } if matches!(cost.work, Work::Tests(_)) => {
            format!("{total} axles in blocks of {} at most", axles.min(total))
        }
        Update::Fixed { .. } | Update::Geometric { .. } => {
            let (count, [shortest, longest]) = match cost.work {
                Work::Passages(work) => (work.blocks, work.block_axles),
                Work::Tests(_) => planned(blocks),
            };
            let range = match shortest == longest {
                true => format!("{longest} axles each"),
                false => format!("{shortest} to {longest} axles"),
            };
            format!("{total} axles in {count} blocks, {range}")
        }
    }
}

/// Number of prescribed blocks, and axles of the shortest and of the longest one.
fn planned(blocks: &Blocks) -> (u64, [u64; 2]) {
    let axles: Vec<u64> = blocks.planned().unwrap_or_default().iter().map(|block| block.axles).collect();
    let [shortest, longest] = [axles.iter().min(), axles.iter().max()].map(|axles| axles.copied().unwrap_or(0));
    (axles.len() as u64, [shortest, longest])
}

fn test_lines(tests: &Tests, actuators: &ActuatorsNode) -> Vec<String> {
    let cycles = match actuators.cycles {
        1 => "1 cycle".to_owned(),
        several => format!("{several} cycles"),
    };
    let packings = match tests.packings {
        0 | 1 => "one packing".to_owned(),
        most if tests.least > 0 && tests.least < most => format!("each of {} to {most} packings", tests.least),
        several => format!("each of {several} packings"),
    };
    let kept: Vec<String> = tests.kept.iter().map(u64::to_string).collect();
    vec![
        format!(
            "{packings}: pack the bed, set down the sleepers or the plate, {cycles} of {} s",
            number(actuators.period)
        ),
        format!("loops and sensor readings are kept for cycle {}", kept.join(", ")),
    ]
}

/// Rounds an estimate to three digits.
fn rounded(value: f64) -> String {
    number(format!("{value:.2e}").parse().unwrap_or(value))
}

/// The expected error of a plan, a line for each part.
fn error_lines(error: &ExpectedError) -> String {
    let numerical = error.numerical.map(|share| {
        format!(
            "expected error: {} of the largest settlement, by blocks, steps and trains that are left out\n",
            percent(share)
        )
    });
    let of_tier = error.of_tier.map(|share| {
        format!(
            "expected error: {} by this model of the ground, against grains under the whole window: {}\n",
            percent(share),
            error.evidence
        )
    });
    [numerical, of_tier].into_iter().flatten().collect()
}

fn cost_lines(cost: &Cost) -> String {
    match cost.work {
        Work::Passages(work) => format!(
            "\nestimate: {} unknowns, {} passages, {} steps, about {} s on one core, {} s on two, {} MB\n",
            work.unknowns,
            work.passages,
            work.steps,
            number((cost.seconds * 10.0).round() / 10.0),
            number((cost.seconds_on_two_cores * 10.0).round() / 10.0),
            cost.bytes.div_ceil(1_000_000)
        ),
        Work::Tests(work @ TestWork { grains, pebbles, time_step, packing_steps, test_steps, .. }) => format!(
            "\nestimate: about {} grains of {} pebbles in all, step {} us\n\
             estimate: about {} steps to pack the bed, {} to test it{}\n\
             estimate: about {} on two cores, within a factor of two, {} MB\n{}",
            rounded(grains),
            rounded(pebbles),
            number((time_step * 1e7).round() / 10.0),
            rounded(packing_steps),
            rounded(test_steps),
            times(work),
            took(cost, work),
            rounded(cost.bytes as f64 / 1e6),
            of_making(work)
        ),
    }
}

/// `, 5 times`, `, 3 to 12 times`; nothing for one packing.
fn times(TestWork { packings, least_packings, .. }: TestWork) -> String {
    match packings {
        0 | 1 => String::new(),
        most if least_packings < most && least_packings > 0 => format!(", {least_packings} to {most} times"),
        most => format!(", {most} times"),
    }
}

/// `estimate: 5 min of this for making the bed, unless it is kept`; nothing below a second.
fn of_making(TestWork { making, packings, .. }: TestWork) -> String {
    let bed = if packings > 1 { "the beds, unless they are kept" } else { "the bed, unless it is kept" };
    if making < 1.0 { String::new() } else { format!("estimate: {} of this for making {bed}\n", duration(making)) }
}

/// `18 min`, `55 min to 3.7 h`
fn took(cost: &Cost, TestWork { packings, least_packings, .. }: TestWork) -> String {
    let longest = cost.seconds_on_two_cores;
    if least_packings == 0 || least_packings >= packings {
        return duration(longest);
    }
    let shortest = longest * f64::from(least_packings) / f64::from(packings);
    format!("{} to {}", duration(shortest), duration(longest))
}

impl Listing {
    /// The plan as text.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for node in &self.nodes {
            out.push_str(&format!("node {}: {}\n", node.name, node.model));
            node.details.iter().for_each(|d| out.push_str(&format!("  {d}\n")));
        }
        out.push('\n');
        for ListedEdge { from, to, quantity } in &self.edges {
            out.push_str(&format!("edge {from} -> {to}: {quantity}\n"));
        }
        out.push('\n');
        self.schedule.iter().for_each(|line| out.push_str(&format!("schedule: {line}\n")));
        out.push('\n');
        for pass in &self.passes {
            out.push_str(&format!("pass {}: {}\n  because {}\n", pass.pass, pass.what, pass.why));
            for other in &pass.rejected {
                let seconds = other.seconds.map_or(String::new(), |s| format!(", about {} on two cores", duration(s)));
                let error = other.error.map_or(String::new(), |e| format!(", expected error {}", percent(e)));
                out.push_str(&format!("  not {}: {}{seconds}{error}\n", other.what, other.why));
            }
        }
        out.push_str(&cost_lines(&self.cost));
        out.push_str(&error_lines(&self.error));
        out
    }

    /// The plan for Graphviz.
    pub fn dot(&self) -> String {
        let quoted = |text: &str| text.replace('"', "'");
        let mut out = String::from("digraph plan {\n  rankdir=LR\n  node [shape=box]\n");
        for node in &self.nodes {
            let (name, model) = (quoted(&node.name), quoted(&node.model));
            out.push_str(&format!("  \"{name}\" [label=\"{name}\\n{model}\"]\n"));
        }
        for ListedEdge { from, to, quantity } in &self.edges {
            let Quantity { symbol, unit, .. } = quantity;
            let (from, to) = (quoted(from), quoted(to));
            out.push_str(&format!("  \"{from}\" -> \"{to}\" [label=\"{symbol} [{unit}]\"]\n"));
        }
        out.push_str("}\n");
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_kept_bed_saves_is_told() {
        let told = |making: f64, packings: u32| of_making(TestWork { making, packings, ..TestWork::default() });
        assert_eq!(told(0.4, 1), "");
        assert_eq!(told(300.0, 1), "estimate: 5 min of this for making the bed, unless it is kept\n");
        assert_eq!(told(900.0, 3), "estimate: 15 min of this for making the beds, unless they are kept\n");
    }
}

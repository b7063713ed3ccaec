//! A track on grains: packed, laid, loaded by trains, stopped and resumed.

use std::ops::ControlFlow;
use trackbed::check::NoModules;
use trackbed::compile::{compile, compile_with};
use trackbed::diag::Code;
use trackbed::execute::{Both, Checkpoint, Event, Executor, Listener, Measured, time_steps};
use trackbed::graph::{GrainsNode, Graph, Model};
use trackbed::lower::Planner;
use trackbed::nodes::Bonds;
use trackbed::results::RunRecorder;
use trackbed::store::{Beds, Directory, Mode, Work};

/// Coarse spheres on soft soil under three sleepers before a slab, one wagon after the other: seconds to pack and
/// minutes for nobody.
const SCENE: &str = "use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7, viscous_damping = 0.3
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
soil clay { youngs_modulus = 60 MPa, poisson_ratio = 0.3, density = 2000 kg/m^3 }
trackform open {
  rail = rails.UIC60, pad = { stiffness = 40 MN/m, damping = 5 kN s/m }
  sleeper = sleepers.concrete { mass = 150 kg per seat, length = 2 m }, spacing = 0.6 m
  layers = [stone: 200 mm, clay: 0.5 m], support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, slab = slabs.half_width_1600 }
track line { sections = [open: 18 m, stiff: 15 m], transitions = [edge: soft_to_stiff] }
vehicle wagon : vehicles.ore_wagon_20t { length = 12 m }
train ore { vehicles = wagon, speed = 200 km/h, direction = forward }
traffic { trains = ore, total = 8 axles }
solve { substructure = full, window = -1.8 .. 1.2 m, support_from = passage }
record { at = [-2, -1, +1] sleepers, after = [0, 8] axles, quantities = rail_seat_load }
";

fn graph(text: &str) -> Graph {
    let compiled = compile("scene.track", text, &NoModules, &[]);
    let said = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
    compiled.runnable().cloned().unwrap_or_else(|| panic!("{said}"))
}

/// What a run tells that the tests look at.
#[derive(Default)]
struct Heard {
    /// After each block: axles before it, and the settlement of every seat after it, m.
    settlements: Vec<(u64, Vec<f64>)>,
    /// Forces of the sleepers on the ground without a train, N, and voids, m, at recorded counts.
    at_rest: Vec<(u64, Vec<f64>, Vec<f64>)>,
    /// Stiffness of the support of every seat at recorded counts, N/m.
    supports: Vec<Vec<f64>>,
    /// Largest seat load of every seat at recorded counts, N.
    seat_loads: Vec<Vec<f64>>,
    /// Bonds of glued grains after the last block.
    bonds: Bonds,
    /// Where to stop: after so many blocks, at which of the moments from then on at which a state may be kept.
    stop_after: Option<(usize, u32)>,
    moments: Vec<u32>,
    kept: Option<Checkpoint>,
}

impl Listener for Heard {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Rest { axles, state } => {
                let forces = state.seats.iter().map(|seat| seat.contact_force).collect();
                self.supports.push(state.seats.iter().map(|seat| seat.support_stiffness).collect());
                self.at_rest.push((*axles, forces, state.seats.iter().map(|seat| seat.void).collect()));
            }
            Event::Passage { passage, .. } => {
                self.seat_loads.push(passage.seats.iter().map(|seat| seat.max_rail_seat_load).collect());
            }
            Event::Block { axles, block: Some((_, measured)), after, .. } => {
                self.settlements.push((*axles, after.to_vec()));
                self.bonds = measured.bonds;
            }
            Event::Between(between) => {
                let blocks = self.settlements.len();
                self.moments.resize(blocks + 1, 0);
                if self.stop_after == Some((blocks, self.moments[blocks])) {
                    self.kept = Some(between.checkpoint().unwrap());
                    return ControlFlow::Break(());
                }
                self.moments[blocks] += 1;
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fn run(graph: &Graph, beds: &std::path::Path, threads: usize, heard: &mut Heard, from: Option<Checkpoint>) {
    let executor = Executor::default().with_beds(Beds::kept_in(beds));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| executor.run(graph, heard, from)).unwrap();
}

/// The seats on grains, from left to right.
fn carried(graph: &Graph) -> Vec<usize> {
    let grains =
        graph.nodes.iter().find_map(|node| if let Model::Grains(grains) = &node.model { Some(grains) } else { None });
    grains.unwrap().stretches.iter().flat_map(|stretch| stretch.sleepers.iter().map(|sleeper| sleeper.seat)).collect()
}

#[test]
fn a_track_on_grains_settles_and_a_run_that_was_stopped_ends_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let graph = graph(SCENE);
    let mut whole = Heard::default();
    run(&graph, folder.path(), 2, &mut whole, None);
    assert_eq!(whole.settlements.len(), 2);
    let on_grains = carried(&graph);
    let [first, second] = [&whole.settlements[0].1, &whole.settlements[1].1];
    for seat in &on_grains {
        assert!(first[*seat] > 1e-6 && first[*seat] < 20e-3, "seat {seat} settles: {} m", first[*seat]);
    }
    // a sleeper beyond the grains goes with the median of the nearest third of those on them
    assert_eq!(first[0], first[on_grains[0]]);
    // and its support is as stiff as theirs, now as at the beginning
    let [built, now] = [0, 1].map(|count| [whole.supports[count][0], whole.supports[count][on_grains[1]]]);
    assert_eq!((built[0], now[0]), (built[1], now[1]));
    assert_ne!(built[0], now[0]);
    assert!(second[on_grains[0]] - first[on_grains[0]] < first[on_grains[0]], "the first train settles most");
    let (structure, _) = graph.track().unwrap().seats.iter().enumerate().find(|(_, seat)| seat.x >= 0.0).unwrap();
    assert_eq!(second[structure], 0.0, "a slab does not settle");

    // without a train it lies still
    let measured = Measured { steps: 200, energy: false, idle: true };
    let idle = time_steps(&graph, &Beds::kept_in(folder.path()), measured, &mut |_, _| ControlFlow::Continue(()))
        .unwrap()
        .idle_m
        .unwrap();
    let an_axle = first[on_grains[1]] / 4.0;
    assert!(idle < an_axle, "{idle} m in a second, {an_axle} m an axle");

    // the other number of threads, and a stop between the trains, under the first and on the way to rest after the
    // second
    for stop in [(1, 0), (0, 407), (1, whole.moments[1] - 7)] {
        stopped_and_resumed(&graph, folder.path(), stop, &whole);
    }
}

/// Stops a run, lets another process go on with it, and compares the two parts with the whole.
fn stopped_and_resumed(graph: &Graph, beds: &std::path::Path, stop: (usize, u32), whole: &Heard) {
    let mut begun = Heard { stop_after: Some(stop), ..Heard::default() };
    run(graph, beds, 1, &mut begun, None);
    let kept = serde_json::to_string(&begun.kept.expect("stopped")).unwrap();
    let mut resumed = Heard::default();
    run(graph, beds, 1, &mut resumed, Some(serde_json::from_str(&kept).unwrap()));
    assert_eq!([begun.settlements, resumed.settlements].concat(), whole.settlements, "{stop:?}");
    assert_eq!([begun.seat_loads, resumed.seat_loads].concat(), whole.seat_loads, "{stop:?}");
    assert_eq!([begun.at_rest, resumed.at_rest].concat(), whole.at_rest, "{stop:?}");
}

/// A recorder that kept the state under a recorded train, and another process that goes on with it, make the tables of
/// a whole run.
fn tables_of_a_run_that_was_stopped(text: &str, beds: &std::path::Path) {
    let compiled = compile("scene.track", text, &NoModules, &[]);
    let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let executor = Executor::default().with_beds(Beds::kept_in(beds));
    let mut whole = RunRecorder::new(&scenario, &graph);
    executor.run(&graph, &mut whole, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let directory = || {
        let work = Work { name: "run".into(), scene_sha256: "scene".into() };
        Directory::open(folder.path(), work, Mode::Resume).unwrap()
    };
    {
        let (directory, mut stop) = (directory(), Heard { stop_after: Some((0, 101)), ..Heard::default() });
        let mut recorder = RunRecorder::new(&scenario, &graph).kept_in(&directory);
        executor.run(&graph, &mut Both(&mut recorder, &mut stop), None).unwrap();
        assert!(recorder.tables.blocks.is_empty() && stop.kept.is_some(), "stopped under its first train");
    }
    let directory = directory();
    let mut resumed = RunRecorder::new(&scenario, &graph).kept_in(&directory);
    let from = resumed.resume().unwrap();
    assert!(from.is_some());
    executor.run(&graph, &mut resumed, from).unwrap();
    assert_eq!(resumed.tables, whole.tables);
    assert_eq!(resumed.all_histories(), whole.all_histories());
    assert!(!whole.beds.told.is_empty() && resumed.beds.told == whole.beds.told);
    volumes_were_recorded(&whole);
    let lasting = whole.beds.told.last().unwrap();
    assert!(lasting.grains.iter().any(|grain| grain.displacement.unwrap()[2] < -1e-6), "grains go down");
    assert!(whole.beds.told[0].grains.iter().all(|grain| grain.displacement == Some([0.0; 3])));
}

/// A volume under sleeper -1 at two counts.
const VOLUME: &str = "record below { at = -1 sleeper, after = [0, 4] axles, depth = 100 mm
  volume = box(along = 300 mm, across = bed, height = 100 mm)
  quantities = [ballast_velocity, ballast_acceleration, ballast_stress, coordination_number] }
";

/// At both counts the grains go down under the wheels, and their acceleration is the change of their velocity.
fn volumes_were_recorded(recorder: &RunRecorder<'_>) {
    for axles in [0, 4] {
        let rows = |quantity: &str| -> Vec<(f64, f64)> {
            let of = |row: &&trackbed::results::HistoryRow| row.quantity == quantity && row.axles == axles;
            let rows: Vec<_> = recorder.histories.iter().filter(of).collect();
            assert!(rows.iter().all(|row| row.id == "-1 at 100 mm"), "{quantity}");
            rows.iter().map(|row| (row.time_s, row.value)).collect()
        };
        let velocity = rows("ballast_velocity");
        let fastest = velocity.iter().map(|(_, v)| v.abs()).fold(0.0, f64::max);
        assert!((1e-3..1.0).contains(&fastest), "{fastest} m/s after {axles} axles");
        let acceleration = rows("ballast_acceleration");
        for (pair, (_, a)) in velocity.windows(2).zip(&acceleration) {
            let change = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
            assert!((change - a).abs() <= 1e-9 * a.abs().max(1.0), "{change} {a}");
        }
        // half a sleeper bears a part of a wheel, and the grains below it feel that
        let most = |quantity: &str| rows(quantity).iter().map(|(_, value)| *value).fold(0.0, f64::max);
        assert!((10e3..120e3).contains(&most("contact_force_on_grains")), "{}", most("contact_force_on_grains"));
        assert!((5e3..2e6).contains(&most("ballast_stress")), "{} Pa", most("ballast_stress"));
        assert!((2.0..12.0).contains(&most("coordination_number")));
        assert_eq!(rows("sleeper_velocity_on_grains").len(), velocity.len());
    }
}

#[test]
fn grains_in_volumes_and_beds_are_kept_through_a_stop() {
    let folder = tempfile::tempdir().unwrap();
    let text = SCENE.replace("8 axles", "4 axles").replace("[0, 8]", "[0, 4]") + VOLUME;
    tables_of_a_run_that_was_stopped(&text, folder.path());
}

#[test]
fn volumes_without_grains_are_told() {
    let compiled = compile(
        "scene.track",
        &(SCENE.to_owned() + &VOLUME.replace("-1 sleeper", "[-9, -1] sleepers").replace("[0, 4]", "[0, 8]")),
        &NoModules,
        &[],
    );
    let told: Vec<&str> =
        compiled.diagnostics.iter().filter(|d| d.code == Code::L1024).map(|d| d.message.as_str()).collect();
    assert!(told.contains(&"no grains lie under seat -9: its volume is not recorded"), "{told:?}");
    assert_eq!(compiled.graph.unwrap().volumes().len(), 1);
}

#[test]
fn vehicles_ride_on_the_rail_over_the_grains() {
    let folder = tempfile::tempdir().unwrap();
    let text = SCENE
        .replace("support_from = passage", "coupling = monolithic")
        .replace("8 axles", "4 axles")
        .replace("[0, 8]", "[0, 4]")
        + VOLUME;
    let graph = graph(&text);
    assert!(graph.is_ridden());
    let mut ridden = Heard::default();
    run(&graph, folder.path(), 2, &mut ridden, None);
    // on the way to rest after the last train: its books and what came before it go on. `examples/faults` stops
    // anywhere
    stopped_and_resumed(&graph, folder.path(), (1, ridden.moments[1] - 47), &ridden);
    tables_of_a_run_that_was_stopped(&text, folder.path());
    let on_grains = carried(&graph);
    let track = graph.track().unwrap();
    // the forces of the feet are the weight of the track
    let (_, forces, voids) = &ridden.at_rest[0];
    let ballasted: Vec<usize> = (0..track.seats.len()).filter(|seat| track.seats[*seat].is_ballasted()).collect();
    let weight: f64 =
        ballasted.iter().map(|seat| 9.81 * (track.seats[*seat].foot.mass() + 0.6 * track.rail[0].mass)).sum();
    let carried: f64 = ballasted.iter().map(|seat| forces[*seat]).sum();
    // the rail carries what is left over to the stiff side
    assert!((carried / weight - 1.0).abs() < 0.015, "{carried} of {weight} N");
    assert!(voids.iter().all(|void| *void < 50e-6), "{voids:?}");
    // after trains the rail lies on what it has settled: no sleeper beyond the grains holds it up
    assert_eq!(ridden.at_rest.len(), 2, "before the axles and after");
    let [before, after] = [0, 1].map(|count: usize| &ridden.at_rest[count].1);
    for seat in ballasted.iter().filter(|seat| !on_grains.contains(seat)) {
        assert!(after[*seat] < 1.5 * before[*seat], "seat {seat}: {:.0} and {:.0} N", before[*seat], after[*seat]);
    }
    let loads = &ridden.seat_loads[0];
    // vehicles come onto the rail as if it went on: only the two seats at its end feel that the track beyond is another
    // model
    assert_eq!(ridden.seat_loads.len(), 2, "before the axles and after");
    for (far, when) in ridden.seat_loads.iter().map(|loads| &loads[..15]).zip(["before", "after"]) {
        for (seat, load) in far.iter().enumerate() {
            let tolerance = if seat < 2 { 0.15 } else { 0.05 };
            assert!((load / far[14] - 1.0).abs() < tolerance, "{when}, seat {seat}: {far:.0?}");
        }
    }
    for seat in &on_grains {
        assert!((15e3..80e3).contains(&loads[*seat]), "seat {seat}: {} N", loads[*seat]);
        let settled = ridden.settlements[0].1[*seat];
        assert!(settled > 1e-6 && settled < 20e-3, "seat {seat}: {settled} m");
    }
}

/// The decision of a pass in words, and the node of grains.
fn planned(text: &str, without: &[&str]) -> (Option<String>, GrainsNode) {
    let planner = without.iter().fold(Planner::default(), |planner, pass| planner.without(pass).unwrap());
    let compiled = compile_with(&planner, "scene.track", text, &NoModules, &[]);
    let graph = compiled.graph.expect("a plan");
    let said = graph.decisions.iter().find(|decision| decision.pass == "bays").map(|decision| decision.what.clone());
    let grains =
        graph.nodes.iter().find_map(|node| if let Model::Grains(grains) = &node.model { Some(grains) } else { None });
    (said, grains.unwrap().clone())
}

/// A check runs the law of a scene for its bays, but no longer than 20 s.
#[test]
fn a_law_that_runs_for_long_does_not_choose_the_bays() {
    let zone = SCENE.replace("substructure = full", "substructure = zone").replace("open: 18 m", "open: 180 m");
    let fast = planned(&zone, &[]).0.unwrap();
    assert!(!fast.contains("within 10 m of a transition"), "{fast}");
    let at_walking_pace = zone.replace("200 km/h", "1 km/h");
    assert_ne!(zone, at_walking_pace);
    assert_eq!(planned(&at_walking_pace, &[]).0.unwrap(), "grains within 10 m of a transition");
}

#[test]
fn zone_has_grains_where_the_law_differs_from_the_far_field() {
    let wide = SCENE.replace("open: 18 m", "open: 30 m").replace("window = -1.8 .. 1.2 m", "window = -15 .. 1.2 m");
    let sleepers = |tolerance: &str, without: &[&str]| {
        let text = wide.replace("substructure = full", &format!("substructure = zone, tolerance = {tolerance}"));
        let (said, grains) = planned(&text, without);
        (said.unwrap(), grains.stretches[0].sleepers.len())
    };
    let (_, full) = planned(&wide, &[]);
    // 24 sleepers in the window, and one over the bay before grains that are held
    let buffers: Vec<bool> = full.stretches[0].sleepers.iter().map(|sleeper| sleeper.buffer).collect();
    assert_eq!(buffers, [vec![true], vec![false; 24]].concat());
    let full = buffers.len();
    let found = ["20 %", "2 %", "0.2 %"].map(|tolerance| sleepers(tolerance, &[]));
    assert!(found.windows(2).all(|pair| pair[0].1 <= pair[1].1), "less tolerance needs more bays: {found:?}");
    // grains are joined over 6 m at least, ten sleepers, with three beyond and the buffer
    assert!(found[0].1 == 14 && found[2].1 < full, "{found:?}");
    assert!(found[1].0.starts_with("grains from -"), "{found:?}");
    // the pass left out: all of the window
    assert_eq!(sleepers("5 %", &["bays"]).1, full);
    // where the law differs farther away, grains reach there
    let stiff_there = wide
        .replace("track line {", "stretch there { over = -11 .. -9 m, pad.stiffness = 400 MN/m }\ntrack line {")
        .replace("transitions =", "stretches = [there], transitions =")
        .replace("substructure = full", "substructure = zone, tolerance = 0.2 %");
    let (said, grains) = planned(&stiff_there, &[]);
    assert!((15..=full).contains(&grains.stretches[0].sleepers.len()), "{said:?}");
}

#[test]
fn sleepers_turn_where_the_scene_lets_them() {
    let pitches = |text: &str| -> Vec<_> {
        let (_, grains) = planned(text, &[]);
        grains.stretches[0].sleepers.iter().map(|sleeper| sleeper.pitch).collect()
    };
    assert!(pitches(SCENE).iter().all(Option::is_none));
    for pitch in pitches(&SCENE.replace("support_from = passage", "sleeper_pitch = free")) {
        let pitch = pitch.unwrap();
        // 40 MN/m over 150 mm of pad; 150 kg of a sleeper some 0.3 m wide and 0.2 m high
        assert!((pitch.stiffness - 75e3).abs() < 1.0 && (1.0..3.0).contains(&pitch.inertia), "{pitch:?}");
    }
}

#[test]
fn layers_along_the_track_lie_in_the_soil_below_the_grains() {
    let wedge =
        "stretch wedge { over = -6 .. 0 m, layers = [stone: 200 mm, mortar: ramp(0.1 .. 0.4 m), clay: rest] }\n";
    let text = SCENE
        .replace("track line {", &format!("soil mortar {{ youngs_modulus = 900 MPa, poisson_ratio = 0.2, density = 2200 kg/m^3 }}\n{wedge}track line {{"))
        .replace("transitions =", "stretches = [wedge], transitions =");
    let compiled = compile("scene.track", &text, &NoModules, &[]);
    let said = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
    let graph = compiled.graph.as_ref().unwrap_or_else(|| panic!("{said}"));
    let soil = graph
        .nodes
        .iter()
        .find_map(|node| if let Model::Soil(soil) = &node.model { Some(soil) } else { None })
        .unwrap();
    let thickness = |x: f64| {
        let layers = soil.layers_at(x);
        assert_eq!(layers.last().unwrap().name, "clay");
        layers.iter().find(|layer| layer.name == "mortar").map_or(0.0, |layer| layer.thickness)
    };
    assert_eq!(thickness(-7.0), 0.0);
    assert!((thickness(-3.0) - 0.25).abs() < 0.005 && (thickness(-0.02) - 0.4).abs() < 0.005, "{}", thickness(-3.0));
    assert!(graph.runs, "{said}");
    // other grains are not what the bed is packed of
    let other = text.replace("layers = [stone: 200 mm, mortar", "layers = [stone: 150 mm, mortar");
    let compiled = compile("scene.track", &other, &NoModules, &[]);
    let told = compiled.diagnostics.iter().find(|d| d.code == Code::E0604).expect("told");
    assert!(told.message.contains("the layers of grains differ"), "{}", told.message);
}

#[test]
fn a_bed_is_as_wide_as_its_longest_sleeper() {
    let longer = "stretch longer { over = -2 .. -1 sleepers, sleeper.length = 2.6 m }\ntrack line {";
    let scene = SCENE.replace("track line {", longer).replace("transitions =", "stretches = [longer], transitions =");
    let [before, behind] = [SCENE, scene.as_str()].map(|text| planned(text, &[]).1.beds[0].numbers().plan[1]);
    assert_eq!((before, behind), (1.0, 1.3));
}

/// The last 1.2 m before the slab are glued, whole or as long as the glue bears nothing.
fn with_glue(strength: &str) -> String {
    let bond = format!(
        "bond = {{ stiffness = 50 MN/m per contact, tensile_strength = {strength}, shear_strength = {strength} }}"
    );
    let glued = format!(
        "granular glued : stone {{ {bond} }}\nstretch bonded {{ over = -1.2 .. 0 m, layers = [glued: 200 mm, clay: 0.5 m] }}\ntrack line {{"
    );
    SCENE
        .replace("track line {", &glued)
        .replace("transitions =", "stretches = [bonded], transitions =")
        .replace("8 axles", "4 axles")
        .replace("[0, 8]", "[0, 4]")
}

#[test]
fn a_stretch_of_glued_grains_settles_less_and_changes_nothing_else_of_the_bed() {
    let folder = tempfile::tempdir().unwrap();
    let (strong, weak) = (graph(&with_glue("5 kN")), graph(&with_glue("1 N")));
    let listing = strong.listing().text();
    assert!(listing.contains("grains of `stone` are glued from -1.2 m to 0 m"), "{listing}");
    let settled = |graph: &Graph| {
        let mut heard = Heard::default();
        run(graph, folder.path(), 2, &mut heard, None);
        let settled = carried(graph).iter().map(|seat| heard.settlements[0].1[*seat]).collect::<Vec<f64>>();
        (settled, heard.bonds)
    };
    let ((strong, hold), (weak, torn)) = (settled(&strong), settled(&weak));
    assert!(hold.intact > 100 && hold.broken == 0, "5 kN are not reached: {hold:?}");
    assert_eq!(torn.made(), hold.made(), "the same contacts are glued");
    assert!(torn.broken > torn.made() / 10, "1 N is what grains weigh: {torn:?}");
    let last = strong.len() - 1;
    assert!(strong[last] < 0.7 * weak[last], "sleeper -1: {strong:?} {weak:?}");
}

#[test]
fn a_track_whose_cribs_are_filled_runs() {
    let folder = tempfile::tempdir().unwrap();
    let scene = SCENE
        .replace("200 mm, clay: 0.5 m]", "200 mm, clay: 0.5 m], crib = 100 mm")
        .replace("slab = slabs.half_width_1600", "slab = slabs.half_width_1600, crib = none")
        .replace("8 axles", "4 axles")
        .replace("[0, 8]", "[0, 4]");
    let graph = graph(&scene);
    let mut filled = Heard::default();
    run(&graph, folder.path(), 2, &mut filled, None);
    for seat in carried(&graph) {
        let settled = filled.settlements[0].1[seat];
        assert!(settled > 1e-6 && settled < 20e-3, "seat {seat} settles: {settled} m");
    }
}

/// A slab between two banks: two beds under one rail, stopped under its train and gone on with.
#[test]
fn beds_on_both_sides_of_a_structure_carry_one_rail() {
    let folder = tempfile::tempdir().unwrap();
    let scene = SCENE
        .replace("sections = [open: 18 m, stiff: 15 m]", "sections = [open: 18 m, stiff: 6 m, open: 15 m]")
        .replace("[edge: soft_to_stiff]", "[edge: soft_to_stiff, other: stiff_to_soft]")
        .replace("[-2, -1, +1] sleepers", "[-2, -1, +1] sleepers, from = edge")
        .replace("8 axles", "4 axles")
        .replace("[0, 8]", "[0, 4]");
    let graph = graph(&scene);
    let (_, grains) = planned(&scene, &[]);
    assert_eq!(grains.stretches.len(), 2);
    let mut whole = Heard::default();
    run(&graph, folder.path(), 2, &mut whole, None);
    let track = graph.track().unwrap();
    let settled = &whole.settlements[0].1;
    for seat in carried(&graph) {
        assert!(settled[seat] > 1e-6 && settled[seat] < 20e-3, "seat {seat} settles: {} m", settled[seat]);
    }
    // beyond each bed sleepers go with its outer end
    let ends = grains.stretches.iter().map(|stretch| {
        let read = || stretch.sleepers.iter().filter(|sleeper| !sleeper.buffer).map(|sleeper| sleeper.seat);
        (read().next().unwrap(), read().next_back().unwrap())
    });
    let ends: Vec<(usize, usize)> = ends.collect();
    let last = track.seats.len() - 1;
    assert_eq!((settled[0], settled[last]), (settled[ends[0].0], settled[ends[1].1]));
    assert_ne!(settled[0], settled[last]);
    // the feet of both beds and the springs beyond carry the track
    let (_, forces, _) = &whole.at_rest[0];
    let ballasted: Vec<usize> = (0..=last).filter(|seat| track.seats[*seat].is_ballasted()).collect();
    let weight: f64 =
        ballasted.iter().map(|seat| 9.81 * (track.seats[*seat].foot.mass() + 0.6 * track.rail[0].mass)).sum();
    let carried: f64 = ballasted.iter().map(|seat| forces[*seat]).sum();
    assert!((carried / weight - 1.0).abs() < 0.015, "{carried} of {weight} N");
    stopped_and_resumed(&graph, folder.path(), (0, 603), &whole);
}

#[test]
fn what_grains_under_a_track_cannot_run_is_told() {
    let told = |from: &str, to: &str| -> Vec<(Code, String)> {
        assert!(SCENE.contains(from), "{from}");
        let compiled = compile("scene.track", &SCENE.replace(from, to), &NoModules, &[]);
        assert!(compiled.runnable().is_none(), "{to}");
        compiled.diagnostics.iter().filter(|d| d.code == Code::E0604).map(|d| (d.code, d.message.clone())).collect()
    };
    let one = |from: &str, to: &str, part: &str| {
        let told = told(from, to);
        assert!(told.len() == 1 && told[0].1.contains(part), "{to}: {told:?}");
    };
    one("support_from = passage", "symmetry = full", "both rails");
    one("track line { ", "track line { base = quiet, ", "lets the soil under grains sink");
    one("window = -1.8 .. 1.2 m", "window = 3 .. 6 m", "fewer than 2 sleepers");
    one("substructure = full", "substructure = cells, coupling = monolithic", "the rail does not connect the cells");
}

#[test]
fn the_time_of_trains_over_grains_counts_blocks_of_every_policy() {
    let time = |text: &str| {
        let graph = graph(text);
        let (passing, blocks) = (graph.passing().unwrap(), graph.blocks().unwrap());
        let all = passing.between(blocks, 0, blocks.total);
        let split = passing.between(blocks, 0, 16) + passing.between(blocks, 16, blocks.total);
        assert!((all - split).abs() < 1e-12 * all);
        (all, passing.of_block(blocks, &blocks.block(0, 1)))
    };
    let solve = |words: &str| {
        SCENE.replace("total = 8 axles", "total = 80 axles").replace("solve { ", &format!("solve {{ {words}, "))
    };
    let (isolated, alone) = time(&solve("update_every = 8 axles"));
    assert!((isolated - 20.0 * alone).abs() < 1e-9, "20 trains, one by one");
    // trains that follow each other save the way to the grains and the rest: all but the first of a block
    let follows = 12.0 / (200.0 / 3.6);
    let (fixed, _) = time(&solve("passages = continuous, update_every = 8 axles"));
    assert!((fixed - (10.0 * alone + 10.0 * follows)).abs() < 1e-9, "10 blocks of 2 trains");
    let (grown, _) = time(&solve("passages = continuous, update_every = geometric(8 axles, ratio = 1)"));
    assert!((grown - (5.0 * alone + 15.0 * follows)).abs() < 1e-9, "blocks of 2, 2, 4, 8 and 4 trains");
}

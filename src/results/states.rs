//! Rail, sleepers and grains at a recorded count as VTK files of polygonal data, which ParaView opens:
//! `states/rail_000500.vtp`, `states/sleepers_000500.vtp`, and with grains under the track `states/grains_000500.vtp`
//! and `states/contacts_000500.vtp`. All stand over axles in `states/states.pvd`.
//!
//! Places are those of the unloaded track, z up. A rail that has not settled is at 0. Sleepers are boxes in their true
//! size. Effects of traffic are data of the points: warp by `displacement` to see the rail under the passage.

use super::vtk::{File, bodies_vtk, contacts_vtk};
use super::{BedsAtCount, Grain, Link, NamedBytes, RailRow, ResultsError, Run, SleeperRow};
use crate::scenario::{Scenario, SleeperBody};
use std::fs;
use std::io;
use std::path::Path;

const FOLDER: &str = "states";
/// Distance between the rails if no sleeper gives it, m.
const GAUGE: f64 = 1.5;
/// The corners of the six sides of a box, seen from outside; bit 0 of a corner is x, bit 1 y, bit 2 z.
const SIDES: [[usize; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// The states that the scene's records ask for; none if none does.
pub(super) fn files(run: &Run, directory: &Path) -> Result<Vec<NamedBytes>, ResultsError> {
    let mut counts: Vec<u64> =
        run.scenario.records.iter().filter(|r| r.states).flat_map(|r| r.after.iter().copied()).collect();
    counts.sort_unstable();
    counts.dedup();
    let mut files = Vec::new();
    if counts.is_empty() {
        return Ok(files);
    }
    let mut listed = String::new();
    for axles in counts {
        let rail: Vec<&RailRow> = run.rail.iter().filter(|row| row.axles == axles).collect();
        let sleepers: Vec<&SleeperRow> = run.sleepers.iter().filter(|row| row.axles == axles).collect();
        let mut parts =
            vec![("rail", rail_vtk(&run.scenario, &rail)), ("sleepers", sleepers_vtk(&run.scenario, &sleepers))];
        if let Some(beds) = run.beds.iter().find(|beds| beds.axles == axles && !beds.under_train) {
            parts.extend([("grains", grains_vtk(run, beds)), ("contacts", contacts_of(run, beds))]);
        }
        for (part, (name, bytes)) in parts.into_iter().enumerate() {
            let file = format!("{name}_{axles:06}.vtp");
            let path = format!("{FOLDER}/{file}");
            let bytes = bytes.map_err(|cause| ResultsError::unwritable(&directory.join(&path), cause))?;
            files.push((path, bytes));
            listed += &format!("<DataSet timestep=\"{axles}\" part=\"{part}\" file=\"{file}\"/>\n");
        }
    }
    let collection = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" \
        version=\"1.0\">\n<Collection>\n{listed}</Collection>\n</VTKFile>\n"
    );
    files.push((format!("{FOLDER}/states.pvd"), collection.into_bytes()));
    Ok(files)
}

/// Takes away the states of another run, and nothing else.
pub fn remove(directory: &Path) -> Result<(), ResultsError> {
    let Ok(entries) = fs::read_dir(directory.join(FOLDER)) else { return Ok(()) };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.extension().is_some_and(|end| end == "vtp" || end == "pvd") {
            fs::remove_file(&path).map_err(|cause| ResultsError::io(&path, "remove", cause))?;
        }
    }
    Ok(())
}

/// The pebbles of the beds under the track.
fn grains_vtk(run: &Run, beds: &BedsAtCount) -> io::Result<Vec<u8>> {
    let depth = depth_of_bed(&run.scenario);
    let place = |[x, y, z]: [f64; 3]| [x, y, z - depth];
    let grains: Vec<Grain> = beds.grains.iter().map(|g| Grain { place: place(g.place), ..*g }).collect();
    let mut bytes = Vec::new();
    bodies_vtk(&grains, &mut bytes)?;
    Ok(bytes)
}

/// Their contacts.
fn contacts_of(run: &Run, beds: &BedsAtCount) -> io::Result<Vec<u8>> {
    let depth = depth_of_bed(&run.scenario);
    let place = |[x, y, z]: [f64; 3]| [x, y, z - depth];
    let link = |link: &Link| Link { from: place(link.from), to: place(link.to), ..*link };
    let mut bytes = Vec::new();
    contacts_vtk(&beds.links.iter().map(link).collect::<Vec<_>>(), &mut bytes)?;
    Ok(bytes)
}

/// Height of the rails, at 0, over the undersides of the sleepers, m.
fn depth_of_bed(scenario: &Scenario) -> f64 {
    scenario.track.seats.iter().find_map(|seat| seat.sleeper).map_or(0.0, |sleeper| sleeper.height)
}

/// Both rails, one line each, as they lie unloaded.
fn rail_vtk(scenario: &Scenario, rows: &[&RailRow]) -> io::Result<Vec<u8>> {
    let half = 0.5 * scenario.track.seats.iter().find_map(|seat| seat.sleeper).map_or(GAUGE, |s| s.seat_distance);
    let both: Vec<(f64, &RailRow)> =
        [-half, half].into_iter().flat_map(|y| rows.iter().map(move |r| (y, *r))).collect();
    let mut file = File { out: Vec::new() };
    let lines = if rows.is_empty() { 0 } else { 2 };
    file.begin_piece([both.len(), 0, lines, 0])?;
    file.points(both.iter().map(|(y, row)| [row.x_m, *y, -row.level_m]))?;
    file.cells("Lines", lines, rows.len())?;
    file.open("PointData Scalars=\"level\" Vectors=\"displacement\"")?;
    file.scalars("level", &both, |(_, row)| row.level_m)?;
    file.vectors("displacement", &both, |(_, row)| [0.0, 0.0, -row.max_displacement_m])?;
    file.scalars("max_moment", &both, |(_, row)| row.max_moment_N_m)?;
    file.scalars("stiffness", &both, |(_, row)| row.stiffness_N_per_m)?;
    file.close("PointData")?;
    file.end()?;
    Ok(file.out)
}

/// Sleepers as boxes; seats on slabs and rigid supports have none. A sleeper lies at its settlement, or hangs above it
/// by its void.
fn sleepers_vtk(scenario: &Scenario, rows: &[&SleeperRow]) -> io::Result<Vec<u8>> {
    let seats = scenario.track.seats.iter().zip(rows);
    let boxes: Vec<(SleeperBody, &SleeperRow, i32)> =
        seats.filter_map(|(seat, row)| Some((seat.sleeper?, *row, seat.number))).collect();
    let corner = |(body, row, _): &(SleeperBody, &SleeperRow, i32), k: usize| {
        let side = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let top = row.void_m - row.settlement_m;
        let z = if k >> 2 & 1 == 1 { top } else { top - body.height };
        [row.x_m + 0.5 * side(0) * body.base_width, 0.5 * side(1) * body.length, z]
    };
    let sides: Vec<(&SleeperRow, i32)> = boxes.iter().flat_map(|(_, row, number)| [(*row, *number); 6]).collect();
    let mut file = File { out: Vec::new() };
    file.begin_piece([8 * boxes.len(), 0, 0, sides.len()])?;
    file.points(boxes.iter().flat_map(|one| (0..8).map(move |k| corner(one, k))))?;
    let corners = (0..boxes.len()).flat_map(|i| SIDES.iter().flatten().map(move |k| 8 * i + k));
    file.connected("Polys", corners, sides.len(), 4)?;
    file.open("CellData Scalars=\"settlement\"")?;
    file.signed("sleeper", &sides, |(_, number)| *number)?;
    type Column = fn(&SleeperRow) -> f64;
    let columns: [(&str, Column); 6] = [
        ("settlement", |row| row.settlement_m),
        ("void", |row| row.void_m),
        ("gravity_contact_force", |row| row.gravity_contact_force_N),
        ("max_contact_force", |row| row.max_contact_force_N),
        ("max_rail_seat_load", |row| row.max_rail_seat_load_N),
        ("max_displacement", |row| row.max_sleeper_displacement_m),
    ];
    for (name, of) in columns {
        file.scalars(name, &sides, |(row, _)| of(row))?;
    }
    file.close("CellData")?;
    file.end()?;
    Ok(file.out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::vtk::tests::numbers;
    use crate::results::{example, files};
    use crate::scenario::Record;
    use crate::scenario::response::Response;

    fn run(states: bool) -> Run {
        let mut run = example::transition();
        let counts: Vec<u64> = run.rail.iter().map(|row| row.axles).collect();
        let after = vec![counts[0], counts[counts.len() - 1]];
        let quantities = vec![Response::ContactForce];
        run.scenario.records.push(Record { quantities, seats: vec![0], after, every: None, near: None, states });
        run
    }

    #[test]
    fn states_come_back_from_their_files() {
        let (run, directory) = (run(true), tempfile::tempdir().unwrap());
        files::write(&run, directory.path()).unwrap();
        let folder = directory.path().join(FOLDER);
        let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
        let last = run.scenario.records.last().unwrap().after[1];
        let collection = read("states.pvd");
        let listed = roxmltree::Document::parse(&collection).unwrap();
        let files: Vec<&str> = listed.descendants().filter_map(|node| node.attribute("file")).collect();
        assert_eq!(files.len(), 4);
        assert!(files.iter().all(|file| folder.join(file).exists()));

        let text = read(&format!("rail_{last:06}.vtp"));
        let document = roxmltree::Document::parse(&text).unwrap();
        let rows: Vec<&RailRow> = run.rail.iter().filter(|row| row.axles == last).collect();
        let (points, moved) = (numbers(&document, "Points"), numbers(&document, "displacement"));
        assert_eq!((points.len(), moved.len()), (6 * rows.len(), 6 * rows.len()), "two rails");
        for (i, row) in rows.iter().enumerate() {
            assert_eq!((points[3 * i], points[3 * i + 2]), (row.x_m, -row.level_m));
            assert!((moved[3 * i + 2] + row.max_displacement_m).abs() < 1e-9, "z is up");
        }
        assert_eq!(numbers(&document, "offsets"), [rows.len() as f64, 2.0 * rows.len() as f64]);

        let text = read(&format!("sleepers_{last:06}.vtp"));
        let document = roxmltree::Document::parse(&text).unwrap();
        let rows = run.sleepers.iter().filter(|row| row.axles == last);
        let track = &run.scenario.track;
        let boxes: Vec<_> = track.seats.iter().zip(rows).filter_map(|(s, row)| Some((s.sleeper?, row))).collect();
        let (points, settled) = (numbers(&document, "Points"), numbers(&document, "settlement"));
        assert_eq!((points.len(), settled.len()), (24 * boxes.len(), 6 * boxes.len()));
        for (i, (body, row)) in boxes.iter().enumerate() {
            let corners: Vec<&[f64]> = points[24 * i..24 * (i + 1)].chunks(3).collect();
            let reach = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
            assert!((reach(0) - row.x_m - 0.5 * body.base_width).abs() < 1e-12);
            assert!((reach(2) - (row.void_m - row.settlement_m)).abs() < 1e-12, "it hangs above its settlement");
            assert!((settled[6 * i] - row.settlement_m).abs() < 1e-9);
        }
    }

    #[test]
    fn grains_and_contacts_stand_in_the_same_series() {
        let (mut run, directory) = (run(true), tempfile::tempdir().unwrap());
        let axles = run.scenario.records.last().unwrap().after[1];
        let grain = Grain {
            place: [-3.0, 0.75, -0.125],
            radius: 0.03125,
            body: 0,
            velocity: [0.0; 3],
            displacement: Some([0.0, 0.0, -0.001953125]),
            coordination: 0,
            largest_force: 0.0,
        };
        run.beds = vec![BedsAtCount { axles, grains: vec![grain], ..BedsAtCount::default() }];
        files::write(&run, directory.path()).unwrap();
        let read = |name: &str| fs::read_to_string(directory.path().join(FOLDER).join(name)).unwrap();
        let series = read("states.pvd");
        assert_eq!(series.matches(&format!("grains_{axles:06}.vtp")).count(), 1);
        assert_eq!(series.matches("contacts_").count(), 1, "a count without beds has none");
        let text = read(&format!("grains_{axles:06}.vtp"));
        let document = roxmltree::Document::parse(&text).unwrap();
        let sleeper = run.scenario.track.seats.iter().find_map(|seat| seat.sleeper).unwrap();
        assert_eq!(numbers(&document, "Points"), [-3.0, 0.75, -0.125 - sleeper.height]);
        assert_eq!(numbers(&document, "displacement"), [0.0, 0.0, -0.001953125]);
    }

    #[test]
    fn nothing_is_written_that_nobody_asked_for_and_nothing_else_taken_away() {
        let directory = tempfile::tempdir().unwrap();
        files::write(&run(false), directory.path()).unwrap();
        assert!(!directory.path().join(FOLDER).exists());
        files::write(&run(true), directory.path()).unwrap();
        let mine = directory.path().join(FOLDER).join("notes.txt");
        fs::write(&mine, "mine").unwrap();
        remove(directory.path()).unwrap();
        assert_eq!(fs::read_dir(directory.path().join(FOLDER)).unwrap().count(), 1);
        assert!(mine.exists());
    }
}

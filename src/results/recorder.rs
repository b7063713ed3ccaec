//! Listens to a run and makes its tables. Between two blocks the recorder holds little data, which goes into the
//! checkpoint; histories go into their own file as soon as they exist.

use super::kept_beds::{BedPieces, KeptBeds};
use super::under_track::Part;
use super::{
    BedSummary, BedTest, BedTests, BlockRow, CheckRow, HistoryRow, LawCount, RailMaxima, RailRow, ResultsError, Run,
    Scalar, SleeperRow, SleeperTable, SoFar, Source, Tables, TampingRow, TrainRow, bed_summary, check_rows, histories,
    parted_by, static_wheel_load, summarise, test_loads,
};
use crate::execute::{Between, BlockMeasures, Checkpoint, Comparison, Event, Listener};
use crate::graph::{Block, Blocks, Graph, Record, Runner, SupportNode, TrackNode};
use crate::nodes::{self, PassageOutcome, SeatOutcome, Stage, Tested, Unloaded, VolumeSample};
use crate::scenario::response::Response;
use crate::scenario::{Loading, Scenario, Track, Traffic};
use crate::solvers::granular::Bed;
use crate::solvers::track::Direction;
use crate::store::{Directory, Piece};
use serde::{Deserialize, Serialize};
use smol_str::SmolStr;
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The small tables of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunTables {
    pub sleepers: Vec<SleeperRow>,
    pub blocks: Vec<BlockRow>,
    pub rail: Vec<RailRow>,
    /// Settlement of every ballasted seat after every block.
    pub settlements: Vec<HistoryRow>,
    /// Settlement by each law after every block; empty if there is only one law.
    pub laws: Vec<LawCount>,
    /// Settlement by the law and in the cells of grains that check it, after every block.
    #[serde(default)]
    pub check: Vec<CheckRow>,
    /// A passage beside a finer one.
    #[serde(default)]
    pub compared: Option<Comparison>,
    /// Passages of each kind of train; empty if there is only one.
    pub trains: Vec<TrainRow>,
    pub tampings: Vec<TampingRow>,
    /// Largest sagging moment and displacement of the last passages, or of a static check, N m and m.
    pub max_rail_moment: Option<f64>,
    pub max_rail_displacement: Option<f64>,
    /// Largest tension in the rail's foot of the last recorded passage, Pa.
    pub max_foot_stress: Option<f64>,
    /// Tests of packed beds; of a track none.
    pub tests: Option<BedTests>,
}

impl RunTables {
    /// The data that expressions read: these tables with the histories and scalars of their run.
    pub fn view<'a>(
        &'a self,
        histories: &'a [HistoryRow],
        scalars: &'a BTreeMap<String, Scalar>,
        track: &'a Track,
        supports: &'a [SupportNode],
    ) -> Tables<'a> {
        let RunTables { sleepers, blocks, rail, .. } = self;
        Tables { sleepers: SleeperTable::Axles(sleepers), blocks, rail, histories, scalars, track, supports }
    }
}

/// The content of a checkpoint; the histories so far are stored in pieces beside it.
#[derive(Serialize, Deserialize)]
struct Saved {
    checkpoint: Checkpoint,
    tables: RunTables,
    histories: Vec<Piece>,
    /// The track before the passages of a block under way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    unloaded: Option<Unloaded>,
    /// Beds under the track, also stored in pieces.
    #[serde(default)]
    beds: BedPieces,
    #[serde(default)]
    spent: Spent,
}

/// Completed and stored parts of the run.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Spent {
    seconds: f64,
    /// A run that is interrupted and resumed once has two.
    parts: u64,
    /// Seconds until the first train ran on grains; `None` before, and without grains.
    #[serde(default)]
    built: Option<f64>,
}

/// Makes the tables of a run.
pub struct RunRecorder<'a> {
    scenario: &'a Scenario,
    track: Option<&'a TrackNode>,
    graph: &'a Graph,
    source: Option<Source<'a>>,
    /// In the parts before this one, and when this one began.
    spent: Spent,
    begun: Instant,
    /// The present stage of the run, and the share of this stage that is done.
    stage: Option<(String, f64)>,
    records: &'a [Record],
    supports: &'a [SupportNode],
    /// Chainages between which every wheel of a train passes, m, for each kind of train.
    passed: Vec<Range<f64>>,
    directory: Option<&'a Directory>,
    /// The largest difference of a law and the cells that check it, as a share of the largest settlement, beyond which
    /// the run ends.
    limit_of_check: Option<f64>,
    /// The block after which the run has ended for this reason, and the difference.
    parted: Option<(u64, f64)>,
    /// Becomes true when the run must store its state and stop.
    interrupted: Option<&'a AtomicBool>,
    /// When a checkpoint is due.
    due: Option<Instant>,
    pub tables: RunTables,
    pub histories: Vec<HistoryRow>,
    /// Histories that are kept already, and their rows.
    kept: Vec<Piece>,
    written: usize,
    unloaded: Option<Unloaded>,
    /// Beds under the track at the recorded counts.
    pub beds: KeptBeds,
    /// The bed under test, before its test is over.
    bed: Option<BedSummary>,
    /// The bed of the last test, as it ended.
    pub last_bed: Option<Bed<f32>>,
    /// Error in storing that has ended the run.
    failure: Option<ResultsError>,
}

/// Time between two checkpoints at least, and as a multiple of what the last one took: they cost a twentieth of a run
/// at most.
const KEEP: Duration = Duration::from_secs(2);
const SHARE: u32 = 20;
/// Limit of the mean rate at which checkpoints write: a checkpoint of a track on grains has 100 MB, and a night has
/// many checkpoints.
const BYTES_A_SECOND: u64 = 1 << 20;

impl<'a> RunRecorder<'a> {
    /// A recorder that writes nothing while the run goes on.
    pub fn new(scenario: &'a Scenario, graph: &'a Graph) -> Self {
        let tests = graph.bed_under_actuators().map(|(bed, _)| BedTests::new(bed));
        RunRecorder {
            scenario,
            track: graph.track(),
            graph,
            source: None,
            spent: Spent::default(),
            begun: Instant::now(),
            stage: None,
            records: &graph.records,
            supports: &graph.supports,
            passed: graph.blocks().map(Blocks::passed_by_kind).unwrap_or_default(),
            directory: None,
            limit_of_check: None,
            parted: None,
            interrupted: None,
            due: None,
            tables: RunTables { tests, ..RunTables::default() },
            histories: Vec::new(),
            kept: Vec::new(),
            written: 0,
            unloaded: None,
            beds: KeptBeds::default(),
            bed: None,
            last_bed: None,
            failure: None,
        }
    }

    /// The same, that keeps in a directory what a run needs to be resumed.
    pub fn kept_in(self, directory: &'a Directory) -> Self {
        RunRecorder { directory: Some(directory), ..self }
    }

    /// The same, that keeps the state and ends the run soon after `asked` has become true.
    pub fn interrupted_by(self, asked: &'a AtomicBool) -> Self {
        RunRecorder { interrupted: Some(asked), ..self }
    }

    /// The same, that ends the run where its law and the cells that check it part by more than this share of the
    /// largest settlement.
    pub fn ended_by_check(self, limit: Option<f64>) -> Self {
        RunRecorder { limit_of_check: limit, ..self }
    }

    /// The axles after which law and grains have parted, and by how much, where this has ended the run.
    pub fn parted(&self) -> Option<(u64, f64)> {
        self.parted
    }

    /// The same, and it stores the results so far of a run of these texts beside its checkpoints.
    pub fn made_by(self, source: Source<'a>) -> Self {
        RunRecorder { source: Some(source), ..self }
    }

    /// The results so far; `None` if the texts of the run are not known.
    pub fn gather(&self) -> Option<Run> {
        Some(Run::gather(self, self.scenario, self.graph, self.source?))
    }

    /// Seconds of computing for what there is, over all parts of the run.
    pub fn seconds(&self) -> f64 {
        self.spent.seconds + self.begun.elapsed().as_secs_f64()
    }

    /// Seconds until the first train ran on grains; 0 without grains.
    pub fn build_seconds(&self) -> f64 {
        self.spent.built.unwrap_or(0.0)
    }

    /// Parts of the run, this one among them: each `--resume` begins another.
    pub fn parts(&self) -> u64 {
        self.spent.parts + 1
    }

    /// The present stage of the run, and the share of this stage that is done.
    pub fn stage(&self) -> Option<&(String, f64)> {
        self.stage.as_ref()
    }

    /// Continues from the state of an interrupted run in the directory; `None` if there is no such state.
    pub fn resume(&mut self) -> Result<Option<Checkpoint>, ResultsError> {
        let Some(directory) = self.directory else { return Ok(None) };
        let Some(saved) = directory.read_checkpoint::<Saved>()? else { return Ok(None) };
        for piece in &saved.histories {
            let bytes = directory.read_piece(piece)?;
            self.histories.extend(histories::decode_bytes(bytes, &directory.path().join(&piece.key))?);
        }
        self.written = self.histories.len();
        self.spent = saved.spent;
        self.beds = KeptBeds::restore(saved.beds, directory)?;
        (self.kept, self.tables, self.unloaded) = (saved.histories, saved.tables, saved.unloaded);
        Ok(Some(saved.checkpoint))
    }

    /// Why the recorder has ended the run, where it has.
    pub fn failure(&mut self) -> Option<ResultsError> {
        self.failure.take()
    }

    /// Whether there is a state to go on from.
    pub fn has_kept(&self) -> bool {
        self.due.is_some() || self.parts() > 1
    }

    /// Whether the packings of a test rig that are tested suffice: an open range of repeats ends there.
    pub fn has_enough(&self) -> bool {
        let repeats = self.scenario.solve.grains.repeats;
        let tests = self.tables.tests.as_ref().filter(|_| repeats.are_open());
        tests.is_some_and(|tests| tests.are_enough(&self.scenario.solve.grains))
    }

    /// Whether so many axles are enough to tell a law from grains: a tenth of all.
    fn is_to_be_checked(&self, axles: u64) -> bool {
        self.graph.blocks().is_some_and(|blocks| 10 * axles >= blocks.total)
    }

    fn is_interrupted(&self) -> bool {
        self.interrupted.is_some_and(|asked| asked.load(Ordering::Relaxed))
    }

    /// Keeps the state of now, where it is time.
    fn keep(&mut self, between: &Between<'_>) -> Result<(), ResultsError> {
        let Some(directory) = self.directory else { return Ok(()) };
        let started = Instant::now();
        let is_due = between.is_last || self.is_interrupted() || self.due.is_none_or(|due| started >= due);
        if !is_due {
            return Ok(());
        }
        if self.written < self.histories.len() {
            let bytes = histories::encode(&self.histories[self.written..], None, directory.path())?;
            self.kept.push(directory.keep(&format!("histories-{:04}", self.kept.len()), &bytes)?);
            self.written = self.histories.len();
        }
        let checkpoint = between.checkpoint().map_err(|cause| ResultsError::unwritable(directory.path(), cause))?;
        let clock = checkpoint.clock;
        let (tables, histories, unloaded) = (self.tables.clone(), self.kept.clone(), self.unloaded.clone());
        let spent = Spent { seconds: self.seconds(), parts: self.parts(), built: self.spent.built };
        let beds = self.beds.save(directory)?;
        let saved = Saved { checkpoint, tables, histories, unloaded, beds: beds.clone(), spent };
        let bytes = directory.write_checkpoint(&saved)?;
        SoFar::keep(self, clock, (&self.kept, beds), directory)?;
        let of_size = Duration::from_secs(bytes as u64 / BYTES_A_SECOND);
        self.due = Some(Instant::now() + KEEP.max(SHARE * started.elapsed()).max(of_size));
        Ok(())
    }

    /// Every history: of the recorded passages, and the settlement of every block.
    pub fn all_histories(&self) -> Vec<HistoryRow> {
        self.histories.iter().chain(&self.tables.settlements).cloned().collect()
    }

    /// The scalars that its tables allow.
    pub fn scalars(&self) -> BTreeMap<String, Scalar> {
        let RunTables { sleepers, blocks, trains, .. } = &self.tables;
        summarise(self.scenario, self.supports, sleepers, blocks, trains, self.rail_maxima())
    }

    fn rail_maxima(&self) -> RailMaxima {
        RailMaxima {
            moment: self.tables.max_rail_moment,
            displacement: self.tables.max_rail_displacement,
            foot_stress: self.tables.max_foot_stress,
            ..RailMaxima::from_profile(self.scenario, &self.tables.rail, |x| self.counts(x))
        }
    }

    fn track(&self) -> &'a Track {
        &self.scenario.track
    }

    fn keep_settlements(&mut self, axles: u64, settlement: &[f64]) {
        let track = self.track();
        let ballasted = track.seats.iter().zip(settlement).filter(|(seat, _)| seat.is_ballasted());
        self.tables.settlements.extend(ballasted.map(|(seat, value)| HistoryRow {
            axles,
            time_s: 0.0,
            quantity: Response::Settlement.name().into(),
            id: track.seat_name(seat).into(),
            x_m: seat.x,
            value: *value,
            train: SmolStr::default(),
        }));
    }

    /// The rail at a recorded count, and the extremes of its moment between the same places.
    fn keep_profile(&mut self, axles: u64, unloaded: &Unloaded, passage: &PassageOutcome) {
        let nodes: Vec<f64> = unloaded.rail.iter().map(|p| p.x).collect();
        self.tables.rail.extend(unloaded.profile.iter().map(|p| RailRow {
            axles,
            x_m: p.x,
            level_m: p.level,
            moment_N_m: p.moment,
            stiffness_N_per_m: p.stiffness,
            max_moment_N_m: between(&nodes, p.x, &passage.rail_moments, |m| m.1),
            min_moment_N_m: between(&nodes, p.x, &passage.rail_moments, |m| m.0),
            max_displacement_m: between(&nodes, p.x, &passage.rail_displacements, |d| d.1),
            min_displacement_m: between(&nodes, p.x, &passage.rail_displacements, |d| d.0),
        }));
        self.tables.max_foot_stress = self.foot_stress(&nodes, passage);
    }

    /// Largest tension in the rail's foot during a passage, Pa.
    fn foot_stress(&self, nodes: &[f64], passage: &PassageOutcome) -> Option<f64> {
        let stress = |(node, moment): (&f64, &(f64, f64))| Some(moment.1 / self.track().rail_at(*node)?.foot_modulus());
        let places = nodes.iter().zip(&passage.rail_moments).filter(|(node, _)| self.counts(**node));
        places.filter_map(stress).reduce(f64::max)
    }

    /// Kinds of trains of which every wheel passes a place.
    fn trains_passing(&self, x: f64) -> usize {
        self.passed.iter().filter(|passed| passed.contains(&x)).count()
    }

    /// Whether a place counts in the extremes of a run: a train passes it whole, or none does anywhere, as on a track
    /// shorter than the trains.
    fn counts(&self, x: f64) -> bool {
        self.trains_passing(x) > 0 || !self.track().seats.iter().any(|seat| self.trains_passing(seat.x) > 0)
    }

    fn traffic(&self) -> Option<&'a Traffic> {
        match &self.scenario.loading {
            Some(Loading::Traffic(traffic)) => Some(traffic),
            _ => None,
        }
    }

    /// Every sleeper after a count, under the leading train.
    fn keep_sleepers(&mut self, axles: u64, unloaded: &Unloaded, passage: &PassageOutcome) {
        let track = self.track();
        for ((seat, outcome), rest) in track.seats.iter().zip(&passage.seats).zip(&unloaded.seats) {
            self.tables.sleepers.push(SleeperRow {
                axles,
                sleeper: track.seat_name(seat),
                x_m: seat.x,
                settlement_m: rest.settlement,
                void_m: rest.void,
                gravity_contact_force_N: rest.contact_force,
                max_contact_force_N: outcome.max_contact_force,
                max_rail_seat_load_N: outcome.max_rail_seat_load,
                max_sleeper_displacement_m: outcome.max_sleeper_displacement,
                support_stiffness_N_per_m: rest.support_stiffness,
                contact_loss_s: outcome.contact_loss,
                trains_passing: self.trains_passing(seat.x),
            });
        }
    }

    /// Widens the rows of the last count to what a further train does: tables hold the extremes over all kinds.
    fn widen(&mut self, unloaded: &Unloaded, passage: &PassageOutcome) {
        let first = self.tables.sleepers.len().saturating_sub(passage.seats.len());
        for (row, outcome) in self.tables.sleepers[first..].iter_mut().zip(&passage.seats) {
            row.max_contact_force_N = row.max_contact_force_N.max(outcome.max_contact_force);
            row.max_rail_seat_load_N = row.max_rail_seat_load_N.max(outcome.max_rail_seat_load);
            row.max_sleeper_displacement_m = row.max_sleeper_displacement_m.max(outcome.max_sleeper_displacement);
            row.contact_loss_s = row.contact_loss_s.max(outcome.contact_loss);
        }
        let nodes: Vec<f64> = unloaded.rail.iter().map(|p| p.x).collect();
        let first = self.tables.rail.len().saturating_sub(unloaded.profile.len());
        for row in &mut self.tables.rail[first..] {
            let moment = |of: fn(&(f64, f64)) -> f64| between(&nodes, row.x_m, &passage.rail_moments, of);
            let displacement = |of: fn(&(f64, f64)) -> f64| between(&nodes, row.x_m, &passage.rail_displacements, of);
            let [moment, displacement] =
                [[moment(|m| m.0), moment(|m| m.1)], [displacement(|d| d.0), displacement(|d| d.1)]];
            row.min_moment_N_m = row.min_moment_N_m.min(moment[0]);
            row.max_moment_N_m = row.max_moment_N_m.max(moment[1]);
            row.min_displacement_m = row.min_displacement_m.min(displacement[0]);
            row.max_displacement_m = row.max_displacement_m.max(displacement[1]);
        }
        let stress = self.foot_stress(&nodes, passage);
        self.tables.max_foot_stress = self.tables.max_foot_stress.into_iter().chain(stress).reduce(f64::max);
    }

    /// The passage of a kind of train.
    fn keep_train(&mut self, axles: u64, runner: Runner, passage: &PassageOutcome) {
        let Some(traffic) = self.traffic() else { return };
        let Some(train) = traffic.trains().nth(runner.kind) else { return };
        let sequence = traffic.sequence();
        let largest = |of: fn(&SeatOutcome) -> f64| passage.seats.iter().map(of).fold(0.0, f64::max);
        self.tables.trains.push(TrainRow {
            axles,
            train: train.name.clone(),
            passed: sequence.counts(sequence.within(axles))[runner.kind],
            static_wheel_load_N: static_wheel_load(self.scenario, train).unwrap_or(0.0),
            max_wheel_force_N: passage.max_wheel_force,
            min_wheel_force_N: passage.min_wheel_force,
            max_rail_seat_load_N: largest(|seat| seat.max_rail_seat_load),
            max_contact_force_N: largest(|seat| seat.max_contact_force),
            max_rail_moment_N_m: passage.max_rail_moment,
            dynamic_amplification: passage.amplification.unwrap_or(0.0),
            wheel_unloading: passage.unloading.unwrap_or(0.0),
        });
    }

    fn train_name(&self, runner: Runner) -> SmolStr {
        let train = self.traffic().and_then(|traffic| traffic.trains().nth(runner.kind));
        train.map(|train| train.name.as_str().into()).unwrap_or_default()
    }

    fn keep_rail(&mut self, axles: u64, quantity: Response, points: impl Iterator<Item = (f64, f64)>) {
        self.histories.extend(points.map(|(x_m, value)| HistoryRow {
            axles,
            time_s: 0.0,
            quantity: quantity.name().into(),
            id: "rail".into(),
            x_m,
            value,
            train: SmolStr::default(),
        }));
    }
}

/// An extreme of the rail at a place, of those at the nodes of the mesh; linear between them.
fn between(nodes: &[f64], x: f64, extremes: &[(f64, f64)], of: fn(&(f64, f64)) -> f64) -> f64 {
    let (left, share) = nodes::between(nodes, x);
    let (a, b) = (of(&extremes[left]), of(&extremes[left + 1]));
    a + share * (b - a)
}

impl Listener for RunRecorder<'_> {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Equilibrium { unloaded, loaded } => self.equilibrium(unloaded, loaded),
            Event::Rest { axles, state } => self.unloaded(*axles, state),
            Event::Beds { axles, under_train, beds } => {
                self.beds.take((*axles, *under_train), beds, self.part_of_beds(*axles));
            }
            Event::Volumes { axles, samples } => self.volumes(*axles, samples),
            Event::Passage { axles, runner, passage } => self.passage(*axles, *runner, passage),
            Event::Block { axles, block, passages, before, after } => {
                self.block(*axles, *block, passages, before, after);
            }
            Event::Tamped { axles, seats, before, after } => self.tamped(*axles, seats, before, after),
            Event::Laws { axles, settlement } => self.laws(*axles, settlement),
            Event::Compared(compared) => self.tables.compared = Some(**compared),
            Event::Checked { axles, seats, settled, cells } => {
                let rows = check_rows(self.track(), *axles, seats, (settled, cells));
                let limit = self.limit_of_check.filter(|_| self.is_to_be_checked(*axles));
                self.parted = limit.and_then(|limit| parted_by(&rows, limit)).map(|share| (*axles, share));
                self.tables.check.extend(rows);
                if self.parted.is_some() {
                    return ControlFlow::Break(());
                }
            }
            Event::Packed { bed, found } => {
                self.bed = Some(bed_summary(&self.scenario.title, bed, &found.packed, None));
            }
            Event::Tested { tested, bed } => {
                self.tested(tested, bed);
                if self.has_enough() {
                    return ControlFlow::Break(());
                }
            }
            Event::Between(between) => {
                if let Err(error) = self.keep(between) {
                    self.failure = Some(error);
                    return ControlFlow::Break(());
                }
                if self.is_interrupted() && !between.is_last {
                    return ControlFlow::Break(());
                }
            }
            Event::Packing(progress) => {
                if self.spent.built.is_none() && progress.stage == Stage::Passage.to_string() {
                    self.spent.built = Some(self.seconds());
                }
                self.stage = Some((progress.stage.clone(), progress.share));
                // a bed on its way cannot be kept
                if self.is_interrupted() {
                    return ControlFlow::Break(());
                }
            }
            Event::Custom { .. } | Event::Progress { .. } => {}
        }
        ControlFlow::Continue(())
    }
}

impl RunRecorder<'_> {
    /// A test is over: its answer stands beside what its bed was.
    fn tested(&mut self, tested: &Tested, bed: &Bed<f32>) {
        if let (Some(tests), Some(summary)) = (&mut self.tables.tests, self.bed.take()) {
            tests.tests.push(BedTest { bed: summary, answer: tested.clone() });
        }
        self.last_bed = Some(bed.clone());
    }

    /// All of the beds where the scene asks for states at a count, else a section along the rail seats.
    fn part_of_beds(&self, axles: u64) -> Part {
        let states = self.scenario.records.iter().any(|record| record.states && record.after.contains(&axles));
        let sleeper = self.track().seats.iter().find_map(|seat| seat.sleeper);
        match sleeper.filter(|_| !states) {
            Some(sleeper) => Part::AlongSeats(0.5 * sleeper.seat_distance),
            None => Part::All,
        }
    }

    fn unloaded(&mut self, axles: u64, state: &Unloaded) {
        self.keep_rail(axles, Response::RailLevel, state.rail.iter().map(|p| (p.x, p.deflection)));
        self.unloaded = Some(state.clone());
    }

    /// Histories of grains in volumes, and of the sleepers over them, under the leading train.
    fn volumes(&mut self, axles: u64, samples: &[VolumeSample]) {
        let train = self.train_name(Runner { kind: 0, direction: Direction::Forward });
        let volumes = self.graph.volumes();
        let row = |sample: &VolumeSample| {
            let volume = volumes.get(sample.volume)?;
            Some(HistoryRow {
                axles,
                time_s: sample.time,
                quantity: sample.quantity.name().into(),
                id: volume.sensor.name.as_str().into(),
                x_m: volume.sensor.x,
                value: sample.value,
                train: train.clone(),
            })
        };
        self.histories.extend(samples.iter().filter_map(row));
    }

    fn passage(&mut self, axles: u64, runner: Runner, passage: &PassageOutcome) {
        let train = self.train_name(runner);
        let Some(node) = self.track else { return };
        let rows = passage.samples.iter().map(|s| HistoryRow {
            axles,
            time_s: s.time,
            quantity: s.quantity.name().into(),
            id: s.part.name(node).into(),
            x_m: s.x,
            value: s.value,
            train: train.clone(),
        });
        self.histories.extend(rows);
        let Some(unloaded) = self.unloaded.take() else { return };
        if runner.kind == 0 {
            self.keep_profile(axles, &unloaded, passage);
            self.keep_sleepers(axles, &unloaded, passage);
        } else {
            self.widen(&unloaded, passage);
        }
        self.keep_train(axles, runner, passage);
        self.unloaded = Some(unloaded);
    }

    fn block(
        &mut self,
        axles: u64,
        block: Option<(&Block, &BlockMeasures)>,
        passages: &[&PassageOutcome],
        before: &[f64],
        after: &[f64],
    ) {
        let sum = |of: fn(&PassageOutcome) -> u64| passages.iter().map(|p| of(p)).sum();
        let last = || BlockMeasures {
            passages: passages.len() as u64,
            time_steps: sum(|p| p.time_steps),
            newton_iterations: sum(|p| p.newton_iterations),
            bonds: self.tables.blocks.last().map(BlockRow::bonds).unwrap_or_default(),
            ..BlockMeasures::default()
        };
        let measured = block.map_or_else(last, |(_, measured)| *measured);
        let block = block.map(|(block, _)| block);
        let largest = |of: fn(&PassageOutcome) -> f64| passages.iter().map(|p| of(p)).fold(f64::NEG_INFINITY, f64::max);
        let seats = |p: &PassageOutcome, of: fn(&SeatOutcome) -> f64| p.seats.iter().map(of).fold(0.0, f64::max);
        let displacement = largest(|p| p.max_rail_displacement);
        let steps = before.iter().zip(after).map(|(b, a)| a - b).fold(0.0, f64::max);
        self.tables.blocks.push(BlockRow {
            axles,
            block_axles: block.map_or(0, |b| b.axles),
            max_wheel_force_N: largest(|p| p.max_wheel_force),
            min_wheel_force_N: passages.iter().map(|p| p.min_wheel_force).fold(f64::INFINITY, f64::min),
            max_rail_seat_load_N: passages.iter().map(|p| seats(p, |s| s.max_rail_seat_load)).fold(0.0, f64::max),
            max_contact_force_N: passages.iter().map(|p| seats(p, |s| s.max_contact_force)).fold(0.0, f64::max),
            max_settlement_m: after.iter().copied().fold(0.0, f64::max),
            max_settlement_step_m: steps,
            error_m: measured.error,
            overshoot: measured.overshoot.unwrap_or(0.0),
            sawtooth: measured.sawtooth,
            unevenness: measured.unevenness,
            rejected: measured.rejected,
            overshot: measured.overshot,
            passages: measured.passages,
            time_steps: measured.time_steps,
            newton_iterations: measured.newton_iterations,
            bonds: measured.bonds.intact,
            broken_bonds: measured.bonds.broken,
        });
        if axles == 0 {
            self.keep_settlements(0, before);
        }
        if let Some(block) = block {
            self.keep_settlements(axles + block.axles, after);
        }
        self.unloaded = None;
        self.tables.max_rail_moment = Some(largest(|p| p.max_rail_moment));
        self.tables.max_rail_displacement = Some(displacement);
    }

    fn tamped(&mut self, axles: u64, seats: &[usize], before: &[f64], after: &[f64]) {
        let track = self.track();
        self.tables.tampings.extend(seats.iter().map(|seat| TampingRow {
            axles,
            sleeper: track.seat_name(&track.seats[*seat]),
            x_m: track.seats[*seat].x,
            settlement_before_m: before[*seat],
            settlement_after_m: after[*seat],
        }));
        self.keep_settlements(axles, after);
    }

    fn laws(&mut self, axles: u64, settlement: &[Vec<f64>]) {
        if settlement.len() > 1 {
            let ballasted: Vec<bool> = self.track().seats.iter().map(|seat| seat.is_ballasted()).collect();
            let of_law = |law: &Vec<f64>| law.iter().zip(&ballasted).filter(|(_, b)| **b).map(|(s, _)| *s).collect();
            self.tables.laws.push(LawCount { axles, settlement: settlement.iter().map(of_law).collect() });
        }
    }

    /// The track under test loads: displacements count from the state without them, forces and moments are whole.
    fn equilibrium(&mut self, unloaded: &Unloaded, loaded: &Unloaded) {
        let track = self.track();
        let moved = loaded.rail.iter().zip(&unloaded.rail).map(|(p, rest)| (p.x, p.deflection - rest.deflection));
        let moved: Vec<(f64, f64)> = moved.collect();
        self.keep_rail(0, Response::RailDisplacement, moved.iter().copied());
        self.keep_rail(0, Response::RailLevel, unloaded.rail.iter().map(|p| (p.x, p.deflection)));
        self.keep_rail(0, Response::RailMoment, loaded.rail.iter().map(|p| (p.x, p.moment)));
        let states = loaded.seats.iter().zip(&unloaded.seats);
        for (seat, (state, rest)) in track.seats.iter().zip(states) {
            self.tables.sleepers.push(SleeperRow {
                axles: 0,
                sleeper: track.seat_name(seat),
                x_m: seat.x,
                settlement_m: rest.settlement,
                void_m: rest.void,
                gravity_contact_force_N: rest.contact_force,
                max_contact_force_N: state.contact_force,
                max_rail_seat_load_N: state.seat_load,
                max_sleeper_displacement_m: state.sleeper_level - rest.sleeper_level,
                support_stiffness_N_per_m: rest.support_stiffness,
                contact_loss_s: 0.0,
                trains_passing: 0,
            });
        }
        self.histories.extend(test_loads::at_seats(track, self.records, unloaded, loaded));
        let largest = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::max);
        self.tables.max_rail_moment = largest(&mut loaded.rail.iter().map(|p| p.moment));
        self.tables.max_rail_displacement = largest(&mut moved.iter().map(|(_, moved)| *moved));
    }
}

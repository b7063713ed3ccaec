//! The blocks of an adaptive run, chosen before the run by the same control as in the run. The model is the track
//! beside each transition on its supports, under standing wheels over one seat after the other. Dynamic effects are
//! only a factor on the wheel force.

use crate::graph::{Block, Blocks, Bogie, Control, Responses, Runner, SupportNode, TrackNode, TrackSeat, Train};
use crate::solvers::settlement::{Law, Peak, SupportState};
use crate::solvers::track::{Track, forces_under_wheels};

/// Number of settling seats beside a transition in the model, and number of seats beyond it that do not settle.
const FOLLOWED: usize = 20;
const BEYOND: usize = 8;
/// Number of stretches in the model; further stretches are mostly alike.
const STRETCHES: usize = 3;
/// Dynamic wheel force / static wheel force.
const DYNAMIC: f64 = 1.05;

/// An estimated run of adaptive blocks.
pub(super) struct DryRun<'a> {
    blocks: &'a Blocks,
    tolerance: f64,
    cap: Option<f64>,
    stretches: Vec<Stretch>,
    states: States,
    control: Control,
    /// Sum of the errors of the blocks so far, m.
    pub error: f64,
}

/// A modelled part of the track.
struct Stretch {
    node: TrackNode,
    track: Track,
    responses: Responses,
    /// Settlement of its seats at the start, m.
    initial: Vec<f64>,
    /// Indices of the seats that settle, and their own laws.
    seats: Vec<usize>,
    laws: Vec<Option<Law>>,
    /// For each kind of train: its different bogies, and the number of vehicles with them.
    wheels: Vec<Vec<(Bogie, u64)>>,
}

/// Index by stretch, then by settling seat.
type States = Vec<Vec<SupportState>>;
/// Index by stretch, kind of train, kind of vehicle and settling seat.
type Peaks = Vec<Vec<Vec<Vec<Peak>>>>;

/// Forces of running trains and of standing bogies on one settlement.
struct Forces {
    running: Peaks,
    standing: Peaks,
}

impl Forces {
    /// Forces of running trains on a settlement with these standing forces.
    fn on(&self, standing: &Peaks) -> Peaks {
        let flat = |peaks: &Peaks| peaks.iter().flatten().flatten().flatten().copied().collect::<Vec<Peak>>();
        let (from, to) = (flat(&self.standing), flat(standing));
        let mut on = self.running.clone();
        let peaks = on.iter_mut().flatten().flatten().flatten();
        peaks.zip(from.into_iter().zip(to)).for_each(|(peak, (from, to))| *peak = peak.followed(from, to));
        on
    }
}

/// Standing forces between those at the start of a step (0) and at its end (1).
fn between(start: &Peaks, end: &Peaks, share: f64) -> Peaks {
    let mut between = start.clone();
    let peaks = between.iter_mut().flatten().flatten().flatten().zip(end.iter().flatten().flatten().flatten());
    peaks.for_each(|(peak, end)| *peak = peak.towards(*end, share));
    between
}

/// Largest settlement by the law under the forces on the new track, m: by all trains, or until the first tamping.
pub(super) fn as_built(track: &TrackNode, supports: &[SupportNode], law: &Law, blocks: &Blocks) -> f64 {
    let dry = DryRun::new(track, supports, law, blocks, (f64::INFINITY, None));
    let tamped = blocks.tampings.iter().flat_map(|tamping| tamping.after.iter().copied()).filter(|count| *count > 0);
    let trains = tamped.min().map_or(blocks.sequence.trains(), |count| blocks.sequence.within(count));
    let states = dry.after(&dry.states, &blocks.block(0, trains), &dry.peaks(&dry.states, 1.0));
    largest(&settlements(&dry.states), &settlements(&states))
}

impl<'a> DryRun<'a> {
    pub fn new(
        track: &TrackNode,
        supports: &[SupportNode],
        law: &Law,
        blocks: &'a Blocks,
        (tolerance, cap): (f64, Option<f64>),
    ) -> Self {
        let mut known: Vec<Vec<Likeness>> = Vec::new();
        let mut new = |range: &[usize; 2]| {
            let likeness = likeness(track, supports, *range);
            let mirrored: Vec<Likeness> = likeness.iter().rev().copied().collect();
            let is_new = !known.contains(&likeness) && !known.contains(&mirrored);
            known.push(likeness);
            is_new
        };
        let ranges = beside_transitions(track).into_iter().filter(|range| new(range)).take(STRETCHES);
        let stretches: Vec<Stretch> = ranges.filter_map(|range| Stretch::new(track, supports, blocks, range)).collect();
        let states = stretches.iter().map(|stretch| stretch.fresh(law)).collect();
        DryRun { blocks, tolerance, cap, stretches, states, control: Control::default(), error: 0.0 }
    }

    /// Largest settlement so far, m.
    pub fn settled(&self) -> f64 {
        settlements(&self.states).into_iter().fold(0.0, f64::max)
    }

    /// Starts the settlement law of every seat again.
    pub fn tamp(&mut self, law: &Law) {
        self.states = self.stretches.iter().map(|stretch| stretch.fresh(law)).collect();
    }

    /// The next block, chosen as in the adaptive step of a run; `middle` receives the passages of every attempt.
    pub fn next(&mut self, before: u64, mut middle: impl FnMut(&[Runner])) -> Block {
        let left = self.blocks.trains_left(before);
        let mut most = left;
        let here = self.forces(&self.states);
        let begun = settlements(&self.states);
        loop {
            let settled = |trains| {
                let states = self.after(&self.states, &self.blocks.block(before, trains), &here.running);
                largest(&begun, &settlements(&states))
            };
            let trains = self.control.choose(most, left, settled);
            let block = self.blocks.block(before, trains);
            if trains == 1 {
                self.states = self.after(&self.states, &block, &here.running);
                return block;
            }
            middle(&block.runners());
            let at_once = settlements(&self.followed(&here, &self.states, &block));
            let half = self.blocks.block(before, trains / 2);
            let halfway = self.followed(&here, &self.states, &half);
            let there = self.forces(&halfway);
            let rest = self.blocks.block(before + half.axles, trains - trains / 2);
            let by_halves = settlements(&self.followed(&there, &halfway, &rest));
            let error = largest(&at_once, &by_halves);
            self.control.learn(error, largest(&begun, &at_once), self.tolerance, self.cap);
            if trains > 2 && error > self.tolerance {
                most = (trains / 2).max(2);
                continue;
            }
            self.error += if trains > 2 { error } else { 0.0 };
            let one = self.blocks.block(before, 1);
            let others = self.blocks.block(before + one.axles, trains - 1);
            let first = self.after(&self.states, &one, &here.running);
            self.states = self.followed(&there, &first, &others);
            return block;
        }
    }

    /// The states of the seats after a block, under forces that follow the settlement as in a run.
    fn followed(&self, reference: &Forces, from: &States, block: &Block) -> States {
        let mut states = from.clone();
        let mut here = self.peaks(&states, 1.0);
        for step in self.blocks.steps(block) {
            let at_start = self.after(&states, &step, &reference.on(&here));
            let end = self.peaks(&at_start, 1.0);
            states = match step.trains() {
                1 => at_start,
                _ => self.after(&states, &step, &reference.on(&between(&here, &end, step.middle()))),
            };
            here = end;
        }
        states
    }

    fn forces(&self, states: &States) -> Forces {
        Forces { running: self.peaks(states, DYNAMIC), standing: self.peaks(states, 1.0) }
    }

    /// The largest force of a wheel on each support, with wheel forces of `times` the static force.
    fn peaks(&self, states: &States, times: f64) -> Peaks {
        self.stretches.iter().zip(states).map(|(stretch, states)| stretch.peaks(states, times)).collect()
    }

    /// The states of the seats after a block under the peak forces.
    fn after(&self, from: &States, block: &Block, peaks: &Peaks) -> States {
        let mut states = from.clone();
        for ((stretch, states), peaks) in self.stretches.iter().zip(&mut states).zip(peaks) {
            for (runner, trains) in &block.runs {
                for ((_, vehicles), peaks) in stretch.wheels[runner.kind].iter().zip(&peaks[runner.kind]) {
                    for (state, peak) in states.iter_mut().zip(peaks) {
                        state.load(&[*peak; 4], trains * vehicles);
                    }
                }
            }
        }
        states
    }
}

impl Stretch {
    /// Supports that nothing has loaded, each under its own law or under that of the scene.
    fn fresh(&self, law: &Law) -> Vec<SupportState> {
        self.laws.iter().map(|own| own.as_ref().unwrap_or(law).fresh()).collect()
    }

    fn new(track: &TrackNode, supports: &[SupportNode], blocks: &Blocks, [first, last]: [usize; 2]) -> Option<Stretch> {
        let node = track.part(first, last)?;
        let supports = supports.get(first..=last)?;
        let responses = Responses { revision: 0, seats: supports.iter().map(|support| support.spring).collect() };
        let seats: Vec<usize> = (0..supports.len()).filter(|seat| supports[*seat].spring.is_some()).collect();
        let laws = seats.iter().map(|seat| supports[*seat].law).collect();
        let initial = supports.iter().map(|support| support.settlement).collect();
        let vehicles = |bogie: &Bogie| bogie.wheels_of_train.len() as u64 / 4;
        let of_train =
            |train: &Train| train.bogies(node.gravity).into_iter().map(|b| (b.clone(), vehicles(&b))).collect();
        let wheels = blocks.kinds().map(|(train, _)| of_train(train)).collect();
        Some(Stretch { track: Track::new(node.model(&responses)).ok()?, node, responses, initial, seats, laws, wheels })
    }

    /// The largest force of a wheel on each support; 0 if the track has no equilibrium, which the run reports as an
    /// error.
    fn peaks(&self, states: &[SupportState], times: f64) -> Vec<Vec<Vec<Peak>>> {
        let mut settlement = self.initial.clone();
        for (seat, state) in self.seats.iter().zip(states) {
            settlement[*seat] += state.settlement();
        }
        let level = self.node.level(&settlement, &self.responses);
        let under = |(bogie, _): &(Bogie, u64)| {
            let [force, apart] = bogie.wheels;
            let forces = forces_under_wheels(&self.track, &level, [times * force, apart], &self.seats);
            let forces = forces.unwrap_or_else(|_| vec![[0.0; 2]; self.seats.len()]);
            forces.into_iter().map(|[force, deflection]| Peak { force, deflection, void: 0.0 }).collect()
        };
        self.wheels.iter().map(|kind| kind.iter().map(under).collect()).collect()
    }
}

/// Settlement of every seat, m.
fn settlements(states: &States) -> Vec<f64> {
    states.iter().flatten().map(SupportState::settlement).collect()
}

/// Largest difference of two settlements of a seat, m.
fn largest(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The first and the last seat of each stretch: both sides of every section boundary beside settling seats, or the
/// middle of the track if there is no such boundary.
fn beside_transitions(track: &TrackNode) -> Vec<[usize; 2]> {
    let (seats, last) = (&track.seats, track.seats.len().saturating_sub(1));
    let reach = |seat: usize| if seats[seat].is_ballasted() { FOLLOWED } else { BEYOND };
    let boundary = |right: &usize| {
        let left = right - 1;
        seats[left].section != seats[*right].section && (seats[left].is_ballasted() || seats[*right].is_ballasted())
    };
    let around = |right: usize| {
        let left = right - 1;
        [(left + 1).saturating_sub(reach(left)), (right + reach(right) - 1).min(last)]
    };
    let found: Vec<[usize; 2]> = (1..seats.len()).filter(boundary).map(around).collect();
    let ballasted: Vec<usize> = (0..seats.len()).filter(|seat| seats[*seat].is_ballasted()).collect();
    match (found.is_empty(), ballasted.get(ballasted.len() / 2)) {
        (true, Some(middle)) => vec![[middle.saturating_sub(FOLLOWED / 2), (middle + FOLLOWED / 2).min(last)]],
        _ => found,
    }
}

/// Data of a seat by which stretches are compared: bay, pad stiffness, support stiffness, settlement, and its own law.
type Likeness = ([f64; 4], Option<Law>);

fn likeness(track: &TrackNode, supports: &[SupportNode], [first, last]: [usize; 2]) -> Vec<Likeness> {
    let seats = track.seats[first..=last].iter().zip(&supports[first..=last]);
    let of = |support: &SupportNode| support.spring.map_or(0.0, |spring| spring.stiffness);
    let numbers = |(seat, support): (&TrackSeat, &SupportNode)| {
        ([seat.bay, seat.pad_stiffness, of(support), support.settlement], support.law)
    };
    seats.map(numbers).collect()
}

//! Divides the axles of a run into blocks, between which forces and settlement are exchanged.

use super::{Draft, Pass, track};
use crate::diag::{Code, Diagnostic, Help, Span};
use crate::graph::{Blocks, Cost, PassagePlan, Rejected, Schedule, Tamping, Train, Update, Work};
use crate::scenario::{self, Loading, Order, Scenario, Share, Traffic};
use crate::schema::Reads;
use crate::units::number;

/// Scenes in which the passes for trains act.
pub(super) const WITH_TRAINS: &str = "where trains run";

/// Fields of trains, of traffic, and of tamping and recording between trains.
const READS: Reads = Reads {
    fields: &[
        "vehicle.axle_load",
        "vehicle.car_body",
        "vehicle.bogie",
        "vehicle.wheelset",
        "vehicle.primary",
        "vehicle.secondary",
        "vehicle.contact",
        "vehicle.length",
        "car_body.mass",
        "car_body.pitch_inertia",
        "car_body.radius_of_gyration",
        "bogie.mass",
        "bogie.pitch_inertia",
        "bogie.spacing",
        "wheelset.mass",
        "wheelset.spacing",
        "wheelset.radius",
        "primary_suspension.stiffness",
        "primary_suspension.damping",
        "secondary_suspension.stiffness",
        "secondary_suspension.damping",
        "train.vehicles",
        "train.speed",
        "train.direction",
        "traffic.trains",
        "traffic.total",
        "traffic.order",
        "tamping.after",
        "tamping.over",
        "tamping.from",
        "tamping.left",
        "solve.update_every",
        "record.states",
    ],
    acts_where: WITH_TRAINS,
};

/// The counts at which results are recorded: axles, or cycles of a test rig.
pub(super) const COUNTS: Reads =
    Reads { fields: &["record.after"], acts_where: "where trains run or a test rig is loaded" };

/// Divides the axles into blocks, with ends at the counts of records and tampings.
pub(super) struct Cut;

impl Pass for Cut {
    fn name(&self) -> &'static str {
        "blocks"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&READS, &COUNTS]
    }

    fn acts(&self, scenario: &Scenario) -> bool {
        matches!(scenario.loading, Some(Loading::Traffic(_)))
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let Some(Loading::Traffic(traffic)) = &draft.scenario.loading else { return };
        draft.blocks = blocks(draft, traffic);
        let Some(blocks) = &draft.blocks else { return };
        let tampings: Vec<(String, String)> = blocks.tampings.iter().map(told).collect();
        let mixed = traffic.is_mixed().then(|| mix(blocks));
        tampings.into_iter().for_each(|(what, why)| draft.decide("tamping", what, why));
        mixed.into_iter().for_each(|(what, why)| draft.decide("mix", what, why));
    }
}

fn blocks(draft: &mut Draft<'_>, traffic: &Traffic) -> Option<Blocks> {
    let scenario = draft.scenario;
    let total = *traffic.total;
    let mut update = scenario.solve.update;
    // counts of mixed traffic are already rounded to whole trains
    let mut sound = traffic.is_mixed() || whole_trains(draft, traffic, &mut update);
    let of_volumes = scenario.volumes.iter().flat_map(|record| record.after.iter().copied());
    let of_track = scenario.records.iter().flat_map(|record| record.after.iter().copied());
    let mut recorded: Vec<u64> = of_track.chain(of_volumes).chain([0, total]).collect();
    recorded.sort_unstable();
    recorded.dedup();
    if !traffic.is_mixed() {
        sound &= between_trains(draft, &recorded, total, &traffic.train);
    }
    if !sound || !few_enough(draft, update, total) {
        return None;
    }
    let sequence = traffic.sequence();
    let turns = sequence.turns().into_iter().map(|position| sequence.axles(position));
    let tamped = scenario.tampings.iter().flat_map(|tamping| tamping.after.iter().copied());
    let mut stops: Vec<u64> = recorded.iter().copied().chain(turns).chain(tamped).collect();
    stops.sort_unstable();
    stops.dedup();
    let mut passages = draft.passages.iter().copied();
    let (train, passage) = (track::train(&traffic.train), passages.next()?);
    let others = traffic.others.iter().map(track::train).zip(passages).collect();
    let tampings = scenario.tampings.clone();
    let compared = None;
    Some(Blocks {
        train,
        passage,
        others,
        sequence,
        update,
        cure: true,
        share: true,
        recorded,
        tampings,
        stops,
        total,
        compared,
    })
}

fn told(tamping: &Tamping) -> (String, String) {
    let after: Vec<String> = tamping.after.iter().map(u64::to_string).collect();
    let what = format!("{} sleepers after {} axles", tamping.seats.len(), after.join(", "));
    let left = number(100.0 * tamping.left);
    (
        what,
        format!(
            "`{}` leaves {left} % of the settlement of these sleepers, and their settlement law starts again",
            tamping.name
        ),
    )
}

/// Largest number of blocks of a run; each block is a passage of every kind of train.
const MOST_BLOCKS: u64 = 20_000;

/// Whether the number of blocks is small enough for a run of reasonable length.
fn few_enough(draft: &mut Draft<'_>, update: Update, total: u64) -> bool {
    let (mut before, mut blocks) = (0, 0);
    while before < total && blocks <= MOST_BLOCKS {
        let Some(axles) = update.axles_after(before) else { return true };
        before += axles.max(1);
        blocks += 1;
    }
    if blocks <= MOST_BLOCKS {
        return true;
    }
    let message =
        format!("{total} axles make more than {MOST_BLOCKS} blocks, each with an exchange of forces and settlement");
    let mut mistake = Diagnostic::new(Code::E0103, message).help(
        "let the blocks grow with the axles: `update_every = adaptive(0.003 mm)` or `geometric(4 axles, ratio = 0.2)`",
    );
    if let Some(span) = draft.scenario.solve.update_span {
        mistake = mistake.label(span, "too short");
    }
    draft.diagnostics.push(mistake);
    false
}

/// Whether the total and the blocks of traffic with one kind of train are whole trains.
fn whole_trains(draft: &mut Draft<'_>, traffic: &Traffic, update: &mut Update) -> bool {
    let (train, span) = (&traffic.train, draft.scenario.solve.update_span);
    let sound = divides(draft, *traffic.total, train, "the run", traffic.total.origin.span());
    let blocks = match update {
        // the default is rounded up to whole trains
        Update::Geometric { first, .. } if span.is_none() => {
            *first = first.div_ceil(train.axles()) * train.axles();
            true
        }
        Update::Geometric { first, .. } => divides(draft, *first, train, "the first block", span),
        Update::Fixed { axles } => divides(draft, *axles, train, "an update interval", span),
        Update::Adaptive { .. } => true,
    };
    sound && blocks
}

/// Whether all recorded counts lie between two trains, for traffic with one kind of train.
fn between_trains(draft: &mut Draft<'_>, recorded: &[u64], total: u64, train: &scenario::Train) -> bool {
    let axles = train.axles();
    let within: Vec<u64> = recorded.iter().copied().filter(|count| count % axles != 0 && *count != total).collect();
    for count in &within {
        draft.diagnostics.push(
            Diagnostic::new(
                Code::E0602,
                format!("the record after {count} axles is not after a whole number of trains of {axles} axles"),
            )
            .help(format!("record after {} axles", (count / axles).max(1) * axles)),
        );
    }
    within.is_empty()
}

/// Mixed traffic in whole trains, and the reason.
fn mix(blocks: &Blocks) -> (String, String) {
    let share = |((train, _), share): ((&Train, &PassagePlan), &Share)| {
        let axles = 100.0 * (share.trains * share.axles) as f64 / blocks.total as f64;
        format!("{} of `{}` ({} % of the axles)", share.trains, train.name, number((axles * 100.0).round() / 100.0))
    };
    let shares: Vec<String> = blocks.kinds().zip(&blocks.sequence.shares).map(share).collect();
    let why = match blocks.sequence.order {
        Order::Interleaved => "shares are rounded to whole trains; the trains are spread evenly over the run",
        Order::InTurn => "shares are rounded to whole trains; one kind of train runs after the other",
    };
    (format!("{}, {} axles in all", shares.join(", "), blocks.total), why.to_owned())
}

/// Uses one passage for all equal trains of a block.
pub(super) struct Shared;

impl Pass for Shared {
    fn name(&self) -> &'static str {
        "share"
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let (Some(Schedule::Blocks(blocks)), Some(cost)) = (&draft.schedule, &draft.cost) else { return };
        let trains = blocks.sequence.trains();
        // over grains every train runs
        if trains < 2 || !matches!(cost.work, Work::Passages(_)) {
            return;
        }
        let why =
            "trains of one kind and block run over the same settled track, so one passage gives the forces of all";
        let work = cost.passages();
        let about = if blocks.adaptive().is_some() { "about " } else { "" };
        let what = format!("{about}{} passages stand for {trains} trains", work.passages);
        let each = cost.seconds_on_two_cores / work.passages.max(1) as f64;
        let why_not = "it would only remove the error of blocks, which the run measures";
        let seconds = Some(each * trains as f64);
        let rejected = Rejected { seconds, ..Rejected::new("a passage of every train", why_not) };
        draft.decide_against(self.name(), what, why, vec![rejected]);
    }

    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(every_train)
    }
}

/// Makes every train a block with its own passage.
fn every_train(draft: &mut Draft<'_>) {
    let Some(Schedule::Blocks(blocks)) = &mut draft.schedule else { return };
    blocks.share = false;
    let trains = blocks.sequence.trains();
    if let Some(Cost { seconds, seconds_on_two_cores, work: Work::Passages(work), .. }) = &mut draft.cost {
        let times = trains as f64 / work.passages.max(1) as f64;
        *seconds *= times;
        *seconds_on_two_cores *= times;
        work.steps = (work.steps as f64 * times) as u64;
        (work.blocks, work.passages) = (trains, trains + 1);
    }
}

/// Whether a count is a whole number of trains.
fn divides(draft: &mut Draft<'_>, count: u64, train: &scenario::Train, what: &str, span: Option<Span>) -> bool {
    let axles = train.axles();
    if count.is_multiple_of(axles) && count > 0 {
        return true;
    }
    let below = (count / axles).max(1) * axles;
    let mut mistake = Diagnostic::new(
        Code::E0602,
        format!("{what} of {count} axles is not a whole number of trains of {axles} axles"),
    );
    let whole = if count < axles { vec![axles] } else { vec![below, below + axles] };
    let help = Help::write_one_of(whole.into_iter().map(|count| format!("{count} axles")).collect());
    mistake = match span {
        Some(span) => mistake.label(span, "not a whole number of trains").advise(span, help),
        None => mistake.help(help.said),
    };
    draft.diagnostics.push(mistake);
    false
}

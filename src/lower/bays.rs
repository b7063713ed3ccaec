//! Bays of a window that get grains in the tier `zone`: the bays in which the track differs from the far field, and an
//! edge of a few bays beside them. The springs beyond settle like the sleepers on this edge. A settlement law shows
//! where the forces differ. Beside a transition the grains differ over a longer distance: sleepers hang, and grains
//! under the next sleepers move towards the unloaded grains. A settlement law of a single sleeper does not describe
//! this.

use super::{Draft, Pass};
use crate::scenario::{Scenario, Tier};
use crate::schema::Reads;
use crate::units::number;

/// Number of sleepers on grains beyond the last sleeper that differs; the sleepers on springs beyond settle like these.
const EDGE: usize = 3;
/// Length of track beside a transition that always gets grains, m. On 16 bays of grains the sleepers up to -8 (4.8 m)
/// settle otherwise than the far field; by the law only the last two do (docs/statements.md).
const JOINED: f64 = 6.0;
/// Length of track beside a transition that gets grains if no law runs, m.
const NEAR: f64 = 10.0;

/// Field that decides which sleepers differ.
pub(super) const READS: Reads = Reads {
    fields: &["solve.tolerance"],
    acts_where: "where grains lie under some sleepers of a track: `substructure = cells` or `zone`",
};

/// Chooses the bays.
pub(super) struct Bays;

impl Pass for Bays {
    fn name(&self) -> &'static str {
        "bays"
    }

    fn reads(&self) -> &'static [&'static Reads] {
        &[&READS]
    }

    fn acts(&self, scenario: &Scenario) -> bool {
        *scenario.solve.grains.tier == Tier::Zone
    }

    fn run(&self, draft: &mut Draft<'_>) {
        let scenario = draft.scenario;
        if !self.acts(scenario) {
            return;
        }
        let windows = wanted(scenario);
        let Some(settlement) = draft.by_law.filter(|settlement| settlement.len() == scenario.track.seats.len()) else {
            draft.bays = windows.iter().map(|window| near(scenario, *window)).collect();
            let what = format!("grains within {NEAR} m of a transition");
            draft.decide(
                self.name(),
                what,
                "no settlement law runs this scene within 20 s, so the sleepers that settle differently are not known",
            );
            return;
        };
        let tolerance = *scenario.solve.grains.tolerance;
        let changes = changes(scenario, settlement);
        draft.bays = differing(scenario, settlement);
        let spans = |windows: &[[f64; 2]]| {
            let span = |[a, b]: &[f64; 2]| format!("{} to {} m", number(rounded(*a)), number(rounded(*b)));
            windows.iter().map(span).collect::<Vec<_>>().join(", ")
        };
        let beyond = |seat: &usize| on_any(scenario, &windows, *seat) && !on_any(scenario, &draft.bays, *seat);
        let most = (0..changes.len()).filter(beyond).map(|seat| changes[seat]).fold(0.0, f64::max);
        let what = format!("grains from {} of the window from {}", spans(&draft.bays), spans(&windows));
        let why = format!(
            "by law `{}` every sleeper beyond settles like the far field, to within {} % of the largest settlement (`tolerance`; largest \
             difference {} %); grains reach at least {JOINED} m from a transition, because grains move from bay to bay and no law \
             computes this; the springs beyond settle like the outermost {EDGE} sleepers on grains",
            scenario.solve.law.name,
            number((1e3 * tolerance).round() / 10.0),
            number((1e3 * most).round() / 10.0),
        );
        draft.decide(self.name(), what, why);
    }

    /// Puts grains in the whole window.
    fn without(&self) -> Option<fn(&mut Draft<'_>)> {
        Some(|draft| draft.bays = wanted(draft.scenario))
    }
}

/// Chainages between which the scene asks for grains, m; the whole track if it states no window.
pub(super) fn wanted(scenario: &Scenario) -> Vec<[f64; 2]> {
    let all = || vec![[scenario.track.start(), scenario.track.end()]];
    scenario.solve.grains.window.clone().unwrap_or_else(all)
}

/// The bays of each window that differ from the far field; `settlement` is the settlement of every seat, m.
pub(super) fn differing(scenario: &Scenario, settlement: &[f64]) -> Vec<[f64; 2]> {
    let changes = changes(scenario, settlement);
    let tolerance = *scenario.solve.grains.tolerance;
    wanted(scenario).into_iter().map(|window| chosen(scenario, &changes, tolerance, window)).collect()
}

/// Difference between the settlement of each seat and the far field of its section / largest settlement of all seats.
fn changes(scenario: &Scenario, settlement: &[f64]) -> Vec<f64> {
    let track = &scenario.track;
    let largest = settlement.iter().fold(0.0, |most: f64, settlement| most.max(settlement.abs()));
    let mut changes = vec![0.0; settlement.len()];
    for section in 0..track.sections.len() {
        let seats = || track.seats_of(section).filter(|seat| track.seats[*seat].is_ballasted());
        let far = track.far_field(seats().map(|seat| (track.seats[seat].x, settlement[seat])).collect());
        for seat in seats() {
            let change = far.map_or(0.0, |far| (settlement[seat] - far).abs());
            changes[seat] = if largest > 0.0 { change / largest } else { 0.0 };
        }
    }
    changes
}

/// Rounds to a millimetre.
fn rounded(x: f64) -> f64 {
    (1e3 * x).round() / 1e3
}

fn is_inside([left, right]: [f64; 2], x: f64) -> bool {
    (left..=right).contains(&x)
}

/// Whether a sleeper stands in one of these windows.
fn on_any(scenario: &Scenario, windows: &[[f64; 2]], seat: usize) -> bool {
    let seat = &scenario.track.seats[seat];
    seat.is_ballasted() && windows.iter().any(|window| is_inside(*window, seat.x))
}

/// The part of a window that gets grains: [`JOINED`] beside its transitions, every sleeper that differs by more than
/// the tolerance, and an edge of a few bays.
fn chosen(scenario: &Scenario, changes: &[f64], tolerance: f64, [left, right]: [f64; 2]) -> [f64; 2] {
    let track = &scenario.track;
    let inside: Vec<usize> = (0..changes.len()).filter(|seat| on_any(scenario, &[[left, right]], *seat)).collect();
    let transitions = || track.transitions.iter().map(|t| t.x).filter(|x| is_inside([left, right], *x));
    let differs = || inside.iter().copied().filter(|seat| changes[*seat] > tolerance);
    let joined = || transitions().flat_map(|x| [(x - JOINED).max(left), (x + JOINED).min(right)]);
    let places = || joined().chain(differs().map(|seat| track.seats[seat].x));
    let (Some(first), Some(last)) = (places().reduce(f64::min), places().reduce(f64::max)) else {
        return [left, right];
    };
    // one bay beyond the outermost sleeper: grains end with a whole cell, and a sleeper needs half a bay before that
    // end
    let reach = |beside: Vec<usize>| beside.last().map(|seat| (track.seats[*seat].x, track.bay(*seat)));
    let before: Vec<usize> =
        inside.iter().rev().copied().filter(|seat| track.seats[*seat].x < first).take(EDGE).collect();
    let behind: Vec<usize> = inside.iter().copied().filter(|seat| track.seats[*seat].x > last).take(EDGE).collect();
    [
        reach(before).map_or(left, |(x, bay)| left.max(x - bay)),
        reach(behind).map_or(right, |(x, bay)| right.min(x + bay)),
    ]
}

fn near(scenario: &Scenario, [left, right]: [f64; 2]) -> [f64; 2] {
    let mut inside = scenario.track.transitions.iter().map(|t| t.x).filter(|x| is_inside([left, right], *x));
    match (inside.next(), inside.next_back()) {
        (Some(first), last) => [left.max(first - NEAR), right.min(last.unwrap_or(first) + NEAR)],
        (None, _) => [left, right],
    }
}

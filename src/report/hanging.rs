//! A hanging sleeper beside one of the far field: contact force, velocity and acceleration during a passage, shaded
//! while there is no contact (paper, Figs. 16 and 17).

use super::curves::Chart;
use super::panels::{Names, panels, share_scale};
use super::seat_clock::{Passages, seats, shown};
use super::{Figure, counts};
use crate::graph::InVolume;
use crate::results::{Run, SleeperRow};
use crate::scenario::response::Response;

const HEIGHT: f64 = 235.0;

const SHOWN: [(Response, &str); 3] = [
    (Response::ContactForce, "contact force"),
    (Response::SleeperVelocity, "velocity"),
    (Response::SleeperAcceleration, "acceleration"),
];

pub fn hanging_sleeper(run: &Run) -> Option<Figure> {
    let counts = counts::shown(run);
    let chosen = chosen(run);
    if chosen.is_empty() {
        return None;
    }
    let passages = Passages::new(run);
    let mut charts: Vec<(Chart, f64)> = Vec::new();
    for (quantity, title) in SHOWN {
        let title = |seat: &str| format!("{}: {title}", shown(seat));
        let mut row: Vec<Chart> =
            chosen.iter().map(|seat| passages.panel(quantity, seat, &title(seat), &counts)).collect();
        if row.iter().all(|chart| !chart.is_empty()) {
            share_scale(row.iter_mut(), HEIGHT - 70.0);
            charts.extend(row.into_iter().map(|chart| (chart, HEIGHT)));
        }
    }
    let others = seats(run, Response::ContactForce).len() - chosen.len();
    let mut caption = "Left: the recorded sleeper with the largest void. Right: a sleeper of the far field. Titles \
                       begin with the sleeper number. Shaded: the sleeper has no contact with its support at the last \
                       count. A hanging sleeper is lifted before the wheel comes, hits the ballast, and leaves it \
                       again between the bogies. The contact force is for half a sleeper and is never negative. \
                       Velocity and acceleration are positive downward. Time is zero when the leading wheel stands \
                       over the sleeper."
        .to_owned();
    if chosen.len() == 1 {
        caption = caption.replace(
            "Left: the recorded sleeper with the largest void. Right: a sleeper of the far field. Titles begin with \
            the sleeper number. ",
            "",
        );
    }
    if others > 0 {
        caption += " The other recorded sleepers are in histories.parquet.";
    }
    let in_grains = run.histories.iter().any(|row| row.quantity == InVolume::SleeperForce.name());
    if in_grains && !run.scenario.solve.grains.monolithic {
        caption += " All curves are for the plane track; the next figure shows sleepers of the 3D model.";
    }
    let names = Names { id: "hanging_sleeper", title: "Sleeper and ballast during a passage", caption: &caption };
    panels(&names, &charts, chosen.len())
}

/// The recorded sleeper with the largest void at the last count, and the one farthest from every transition.
fn chosen(run: &Run) -> Vec<String> {
    let recorded = seats(run, Response::ContactForce);
    let last = run.sleepers.iter().map(|row| row.axles).max();
    let at_last = |name: &str| run.sleepers.iter().find(|row| Some(row.axles) == last && row.sleeper == name);
    let rows: Vec<&SleeperRow> = recorded.iter().filter_map(|(name, _)| at_last(name)).collect();
    let distance = |row: &SleeperRow| {
        let distances = run.scenario.track.transitions.iter().map(|transition| (transition.x - row.x_m).abs());
        distances.fold(f64::INFINITY, f64::min)
    };
    let voided = rows.iter().max_by(|a, b| {
        a.void_m
            .total_cmp(&b.void_m)
            .then(a.contact_loss_s.total_cmp(&b.contact_loss_s))
            .then(distance(b).total_cmp(&distance(a)))
    });
    let far = rows.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
    let mut names: Vec<String> = voided.into_iter().chain(far).map(|row| row.sleeper.clone()).collect();
    names.dedup();
    names
}

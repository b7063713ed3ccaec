//! What happens in time while a train passes: wheel forces over the wheel's place, and the histories asked for.

use super::Figure;
use super::along::{figure, track_chart};
use super::chart::{Axis, Band, Chart, Mark, Series};
use super::counts::{self, Count};
use super::number::{shown_unit, significant};
use super::scene::WIDTH;
use super::svg::{Frame, Svg};
use crate::results::{HistoryRow, Run, static_wheel_load};
use crate::scenario::response::{Place, Response};

const PANEL_HEIGHT: f64 = 230.0;

/// Wheel-rail force against the wheel's chainage: the leading wheel at every count, the next three at the last one.
pub fn wheel_force(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Wheel\u{2013}rail force", "N", false);
    let counts = counts::shown(run);
    let rows = |axles: u64, wheel: &str| -> Vec<(f64, f64)> {
        let rows = run.histories.iter().filter(|h| h.quantity == "wheel_force" && h.id == wheel && h.axles == axles);
        rows.map(|h| (h.x_m, h.value)).collect()
    };
    if let Some(last) = counts.last() {
        for wheel in ["wheel 2", "wheel 3", "wheel 4"] {
            chart.series.push(Series::new(wheel, &last.class, Mark::Faint, rows(last.axles, wheel)));
        }
    }
    for count in &counts {
        let points = rows(count.axles, "wheel 1");
        if !points.is_empty() {
            chart.series.push(Series::new(&count.name, &count.class, Mark::Line, points));
        }
    }
    if let Some(load) = static_wheel_load(&run.scenario) {
        chart.levels = vec![(load, format!("static {} kN", significant(load / 1e3, 3)))];
    }
    let caption = "Force of the leading wheel on the rail where the wheel stands, per wheel; thin lines are the next \
                   three wheels at the last count.";
    figure(&chart, "wheel_force", "Wheel\u{2013}rail force along the track", caption)
}

/// One figure a quantity, one panel a seat; shaded while the sleeper has lost its ballast at the last count.
pub fn histories(run: &Run) -> Vec<Figure> {
    Response::ALL.iter().filter_map(|response| history(run, *response)).collect()
}

fn history(run: &Run, response: Response) -> Option<Figure> {
    if response == Response::WheelForce || response == Response::Settlement || response.place() == Place::Scene {
        return None;
    }
    let rows: Vec<&HistoryRow> =
        run.histories.iter().filter(|h| h.quantity == response.name() && h.id != "rail").collect();
    let mut seats: Vec<(&str, f64)> = rows.iter().map(|h| (h.id.as_str(), h.x_m)).collect();
    seats.sort_by(|a, b| a.1.total_cmp(&b.1));
    seats.dedup_by(|a, b| a.0 == b.0);
    let counts = counts::shown(run);
    let limits = (
        rows.iter().map(|h| h.time_s).fold(f64::INFINITY, f64::min),
        rows.iter().map(|h| h.time_s).fold(f64::NEG_INFINITY, f64::max),
    );
    if seats.is_empty() || counts.is_empty() || limits.1 <= limits.0 {
        return None;
    }
    let mut svg = Svg::default();
    let columns = if seats.len() == 1 { 1 } else { 2 };
    let width = WIDTH / columns as f64;
    for (index, (seat, _)) in seats.iter().enumerate() {
        let frame = Frame {
            x: (index % columns) as f64 * width,
            y: (index / columns) as f64 * (PANEL_HEIGHT + 14.0),
            width,
            height: PANEL_HEIGHT,
        };
        let chart = panel(&rows, response, seat, limits, &counts, lost(run, seat, &counts));
        let id = format!("plane-{}-{index}", response.name());
        chart.draw(&mut svg, &id, frame);
    }
    let height = seats.len().div_ceil(columns) as f64 * (PANEL_HEIGHT + 14.0);
    let title = title(response);
    let lost_any = seats.iter().any(|(seat, _)| !lost(run, seat, &counts).is_empty());
    let mut caption = "During one passage, per seat; the clock starts with the passage.".to_owned();
    if lost_any {
        caption += " Shaded while the sleeper has no contact with its support at the last count.";
    }
    let id = format!("history_{}", response.name());
    Some(Figure { svg: svg.finish(WIDTH, height, &title), id, title, caption })
}

fn panel(
    rows: &[&HistoryRow],
    response: Response,
    seat: &str,
    limits: (f64, f64),
    counts: &[Count],
    lost: Vec<Band>,
) -> Chart {
    let name = format!("Seat {}", seat.replace('-', "\u{2212}"));
    let mut y = Axis::new(&name, shown_unit(response.unit()));
    y.downwards = matches!(response, Response::RailDisplacement | Response::SleeperDisplacement | Response::RailLevel);
    let mut chart = Chart::new(Axis { range: Some(limits), ..Axis::new("Time", ("s", 1.0)) }, y);
    chart.bands = lost;
    // One scale for all panels, so that they can be compared.
    let values = || rows.iter().map(|h| h.value).filter(|value| value.is_finite());
    let all = Series::new("", "", Mark::Line, values().map(|value| (limits.0, value)).collect());
    chart.y.range = Some(chart.y_extent(&all, PANEL_HEIGHT - 70.0));
    for count in counts {
        let points: Vec<(f64, f64)> =
            rows.iter().filter(|h| h.id == seat && h.axles == count.axles).map(|h| (h.time_s, h.value)).collect();
        if !points.is_empty() {
            let name = count.name.trim_start_matches("after ").trim_end_matches(" axles");
            chart.series.push(Series::new(name, &count.class, Mark::Line, points));
        }
    }
    chart
}

/// When the seat's contact force was zero at the last count.
fn lost(run: &Run, seat: &str, counts: &[Count]) -> Vec<Band> {
    let Some(last) = counts.last() else { return vec![] };
    let samples: Vec<(f64, f64)> = run
        .histories
        .iter()
        .filter(|h| h.quantity == "contact_force" && h.id == seat && h.axles == last.axles)
        .map(|h| (h.time_s, h.value))
        .collect();
    let pieces = samples.chunk_by(|a, b| (a.1 <= 0.0) == (b.1 <= 0.0));
    let bands = pieces.filter(|piece| piece[0].1 <= 0.0).map(|piece| Band {
        from: piece[0].0,
        to: piece[piece.len() - 1].0,
        label: String::new(),
        class: "lost",
    });
    bands.collect()
}

/// `rail_seat_load` as `Rail seat load`.
fn title(response: Response) -> String {
    let words = response.name().replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

//! A train on the drawing: wheels and bogies where a passage starts, the car body as a symbol.

use super::number::plain;
use super::svg::{Anchor, Frame, Svg};
use super::symbols::draw_spring;
use super::view::View;
use crate::scenario::{Direction, Scenario, Traffic, Vehicle};

/// Heights above the rail's top, m: floor and roof of the car body.
const FLOOR: f64 = 1.25;
const ROOF: f64 = 3.6;

/// Draws every vehicle of the train that stands on the view.
pub(super) fn draw_train(svg: &mut Svg, scenario: &Scenario, traffic: &Traffic, view: &View) {
    let train = &traffic.train;
    let forwards = train.direction != Direction::Backward;
    let sign = if forwards { -1.0 } else { 1.0 };
    let lead = scenario.solve.start.map_or_else(
        || {
            let reach = (train.wheel_base() + 2.0).min(0.92 * (view.end - view.start));
            if forwards { view.start + reach } else { view.end - reach }
        },
        |start| *start,
    );
    for (vehicle, offset) in train.vehicles.iter().zip(train.vehicle_offsets()) {
        let first = lead + sign * offset;
        let reach = vehicle.wheel_offsets()[3];
        let (left, right) = (first.min(first + sign * reach), first.max(first + sign * reach));
        if right > view.start && left < view.end {
            draw_vehicle(svg, view, vehicle, first, sign);
        }
    }
    let mut text =
        format!("{}, {} km/h", train.vehicles.first().map_or("", |v| v.name.as_str()), plain(*train.speed * 3.6, 3));
    if let Some(start) = scenario.solve.start {
        text += &format!("; the leading wheel starts at {} m", plain(*start, 3));
    }
    svg.text("small muted", (view.x(view.end), 16.0), Anchor::End, &text);
    let nose = lead - sign * train.vehicles.first().map_or(0.0, |v| (body_length(v) - v.wheel_offsets()[3]) / 2.0);
    let (tip, tail) = (view.x(nose) - sign * 32.0, view.x(nose) - sign * 8.0);
    let y = view.y(-0.5 * ROOF);
    svg.path("push", &[(tail, y), (tip, y)], false, "");
    svg.path("push", &[(tip + sign * 7.0, y - 4.5), (tip, y), (tip + sign * 7.0, y + 4.5)], false, "");
}

fn draw_vehicle(svg: &mut Svg, view: &View, vehicle: &Vehicle, first: f64, sign: f64) {
    let wheels = vehicle.wheel_offsets().map(|offset| first + sign * offset);
    let base = vehicle.wheel_offsets()[3];
    let length = body_length(vehicle);
    let centre = first + sign * base / 2.0;
    svg.rect("body", area(view, centre - length / 2.0, centre + length / 2.0, ROOF, FLOOR));
    let radius = vehicle.wheel_radius;
    for pair in [[0, 1], [2, 3]] {
        let (left, right) = (wheels[pair[0]].min(wheels[pair[1]]), wheels[pair[0]].max(wheels[pair[1]]));
        let middle = (left + right) / 2.0;
        let beam = (radius + 0.22, radius - 0.02);
        draw_spring(svg, (view.x(middle), view.y(-FLOOR)), view.y(-beam.0), (0.22 * view.scale).max(2.0));
        svg.rect("steel", area(view, left - 0.3, right + 0.3, beam.0, beam.1));
        for wheel in pair {
            let r = radius * view.scale;
            svg.circle("wheel", (view.x(wheels[wheel]), view.y(-radius)), r, "");
            svg.circle("steel", (view.x(wheels[wheel]), view.y(-radius)), (0.18 * r).max(1.0), "");
        }
    }
}

/// The car body ends a little before the couplers do, m.
fn body_length(vehicle: &Vehicle) -> f64 {
    vehicle.length.map_or(vehicle.wheel_offsets()[3] + 2.6, |length| *length - 0.8)
}

/// A box between two chainages and two heights above the rail's top, m; the view's clip cuts what sticks out.
fn area(view: &View, left: f64, right: f64, top: f64, bottom: f64) -> Frame {
    Frame { x: view.x(left), y: view.y(-top), width: (right - left) * view.scale, height: (top - bottom) * view.scale }
}

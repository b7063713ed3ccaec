//! Scenes that are hard for the methods: each is run with the scene's own numerics and again at a quarter of its step.

use super::variant::{Case, METHODS, Prepared, Variant};
use super::verdict::{Foreseen, Verdict, check, judge, refused};
use super::void::{Void, middle};
use crate::graph::Train;
use crate::lint::Winkler;
use crate::lower::{self, with_stated_supports};
use crate::scenario::{self, Foot, Given, Integrator, Loading, RailEnds, Scenario, TimeStep, Track};
use crate::units::number;
use serde::Serialize;

/// One hard scene and how it ended.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stress {
    pub name: String,
    pub verdict: Verdict,
    /// Largest wheel force over the static one, where the passage came to its end.
    pub wheel_force: Option<f64>,
    /// Seats whose sleepers lost contact at some time.
    pub losing_contact: Option<usize>,
    /// Physics rules that report something before the run.
    pub warnings: Vec<&'static str>,
    /// Whether the error is what the energy of a free vibration seems to gain.
    pub energy: bool,
}

impl Stress {
    /// The result in one line.
    pub fn told(&self) -> String {
        match &self.verdict {
            Verdict::Stable { error } if self.energy => {
                format!("its energy grows by at most {} %", number((error * 1e4).round() / 1e2))
            }
            verdict => verdict.told(),
        }
    }
}

/// A scene under change.
struct Hard {
    name: String,
    scenario: Scenario,
    settlement: Vec<f64>,
    /// Distance of the outermost wheels from the ends of the model, where the plan is not asked, m.
    margin: Option<f64>,
    method: Option<Integrator>,
}

/// Apparent energy gain of undamped free vibration that is accepted, as a share: the effect of one step during an
/// impact.
const ENERGY: f64 = 0.01;
/// Steps of free vibration.
const FREE_STEPS: usize = 2000;

pub(super) fn stresses(scenario: &Scenario, tick: &mut dyn FnMut()) -> Vec<Stress> {
    let mut rows: Vec<Stress> = Vec::new();
    for hard in list(scenario) {
        rows.push(passage(&hard));
        tick();
    }
    for method in METHODS {
        for coarser in [1.0, 4.0] {
            rows.extend(free_vibration(scenario, method, coarser));
        }
        tick();
    }
    rows
}

fn list(scenario: &Scenario) -> Vec<Hard> {
    // those that change supports change numbers
    let scenario = &with_stated_supports(scenario);
    let (track, known) = (&scenario.track, lower::supports(scenario));
    let even = vec![0.0; track.seats.len()];
    let hard = |name: &str, change: &dyn Fn(&mut Scenario)| {
        let mut scenario = scenario.clone();
        change(&mut scenario);
        Hard { name: name.into(), scenario, settlement: even.clone(), margin: None, method: None }
    };
    let settled = |name: &str, settlement: Vec<f64>| Hard { settlement, ..hard(name, &|_| {}) };
    let void = |depth: f64, sleepers: Option<usize>| Void { depth, sleepers }.settlement(track);
    let speed = |factor: f64| move |s: &mut Scenario| of_train(s, |t| t.speed.value = factor);
    let critical = (0..track.sections.len())
        .filter_map(|i| Some(Winkler::of_section(track, &known, i)?.critical_speed()))
        .fold(f64::INFINITY, f64::min);

    let mut list = vec![
        hard("the scene as it is", &|_| {}),
        settled("all sleepers but the outermost hang by 20 mm", {
            // those hold the clamped end of the rail at its level
            let mut all = void(20e-3, None);
            let outermost = (0..all.len()).filter(|i| *i == 0 || i + 1 == all.len());
            outermost.collect::<Vec<_>>().into_iter().for_each(|i| all[i] = 0.0);
            all
        }),
        settled("three sleepers hang by 1 mm", void(1e-3, Some(3))),
        settled("one sleeper hangs by 20 mm", void(20e-3, Some(1))),
        settled("every second sleeper hangs by 1 mm", {
            (0..track.seats.len())
                .map(|i| if i % 2 == 0 && track.seats[i].is_ballasted() { 1e-3 } else { 0.0 })
                .collect()
        }),
        settled("a settlement step of 0.05 mm", void(0.05e-3, None)),
        settled("a settlement step of 20 mm", void(20e-3, None)),
        hard("no damping anywhere", &undamp),
        Hard { settlement: void(1e-3, Some(3)), ..hard("no damping, three sleepers hang by 1 mm", &undamp) },
        hard("300 km/h", &speed(300.0 / 3.6)),
        Hard { settlement: void(1e-3, Some(3)), ..hard("300 km/h, three sleepers hang by 1 mm", &speed(300.0 / 3.6)) },
    ];
    for share in [0.95, 1.0, 1.05] {
        if critical.is_finite() {
            list.push(hard(&format!("{:.0} % of the critical speed", 100.0 * share), &speed(share * critical)));
        }
    }
    list.extend([
        hard("a slab 1000 times stiffer", &|s| {
            for slab in s.track.sections.iter_mut().filter_map(|section| section.slab.as_mut()) {
                slab.bending_stiffness.value *= 1e3;
                slab.foundation_stiffness.value *= 1e3;
            }
        }),
        hard("supports 1000 times stiffer", &|s| supports(s, 1e3)),
        hard("supports 1000 times softer", &|s| supports(s, 1e-3)),
        Hard { margin: Some(0.01), ..hard("wheels 10 mm from the ends of the model", &|_| {}) },
        Hard { margin: Some(0.01), ..hard("the same, rail ends free", &|s| s.track.rail_ends = RailEnds::Free) },
        hard("no gravity", &|s| s.solve.gravity.value = 0.0),
        hard("a contact 100 times stiffer", &|s| {
            of_train(s, |t| t.vehicles.iter_mut().for_each(|v| v.hertz.value *= 100.0))
        }),
        hard("one element a bay", &|s| s.solve.elements_per_bay.value = 1),
        Hard {
            method: Some(Integrator::Newmark),
            settlement: void(1e-3, Some(3)),
            ..hard("newmark without damping, three hang by 1 mm", &undamp)
        },
        hard("a step of one element's transit", &|s| coarsest(s, 1.0)),
        hard("a step of two elements' transit", &|s| coarsest(s, 2.0)),
    ]);
    list
}

fn of_train(scenario: &mut Scenario, change: impl Fn(&mut scenario::Train)) {
    if let Some(Loading::Traffic(traffic)) = &mut scenario.loading {
        change(&mut traffic.train);
    }
}

fn undamp(scenario: &mut Scenario) {
    for seat in &mut scenario.track.seats {
        if let Some(pad) = &mut seat.pad {
            pad.damping.value = 0.0;
        }
        if let Foot::Sleeper { support: Some(support), .. } = &mut seat.foot {
            support.damping.value = 0.0;
        }
    }
    for slab in scenario.track.sections.iter_mut().filter_map(|section| section.slab.as_mut()) {
        slab.foundation_damping.value = 0.0;
    }
    of_train(scenario, |train| {
        for vehicle in &mut train.vehicles {
            vehicle.primary_damping.value = 0.0;
            vehicle.secondary_damping.value = 0.0;
        }
    });
}

fn supports(scenario: &mut Scenario, factor: f64) {
    for seat in &mut scenario.track.seats {
        if let Foot::Sleeper { support: Some(support), .. } = &mut seat.foot {
            support.stiffness.value *= factor;
        }
    }
}

fn coarsest(scenario: &mut Scenario, transits: f64) {
    let spacing = scenario.track.shortest_bay();
    let Some(Loading::Traffic(traffic)) = &scenario.loading else { return };
    let transit = spacing / f64::from(*scenario.solve.elements_per_bay) / *traffic.train.speed;
    scenario.solve.time_step = TimeStep::Fixed(Given::derived(transit * transits * (1.0 - 1e-9)));
}

fn passage(hard: &Hard) -> Stress {
    let (planned, foreseen, warnings) = check(&hard.scenario);
    let row = |verdict| Stress {
        name: hard.name.clone(),
        verdict,
        wheel_force: None,
        losing_contact: None,
        warnings: warnings.clone(),
        energy: false,
    };
    if let Foreseen::Refused(code, message) = foreseen {
        return row(Verdict::Refused { code, message });
    }
    let Some(planned) = &planned else {
        return row(Verdict::Wrong { why: "the scene has no passage".into() });
    };
    let mut case = Case::planned(planned, hard.settlement.clone());
    if let Some(margin) = hard.margin {
        (case.left, case.right) = (case.node.ends()[0] + margin, case.node.ends()[1] - margin);
    }
    let case = case.aligned(planned.blocks.passage.time_step);
    let own = Variant::planned(planned).even();
    let own = Variant { method: hard.method.unwrap_or(own.method), ..own };
    let run = |time_step: f64| {
        let prepared = Prepared::new(&planned.node, &planned.responses, Variant { time_step, ..own }, own.time_step)?;
        prepared.run(&case).map_err(|failure| failure.cause)
    };
    match (run(own.time_step), run(own.time_step / 4.0)) {
        (Err(cause), _) => row(refused(&cause, planned)),
        (Ok(_), Err(cause)) => row(Verdict::Wrong { why: format!("stops at a quarter of the step: {cause}") }),
        (Ok(measured), Ok(fine)) => {
            let weight = case.static_wheel_force();
            Stress {
                wheel_force: (weight > 0.0).then(|| measured.wheel_peak / weight),
                losing_contact: Some(measured.contact_losses.iter().filter(|loss| **loss > 0.0).count()),
                ..row(judge(&measured, &fine, weight.max(1.0), foreseen.warning()))
            }
        }
    }
}

/// The track without any damping springs back after the train load is removed, with three hanging sleepers; its energy
/// must not grow.
fn free_vibration(scenario: &Scenario, method: Integrator, coarser: f64) -> Option<Stress> {
    let mut scenario = scenario.clone();
    undamp(&mut scenario);
    let (planned, ..) = check(&scenario);
    let planned = &planned?;
    let case = Case::planned(planned, Void { depth: 1e-3, sleepers: Some(3) }.settlement(&scenario.track));
    let own = Variant::planned(planned).even();
    let time_step = coarser * own.time_step;
    scenario.solve.time_step = TimeStep::Fixed(Given::derived(time_step));
    let (_, foreseen, warnings) = check(&scenario);
    let wheels = wheels_at(&scenario.track, &case.train);
    let pressed: Vec<(f64, f64)> = wheels.into_iter().map(|x| (x, case.static_wheel_force())).collect();
    let verdict =
        match Prepared::new(&planned.node, &planned.responses, Variant { method, time_step, ..own }, time_step)
            .and_then(|prepared| prepared.free_vibration(&case, &pressed, FREE_STEPS))
        {
            Err(cause) => refused(&cause, planned),
            Ok(ratio) if ratio <= 1.0 + ENERGY => Verdict::Stable { error: (ratio - 1.0).max(0.0) },
            Ok(ratio) => match foreseen.warning() {
                Some(code) => Verdict::Coarse { error: ratio - 1.0, code },
                None => Verdict::Wrong { why: format!("the energy grows to {ratio:.2} times its initial value") },
            },
        };
    let name = format!("let go without damping: {method}, {} ms", number(time_step * 1e3));
    Some(Stress { name, verdict, wheel_force: None, losing_contact: None, warnings, energy: true })
}

/// Wheels of a train that stands over the transition, those that fit on the track.
fn wheels_at(track: &Track, train: &Train) -> Vec<f64> {
    let leading = middle(track) + 1.0;
    let wheels = train.vehicles.iter().flat_map(|(v, offset)| v.wheel_offsets().map(|wheel| leading - offset - wheel));
    wheels.filter(|x| (track.start()..track.end()).contains(x)).collect()
}

//! Made-up runs for the tests of files, scalars and pages: the shape of real ones without a solver.

use super::*;
use crate::diag::{FileId, Span};
use crate::scenario::response::{Expectation, Expression, Measure, Reduction, Response};
use crate::scenario::*;
use crate::solvers::foundation::Method;
use crate::solvers::settlement::{CyclePer, Form, Law, Varandas};
use crate::syntax::tree::Comparison;

fn given<T>(value: T) -> Given<T> {
    Given::derived(value)
}

fn rail() -> Rail {
    Rail {
        mass: given(60.0),
        bending_stiffness: given(6.4e6),
        shear_stiffness: None,
        rotary_inertia: 0.24,
        height: 0.172,
    }
}

fn pad() -> Pad {
    Pad { stiffness: given(40e6), damping: given(5e3) }
}

fn solve() -> Solve {
    let form = Form::Varandas(Varandas { gamma: 4.9e-9, reference_cycles: 1.0, ..Varandas::default() });
    let law = Law { form, cycle_per: CyclePer::Axle };
    Solve {
        law: SettlementLaw {
            name: "varandas".to_owned(),
            law,
            loads: None,
            cycles: None,
            voids: None,
            error: None,
            origin: Origin::Default,
        },
        other_laws: vec![],
        update: Update::Fixed { axles: 20 },
        update_span: None,
        support_method: Method::StressCone,
        integrator: Integrator::GeneralisedAlpha { rho: 0.9 },
        beam: given(Beam::Euler),
        elements_per_bay: given(4),
        time_step: TimeStep::Fixed(given(5e-5)),
        start: Some(given(-25.0)),
        finish: None,
        gravity: given(9.81),
        seed: 1,
        grains: Grains::default(),
    }
}

fn vehicle() -> Vehicle {
    Vehicle {
        name: "freight_wagon".to_owned(),
        car_body_mass: given(36e3),
        car_body_pitch_inertia: given(1e6),
        bogie_mass: given(1.0e3),
        bogie_pitch_inertia: given(1.5e3),
        bogie_spacing: given(9.0),
        wheel_mass: given(0.5e3),
        wheelset_spacing: given(1.8),
        wheel_radius: 0.46,
        primary_stiffness: given(2e6),
        primary_damping: given(2e4),
        secondary_stiffness: given(5e5),
        secondary_damping: given(2e4),
        hertz: given(1e11),
        length: Some(given(14.0)),
    }
}

fn sleeper() -> SleeperBody {
    SleeperBody { length: 2.6, base_width: 0.3, height: 0.2, base_area: 2.6 * 0.3, seat_distance: 1.5 }
}

/// Ballast of 69 sleepers meeting a slab of 40 seats under 125 wagons: a dip of 3 mm over a uniform 1.2 mm.
pub(crate) fn transition() -> Run {
    let section = |name: &str, start, end, slab| Section {
        name: name.to_owned(),
        start,
        end,
        rail: Some(rail()),
        spacing: given(0.6),
        slab,
        layers: vec![],
        layers_span: None,
        crib: None,
        length_origin: Origin::Default,
    };
    let slab = Slab {
        bending_stiffness: given(7e7),
        mass: given(900.0),
        foundation_stiffness: given(1e8),
        foundation_damping: given(1e5),
    };
    let support = Support { stiffness: given(40e6), damping: given(4e4), seating: None };
    let ballast = Foot::Sleeper { mass: given(150.0), support: Some(support), usp: None, law: None };
    let seat = |number: i32| Seat {
        number,
        transition: 0,
        x: if number < 0 { 0.6 * number as f64 } else { 0.6 * (number - 1) as f64 },
        section: usize::from(number > 0),
        pad: Some(pad()),
        foot: if number < 0 { ballast.clone() } else { Foot::Slab },
        sleeper: (number < 0).then(sleeper),
        initial_settlement: Given::derived(0.0),
        stack: None,
    };
    let expectation = |text: &str, low: f64, high: f64, reduction, response, unit: (&str, f64)| Expectation {
        text: text.to_owned(),
        span: Span::new(FileId(0), 0, 1),
        operands: vec![
            Expression::Number(low),
            Expression::Measure(Measure::new(reduction, response)),
            Expression::Number(high),
        ],
        operators: vec![Comparison::Less, Comparison::Less],
        unit: (unit.0.to_owned(), unit.1),
    };
    let scenario = Scenario {
        title: "Ballast meets slab: 125 wagons at 200 km/h".to_owned(),
        track: Track {
            name: "line".to_owned(),
            sections: vec![section("ballasted", -42.0, 0.0, None), section("slab_track", 0.0, 24.0, Some(slab))],
            transitions: vec![Transition { name: String::new(), x: 0.0, side: Side::SoftToStiff }],
            seats: (-69..=40).filter(|n| *n != 0).map(seat).collect(),
            auxiliary_rails: vec![],
            stretches: vec![],
            groundworks: vec![],
            rail_ends: RailEnds::Clamped,
            irregularity: None,
            bed: Bed::default(),
        },
        loading: Some(Loading::Traffic(Traffic {
            train: Train {
                name: "wagon".to_owned(),
                vehicles: vec![vehicle()],
                speed: given(200.0 / 3.6),
                speed_profile: None,
                direction: Direction::Forward,
            },
            others: vec![],
            counts: vec![125],
            order: Order::Interleaved,
            total: given(500),
        })),
        tampings: vec![],
        solve: solve(),
        records: vec![],
        volumes: vec![],
        expectations: vec![
            expectation(
                "-5 m < place_of_max(settlement) < -2.5 m",
                -5.0,
                -2.5,
                Reduction::PlaceOfMax,
                Response::Settlement,
                ("m", 1.0),
            ),
            expectation("0 mm < max(settlement) < 3 mm", 0.0, 3e-3, Reduction::Max, Response::Settlement, ("mm", 1e-3)),
        ],
        allow: vec![],
        deny: vec![],
        warn: vec![],
        library: vec![],
    };
    filled(scenario)
}

const COUNTS: [u64; 3] = [0, 100, 500];

/// Share of the final settlement that `axles` have made.
fn progress(axles: u64) -> f64 {
    (axles as f64 / 500.0).powf(0.35)
}

fn dip(x: f64) -> f64 {
    if x < -0.1 { 1.8e-3 * (-((x + 3.0) / 1.7).powi(2)).exp() } else { 0.0 }
}

fn settlement(x: f64, axles: u64) -> f64 {
    if x < -0.1 { progress(axles) * (1.2e-3 + dip(x)) } else { 0.0 }
}

/// How strongly the passage at x is disturbed by the transition.
fn disturbance(x: f64, axles: u64) -> f64 {
    let decay = if x < 0.0 { (x / 4.0).exp() } else { (-x / 2.5).exp() };
    decay * (0.15 + 0.85 * progress(axles)) * (2.1 * x).sin()
}

/// The passage of a wagon with 98.1 kN per wheel and this largest wheel force, N.
fn train_row(axles: u64, largest: f64) -> TrainRow {
    TrainRow {
        axles,
        train: "ore".into(),
        passed: axles / 4,
        static_wheel_load_N: 98.1e3,
        max_wheel_force_N: largest,
        min_wheel_force_N: 2.0 * 98.1e3 - largest,
        max_rail_seat_load_N: 0.42 * largest,
        max_contact_force_N: 0.4 * largest,
        max_rail_moment_N_m: 21.3e3,
        dynamic_amplification: largest / 98.1e3,
        wheel_unloading: largest / 98.1e3 - 1.0,
    }
}

fn filled(scenario: Scenario) -> Run {
    let (mut sleepers, mut histories, mut blocks, mut rail) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for axles in COUNTS {
        for seat in &scenario.track.seats {
            let name = scenario.track.seat_name(seat);
            let near = disturbance(seat.x, axles);
            let lifted = seat.is_ballasted() && seat.x > -2.5 && axles > 0;
            let contact = if seat.is_ballasted() { 32e3 * (1.0 + near) } else { 0.0 };
            let gravity = if lifted { 0.0 } else { 1.82e3 * (1.0 + 1.4 * near.abs()) };
            sleepers.push(SleeperRow {
                axles,
                sleeper: name,
                x_m: seat.x,
                settlement_m: settlement(seat.x, axles),
                void_m: if lifted { progress(axles) * 0.8e-3 * (seat.x + 3.0) / 3.0 } else { 0.0 },
                gravity_contact_force_N: if seat.is_ballasted() { gravity } else { 0.0 },
                max_contact_force_N: contact,
                max_rail_seat_load_N: if seat.is_ballasted() { 36e3 } else { 41e3 } * (1.0 + 0.7 * near),
                max_sleeper_displacement_m: if seat.is_ballasted() { 0.8e-3 * (1.0 + near.abs()) } else { 0.0 },
                support_stiffness_N_per_m: if seat.is_ballasted() { 40e6 } else { 0.0 },
                contact_loss_s: if lifted { 0.04 } else { 0.0 },
                trains_passing: 1,
            });
        }
        fill_passage(axles, &mut histories);
        rail.extend((0..=432).map(|k| rail_row(axles, -41.4 + 0.15 * f64::from(k))));
        for k in 0..=660 {
            let x = -42.0 + 0.1 * k as f64;
            let level = settlement(x, axles) * if x > -1.2 { 0.6 } else { 1.0 } + 0.2e-3;
            push(&mut histories, axles, 0.0, ("rail_level", "rail"), x, level);
        }
    }
    for axles in (0..=500).step_by(20) {
        let worst = 98.1e3 * (1.0 + 0.09 + 0.25 * progress(axles));
        let step = settlement(-3.0, axles + 20) - settlement(-3.0, axles);
        let block_axles = if axles < 500 { 20 } else { 0 };
        blocks.push(BlockRow {
            axles,
            block_axles,
            max_wheel_force_N: worst,
            min_wheel_force_N: 2.0 * 98.1e3 - worst,
            max_rail_seat_load_N: 0.42 * worst,
            max_contact_force_N: 0.4 * worst,
            max_settlement_m: settlement(-3.0, axles + block_axles),
            max_settlement_step_m: if block_axles > 0 { step } else { 0.0 },
            error_m: step / 50.0,
            overshoot: 0.2,
            sawtooth: 0.0,
            unevenness: 0.02,
            rejected: 0,
            overshot: 0,
            passages: 2,
            time_steps: 15_000,
            newton_iterations: 32_100 + axles,
            bonds: 0,
            broken_bonds: 0,
        });
        for seat in &scenario.track.seats {
            if seat.is_ballasted() {
                let name = scenario.track.seat_name(seat);
                let value = settlement(seat.x, axles);
                push(&mut histories, axles, 0.0, ("settlement", &name), seat.x, value);
            }
        }
    }
    let maxima = RailMaxima {
        moment: Some(21.3e3),
        foot_stress: Some(60e6),
        ..RailMaxima::from_profile(&scenario, &rail, |_| true)
    };
    Run { rail, ..finished(scenario, sleepers, blocks, histories, maxima) }
}

/// A rail that is stiffer over sleepers and over the slab.
fn rail_row(axles: u64, x: f64) -> RailRow {
    let over_sleepers = 1.0 + 0.01 * (std::f64::consts::TAU * x / 0.6).cos();
    RailRow {
        axles,
        x_m: x,
        level_m: settlement(x, axles) + 0.2e-3,
        moment_N_m: -2e3 * disturbance(x, axles),
        stiffness_N_per_m: if x < 0.0 { 66e6 } else { 80e6 } * over_sleepers,
        max_moment_N_m: 20e3 * (1.0 + 0.1 * disturbance(x, axles)),
        min_moment_N_m: -5e3,
        max_displacement_m: 1.2e-3 * over_sleepers,
        min_displacement_m: -0.05e-3,
    }
}

/// One passage at 200 km/h, sampled every 0.5 ms.
fn fill_passage(axles: u64, histories: &mut Vec<HistoryRow>) {
    let seats = [("-13", -7.8), ("-3", -1.8), ("+7", 3.6)];
    let wheels = [0.0, 1.8, 9.0, 10.8];
    for step in 0..1700 {
        let time = 5e-4 * step as f64;
        let lead = -25.0 + 200.0 / 3.6 * time;
        for (wheel, offset) in wheels.iter().enumerate() {
            let x = lead - offset;
            let ripple = 600.0 * (std::f64::consts::TAU * x / 0.6).sin();
            let force = 98.1e3 * (1.0 + 0.35 * disturbance(x, axles)) + ripple;
            push(histories, axles, time, ("wheel_force", &format!("wheel {}", wheel + 1)), x, force);
        }
        for (name, x) in seats {
            let bowl = |x: f64| (-(x / 0.9).powi(2)).exp() - 0.08 * (-((x.abs() - 2.2) / 0.7).powi(2)).exp();
            let under: f64 = wheels.iter().map(|offset| bowl(lead - offset - x)).sum();
            let hanging = name == "-3" && axles > 0;
            let peak = if hanging { 45e3 } else { 34e3 };
            let contact = (peak * under + if hanging { -500.0 } else { 1.8e3 }).max(0.0);
            push(histories, axles, time, ("rail_seat_load", name), x, peak * under);
            push(histories, axles, time, ("rail_displacement", name), x, 1.1e-3 * under);
            if x < 0.0 {
                push(histories, axles, time, ("contact_force", name), x, contact);
            }
        }
    }
}

/// A static check: 20 seats that do not move, 100 kN over the tenth.
pub(crate) fn bench() -> Run {
    let seats: Vec<Seat> = (1..=20)
        .map(|number| Seat {
            number,
            transition: 0,
            x: 0.6 * (f64::from(number) - 0.5),
            section: 0,
            pad: Some(pad()),
            foot: Foot::Rigid,
            sleeper: Some(sleeper()),
            initial_settlement: Given::derived(0.0),
            stack: None,
        })
        .collect();
    let load = seats[9].x;
    let scenario = Scenario {
        title: "Static check: 100 kN on 20 seats".to_owned(),
        track: Track {
            name: "bench".to_owned(),
            sections: vec![Section {
                name: "seats".to_owned(),
                start: 0.0,
                end: 12.0,
                rail: Some(rail()),
                spacing: given(0.6),
                slab: None,
                layers: vec![],
                layers_span: None,
                crib: None,
                length_origin: Origin::Default,
            }],
            transitions: vec![],
            seats,
            auxiliary_rails: vec![],
            stretches: vec![],
            groundworks: vec![],
            rail_ends: RailEnds::Free,
            irregularity: None,
            bed: Bed::default(),
        },
        tampings: vec![],
        loading: Some(Loading::Static(vec![StaticLoad {
            name: "jack".to_owned(),
            span: Span::new(FileId(0), 0, 1),
            on: Target::Rail,
            x: load,
            force: given(100e3),
        }])),
        solve: Solve { gravity: given(0.0), start: None, ..solve() },
        records: vec![],
        volumes: vec![],
        expectations: vec![],
        allow: vec![],
        deny: vec![],
        warn: vec![],
        library: vec![],
    };
    // The beam on a Winkler foundation: w = w0 e^(-bx) (cos bx + sin bx), M = M0 e^(-bx) (cos bx - sin bx).
    let winkler = |x: f64, sign: f64| {
        let z = 1.2703 * (x - load).abs();
        (-z).exp() * (z.cos() + sign * z.sin())
    };
    let row = |seat: &Seat| SleeperRow {
        axles: 0,
        sleeper: scenario.track.seat_name(seat),
        x_m: seat.x,
        settlement_m: 0.0,
        void_m: 0.0,
        gravity_contact_force_N: 0.0,
        max_contact_force_N: 0.0,
        max_rail_seat_load_N: 38e3 * winkler(seat.x, 1.0),
        max_sleeper_displacement_m: 0.0,
        support_stiffness_N_per_m: 0.0,
        contact_loss_s: 0.0,
        trains_passing: 1,
    };
    let sleepers = scenario.track.seats.iter().map(row).collect();
    let mut histories = Vec::new();
    for k in 0..=80 {
        let x = 0.15 * f64::from(k);
        push(&mut histories, 0, 0.0, ("rail_displacement", "rail"), x, 0.9498e-3 * winkler(x, 1.0));
        push(&mut histories, 0, 0.0, ("rail_moment", "rail"), x, 17.66e3 * winkler(x, -1.0));
    }
    let rail = RailMaxima { moment: Some(17.66e3), displacement: Some(0.9498e-3), ..RailMaxima::default() };
    finished(scenario, sleepers, vec![], histories, rail)
}

fn push(rows: &mut Vec<HistoryRow>, axles: u64, time_s: f64, what: (&str, &str), x_m: f64, value: f64) {
    rows.push(HistoryRow {
        axles,
        time_s,
        quantity: what.0.into(),
        id: what.1.into(),
        x_m,
        value,
        train: Default::default(),
    });
}

fn finished(
    scenario: Scenario,
    sleepers: Vec<SleeperRow>,
    blocks: Vec<BlockRow>,
    histories: Vec<HistoryRow>,
    rail: RailMaxima,
) -> Run {
    let trains: Vec<TrainRow> =
        blocks.last().map(|block| train_row(block.axles, block.max_wheel_force_N)).into_iter().collect();
    let scalars = summarise(&scenario, &[], &sleepers, &blocks, &trains, rail);
    let tables = Tables {
        sleepers: SleeperTable::Axles(&sleepers),
        blocks: &blocks,
        rail: &[],
        histories: &histories,
        scalars: &scalars,
        track: &scenario.track,
        supports: &[],
    };
    let expectations = verdicts(&scenario, tables);
    let provenance = Provenance {
        program: "trackbed".to_owned(),
        version: "0.1.0".to_owned(),
        file: "transition.track".to_owned(),
        source: "// 1 < 2 & \"quoted\"\nuse std\nscenario { title = \"Ballast meets slab\" }\n".to_owned(),
        source_sha256: "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".to_owned(),
        overrides: vec!["ore.speed = 190 km/h".to_owned()],
        seed: 1,
        plan: "track        2D finite elements, 440 elements\nsubstructure law varandas, 69 seats\n".to_owned(),
    };
    let summary = Summary { scalars, expectations, reliance: Reliance::default(), provenance };
    Run {
        scenario,
        summary,
        sleepers,
        blocks,
        laws: vec![],
        check: vec![],
        rail: vec![],
        trains,
        tampings: vec![],
        histories,
        beds: vec![],
        tests: None,
        packings: Vec::new(),
    }
}

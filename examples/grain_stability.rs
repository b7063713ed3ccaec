//! Where the steps of grains end: runs on a grid of step, damping ratio, contacts a body and size ratio, against
//! theory.
//!
//!     cargo run --release --example grain_stability -- docs/charts
//!
//! Every cell is a run of the kernel itself, kicked by far less than its contacts overlap: it grows or it does not.

use std::fmt::Write;
use trackbed::solvers::granular::{
    Bed, BodyId, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, FrictionLimit, Limits, Linear, Sphere,
};

const STIFFNESS: f64 = 1.3e7;
const RADIUS: f64 = 0.02;
/// Overlap over radius in lattices.
const PRESSED: f64 = 1e-3;
/// Damping ratios across, shares of the network's limit upwards.
const RATIOS: [f64; 9] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0];
const SHARES: [f64; 17] = [0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.94, 0.98, 1.02, 1.06, 1.1, 1.15, 1.2, 1.25, 1.3, 1.4, 1.5];

/// A packing, and how the theory sees it.
struct Packing {
    name: &'static str,
    size_ratio: f64,
    /// Contacts of a body; of the body that sets the limit where they differ.
    contacts: usize,
    bed: Bed<f64>,
}

/// What a line shows of a column.
type Value = fn(&Column) -> f64;

/// One column: what is known, and what the runs did.
struct Column {
    ratio: f64,
    network: f64,
    theory: f64,
    bound: f64,
    pfc: f64,
    grows: Vec<bool>,
}

fn law(ratio: f64, friction: f64) -> ContactLaw {
    ContactLaw::Linear(Linear {
        normal_stiffness: STIFFNESS,
        shear_stiffness: STIFFNESS,
        friction,
        dashpot: Dashpot::Ratio { normal: ratio, shear: ratio },
        mode: DashpotMode::Full,
        limit: FrictionLimit::Spring,
    })
}

fn sphere(centre: [f64; 3], radius: f64) -> Sphere {
    Sphere { centre, radius, density: 2700.0, surface: 0 }
}

/// Spheres that do not turn, at places in units of two radii, in a box that repeats.
fn lattice(places: &[[f64; 3]], periods: [Option<f64>; 3]) -> Bed<f64> {
    let unit = 2.0 * RADIUS * (1.0 - PRESSED);
    let periodic = |d: Domain, axis: usize| periods[axis].map_or(d, |p| d.periodic(axis, p * unit));
    let mut bed = Bed::new((0..3).fold(Domain::open(), periodic), ContactLaws::uniform(1, law(0.0, 1e9)));
    for place in places {
        let id = bed.add_sphere(&sphere(place.map(|x| x * unit), RADIUS));
        bed.hold_rotation(id);
    }
    bed
}

fn grid(counts: [usize; 3], cell: f64, basis: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut places = Vec::new();
    for k in 0..counts.iter().product() {
        let at = [k % counts[0], k / counts[0] % counts[1], k / counts[0] / counts[1]].map(|i| i as f64 * cell);
        places.extend(basis.iter().map(|b| [0, 1, 2].map(|c| at[c] + b[c] * cell)));
    }
    places
}

/// A chain of spheres of two sizes in turn.
fn chain(size_ratio: f64) -> Bed<f64> {
    let radii = [RADIUS, size_ratio * RADIUS];
    let step = (radii[0] + radii[1]) * (1.0 - PRESSED);
    let mut bed = Bed::new(Domain::open().periodic(0, 8.0 * step), ContactLaws::uniform(1, law(0.0, 1e9)));
    for k in 0..8 {
        let id = bed.add_sphere(&sphere([f64::from(k) * step, 0.0, 0.0], radii[k as usize % 2]));
        bed.hold_rotation(id);
    }
    bed
}

/// Spheres by chance, radii up to `size_ratio` apart, pressed until at rest; they may turn.
fn random(size_ratio: f64, count: usize) -> Bed<f64> {
    let mut state = 88_172_645_463_325_252_u64;
    let mut chance = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    // many small ones for each large one
    let small = size_ratio.powi(-2);
    let radii: Vec<f64> = (0..count).map(|_| RADIUS / (small + chance() * (1.0 - small)).sqrt()).collect();
    let solid: f64 = radii.iter().map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum();
    let length = (solid / if size_ratio < 2.0 { 0.67 } else { 0.72 }).cbrt();
    let domain = (0..3).fold(Domain::open(), |d, axis| d.periodic(axis, length));
    let mut bed = Bed::new(domain, ContactLaws::uniform(1, law(0.0, 0.0)));
    for radius in radii {
        bed.add_sphere(&sphere([(); 3].map(|()| chance() * length), radius));
    }
    bed.set_limits(Limits { overlap: 1e9, stride: 1e9, growth: false, ..Limits::default() });
    bed.set_damping(0.7);
    bed.set_time_step(5e-6);
    // downhill: stopped again and again until what overlapped by chance is apart
    for _ in 0..400 {
        bed.run(20).expect("a bed that is stopped");
        stop(&mut bed);
    }
    bed.change_laws(|l| *l = law(0.0, 0.5));
    for _ in 0..40 {
        bed.run(2000).expect("a bed that is stopped");
        if fastest(&bed) < 1e-7 {
            break;
        }
        stop(&mut bed);
    }
    bed.set_damping(0.0);
    bed
}

fn stop(bed: &mut Bed<f64>) {
    (0..bed.len() as u32).for_each(|id| bed.set_velocity(BodyId(id), [0.0; 3], [0.0; 3]));
}

/// Largest speed of a body, turning among it \[m/s\].
fn fastest(bed: &Bed<f64>) -> f64 {
    let of = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    bed.states().map(|s| of(s.velocity).max(RADIUS * of(s.spin))).fold(0.0, f64::max)
}

/// Largest speed in so many steps of a bed kicked a little; it stops looking above `most`.
fn peak(bed: &Bed<f64>, dt: f64, steps: u64, most: f64) -> f64 {
    let mut bed = bed.clone();
    bed.set_limits(Limits { overlap: 1e9, stride: 1e9, growth: false, ..Limits::default() });
    bed.set_time_step(dt);
    let kick = 1e-7;
    for id in 0..bed.len() as u32 {
        let sign = |c: u32| f64::from((id.wrapping_mul(2_654_435_761) >> (8 + c)) & 1) * 2.0 - 1.0;
        bed.set_velocity(BodyId(id), [kick * sign(0), kick * sign(1), kick * sign(2)], [0.0; 3]);
    }
    let mut peak = fastest(&bed);
    for _ in 0..steps / 50 {
        if bed.run(50).is_err() {
            return f64::INFINITY;
        }
        peak = peak.max(fastest(&bed));
        if peak > most {
            break;
        }
    }
    peak
}

fn column(packing: &Packing, ratio: f64) -> Column {
    let mut bed = packing.bed.clone();
    bed.change_laws(|l| *l = law(ratio, 1e9));
    let step = bed.critical_step(0.0).expect("lists of a bed at rest");
    let mut smooth = packing.bed.clone();
    smooth.change_laws(|l| *l = law(0.0, 1e9));
    let undamped = smooth.critical_step(0.0).expect("lists of a bed at rest").network.step;
    // what is not quite at rest moves anyway
    let most = 300.0 * peak(&bed, 0.3 * step.network.step, 4000, f64::INFINITY);
    let grows = |share: &f64| peak(&bed, share * step.network.step, 1500, most) > most;
    let xi = ratio * (packing.contacts as f64).sqrt();
    Column {
        ratio,
        network: step.network.step,
        theory: undamped * ((1.0 + xi * xi).sqrt() - xi),
        bound: step.bound.step,
        pfc: 0.8 * step.estimate.step,
        grows: SHARES.iter().map(grows).collect(),
    }
}

fn packings() -> Vec<Packing> {
    let packing = |name, size_ratio, contacts, bed| Packing { name, size_ratio, contacts, bed };
    let (one, corner) = ([[0.0; 3]], 0.5f64.sqrt());
    let faces = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
    let cubic = |n: [usize; 3]| {
        let period = |axis: usize| (n[axis] > 1).then_some(n[axis] as f64);
        lattice(&grid(n, 1.0, &one), [0, 1, 2].map(period))
    };
    let close = lattice(&grid([4; 3], 2.0 * corner, &faces), [Some(8.0 * corner); 3]);
    let worst = |bed: &Bed<f64>| {
        let step = bed.clone().critical_step(0.0).expect("lists of a bed at rest");
        step.network.seat.map_or(0, |seat| seat.contacts)
    };
    let (even, graded, wide) = (random(1.2, 343), random(3.0, 400), random(6.0, 500));
    let seats = [&even, &graded, &wide].map(worst);
    vec![
        packing("chain", 1.0, 2, cubic([8, 1, 1])),
        packing("chain", 6.0, 2, chain(6.0)),
        packing("square lattice", 1.0, 4, cubic([6, 6, 1])),
        packing("simple cubic", 1.0, 6, cubic([6, 6, 6])),
        packing("close packing", 1.0, 12, close),
        packing("random bed", 1.2, seats[0], even),
        packing("random bed", 3.0, seats[1], graded),
        packing("random bed", 6.0, seats[2], wide),
    ]
}

fn csv(map: &[(Packing, Vec<Column>)]) -> String {
    let mut text =
        "packing,size_ratio,contacts,damping_ratio,network_s,theory_s,bound_s,pfc_s,step_over_network,grows\n"
            .to_owned();
    for (packing, columns) in map {
        for c in columns {
            for (share, grows) in SHARES.iter().zip(&c.grows) {
                let Packing { name, size_ratio, contacts, .. } = packing;
                let (n, t, b, p) = (c.network, c.theory, c.bound, c.pfc);
                let grows = if *grows { "yes" } else { "no" };
                let _ = writeln!(
                    text,
                    "{name},{size_ratio},{contacts},{},{n:.4e},{t:.4e},{b:.4e},{p:.4e},{share},{grows}",
                    c.ratio
                );
            }
        }
    }
    text
}

const CELL: (f64, f64) = (24.0, 17.0);
const PANEL: (f64, f64) = (292.0, 372.0);
const LEFT: f64 = 56.0;
const TOP: f64 = 132.0;

/// Height of a share of the network's limit: between the cells' middles, straight.
fn height(share: f64) -> f64 {
    let after = SHARES.partition_point(|s| *s < share).clamp(1, SHARES.len() - 1);
    let (a, b) = (SHARES[after - 1], SHARES[after]);
    let row = after as f64 - 1.0 + (share - a) / (b - a);
    (SHARES.len() as f64 - 0.5 - row) * CELL.1
}

fn svg(map: &[(Packing, Vec<Column>)]) -> String {
    let columns = 4;
    let (width, rows) = (LEFT + columns as f64 * PANEL.0 - 8.0, map.len().div_ceil(columns));
    let total = TOP + rows as f64 * PANEL.1 - 6.0;
    let mut s = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {total}\" width=\"{width}\" height=\"{total}\" role=\"img\" \
         aria-label=\"Stable and unstable steps of grains\"><style>{STYLE}</style><rect class=\"paper\" width=\"{width}\" height=\"{total}\"/>"
    );
    let text = |s: &mut String, class: &str, x: f64, y: f64, anchor: &str, t: &str| {
        let _ = write!(s, "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{t}</text>");
    };
    text(&mut s, "title", 16.0, 26.0, "start", "Grains: how long a step may be");
    let under = "Each cell is a run of the kernel. Across the damping ratio of a contact; upwards the step over the limit that the network of contacts gives.";
    text(&mut s, "small", 16.0, 46.0, "start", under);
    let (mut x, y) = (16.0, 62.0);
    for (class, name, room) in [("calm", "stays", 74.0), ("grow", "grows", 90.0)] {
        let _ = write!(s, "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"16\" height=\"14\"/>");
        text(&mut s, "small", x + 22.0, y + 11.0, "start", name);
        x += room;
    }
    let lines = [
        ("network", "limit of the network", 180.0),
        ("theory", "theory for N equal contacts: (2/w) (sqrt(1 + xi²) - xi), xi = beta sqrt(N)", 480.0),
        ("bound", "bound by single bodies", 190.0),
        ("pfc", "PFC's rule, 0.8 of it", 160.0),
    ];
    for (class, name, room) in lines {
        let _ = write!(s, "<path class=\"{class}\" d=\"M{x} {} h26\"/>", y + 7.0);
        text(&mut s, "small", x + 32.0, y + 11.0, "start", name);
        x += room;
    }
    for (number, (packing, cells)) in map.iter().enumerate() {
        let (x, y) = (LEFT + (number % columns) as f64 * PANEL.0, TOP + (number / columns) as f64 * PANEL.1);
        let name = if packing.size_ratio > 1.0 {
            format!("{}, sizes 1 to {}", packing.name, packing.size_ratio)
        } else {
            packing.name.to_owned()
        };
        text(&mut s, "strong", x, y - 22.0, "start", &name);
        let turn = if packing.name == "random bed" {
            format!("{} contacts where it fails first", packing.contacts)
        } else {
            format!("{} contacts a sphere", packing.contacts)
        };
        text(&mut s, "small", x, y - 7.0, "start", &turn);
        for (i, column) in cells.iter().enumerate() {
            for (j, grows) in column.grows.iter().enumerate() {
                let (class, cx) = (if *grows { "grow" } else { "calm" }, x + i as f64 * CELL.0);
                let cy = y + (SHARES.len() - 1 - j) as f64 * CELL.1;
                let _ = write!(
                    s,
                    "<rect class=\"{class}\" x=\"{cx:.1}\" y=\"{cy:.1}\" width=\"{}\" height=\"{}\"/>",
                    CELL.0 - 1.0,
                    CELL.1 - 1.0
                );
            }
            text(
                &mut s,
                "tick",
                x + (i as f64 + 0.5) * CELL.0,
                y + SHARES.len() as f64 * CELL.1 + 13.0,
                "middle",
                &format!("{}", column.ratio),
            );
        }
        text(
            &mut s,
            "small",
            x + 4.5 * CELL.0,
            y + SHARES.len() as f64 * CELL.1 + 29.0,
            "middle",
            "damping ratio beta",
        );
        for (j, share) in SHARES.iter().enumerate().filter(|(j, _)| number % columns == 0 && j % 2 == 0) {
            text(
                &mut s,
                "tick",
                x - 6.0,
                y + (SHARES.len() as f64 - 0.5 - j as f64) * CELL.1 + 4.0,
                "end",
                &format!("{share}"),
            );
        }
        let of: [(&str, Value); 4] =
            [("bound", |c| c.bound), ("pfc", |c| c.pfc), ("network", |c| c.network), ("theory", |c| c.theory)];
        for (class, value) in of {
            let mut path = String::new();
            for (i, column) in cells.iter().enumerate() {
                let share = value(column) / column.network;
                if !(0.48..1.55).contains(&share) {
                    continue;
                }
                let _ = write!(
                    path,
                    "{}{:.1} {:.1}",
                    if path.is_empty() { "M" } else { " L" },
                    x + (i as f64 + 0.5) * CELL.0,
                    y + height(share)
                );
            }
            let _ = write!(s, "<path class=\"{class}\" d=\"{path}\"/>");
        }
    }
    s + "</svg>\n"
}

const STYLE: &str = "text{font-family:system-ui,sans-serif;font-size:13px;fill:#222}.title{font-size:17px;font-weight:600}\
.strong{font-weight:600}.small{font-size:12px;fill:#444}.tick{font-size:11px;fill:#555}.paper{fill:#fff}.calm{fill:#d9e6ef}.grow{fill:#8c3b2e}\
path{fill:none;stroke-width:2.2}.network{stroke:#111}.theory{stroke:#e69f00;stroke-width:3;stroke-dasharray:7 4}.bound{stroke:#0072b2}\
.pfc{stroke:#12b886;stroke-width:3;stroke-dasharray:3 3}";

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs/charts".to_owned());
    let map: Vec<(Packing, Vec<Column>)> = packings()
        .into_iter()
        .map(|packing| {
            let columns: Vec<Column> = RATIOS.iter().map(|ratio| column(&packing, *ratio)).collect();
            let wrong: usize = columns
                .iter()
                .map(|c| SHARES.iter().zip(&c.grows).filter(|(share, grows)| **grows != (**share > 1.0)).count())
                .sum();
            println!(
                "{} 1 to {}, N = {}: {wrong} cells against the network",
                packing.name, packing.size_ratio, packing.contacts
            );
            for c in &columns {
                println!(
                    "  beta {}: theory {:.3}, bound {:.3}, pfc {:.3} of the network's {:.3e} s",
                    c.ratio,
                    c.theory / c.network,
                    c.bound / c.network,
                    c.pfc / c.network,
                    c.network
                );
            }
            (packing, columns)
        })
        .collect();
    std::fs::create_dir_all(&folder)?;
    std::fs::write(format!("{folder}/grains_stability.csv"), csv(&map))?;
    std::fs::write(format!("{folder}/grains_stability.svg"), svg(&map))
}

//! The whole experiment: settling, first loading, load cycles.

use super::experiment::{Oedometer, Parameters, Phase, Row, Trouble};
use super::particles::Particles;
use trackbed::solvers::granular::Real;

/// Travel of the plate over the height of the bed in seating, first loading and one way of a cycle, as long as nothing
/// better is known: for the estimate of the time left only.
const USUAL_TRAVEL: [f64; 3] = [0.0045, 0.007, 0.0013];

/// One load cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// 0 is the first loading.
    pub number: usize,
    /// Height of the plate at the lower pressure before, at the upper one, and at the lower one after \[m\].
    pub heights: [f64; 3],
    /// Since the lower pressure was first reached \[m\].
    pub settlement: f64,
    /// At the upper pressure and at the lower one after.
    pub porosity: [f64; 2],
    pub coordination: [f64; 2],
}

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// From rest to the upper pressure.
    pub compression: Vec<Row>,
    /// From there on.
    pub path: Vec<Row>,
    pub cycles: Vec<Cycle>,
    pub steps: u64,
}

/// Runs everything. `tell` hears how many steps are done and about how many there will be.
pub fn run<R: Real>(
    particles: &Particles,
    parameters: &Parameters,
    mut tell: impl FnMut(u64, u64),
) -> Result<Outcome, Trouble> {
    let mut oedometer = Oedometer::<R>::new(particles, parameters)?;
    let mut outlook = Outlook::new(parameters, oedometer.height());
    let mut compression = vec![oedometer.settle(|step| tell(step, outlook.all(step)))?];
    let mut path = Vec::new();
    let mut cycles: Vec<Cycle> = Vec::new();
    let mut turns: Vec<Row> = Vec::new();
    for phase in phases(parameters) {
        outlook.enter(oedometer.steps());
        let rows = oedometer.drive(&phase, |step| tell(step, outlook.all(step)))?;
        turns.extend(rows.last().cloned());
        // the first two phases compress, every later pair is a cycle
        if turns.len() <= 2 {
            compression.extend(rows)
        } else {
            path.extend(rows)
        }
        if let [first, ..] = &turns[..]
            && let (true, [.., before, loaded, after]) = (!phase.loads, &turns[..])
        {
            cycles.push(Cycle::between(cycles.len(), first, before, loaded, after));
        }
    }
    Ok(Outcome { compression, path, cycles, steps: oedometer.steps() })
}

/// Every way of the plate in turn.
pub fn phases(parameters: &Parameters) -> Vec<Phase> {
    let &Parameters { seat_speed, speed, low, high, .. } = parameters;
    let load = |name: String| Phase { name, loads: true, speed, target: high };
    let unload = |name: String| Phase { name, loads: false, speed, target: low };
    let seat = Phase { name: format!("seat_to_{}", low / 1e3), loads: true, speed: seat_speed, target: low };
    let mut phases = vec![seat, load(format!("load_to_{}", high / 1e3)), unload("unload_0".to_owned())];
    phases.extend((1..=parameters.cycles).flat_map(|k| [load(format!("load_{k}")), unload(format!("unload_{k}"))]));
    phases
}

impl Cycle {
    fn between(number: usize, first: &Row, before: &Row, loaded: &Row, after: &Row) -> Cycle {
        Cycle {
            number,
            heights: [before, loaded, after].map(|row| row.plate_height_m),
            settlement: first.plate_height_m - after.plate_height_m,
            porosity: [loaded.porosity, after.porosity],
            coordination: [loaded.coordination, after.coordination],
        }
    }
}

/// About how many steps there are to come.
struct Outlook {
    /// Steps of each phase, settling first.
    expected: Vec<u64>,
    /// The phase under way, and the step at which it began.
    phase: usize,
    began: u64,
}

impl Outlook {
    fn new(parameters: &Parameters, height: f64) -> Outlook {
        let steps = |travel: f64, speed: f64| (travel * height / (speed * parameters.time_step)) as u64;
        let [seat, load, turn] = USUAL_TRAVEL;
        let first = [parameters.settle_steps, steps(seat, parameters.seat_speed), steps(load - seat, parameters.speed)];
        let cycles = vec![steps(turn, parameters.speed); 1 + 2 * parameters.cycles];
        Outlook { expected: [first.to_vec(), cycles].concat(), phase: 0, began: 0 }
    }

    /// The next phase begins; the last one shows how long those like it take.
    fn enter(&mut self, step: u64) {
        let took = step - self.began;
        if self.phase > 2 {
            self.expected[self.phase + 1..].fill(took);
        }
        (self.phase, self.began) = (self.phase + 1, step);
    }

    fn all(&self, step: u64) -> u64 {
        let here = (step - self.began).max(self.expected[self.phase]);
        self.began + here + self.expected[self.phase + 1..].iter().sum::<u64>()
    }
}

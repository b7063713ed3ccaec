//! The oedometer: a bed of spheres in a periodic cell, on a floor, under a plate that moves at a given speed between
//! pressures and never stops.

use super::particles::Particles;
use serde::{Deserialize, Serialize};
use std::fmt;
use trackbed::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Domain, Failure, FrictionLimit, Gravity, Linear, Party, Real,
    Sphere, WallId, WallMotion,
};

/// Steps between looks at the plate's pressure.
const LOOK: u64 = 10;
/// Share of the start height that the plate may travel in one phase: more means that the target is out of reach.
const FARTHEST: f64 = 0.5;

/// Everything that the experiment hangs on, in SI.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameters {
    /// Of the cell in x and y \[m\].
    pub period: [f64; 2],
    /// \[kg/m3\]
    pub density: f64,
    /// Of a contact, wall or sphere \[N/m\].
    pub normal_stiffness: f64,
    /// \[N/m\]
    pub shear_stiffness: f64,
    pub friction: f64,
    /// Cundall's local damping.
    pub damping: f64,
    /// Downwards \[m/s2\].
    pub gravity: f64,
    /// \[s\]
    pub time_step: f64,
    /// Steps under gravity before the plate moves.
    pub settle_steps: u64,
    /// Between the highest sphere and the plate at the start \[m\].
    pub gap: f64,
    /// Of the plate until the seating pressure is reached, and from then on \[m/s\].
    pub seat_speed: f64,
    pub speed: f64,
    /// At which the cycles turn \[Pa\].
    pub low: f64,
    pub high: f64,
    pub cycles: usize,
    /// Steps between rows.
    pub interval: u64,
}

impl Default for Parameters {
    /// Those of the YADE run.
    fn default() -> Self {
        Parameters {
            period: [0.6, 0.6],
            density: 2700.0,
            normal_stiffness: 1.3e7,
            shear_stiffness: 1.3e7,
            friction: 0.7,
            damping: 0.7,
            gravity: 9.81,
            time_step: 1e-5,
            settle_steps: 10_000,
            gap: 0.2e-3,
            seat_speed: 0.02,
            speed: 0.01,
            low: 20e3,
            high: 100e3,
            cycles: 10,
            interval: 200,
        }
    }
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    NoSpheres,
    /// A parameter, its value, and what it should be.
    Parameter(&'static str, f64, &'static str),
    Bed(Failure),
    /// A phase in which the plate went far without meeting its target.
    OutOfReach {
        phase: String,
        pressure: f64,
    },
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Trouble::NoSpheres => write!(f, "there are no spheres"),
            Trouble::Parameter(name, value, expected) => write!(f, "{name} is {value}, expected {expected}"),
            Trouble::Bed(failure) => write!(f, "{failure}"),
            Trouble::OutOfReach { phase, pressure } => {
                write!(f, "{phase}: the plate went through half the bed and stands at {:.3} kPa", pressure / 1e3)
            }
        }
    }
}

impl std::error::Error for Trouble {}

impl From<Failure> for Trouble {
    fn from(failure: Failure) -> Trouble {
        Trouble::Bed(failure)
    }
}

impl Parameters {
    /// The first number that cannot be.
    pub fn check(&self) -> Result<(), Trouble> {
        let positive = [
            ("period in x", self.period[0]),
            ("period in y", self.period[1]),
            ("density", self.density),
            ("gravity", self.gravity),
            ("time step", self.time_step),
            ("seating speed", self.seat_speed),
            ("speed of the plate", self.speed),
            ("lower pressure", self.low),
            ("number of steps between rows", self.interval as f64),
        ];
        let wrong = positive.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
        if let Some((name, value)) = wrong {
            return Err(Trouble::Parameter(name, value, "a number above 0"));
        }
        if !(self.high.is_finite() && self.high > self.low) {
            return Err(Trouble::Parameter("upper pressure", self.high, "a number above the lower one"));
        }
        if !(self.gap.is_finite() && self.gap >= 0.0) {
            return Err(Trouble::Parameter("gap", self.gap, "a number from 0"));
        }
        if !(0.0..1.0).contains(&self.damping) {
            return Err(Trouble::Parameter("damping", self.damping, "a number from 0 to below 1"));
        }
        let faults = self.law().faults();
        faults.first().map_or(Ok(()), |fault| Err(Trouble::Parameter(fault.quantity, fault.value, fault.expected)))
    }

    /// A spring without a dashpot.
    fn law(&self) -> ContactLaw {
        ContactLaw::Linear(Linear {
            normal_stiffness: self.normal_stiffness,
            shear_stiffness: self.shear_stiffness,
            friction: self.friction,
            dashpot: Dashpot::Ratio { normal: 0.0, shear: 0.0 },
            mode: DashpotMode::NoTension,
            limit: FrictionLimit::Spring,
        })
    }

    /// Of the cell \[m2\].
    pub fn area(&self) -> f64 {
        self.period[0] * self.period[1]
    }
}

/// The bed at an instant, under the names that YADE's script gives them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub phase: String,
    pub step: u64,
    pub plate_height_m: f64,
    #[serde(rename = "plate_kPa")]
    pub plate_kpa: f64,
    #[serde(rename = "floor_kPa")]
    pub floor_kpa: f64,
    /// 1 - solid volume / (area x height of the plate).
    pub porosity: f64,
    /// Contacts of spheres with a force, twice, over the number of spheres.
    pub coordination: f64,
    /// The same over the spheres that are no rattlers.
    pub coordination_no_rattlers: f64,
    pub wall_contacts: usize,
    /// Spheres with fewer than two contacts with others.
    pub rattlers: usize,
    #[serde(rename = "kinetic_J")]
    pub kinetic_j: f64,
}

/// A way of the plate.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    pub name: String,
    /// Down or up, at this speed \[m/s\].
    pub loads: bool,
    pub speed: f64,
    /// Pressure of the plate that ends it \[Pa\].
    pub target: f64,
}

/// A bed between floor and plate.
pub struct Oedometer<R: Real> {
    bed: Bed<R>,
    floor: WallId,
    plate: WallId,
    parameters: Parameters,
    solid_volume: f64,
    start_height: f64,
}

impl<R: Real> Oedometer<R> {
    /// Spheres at rest without any history of contacts, the plate above the highest.
    pub fn new(particles: &Particles, parameters: &Parameters) -> Result<Self, Trouble> {
        parameters.check()?;
        if particles.radii.is_empty() {
            return Err(Trouble::NoSpheres);
        }
        let [x, y] = parameters.period;
        let mut bed = Bed::new(Domain::open().periodic(0, x).periodic(1, y), ContactLaws::single(parameters.law()));
        bed.set_time_step(parameters.time_step);
        bed.set_gravity(Gravity::Constant([0.0, 0.0, -parameters.gravity]));
        bed.set_damping(parameters.damping);
        for (&centre, &radius) in particles.centres.iter().zip(&particles.radii) {
            bed.add_sphere(&Sphere { centre, radius, density: parameters.density, surface: 0 });
        }
        let start_height = particles.top() + parameters.gap;
        let floor = bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        let plate = bed.add_plane([0.0, 0.0, start_height], [0.0, 0.0, -1.0], 0);
        let solid_volume = particles.solid_volume();
        Ok(Oedometer { bed, floor, plate, parameters: parameters.clone(), solid_volume, start_height })
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.bed.steps()
    }

    /// Lets the bed come to rest under gravity. `tell` hears the number of every step that ends an interval.
    pub fn settle(&mut self, mut tell: impl FnMut(u64)) -> Result<Row, Trouble> {
        for _ in 0..self.parameters.settle_steps {
            self.bed.step()?;
            if self.steps().is_multiple_of(self.parameters.interval) {
                tell(self.steps());
            }
        }
        self.row("settle")
    }

    /// Moves the plate until its pressure crosses the target; gives a row at every interval and one at the end.
    pub fn drive(&mut self, phase: &Phase, mut tell: impl FnMut(u64)) -> Result<Vec<Row>, Trouble> {
        let down = if phase.loads { -phase.speed } else { phase.speed };
        let linear = [0.0, 0.0, down].into();
        self.bed.set_motion(self.plate, WallMotion::Velocity { linear, angular: [0.0; 3].into() });
        let last = self.steps() + (FARTHEST * self.start_height / (phase.speed * self.parameters.time_step)) as u64;
        let mut rows = Vec::new();
        loop {
            let step = self.steps();
            if step.is_multiple_of(self.parameters.interval) {
                rows.push(self.row(&phase.name)?);
                tell(step);
            }
            self.bed.step()?;
            let pressure = self.pressure(self.plate);
            let met = if phase.loads { pressure >= phase.target } else { pressure <= phase.target };
            if step.is_multiple_of(LOOK) && met {
                break;
            }
            if step >= last {
                return Err(Trouble::OutOfReach { phase: phase.name.clone(), pressure });
            }
        }
        rows.push(self.row(&phase.name)?);
        Ok(rows)
    }

    /// Height of the plate above the floor \[m\].
    pub fn height(&self) -> f64 {
        self.bed.wall(self.plate).pose(self.bed.domain()).position.z
    }

    /// What the last step found on a wall \[Pa\].
    fn pressure(&self, wall: WallId) -> f64 {
        self.bed.wall(wall).felt().force.z.abs() / self.parameters.area()
    }

    /// The bed now. Pressures are sums over the contacts of this very instant.
    fn row(&mut self, phase: &str) -> Result<Row, Trouble> {
        let snapshot = self.bed.snapshot()?;
        let count = self.bed.len();
        let (mut pairs, mut touching) = (0, vec![0u32; count]);
        let (mut plate, mut floor, mut wall_contacts) = (0.0, 0.0, 0);
        for contact in &snapshot.contacts {
            match contact.second {
                Party::Wall(wall) => {
                    wall_contacts += 1;
                    // the floor pushes up, the plate down
                    if wall == self.floor { floor += contact.force[2] } else { plate -= contact.force[2] }
                }
                Party::Body(other, _) => {
                    pairs += 1;
                    for body in [contact.first.body(), Some(other)].into_iter().flatten() {
                        touching[body.0 as usize] += 1;
                    }
                }
            }
        }
        let rattlers = touching.iter().filter(|contacts| **contacts < 2).count();
        let kpa = 1e3 * self.parameters.area();
        let height = self.height();
        Ok(Row {
            phase: phase.to_owned(),
            step: self.steps(),
            plate_height_m: height,
            plate_kpa: plate / kpa,
            floor_kpa: floor / kpa,
            porosity: 1.0 - self.solid_volume / (self.parameters.area() * height),
            coordination: 2.0 * f64::from(pairs) / count as f64,
            coordination_no_rattlers: 2.0 * f64::from(pairs) / (count - rattlers).max(1) as f64,
            wall_contacts,
            rattlers,
            kinetic_j: snapshot.translation + snapshot.rotation,
        })
    }
}

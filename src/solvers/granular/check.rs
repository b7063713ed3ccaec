//! Finds invalid values before anything moves.
//!
//! Bodies, walls and settings are added to a bed unchecked, so that building a bed does not return an error at every
//! line. Changes are checked before the next step; an invalid value makes that step fail, and nothing is moved.
//! [`Bed::check`] checks at once.

use super::bed::Bed;
use super::body::{Body, BodyId, SPHERE};
use super::bonds::Glue;
use super::fault::{Fault, NOT_NEGATIVE, POSITIVE, Subject};
use super::gravity::Gravity;
use super::lanes::Real;
use super::law::LawError;
use super::record::Record;
use super::vector::{Vec3, dot, norm, sub};
use super::walls::{Wall, WallId};

/// Largest distance from the origin \[m\]. Beyond it positions are lost in rounding, and cell numbers overflow.
const FARTHEST: f64 = 1e8;

impl<R: Real> Bed<R> {
    /// Fails with the first invalid number, in the order settings, laws, bodies, walls.
    pub fn check(&self) -> Result<(), Fault> {
        self.check_settings()?;
        self.check_laws()?;
        self.bodies.iter().try_for_each(|body| self.check_body(body))?;
        self.walls
            .iter()
            .enumerate()
            .try_for_each(|(number, wall)| self.check_wall(Subject::Wall(WallId(number as u32)), wall))
    }

    fn check_settings(&self) -> Result<(), Fault> {
        let bed = Subject::Bed;
        for axis in 0..3 {
            if let Some(length) = self.domain.cell_length(axis) {
                bed.positive(["length of a period or bay along x", "period along y", "period along z"][axis], length)?;
            }
            let cells = self.domain.cells(axis).unwrap_or(1);
            bed.want(cells > 0, "number of bays", f64::from(cells), POSITIVE)?;
        }
        // a missing time step is reported by the step itself
        bed.want(self.dt.is_finite() && self.dt >= 0.0, "time step", self.dt, POSITIVE)?;
        bed.want((0.0..1.0).contains(&self.damping), "local damping", self.damping, "a share from 0 to below 1")?;
        if let Some(skin) = self.lists.fixed_skin {
            bed.positive("reach of the lists", skin)?;
        }
        bed.want(self.limits.every > 0, "steps between looks at overlaps", 0.0, POSITIVE)?;
        for (quantity, limit) in [("limit of overlap", self.limits.overlap), ("limit of stride", self.limits.stride)] {
            bed.want(limit >= 0.0, quantity, limit, NOT_NEGATIVE)?;
        }
        match &self.gravity {
            Gravity::Constant(value) => bed.numbers("gravity", value),
            Gravity::Shaken { mean, share, frequency } => {
                bed.numbers("gravity", mean)?;
                bed.numbers("share of gravity that shakes", &[*share])?;
                bed.numbers("frequency of gravity", &[*frequency])
            }
            Gravity::Table { times, values } => {
                bed.want(!times.is_empty(), "number of times of gravity", 0.0, POSITIVE)?;
                let same = times.len() == values.len();
                bed.want(same, "number of values of gravity", values.len() as f64, "the number of times")?;
                bed.numbers("times of gravity", times)?;
                let later =
                    |t: &[f64]| bed.want(t[0] < t[1], "times of gravity", t[1], "each above the time before it");
                times.windows(2).try_for_each(later)?;
                bed.numbers("gravity", values.as_flattened())
            }
        }
    }

    fn check_laws(&self) -> Result<(), Fault> {
        for (pair, law) in self.laws.all().iter().enumerate() {
            if let Some(&LawError { quantity, value, expected }) = law.faults().first() {
                let surfaces = self.laws.surfaces();
                let of = Subject::ContactLaw((pair / surfaces) as u16, (pair % surfaces) as u16);
                return Err(Fault { of, quantity, value, expected });
            }
        }
        match self.bonds.glues.iter().flat_map(Glue::faults).next() {
            Some(LawError { quantity, value, expected }) => Err(Fault { of: Subject::Bed, quantity, value, expected }),
            None => Ok(()),
        }
    }

    fn check_surface(&self, of: Subject, surface: u16) -> Result<(), Fault> {
        let fine = usize::from(surface) < self.laws.surfaces();
        of.want(fine, "surface", f64::from(surface), "a number below the number of surfaces with laws")
    }

    fn check_body(&self, body: &Body) -> Result<(), Fault> {
        let of = Subject::Body(BodyId(body.id));
        of.want(body.pebbles > 0, "number of pebbles", f64::from(body.pebbles), "from 1 to 65535")?;
        let records = &self.records[body.first as usize..body.first as usize + usize::from(body.pebbles)];
        for record in records {
            of.positive("radius", record.radius())?;
            of.numbers("place", &record.position())?;
        }
        of.positive("mass, by its density and volume,", body.mass)?;
        // single precision has a smaller range
        records
            .iter()
            .try_for_each(|record| of.positive("mass in the precision of contacts", record.mass().to_f64()))?;
        self.check_surface(of, body.surface)?;
        of.numbers("velocity", &body.velocity)?;
        of.numbers("spin", &body.spin)?;
        let centre = match body.clump {
            SPHERE => records[0].position(),
            clump => {
                let clump = &self.clumps[clump as usize];
                let length = clump.attitude.iter().map(|c| c * c).sum::<f64>().sqrt();
                of.want((length - 1.0).abs() < 1e-9, "length of the attitude's quaternion", length, "1")?;
                for inverse in clump.inverse_inertia {
                    of.want(inverse.is_finite() && inverse >= 0.0, "inertia", 1.0 / inverse, POSITIVE)?;
                }
                clump.centre
            }
        };
        let place = self.domain.place(body.cell, centre);
        let far = |&x: &f64| of.want(x.abs() <= FARTHEST, "place", x, "within 1e8 m of the origin");
        place.iter().try_for_each(far)?;
        self.check_period(of, records, centre)
    }

    /// A body must not touch itself across a period at any rotation.
    fn check_period(&self, of: Subject, records: &[R::Record], centre: Vec3) -> Result<(), Fault> {
        let reach = records.iter().map(|r| r.radius() + norm(sub(r.position(), centre))).fold(0.0, f64::max);
        let shortest = (0..3).filter_map(|axis| self.domain.period(axis)).fold(f64::INFINITY, f64::min);
        of.want(2.0 * reach <= shortest, "size", 2.0 * reach, "no longer than the shortest period")
    }

    fn check_wall(&self, of: Subject, wall: &Wall) -> Result<(), Fault> {
        wall.shape.check().map_err(|error| of.shape(error))?;
        wall.pose.check().map_err(|error| of.moves(error))?;
        wall.motion.check().map_err(|error| of.moves(error))?;
        let away = wall.pose(&self.domain).position;
        of.want(dot(away.into(), away.into()).sqrt() <= FARTHEST, "place", away.norm(), "within 1e8 m of the origin")?;
        self.check_surface(of, wall.surface)
    }
}

//! Removes bodies from a bed; the other bodies keep their contacts with their histories.

use super::bed::Bed;
use super::body::BodyId;
use super::bonds::Bond;
use super::build::Carried;
use super::failure::Failure;
use super::lanes::Real;
use super::walls::Kept;

impl<R: Real> Bed<R> {
    /// Removes the bodies for which `goes` is true, and returns their number. The others are renumbered in the same
    /// order.
    pub fn remove(&mut self, goes: impl Fn(BodyId) -> bool) -> Result<usize, Failure> {
        self.refresh()?;
        let before = self.clone();
        self.clear_bodies();
        let copied = |place: &u32| {
            if goes(BodyId(before.bodies[*place as usize].id)) {
                return None;
            }
            let body = self.copy_body(&before, *place);
            // ranks differ from those of bodies that are added later
            body.rank = body.id;
            Some(body.id)
        };
        let numbers: Vec<Option<u32>> = before.index.iter().map(copied).collect();
        let renamed = |(body, pebble): (u32, u16)| Some((numbers[body as usize]?, pebble));
        let carried = before
            .carried()
            .into_iter()
            .filter_map(|near| Some(Carried { low: renamed(near.low)?, high: renamed(near.high)?, ..near }));
        let kept =
            before.kept().into_iter().filter_map(|touch| Some(Kept { body: numbers[touch.body as usize]?, ..touch }));
        let bonds = before.bonds.held().into_iter();
        let bonds = bonds.filter_map(|bond| Some(Bond { low: renamed(bond.low)?, high: renamed(bond.high)?, ..bond }));
        self.bonds.dropped = before.broken_bonds();
        self.lists.outdated = true;
        self.bind(bonds.collect())?;
        self.rebuild_with(carried.collect(), kept.collect())?;
        Ok(before.len() - self.len())
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::{ContactLaw, Dashpot, DashpotMode, FrictionLimit, Linear};
    use super::super::{ContactLaws, Domain, Gravity, Sphere};
    use super::*;

    const RADIUS: f64 = 0.03;

    /// A row of touching spheres on a floor, with friction, at rest except for one that falls on the last.
    fn row() -> Bed<f64> {
        let law = ContactLaw::Linear(Linear {
            normal_stiffness: 1e6,
            shear_stiffness: 1e6,
            friction: 0.5,
            dashpot: Dashpot::Ratio { normal: 0.5, shear: 0.5 },
            mode: DashpotMode::default(),
            limit: FrictionLimit::default(),
        });
        let mut bed = Bed::new(Domain::open(), ContactLaws::single(law));
        bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
        let mut sphere = |x: f64, z: f64| {
            bed.add_sphere(&Sphere { centre: [x, 0.0, z], radius: RADIUS, density: 2700.0, surface: 0 })
        };
        sphere(0.0, RADIUS);
        sphere(1.0, RADIUS);
        sphere(1.05, RADIUS + 0.03);
        bed.set_gravity(Gravity::Constant([0.0, 0.0, -9.81]));
        bed.set_time_step(1e-5);
        bed
    }

    #[test]
    fn those_that_stay_go_on_as_if_nothing_had_happened() {
        let mut whole = row();
        whole.run(2000).unwrap();
        let mut less = whole.clone();
        assert_eq!(less.remove(|body| body == BodyId(0)).unwrap(), 1);
        assert_eq!(less.len(), 2);
        whole.run(2000).unwrap();
        less.run(2000).unwrap();
        for number in 0..2 {
            let (there, here) = (whole.body_state(BodyId(number + 1)), less.body_state(BodyId(number)));
            assert_eq!((here.place, here.velocity, here.spin), (there.place, there.velocity, there.spin));
        }
    }
}

//! How long a time step may be.

use super::bed::Bed;
use super::force::Tangent;
use super::lanes::Real;
use super::record::Record;

impl<R: Real> Bed<R> {
    /// Stable time step by the contacts of each body alone \[s\]; infinite without contacts.
    pub fn body_time_step(&self) -> f64 {
        let mut stiffness = vec![0.0; self.bodies.len()];
        for place in 0..self.contacts.len() {
            if self.overlap(place).is_none() {
                continue;
            }
            let (a, b) = (self.contacts.first[place] as usize, self.contacts.second[place] as usize);
            let law = &self.laws.all()[usize::from(self.contacts.law[place / super::lanes::BLOCK])];
            let tangent = Tangent::of(law, 0.0, 1.0, self.records[a].radius());
            for pebble in [a, b] {
                stiffness[self.owner[pebble] as usize] += tangent.normal;
            }
        }
        let shortest = self.bodies.iter().zip(&stiffness).map(|(b, k)| b.inverse_mass * k).fold(0.0, f64::max);
        2.0 / (2.0 * shortest).sqrt()
    }
}

//! Energy balance: a ledger of energies by kind.

use super::contacts::ContactEnergy;
use super::integrate::Tally;
use super::walls::Wall;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Energies at the start of the last step \[J\], and work and losses since the watch began.
///
/// Work is force times displacement by the trapezoidal rule, consistent with the leapfrog scheme, so the residual
/// decreases with the square of the time step. Work on fixed bodies is not included.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy of translation and of rotation.
    pub translation: f64,
    pub rotation: f64,
    /// Energy in the springs of contacts.
    pub strain: f64,
    /// Energy lost to slip, to dashpots and to local damping.
    pub slip: f64,
    pub dashpot: f64,
    pub damping: f64,
    /// Work done by gravity and by walls.
    pub gravity: f64,
    pub walls: f64,
    /// Kinetic and strain energy when the watch began.
    pub start: f64,
}

impl Energy {
    /// Kinetic energy \[J\].
    pub fn kinetic(&self) -> f64 {
        self.translation + self.rotation
    }

    /// Lost since the watch began \[J\].
    pub fn lost(&self) -> f64 {
        self.slip + self.dashpot + self.damping
    }

    /// Stored and lost energy, minus initial energy and work: 0 except for the error of the scheme \[J\].
    pub fn residual(&self) -> f64 {
        self.kinetic() + self.strain + self.lost() - self.start - self.gravity - self.walls
    }
}

/// The running account.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Ledger {
    pub watched: bool,
    /// Whether a step has been recorded.
    begun: bool,
    pub now: Energy,
    /// Second halves of the work and loss of the last step: gravity, local damping.
    pending: [f64; 2],
    /// Forces and moments on walls one step ago.
    walls: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// Forces one step ago on the corners of floors that move.
    #[serde(default)]
    sheets: Vec<Vec<[f64; 3]>>,
}

impl Ledger {
    pub fn watch(&mut self, on: bool) {
        *self = Ledger { watched: on, ..Ledger::default() };
    }

    /// Records the results of a step, before the walls move on.
    pub fn enter(&mut self, contacts: ContactEnergy, tally: &Tally, walls: &[Wall], dt: f64) {
        self.enter_contacts(contacts, walls, dt);
        self.enter_bodies(tally);
    }

    fn enter_contacts(&mut self, contacts: ContactEnergy, walls: &[Wall], dt: f64) {
        let now = &mut self.now;
        now.strain = contacts.strain;
        let felt: Vec<_> = walls.iter().map(|w| (w.felt.force, Vector3::from(w.moment))).collect();
        if self.begun {
            now.slip += contacts.slip;
            now.dashpot += contacts.dashpot;
            for ((wall, (force, moment)), (f, m)) in walls.iter().zip(&felt).zip(&self.walls) {
                // the force of the wall on the grains is opposite to its contact force
                now.walls -= 0.5 * dt * ((force + f).dot(&wall.velocity) + (moment + m).dot(&wall.spin));
            }
            let sheets = walls.iter().filter_map(Wall::sheet).zip(&self.sheets);
            now.walls += sheets.map(|(sheet, before)| sheet.work(before, dt)).sum::<f64>();
        }
        self.sheets = walls.iter().filter_map(Wall::sheet).map(|sheet| sheet.forces().to_vec()).collect();
        self.walls = felt;
    }

    fn enter_bodies(&mut self, tally: &Tally) {
        let now = &mut self.now;
        (now.translation, now.rotation) = (tally.translation, tally.rotation);
        let halves = [tally.gravity, tally.damping].map(|work| 0.5 * work);
        if self.begun {
            now.gravity += self.pending[0] + halves[0];
            now.damping += self.pending[1] + halves[1];
        } else {
            now.start = now.kinetic() + now.strain;
            self.begun = true;
        }
        self.pending = halves;
    }
}

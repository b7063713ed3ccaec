//! The space for grains of cribs and shoulders: between the sleepers, and beyond their ends up to the edge of the
//! shoulder.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::walls::WallId;
use super::description::Sleeper;
use super::filling::Filling;

/// Side of the columns by which empty space is measured, m.
const COLUMN: f64 = 0.01;

/// The space beside some sleepers, in plan.
pub(super) struct Pocket {
    /// Middle and half sides of each sleeper along and across, m.
    blocks: Vec<[[f64; 2]; 2]>,
    /// Largest distance across from the middle of a sleeper, m.
    reach: f64,
    plan: [f64; 2],
    periods: [Option<f64>; 2],
    /// m2.
    pub area: f64,
    /// Mean level of the undersides of the sleepers, m.
    pub underside: f64,
}

impl Pocket {
    /// The space beside sleepers; `walls` are their walls in the bed.
    pub fn around<R: Real>(bed: &Bed<R>, sleepers: &[Sleeper], walls: &[WallId], filling: &Filling) -> Pocket {
        let underside = |(sleeper, wall): (&Sleeper, &WallId)| {
            bed.wall(*wall).pose(bed.domain()).position.z - sleeper.size[2] / 2.0
        };
        let longest = sleepers.iter().map(|sleeper| sleeper.size[1]).fold(0.0, f64::max);
        let mut pocket = Pocket {
            blocks: sleepers.iter().map(|s| [s.place, [s.size[0] / 2.0, s.size[1] / 2.0]]).collect(),
            reach: longest / 2.0 + filling.crib.shoulder,
            plan: filling.plan,
            periods: [0, 1].map(|axis| bed.domain().period(axis)),
            area: 0.0,
            underside: sleepers.iter().zip(walls).map(underside).sum::<f64>() / sleepers.len().max(1) as f64,
        };
        let columns = pocket.columns();
        pocket.area = columns.area * columns.places().filter(|place| pocket.holds(*place, 0.0)).count() as f64;
        pocket
    }

    /// Whether a ball with its centre there in plan lies beside all sleepers, and inside the edge of the shoulder.
    pub fn holds(&self, place: [f64; 2], radius: f64) -> bool {
        let beside = |[middle, half]: &[[f64; 2]; 2]| {
            (0..2).any(|axis| self.apart(axis, place[axis], middle[axis]) >= half[axis] + radius)
        };
        let before = |[middle, _]: &[[f64; 2]; 2]| self.apart(1, place[1], middle[1]) + radius <= self.reach;
        self.blocks.iter().all(beside) && self.blocks.iter().any(before)
    }

    /// Space below a height above the underside of the sleepers that is not covered by grains, m3.
    pub fn empty<R: Real>(&self, bed: &Bed<R>, height: f64) -> f64 {
        let columns = self.columns();
        let mut tops = vec![self.underside; columns.count[0] * columns.count[1]];
        for pebble in bed.pebbles().filter(|pebble| pebble.place[2] + pebble.radius > self.underside) {
            columns.near(pebble.place, pebble.radius, |column, square| {
                let top = pebble.place[2] + (pebble.radius.powi(2) - square).sqrt();
                tops[column] = tops[column].max(top);
            });
        }
        let brim = self.underside + height;
        let open = columns.places().zip(tops).filter(|(place, _)| self.holds(*place, 0.0));
        open.map(|(_, top)| (brim - top).max(0.0) * columns.area).sum()
    }

    /// Distance along an axis, the shorter way across a period, m.
    fn apart(&self, axis: usize, a: f64, b: f64) -> f64 {
        let away = a - b;
        self.periods[axis].map_or(away, |period| away - period * (away / period).round()).abs()
    }

    fn columns(&self) -> Columns {
        let count = self.plan.map(|side| (side / COLUMN).ceil().max(1.0) as usize);
        let sides = [0, 1].map(|axis| self.plan[axis] / count[axis] as f64);
        Columns { count, sides, area: sides[0] * sides[1], periodic: self.periods.map(|period| period.is_some()) }
    }
}

/// The plan of a bed in columns.
struct Columns {
    count: [usize; 2],
    /// m.
    sides: [f64; 2],
    /// Area of one column, m2.
    area: f64,
    periodic: [bool; 2],
}

impl Columns {
    /// Centres of all columns in their order, m.
    fn places(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let ([along, across], [dx, dy]) = (self.count, self.sides);
        (0..along * across)
            .map(move |column| [((column % along) as f64 + 0.5) * dx, ((column / along) as f64 + 0.5) * dy])
    }

    /// Calls `tell` for each column covered by a ball, with its squared distance from the middle of the ball, m2.
    fn near(&self, place: [f64; 3], radius: f64, mut tell: impl FnMut(usize, f64)) {
        let range = |axis: usize| {
            let of = |x: f64| (x / self.sides[axis] - 0.5) as i64;
            of(place[axis] - radius).saturating_sub(1)..=of(place[axis] + radius).saturating_add(1)
        };
        // the column of this number along an axis; `None` beyond an end
        let column = |axis: usize, number: i64| {
            let count = self.count[axis] as i64;
            let wrapped = if self.periodic[axis] { number.rem_euclid(count) } else { number };
            (0..count).contains(&wrapped).then_some(wrapped as usize)
        };
        for (i, j) in range(1).flat_map(|j| range(0).map(move |i| (i, j))) {
            let middle = |axis: usize, number: i64| (number as f64 + 0.5) * self.sides[axis];
            let square = (middle(0, i) - place[0]).powi(2) + (middle(1, j) - place[1]).powi(2);
            if let (Some(x), Some(y)) = (column(0, i), column(1, j))
                && square < radius.powi(2)
            {
                tell(y * self.count[0] + x, square);
            }
        }
    }
}

//! The position of a train over time.
//!
//! The speed v is linear in x between the points of a profile. With the distance ξ from a point, `ξ' = v_0 + g ξ`, so
//!
//! ```text
//! ξ = v_0 (exp(g t) - 1)/g,    t = ln(v_1/v_0)/g,    g = (v_1 - v_0)/(ξ_1 - ξ_0)
//! ```

use super::error::{TrackError, TrackParameter};
use serde::{Deserialize, Serialize};

/// The speed of a train, m/s, above 0 in both directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    Constant(f64),
    /// Chainage of the leading wheel (m, increasing) and speed; linear in between, constant beyond the outer points.
    ByChainage(Vec<(f64, f64)>),
}

/// The positions of a leading wheel over time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Timetable {
    /// +1 or -1.
    sign: f64,
    /// In the order of travel.
    pieces: Vec<Piece>,
    /// s, from start to finish.
    pub duration: f64,
}

/// A part of the track on which the speed is linear in x.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// Time and place at which it begins, s and m.
    time: f64,
    x: f64,
    /// m/s, there.
    speed: f64,
    /// g: change of speed per distance, 1/s.
    growth: f64,
}

impl Motion {
    /// m/s, with the leading wheel at x (m).
    pub fn speed_at(&self, x: f64) -> f64 {
        match self {
            Motion::Constant(speed) => *speed,
            Motion::ByChainage(points) => {
                let right = points.partition_point(|point| point.0 <= x);
                match (points.get(right.wrapping_sub(1)), points.get(right)) {
                    (Some(&(a, v_a)), Some(&(b, v_b))) => v_a + (v_b - v_a) * (x - a) / (b - a),
                    (Some(&(_, speed)), None) | (None, Some(&(_, speed))) => speed,
                    (None, None) => f64::NAN,
                }
            }
        }
    }

    /// The run from `start` to `finish` (m). Fails if a speed is not above 0, if the chainages do not increase, or if
    /// the finish does not lie ahead in the direction `sign`.
    pub(super) fn timetable(&self, start: f64, finish: f64, sign: f64) -> Result<Timetable, TrackError> {
        let fail = |name, value, expected| Err(TrackError::Parameter { name, value, expected });
        let distance = sign * (finish - start);
        if !(distance > 0.0 && distance.is_finite()) {
            return fail(TrackParameter::Distance, distance, "above 0");
        }
        let points: &[(f64, f64)] = match self {
            Motion::Constant(speed) => &[(start, *speed)],
            Motion::ByChainage(points) => points,
        };
        if points.is_empty() {
            return fail(TrackParameter::SpeedProfile("points of a speed profile"), 0.0, "of 1 or more");
        }
        if let Some((_, speed)) = points.iter().find(|(_, speed)| !(*speed > 0.0 && speed.is_finite())) {
            return fail(TrackParameter::Speed, *speed, "above 0");
        }
        // Written so that a value that is not a number fails.
        if let Some((x, _)) = points.iter().find(|(x, _)| !x.is_finite()) {
            return fail(TrackParameter::SpeedProfile("chainage in a speed profile"), *x, "a finite number");
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
            return fail(
                TrackParameter::SpeedProfile("chainage in a speed profile"),
                pair[1].0,
                "above the chainage before it",
            );
        }
        let mut places = vec![start];
        places.extend(points.iter().map(|p| p.0).filter(|x| (start.min(finish) < *x) && (*x < start.max(finish))));
        places.push(finish);
        places.sort_by(|a, b| (sign * a).total_cmp(&(sign * b)));
        let (mut pieces, mut time) = (Vec::with_capacity(places.len()), 0.0);
        for pair in places.windows(2) {
            let (length, speed) = (sign * (pair[1] - pair[0]), self.speed_at(pair[0]));
            let change = self.speed_at(pair[1]) / speed - 1.0;
            pieces.push(Piece { time, x: pair[0], speed, growth: speed * change / length });
            time += length / speed * if change == 0.0 { 1.0 } else { change.ln_1p() / change };
        }
        Ok(Timetable { sign, pieces, duration: time })
    }
}

impl Timetable {
    /// Chainage of the leading wheel at a time since the start (s), m.
    pub fn position(&self, time: f64) -> f64 {
        let piece = self.pieces[self.pieces.partition_point(|piece| piece.time <= time).max(1) - 1];
        let since = time - piece.time;
        let stretch = if piece.growth == 0.0 { since } else { (piece.growth * since).exp_m1() / piece.growth };
        piece.x + self.sign * piece.speed * stretch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_speed() {
        let table = Motion::Constant(50.0).timetable(10.0, -10.0, -1.0).unwrap();
        assert_eq!((table.duration, table.position(0.0), table.position(0.1)), (0.4, 10.0, 5.0));
        let level = Motion::ByChainage(vec![(-5.0, 50.0), (5.0, 50.0)]).timetable(10.0, -10.0, -1.0).unwrap();
        for time in [0.0, 0.05, 0.2, 0.4] {
            assert!((level.position(time) - table.position(time)).abs() < 1e-13);
        }
    }

    /// Slower before x = 10 m, faster behind x = 20 m: compared with a Runge–Kutta method, in both directions.
    #[test]
    fn speed_by_chainage() {
        let motion = Motion::ByChainage(vec![(10.0, 40.0), (12.0, 10.0), (20.0, 15.0)]);
        for (start, finish, sign) in [(4.0, 31.0, 1.0), (29.0, 3.0, -1.0)] {
            let table = motion.timetable(start, finish, sign).unwrap();
            assert!((table.position(table.duration) - finish).abs() < 1e-12);
            let (mut x, h) = (start, table.duration / 20_000.0);
            let v = |x: f64| sign * motion.speed_at(x);
            for step in 0..20_000 {
                assert!((table.position(f64::from(step) * h) - x).abs() < 1e-6);
                let k1 = v(x);
                let k2 = v(x + 0.5 * h * k1);
                let k3 = v(x + 0.5 * h * k2);
                x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + v(x + h * k3));
            }
        }
    }

    #[test]
    fn impossible_motions_are_refused() {
        let by = Motion::ByChainage;
        for broken in [
            Motion::Constant(0.0),
            Motion::Constant(f64::NAN),
            by(vec![]),
            by(vec![(0.0, 10.0), (1.0, 0.0)]),
            by(vec![(1.0, 10.0), (1.0, 20.0)]),
        ] {
            assert!(broken.timetable(0.0, 5.0, 1.0).is_err(), "{broken:?}");
        }
        assert!(Motion::Constant(1.0).timetable(0.0, 5.0, -1.0).is_err());
    }
}

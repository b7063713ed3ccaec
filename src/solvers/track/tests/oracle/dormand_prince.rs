//! Dormand and Prince's pair of order 5(4) with error control and located contacts: a change of a support is a root of
//! `min(g, R)`, found to 1e-13 s, and the integration restarts there.

use super::Oracle;

/// Dormand and Prince's tableau: weights of the earlier stages in each stage, and the difference to the embedded fourth
/// order.
const STAGES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const TIMES: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

pub struct Integrator {
    pub oracle: Oracle,
    pub time: f64,
    pub y: Vec<f64>,
    step: f64,
    tolerance: f64,
    slopes: Vec<Vec<f64>>,
    stage: Vec<f64>,
    /// Whether `slopes[0]` belongs to the present state.
    fresh: bool,
    pub events: usize,
    pub steps: usize,
    /// Time in which each support carried no force, s.
    pub hanging: Vec<f64>,
}

impl Integrator {
    pub fn new(mut oracle: Oracle, y: Vec<f64>, tolerance: f64) -> Self {
        oracle.settle_phases(&y);
        Self {
            slopes: vec![vec![0.0; y.len()]; 7],
            stage: y.clone(),
            hanging: vec![0.0; oracle.seats()],
            oracle,
            time: 0.0,
            y,
            step: 1e-6,
            tolerance,
            fresh: false,
            events: 0,
            steps: 0,
        }
    }

    /// Tries a step; stores its end in `stage` and returns its error in units of the tolerance.
    fn attempt(&mut self, h: f64) -> f64 {
        if !self.fresh {
            self.oracle.rate(self.time, &self.y, &mut self.slopes[0]);
            self.fresh = true;
        }
        for (i, (row, at)) in STAGES.iter().zip(TIMES).enumerate() {
            self.stage.copy_from_slice(&self.y);
            for (part, slope) in row.iter().zip(&self.slopes) {
                for (value, slope) in self.stage.iter_mut().zip(slope) {
                    *value += h * part * slope;
                }
            }
            self.oracle.rate(self.time + at * h, &self.stage, &mut self.slopes[i + 1]);
        }
        let half = self.y.len() / 2;
        let mut worst = 0.0f64;
        for i in 0..self.y.len() {
            let error: f64 = ERROR.iter().zip(&self.slopes).map(|(part, slope)| part * slope[i]).sum();
            // Typical sizes of this motion are a millimetre and a tenth of a metre per second.
            let size = if i < half { 1e-3 } else { 0.1 };
            worst = worst.max((h * error).abs() / (self.tolerance * size));
        }
        worst
    }

    fn accept(&mut self, h: f64) {
        for (hanging, carrying) in self.hanging.iter_mut().zip(&self.oracle.carrying) {
            *hanging += if *carrying { 0.0 } else { h };
        }
        self.time += h;
        self.steps += 1;
        std::mem::swap(&mut self.y, &mut self.stage);
    }

    /// Integrates to `target`, s.
    pub fn advance(&mut self, target: f64) {
        while target - self.time > 1e-13 {
            let h = self.step.min(target - self.time);
            let error = self.attempt(h);
            let next = h * (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 2.0);
            if error > 1.0 {
                self.step = next;
                continue;
            }
            if !self.oracle.contradicted(&self.stage) {
                self.step = if h < self.step { self.step.max(next) } else { next };
                self.accept(h);
                self.slopes.swap(0, 6);
                continue;
            }
            let (mut low, mut high) = (0.0, h);
            while high - low > 1e-13 {
                let middle = 0.5 * (low + high);
                self.attempt(middle);
                if self.oracle.contradicted(&self.stage) { high = middle } else { low = middle }
            }
            self.attempt(high);
            self.accept(high);
            let y = std::mem::take(&mut self.y);
            self.oracle.settle_phases(&y);
            self.y = y;
            self.fresh = false;
            self.events += 1;
            self.step = 1e-6;
        }
    }
}

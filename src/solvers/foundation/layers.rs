//! The bearing area of a sleeper, the layers below it, and the resulting support.

use serde::{Deserialize, Serialize};

/// The bearing area of half a sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bearing {
    /// Width of the base of the sleeper, along the track, m.
    pub width: f64,
    /// Length across the track on which half a sleeper bears, m: about 0.95 m of 1.3 m, because ballast is not tamped
    /// in the middle.
    pub length: f64,
    /// Distances to the neighbouring sleepers on the left and on the right, centre to centre, m.
    pub spacings: [f64; 2],
    /// Distance from the inner end of the bearing area to the centre line of the track, m; the other half acts beyond
    /// it. `None` leaves the other half out.
    pub to_centre: Option<f64>,
}

/// One layer; thickness and material are constant within the reach of the load.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// m; 0 if the layer does not exist here.
    pub thickness: f64,
    /// Pa.
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    /// kg/m^3, in bulk.
    pub density: f64,
    /// Angle to the vertical at which the load spreads, rad. For ballast 35 degrees are usual. Only used by the stress
    /// cone.
    pub spread: f64,
}

/// The ground below the last layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Below {
    /// Rock: no displacement.
    Rigid,
    /// Distributed springs: Pa per metre of deflection, the modulus of subgrade reaction; in the elastic method the
    /// same stiffness acts against sliding.
    Springs { modulus: f64 },
    /// Infinite half-space: Young's modulus, Pa, and Poisson's ratio.
    HalfSpace { youngs_modulus: f64, poisson_ratio: f64 },
}

/// The method for the load spread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Method {
    /// Truncated pyramids, each in series with the one below (Zhai, Wang and Lin 2004). Neighbouring pyramids meet
    /// halfway and stop spreading there, as if all sleepers carried the same load.
    StressCone,
    /// Linear elasticity of bonded layers under a uniform pressure. Each neighbouring sleeper carries `neighbours`
    /// times the load of this sleeper: 0 for a single sleeper, 1 for equal loads.
    LayeredElastic { neighbours: f64 },
}

impl Method {
    /// Load of the sleepers next to a loaded sleeper on common track, as a share of its load: `exp(-t) (cos t + sin t)`
    /// with `t = lambda s = 0.65`, the deflection of a beam on springs at one spacing s beside the load.
    pub const NEIGHBOURS: f64 = 0.73;
}

/// The support of one rail seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// N/m.
    pub stiffness: f64,
    /// Moving mass of each layer, kg: the volume of the cone under this half sleeper times the density. An infinite
    /// elastic half-space has no such mass, so both methods give the mass of the cone.
    pub masses: Vec<f64>,
    /// Pressure under the sleeper and at the bottom of each layer, per newton of load, 1/m^2.
    pub pressures: Vec<f64>,
}

impl Support {
    /// Vertical pressure under the sleeper and at the bottom of each layer, Pa, for a load (N) on the seat. The stress
    /// cone gives the mean over the cone; the elastic method gives the pressure on the axis of the load below the
    /// sleeper, which is the largest.
    pub fn pressures(&self, load: f64) -> Vec<f64> {
        self.pressures.iter().map(|pressure| pressure * load).collect()
    }
}

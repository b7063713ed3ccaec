//! A sleeper's bearing, the layers below it, and the support that they make.

use serde::{Deserialize, Serialize};

/// Where half a sleeper lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bearing {
    /// Width of the sleeper's base, along the track, m.
    pub width: f64,
    /// Length across the track on which half a sleeper bears, m: about 0.95 m of 1.3 m, since ballast is not tamped in the
    /// middle.
    pub length: f64,
    /// Distances to the neighbouring sleepers on the left and on the right, centre to centre, m.
    pub spacings: [f64; 2],
    /// From the inner end of the bearing to the track's centre line, beyond which the other half acts, m. `None` leaves the
    /// other half out.
    pub to_centre: Option<f64>,
}

/// One layer, of the same thickness and the same material wherever the load reaches.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// m; a layer that has run out has none.
    pub thickness: f64,
    /// Pa.
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
    /// kg/m^3, in bulk.
    pub density: f64,
    /// Angle against the vertical at which the load spreads, rad. Of ballast 35 degrees are usual. Only the stress cone
    /// asks for it.
    pub spread: f64,
}

/// What lies below the last layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Below {
    /// Rock: nothing moves.
    Rigid,
    /// Springs side by side: Pa per metre of deflection, the modulus of subgrade reaction; in the elastic
    /// method the same against sliding.
    Springs { modulus: f64 },
    /// Ground without end: Young's modulus, Pa, and Poisson's ratio.
    HalfSpace { youngs_modulus: f64, poisson_ratio: f64 },
}

/// How the load is followed down.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Method {
    /// Truncated pyramids, each in series with the one below (Zhai, Wang and Lin 2004). Where neighbours meet, halfway
    /// between them, they stop to spread: as if each bore the same load.
    StressCone,
    /// Linear elasticity of bonded layers under a uniform pressure. Each neighbouring sleeper bears `neighbours` times the
    /// load of this one: 0 for a sleeper alone, 1 for all alike.
    LayeredElastic { neighbours: f64 },
}

impl Method {
    /// What the sleepers next to a loaded one bear of its load on common track: `exp(-t) (cos t + sin t)` with
    /// `t = lambda s = 0.65`, the deflection of a beam on springs one spacing s beside the load.
    pub const NEIGHBOURS: f64 = 0.73;
}

/// The support of one rail seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// N/m.
    pub stiffness: f64,
    /// What each layer moves, kg: the cone's volume under this half sleeper times the density. Elastic ground without end has
    /// no such mass, so that both methods give that of the cone.
    pub masses: Vec<f64>,
    /// Under the sleeper and at the bottom of each layer: pressure for each newton of load, 1/m^2.
    pub pressures: Vec<f64>,
}

impl Support {
    /// Vertical pressure under the sleeper and at the bottom of each layer in turn, Pa, for a load (N) on the seat. The
    /// stress cone gives the mean over the cone, the elastic method below the sleeper that on the axis of the load, which is
    /// the largest.
    pub fn pressures(&self, load: f64) -> Vec<f64> {
        self.pressures.iter().map(|pressure| pressure * load).collect()
    }
}

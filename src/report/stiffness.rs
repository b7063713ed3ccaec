//! Static stiffness at rail level along the track (paper, Fig. 8).

use super::along::{along_profile, track_chart};
use super::number::significant;
use super::panels::{Names, panels};
use super::scene::has_usps;
use super::{Figure, counts};
use crate::results::{Run, mean_wheel_load};

pub fn rail_stiffness(run: &Run) -> Option<Figure> {
    let mut chart = track_chart(run, "Static stiffness at rail level", "N/m", false);
    chart.series =
        counts::shown(run).iter().map(|count| along_profile(run, count, |row| row.stiffness_N_per_m)).collect();
    let load = mean_wheel_load(&run.scenario).map_or(String::new(), |f| format!(" of {} kN", significant(f / 1e3, 3)));
    let pads = match has_usps(&run.scenario) {
        true => " It includes every pad: under sleepers pad and support lie in series.",
        false => "",
    };
    let caption = format!(
        "Secant stiffness, per rail: a mean wheel load{load} standing still, over the rail deflection that it adds to the \
         unloaded track of that axle count; each place is an equilibrium with its own lost contacts. It is highest over the \
         seats and lowest between them. Where a sleeper hangs the wheel closes its void first, and the stiffness drops; \
         before the first axle it is that of the assembled matrix of the track, but for sleepers that the wheel lifts beside \
         itself.{pads}"
    );
    let names = Names { id: "rail_stiffness", title: "Track stiffness at rail level", caption: &caption };
    panels(&names, &[(chart, 330.0)], 1)
}

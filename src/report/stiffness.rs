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
        true => " It includes every pad: an under sleeper pad and its support are in series.",
        false => "",
    };
    let caption = format!(
        "Secant stiffness per rail: a mean wheel load{load} at rest, divided by the rail deflection that it adds to \
         the unloaded track at that axle count. Each place is an equilibrium with its own lost contacts. The stiffness \
         is highest over the seats and lowest between them. If a sleeper hangs, the wheel closes its void first, and \
         the stiffness drops. Before the first axle the stiffness is that of the assembled matrix of the track, except \
         for sleepers beside the wheel that the wheel lifts.{pads}"
    );
    let names = Names { id: "rail_stiffness", title: "Track stiffness at rail level", caption: &caption };
    panels(&names, &[(chart, 330.0)], 1)
}

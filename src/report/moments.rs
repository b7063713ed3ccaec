//! Bending moment of the rail along the track: during a passage, with the stress in the rail foot, and without a
//! vehicle.

use super::along::{along_profile, track_chart};
use super::curves::Series;
use super::number::significant;
use super::panels::{Names, panels};
use super::{Figure, counts};
use crate::results::Run;

pub fn rail_moments(run: &Run) -> Option<Figure> {
    if run.rail.is_empty() {
        return None;
    }
    let counts = counts::shown(run);
    let mut traffic = track_chart(run, "Rail moment during a passage", "N m", true);
    for count in &counts {
        traffic.series.push(along_profile(run, count, |row| row.max_moment_N_m));
        let hogging = along_profile(run, count, |row| row.min_moment_N_m);
        traffic.series.push(Series { name: String::new(), ..hogging });
    }
    let mut unloaded = track_chart(run, "Rail moment without a vehicle", "N m", true);
    unloaded.series = counts.iter().map(|count| along_profile(run, count, |row| row.moment_N_m)).collect();

    let moduli: Vec<f64> =
        run.scenario.track.sections.iter().filter_map(|section| Some(section.rail.as_ref()?.foot_modulus())).collect();
    let same = moduli.iter().all(|modulus| (modulus / moduli[0] - 1.0).abs() < 1e-9);
    let stress = match moduli.first() {
        Some(modulus) if same => {
            traffic.second = Some(("Foot stress [MPa]".to_owned(), 1e-6 / modulus));
            format!(
                " The right scale is the stress at the rail foot, tension positive, with a section modulus of {} \
                 cm\u{b3}: second moment of area divided by half the rail's height, for steel of 210 GPa. The neutral \
                 axis is assumed at half the height. Residual and thermal stress are not included.",
                significant(modulus * 1e6, 3)
            )
        }
        _ => String::new(),
    };
    let caption = format!(
        "Top: largest sagging and hogging moment of one rail at each place, drawn on the tension side: sagging is \
         positive and drawn downward. The curves cover the range of the wheels; near their ends only some wheels \
         pass.{stress} Bottom: moment in the unloaded rail, which bends if it bridges hanging sleepers."
    );
    let names = Names { id: "rail_moment", title: "Rail bending moment along the track", caption: &caption };
    panels(&names, &[(traffic, 320.0), (unloaded, 240.0)], 1)
}

//! Trackbed as a library: which under sleeper pad keeps the track stiffness of a transition closest to even?
//!
//! `cargo run --release --example library`

use trackbed::{Scene, Stopped};

const ZONE: &str = r#"
use std
use site

stretch padded { over = -count .. -1 sleepers, usp = usps.polyurethane { bedding_modulus = modulus } }
let count   = 12 sleepers
let modulus = 0.2 N/mm^3

track line { sections = [site.open: 24 m, site.deck: 12 m], stretches = padded }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 80 km/h }
traffic { trains = ore, total = 40 axles }
"#;

const SITE: &str = r#"
use std
trackform open {
  rail    = rails.UIC60
  pad     = pads.medium
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 60 MN/m per seat }
}
trackform deck : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
"#;

fn main() -> Result<(), Stopped> {
    let zone = Scene::from_text(ZONE).with_files([("site.track", SITE)]);
    println!("N/mm^3   stiffness from .. to, MN/m   largest settlement, mm   largest seat load, kN");
    for modulus in [0.1, 0.2, 0.4, 0.8] {
        let run = zone.clone().set("modulus", format!("{modulus} N/mm^3")).run()?;
        let stiffness: Vec<f64> = run.rail.iter().map(|row| row.stiffness_N_per_m / 1e6).collect();
        let (least, most) = stiffness.iter().fold((f64::MAX, 0.0_f64), |(a, b), k| (a.min(*k), b.max(*k)));
        let settled = run.scalar("max_settlement").unwrap_or(f64::NAN) * 1e3;
        let load = run.scalar("max_rail_seat_load").unwrap_or(f64::NAN) / 1e3;
        println!("{modulus:<6}   {least:>14.1} .. {most:<10.1}   {settled:>22.4}   {load:>20.1}");
    }
    Ok(())
}

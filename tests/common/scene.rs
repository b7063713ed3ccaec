//! A realistic scene to make mistakes in.

/// A scene without a mistake and without a warning.
pub const SCENE: &str = r#"// an embankment meets a slab
use std

let pad_stiffness = 40 MN/m
let bay = 0.6 m

scenario {
  title = "Embankment to slab"
  allow = [stiffness_jump: "this is what the scene is about"]
  deny  = [critical_speed]
}

trackform open {
  rail    = rails.UIC60 { density = 7800 kg/m^3, bending_stiffness = 6.4 MN m^2 }
  pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }
  sleeper = sleepers.concrete { mass = 150 kg per seat, length = 2.4 m }
  spacing = bay
  support = { stiffness = 50 MN/m per seat, damping = 50 kN s/m per seat }
  usp     = usps.stiff { damping_time = 0.1 ms }
  settlement = ramp(0 .. 2 mm, over = -6 .. 0 m), layers = [stone: 350 mm, fill: 1 m]
}

trackform stiff : open {
  sleeper = none
  support = none
  slab    = slabs.half_width_1600
  usp     = none
  settlement = 0 mm
}

track line {
  sections    = [open: 42 m, stiff: 24 m], stretches = [firm, low, wedge]
  transitions = [edge: soft_to_stiff]
  rail_ends   = clamped
}

vehicle wagon {
  axle_load = 20 t
  car_body  = { radius_of_gyration = 3.91 m }
  bogie     = { mass = 800 kg per bogie, pitch_inertia = 730 kg m^2 per bogie, spacing = 6.77 m }
  wheelset  = { mass = 1341 kg per wheelset, spacing = 1.78 m }
  primary   = { stiffness = 30 MN/m per wheelset, damping = 70 kN s/m per wheelset }
  secondary = { stiffness = 3.75 MN/m per bogie, damping = 10 kN s/m per bogie }
}

train ore {
  vehicles  = wagon
  speed     = 70 km/h
  direction = forward
}

law mild : laws.varandas_2014 {
  form.gamma = 8 mm
}

traffic {
  trains = ore
  total  = 500 axles
}

solve {
  substructure     = law
  law              = mild
  update_every     = geometric(4 axles, 0.2)
  elements_per_bay = 4
  time_step        = 1e-4 s
  finish           = 15 m
}

record forces {
  at         = [-20, -5, -1, +1] sleepers
  after      = [0, 100, 500] axles
  quantities = [rail_seat_load, contact_force]
}

record bed {
  over       = -20 .. -1 sleepers
  quantities = settlement
}

expect {
  that = [
    max(contact_force, over = -20 .. -1 sleepers) < 80 kN per seat
    -12 m < place_of_max(settlement) < 0 m
  ]
}

granular stone : ballasts.granite_31_63 {
  grading  = { passing = [22.4 mm: 0 %, 40 mm: 60 %, 63 mm: 100 %], cut_below = 25 mm }
  friction = 0.7
}

soil fill {
  youngs_modulus = 90 MPa, poisson_ratio = 0.3
  density        = 2000 kg/m^3
}

stretch firm {
  over          = -20 .. -1 sleepers
  pad.stiffness = ramp(60 .. 80 MN/m)
}

stretch low {
  over    = -10 .. -5 sleepers
  support = { stiffness = 45 MN/m per seat, damping_time = 1 ms }
}

study what_helps {
  vary       = [
    bay: [0.55, 0.6, 0.65] m
    low.support.stiffness: steps(30 .. 60 MN/m per seat, by = 10 MN/m per seat)
  ]
  set        = [ore.speed: 60 km/h]
  minimise   = max(settlement)
  report     = [far_field_settlement, mean(contact_force, over = -20 .. -1 sleepers)]
  subject_to = max(wheel_force) < 200 kN per wheel
}

tamping levelling {
  after = 200 axles
  over  = -20 .. -1 sleepers
  left  = 10 %
}

stretch wedge {
  over   = -12 .. 0 m
  layers = [stone: 0.35 m, treated: ramp(0.2 .. 0.6 m), fill: rest]
}

soil treated : fill { youngs_modulus = 300 MPa }
"#;

"""A small track on coarse spheres and soft soil before a slab: packed within seconds. Benches add its line, traffic and solver."""

SMALL_TRACK = """use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7, viscous_damping = 0.3
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
soil clay { youngs_modulus = 60 MPa, poisson_ratio = 0.3, density = 2000 kg/m^3 }
trackform open {
  rail = rails.UIC60, pad = { stiffness = 40 MN/m, damping = 5 kN s/m }
  sleeper = sleepers.concrete { mass = 150 kg per seat, length = 2 m }, spacing = 0.6 m
  layers = [stone: 200 mm, clay: 0.5 m], support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, slab = slabs.half_width_1600 }
"""

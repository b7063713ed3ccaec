//! Quantities that engineers give by another name, or in a unit of something near.

use crate::{B, J, S, Slip, T, U, X};
use trackbed::diag::Code::*;

#[rustfmt::skip]
pub const SLIPS: &[Slip] = &[
    // the bedding modulus of a pad, the stiffness of a support
    (U, "let first = 0.15 N/mm^3", "let first = 0.2 MPa", E0302, "`0.2 N/mm^3`", "0.2 MPa"),
    (U, "let first = 0.15 N/mm^3", "let first = 0.2 N/mm^2", E0302, "`0.2 N/mm^3`", "0.2 N/mm^2"),
    (U, "let first = 0.15 N/mm^3", "let first = 60 kN/mm", E0302, "base area", ""),
    (U, "let first = 0.15 N/mm^3", "let first = 150 MN/m^2", E0302, "`150 MN/m^3`", "150 MN/m^2"),
    (S, "stiffness = 50 MN/m per seat,", "stiffness = 50 kN/mm/m per seat,", E0302, "`30 MN/m", ""),
    (S, "stiffness = 50 MN/m per seat,", "stiffness = 50 MN/m^2 per seat,", E0302, "spacing", ""),
    (S, "stiffness = 50 MN/m per seat,", "stiffness = 50 MPa per seat,", E0302, "spacing", ""),
    (S, "stiffness = 50 MN/m per seat,", "stiffness = 0.1 N/mm^3 per seat,", E0302, "base area", ""),
    (S, "stiffness = 50 MN/m per seat,", "stiffness = 100 MN/m^3 per seat,", E0302, "base area", ""),
    (S, "support = { stiffness = 50 MN/m per seat, damping = 50 kN s/m per seat }", "support = 50 MN/m per seat", E0406, "`{ stiffness = 50 MN/m per seat }`", "50 MN/m per seat"),
    (S, "support = { stiffness = 50 MN/m per seat, damping = 50 kN s/m per seat }", "support = fixed", E0201, "`rigid`", ""),
    (S, "usp     = usps.stiff { damping_time = 0.1 ms }", "usp     = 0.3 N/mm^3", E0406, "`{ bedding_modulus = 0.3 N/mm^3 }`", "0.3 N/mm^3"),
    (S, "pad     = { stiffness = pad_stiffness, damping = 5 kN s/m }", "pad     = pad_stiffness", E0406, "`{ stiffness = pad_stiffness }`", "pad_stiffness"),
    (S, "sleepers.concrete { mass = 150 kg per seat, length = 2.4 m }", "300 kg", E0406, "`{ mass = 300 kg }`", ""),
    // dashpots
    (S, "damping = 5 kN s/m }", "damping = 10 % }", E0302, "`kN s/m`", ""),
    (S, "damping = 5 kN s/m }", "damping = 0.1 }", E0301, "damping_time", ""),
    (S, "damping = 5 kN s/m }", "damping = 0.125 ms }", E0302, "`damping_time = 0.125 ms`", "damping = 0.125 ms"),
    (S, "damping = 5 kN s/m }", "damping = 5 kN/m }", E0302, "`5 kN s/m`", "5 kN/m"),
    (S, "damping_time = 0.1 ms", "damping_time = 10 %", E0302, "damping / stiffness", ""),
    (S, "damping = 50 kN s/m per seat }", "damping = 50 kN s/m/m per seat }", E0302, "`50 kN s/m per seat`", ""),
    // weights and masses
    (S, "density        = 2000 kg/m^3", "density        = 18 kN/m^3", E0302, "`1835 kg/m^3`", "18 kN/m^3"),
    (B, "density = 2500 kg/m^3", "density = 25 kN/m^3", E0302, "`2548 kg/m^3`", "25 kN/m^3"),
    (S, "mass = 150 kg per seat", "mass = 1.5 kN per seat", E0302, "`152.9 kg per seat`", "1.5 kN per seat"),
    (J, "mass = 60 kg/m", "mass = 0.6 kN/m", E0302, "`61.16 kg/m`", ""),
    (J, "mass = 60 kg/m", "mass = 60 kg", E0302, "`60 kg/m`", "60 kg"),
    (J, "mass = 60 kg/m", "mass = 7850 kg/m^3", E0302, "`density = 7850 kg/m^3`", ""),
    (X, "cyclic(5 .. 60 kN, 20 Hz)", "cyclic(0.5 .. 6 t, 20 Hz)", E0302, "kN`", ""),
    (J, "force = 100 kN per rail", "force = 10 t per rail", E0302, "`98.1 kN per rail`", ""),
    (S, "< 80 kN per seat", "< 8 t per seat", E0305, "`78.48 kN per seat`", "8 t per seat"),
    (S, "axle_load = 20 t", "axle_load = 20 t/m", E0302, "`20 t`", "20 t/m"),
    (S, "axle_load = 20 t", "axle_load = 20 t/axle", E0302, "`20 t`", "20 t/axle"),
    (T, "confinement = 60 kPa", "confinement = 6 t/m^2", E0302, "`58.86 kPa`", "6 t/m^2"),
    (T, "confinement = 60 kPa", "confinement = 60 kN", E0302, "`60 kN/m^2`", "60 kN"),
    (S, "youngs_modulus = 90 MPa,", "youngs_modulus = 900 kg/cm^2,", E0302, "`88.29 MPa`", "900 kg/cm^2"),
    (S, "youngs_modulus = 90 MPa,", "youngs_modulus = 90 MN,", E0302, "`90 MN/m^2`", "90 MN"),
    (S, "let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 kN", E0302, "`40 kN/mm`", "40 kN"),
    (S, "let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MN m", E0302, "`40 MN/m`", "40 MN m"),
    (S, "let pad_stiffness = 40 MN/m", "let pad_stiffness = 40 MN per m", E0302, "`40 MN/m`", "40 MN per m"),
    // a value of another field of the same thing
    (S, "bending_stiffness = 6.4 MN m^2", "bending_stiffness = 3055 cm^4", E0302, "`second_moment = 3055 cm^4`", ""),
    (S, "bending_stiffness = 6.4 MN m^2", "bending_stiffness = 210 GPa", E0302, "`youngs_modulus = 210 GPa`", ""),
    (S, "car_body  = { radius_of_gyration = 3.91 m }", "car_body  = { pitch_inertia = 3.91 m }", E0302, "`radius_of_gyration = 3.91 m`", "pitch_inertia = 3.91 m"),
    (S, "bending_stiffness = 6.4 MN m^2", "bending_stiffness = 6.4 MN/m^2", E0302, "`6.4 MN m^2`", "6.4 MN/m^2"),
    // frequencies, periods, angles, slopes, numbers per length
    (S, "time_step        = 1e-4 s", "time_step        = 10 kHz", E0302, "`0.0001 s`", "10 kHz"),
    (X, "cyclic(5 .. 60 kN, 20 Hz)", "cyclic(5 .. 60 kN, 0.05 s)", E0302, "`20 Hz`", "0.05 s"),
    (X, "cyclic(5 .. 60 kN, 20 Hz)", "cyclic(5 .. 60 kN, 125.66 rad/s)", E0302, "`20 Hz`", "125.66 rad/s"),
    (X, "cyclic(5 .. 60 kN, 20 Hz)", "cyclic(5 .. 60 kN, 1200 rpm)", E0303, "Hz", ""),
    (S, "friction = 0.7", "friction = 35 deg", E0302, "`0.7002`", "35 deg"),
    (S, "spacing = bay", "spacing = 1667 sleepers/km", E0302, "`0.5999 m`", "1667 sleepers/km"),
    (S, "rail_ends   = clamped", "irregularity = 2 mm/m", E0302, "`ramp(", ""),
    (S, "rail_ends   = clamped", "irregularity = 2 ‰", E0302, "`ramp(", ""),
    (S, "settlement = 0 mm\n", "settlement = 1/200\n", E0302, "`ramp(", ""),
    (S, "speed     = 70 km/h", "speed     = 70 km", E0302, "`70 km/h`", "70 km"),
    (S, "speed     = 70 km/h", "speed     = 70 km per h", E0302, "`70 km/h`", "70 km per h"),
    (S, "wheelset  = { mass = 1341 kg per wheelset, spacing = 1.78 m }", "wheelset  = { mass = 1341 kg per wheelset, spacing = 1.78 m, radius = 920 mm }", E0405, "`460 mm`", "920 mm"),
    (T, "strain      = 10 %", "strain      = 60 mm", E0302, "`%`", ""),
    (S, "elements_per_bay = 4", "elements_per_bay = 0.15 m", E0302, "whole number", ""),
];

//! Lanes as plain arrays: the reference for all other kinds, used on machines without wide instructions.

use super::{BLOCK, Columns, Fine, FineVector, Lanes, Num, Real, Row, Vector};
use crate::solvers::granular::entry::Entry;
use crate::solvers::granular::record::Record;
use std::marker::PhantomData;

/// `W` lanes of `R`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Plain<R, const W: usize>(PhantomData<R>);

impl<R, const W: usize> Plain<R, W> {
    pub fn new() -> Self {
        Plain(PhantomData)
    }
}

impl<R: Real, const W: usize> Lanes for Plain<R, W> {
    const WIDTH: usize = W;
    type Real = R;
    type Num = [R; W];
    type Fine = [f64; W];
    type Mask = [bool; W];

    #[inline(always)]
    fn splat(self, value: R) -> [R; W] {
        [value; W]
    }
    #[inline(always)]
    fn load(self, from: &[R]) -> [R; W] {
        from[..W].try_into().expect("a number for each lane")
    }
    #[inline(always)]
    fn store(self, value: [R; W], to: &mut [R]) {
        to[..W].copy_from_slice(&value);
    }
    #[inline(always)]
    fn add(self, a: [R; W], b: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = a[l] + b[l];
        }
        out
    }
    #[inline(always)]
    fn sub(self, a: [R; W], b: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = a[l] - b[l];
        }
        out
    }
    #[inline(always)]
    fn mul(self, a: [R; W], b: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = a[l] * b[l];
        }
        out
    }
    #[inline(always)]
    fn div(self, a: [R; W], b: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = a[l] / b[l];
        }
        out
    }
    #[inline(always)]
    fn fma(self, a: [R; W], b: [R; W], c: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = a[l].fma(b[l], c[l]);
        }
        out
    }
    #[inline(always)]
    fn sqrt(self, a: [R; W]) -> [R; W] {
        let mut out = a;
        for l in 0..W {
            out[l] = a[l].sqrt();
        }
        out
    }
    #[inline(always)]
    fn min(self, a: [R; W], b: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = if a[l] < b[l] { a[l] } else { b[l] };
        }
        out
    }
    #[inline(always)]
    fn max(self, a: [R; W], b: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = if a[l] > b[l] { a[l] } else { b[l] };
        }
        out
    }
    #[inline(always)]
    fn less(self, a: [R; W], b: [R; W]) -> [bool; W] {
        let mut out = [false; W];
        for l in 0..W {
            out[l] = a[l] < b[l];
        }
        out
    }
    #[inline(always)]
    fn select(self, mask: [bool; W], yes: [R; W], no: [R; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = if mask[l] { yes[l] } else { no[l] };
        }
        out
    }
    #[inline(always)]
    fn bits(self, mask: [bool; W]) -> u32 {
        let mut bits = 0;
        for l in 0..W {
            bits |= u32::from(mask[l]) << l;
        }
        bits
    }

    #[inline(always)]
    fn fine_splat(self, value: f64) -> [f64; W] {
        [value; W]
    }
    #[inline(always)]
    fn fine_load(self, from: &[f64]) -> [f64; W] {
        from[..W].try_into().expect("a number for each lane")
    }
    #[inline(always)]
    fn fine_add(self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        let mut out = [0.0; W];
        for l in 0..W {
            out[l] = a[l] + b[l];
        }
        out
    }
    #[inline(always)]
    fn fine_sub(self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        let mut out = [0.0; W];
        for l in 0..W {
            out[l] = a[l] - b[l];
        }
        out
    }
    #[inline(always)]
    fn fine_fma(self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        let mut out = [0.0; W];
        for l in 0..W {
            out[l] = a[l].mul_add(b[l], c[l]);
        }
        out
    }
    #[inline(always)]
    fn fine_store(self, value: [f64; W], to: &mut [f64]) {
        to[..W].copy_from_slice(&value);
    }
    #[inline(always)]
    fn fine_mul(self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        let mut out = [0.0; W];
        for l in 0..W {
            out[l] = a[l] * b[l];
        }
        out
    }
    #[inline(always)]
    fn fine_div(self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        let mut out = [0.0; W];
        for l in 0..W {
            out[l] = a[l] / b[l];
        }
        out
    }
    #[inline(always)]
    fn fine_sqrt(self, a: [f64; W]) -> [f64; W] {
        let mut out = a;
        for l in 0..W {
            out[l] = a[l].sqrt();
        }
        out
    }
    #[inline(always)]
    fn fine_abs(self, a: [f64; W]) -> [f64; W] {
        let mut out = a;
        for l in 0..W {
            out[l] = a[l].abs();
        }
        out
    }
    #[inline(always)]
    fn fine_where_less(self, a: [f64; W], b: [f64; W], yes: [f64; W], no: [f64; W]) -> [f64; W] {
        let mut out = no;
        for l in 0..W {
            out[l] = if a[l] < b[l] { yes[l] } else { no[l] };
        }
        out
    }
    #[inline(always)]
    fn fine_any_less(self, a: [f64; W], b: [f64; W]) -> bool {
        let mut any = false;
        for l in 0..W {
            any |= a[l] < b[l];
        }
        any
    }
    #[inline(always)]
    fn narrow(self, a: [f64; W]) -> [R; W] {
        let mut out = [R::default(); W];
        for l in 0..W {
            out[l] = R::from_f64(a[l]);
        }
        out
    }
    #[inline(always)]
    fn widen(self, a: [R; W]) -> [f64; W] {
        let mut out = [0.0; W];
        for l in 0..W {
            out[l] = a[l].to_f64();
        }
        out
    }

    #[inline(always)]
    fn gather(self, records: &[R::Record], index: &[u32]) -> Columns<Self> {
        let (mut position, mut velocity, mut spin) = ([[0.0; W]; 3], [[R::default(); W]; 3], [[R::default(); W]; 3]);
        let (mut radius, mut mass) = ([0.0; W], [R::default(); W]);
        for l in 0..W {
            let row = &records[index[l] as usize];
            for c in 0..3 {
                position[c][l] = row.position()[c];
                velocity[c][l] = row.velocity()[c];
                spin[c][l] = row.spin()[c];
            }
            (radius[l], mass[l]) = (row.radius(), row.mass());
        }
        Columns {
            position: [fine(self, position[0]), fine(self, position[1]), fine(self, position[2])],
            radius: fine(self, radius),
            velocity: Vector([num(self, velocity[0]), num(self, velocity[1]), num(self, velocity[2])]),
            spin: Vector([num(self, spin[0]), num(self, spin[1]), num(self, spin[2])]),
            mass: num(self, mass),
        }
    }

    #[inline(always)]
    fn move_records(
        self,
        records: &mut [R::Record],
        index: &[u32; BLOCK],
        position: FineVector<Self>,
        velocity: Vector<Self>,
        spin: Vector<Self>,
    ) {
        for l in 0..W {
            if let Some(record) = records.get_mut(index[l] as usize) {
                record.place([0, 1, 2].map(|c| position.0[c].value[l]));
                record.move_with([0, 1, 2].map(|c| velocity.0[c].value[l]), [0, 1, 2].map(|c| spin.0[c].value[l]));
            }
        }
    }

    #[inline(always)]
    fn columns(self, rows: [&[f64; 8]; BLOCK]) -> [Fine<Self>; 8] {
        let mut columns = [[0.0; W]; 8];
        for l in 0..W {
            for c in 0..8 {
                columns[c][l] = rows[l][c];
            }
        }
        columns.map(|value| fine(self, value))
    }

    #[inline(always)]
    fn short_columns(self, rows: [&[f64; 4]; BLOCK]) -> [Fine<Self>; 4] {
        let mut columns = [[0.0; W]; 4];
        for l in 0..W {
            for c in 0..4 {
                columns[c][l] = rows[l][c];
            }
        }
        columns.map(|value| fine(self, value))
    }

    #[inline(always)]
    fn rows(self, columns: [Fine<Self>; 8]) -> [[f64; 8]; BLOCK] {
        let mut rows = [[0.0; 8]; BLOCK];
        for l in 0..W {
            for c in 0..8 {
                rows[l][c] = columns[c].value[l];
            }
        }
        rows
    }

    #[inline(always)]
    fn gather_rows(self, rows: &[Row<R>], entries: &[Entry]) -> [Num<Self>; 8] {
        let mut columns = [[R::default(); W]; 8];
        for l in 0..W {
            for c in 0..8 {
                columns[c][l] = rows[entries[l].place()][c];
            }
        }
        columns.map(|value| num(self, value))
    }

    #[inline(always)]
    fn of_second(self, entries: &[Entry]) -> [bool; W] {
        let mut mask = [false; W];
        for l in 0..W {
            mask[l] = entries[l].is_second();
        }
        mask
    }

    #[inline(always)]
    fn scatter(self, columns: [Num<Self>; 8], to: &mut [Row<R>]) {
        for (l, row) in to[..W].iter_mut().enumerate() {
            for c in 0..8 {
                row.0[c] = columns[c].value[l];
            }
        }
    }
}

#[inline(always)]
fn num<R: Real, const W: usize>(lanes: Plain<R, W>, value: [R; W]) -> Num<Plain<R, W>> {
    Num { lanes, value }
}

#[inline(always)]
fn fine<R: Real, const W: usize>(lanes: Plain<R, W>, value: [f64; W]) -> Fine<Plain<R, W>> {
    Fine { lanes, value }
}

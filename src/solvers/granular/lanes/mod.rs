//! Numbers in lanes: the same arithmetic on many contacts at once.
//!
//! The physics of a contact is written once, over [`Num`] and [`Fine`]; a [`Lanes`] defines the number of lanes and
//! their instructions. Only operations that IEEE 754 rounds correctly are used (`+ - * /`, square root, fused
//! multiply-add), so all kinds of lanes give the same bits.

// loops run over the lanes of several arrays at once
#![allow(clippy::needless_range_loop)]

mod dispatch;
mod fine;
mod plain;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use fine::{FineVector, Matrix};
pub use plain::Plain;

use super::entry::Entry;
use super::record::Record;
use bytemuck::Pod;
use serde::{Serialize, de::DeserializeOwned};
use std::ops::{Add, Div, Index, Mul, Neg, Sub};

/// Contacts that are stored together; a multiple of every width.
pub const BLOCK: usize = 16;

/// Index of a lane that has no record.
pub const NOWHERE: u32 = u32::MAX;

/// A precision for forces, velocities and contact histories. Positions and sums are always `f64`.
pub trait Real:
    Pod
    + Send
    + Sync
    + PartialOrd
    + Default
    + std::fmt::Debug
    + Serialize
    + DeserializeOwned
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + 'static
{
    /// The data of a pebble that a contact reads.
    type Record: Record<Self>;
    /// The name of the precision, for tables.
    const NAME: &'static str;

    fn from_f64(value: f64) -> Self;
    fn to_f64(self) -> f64;
    fn sqrt(self) -> Self;
    fn fma(self, factor: Self, summand: Self) -> Self;

    /// Runs `work` with the widest lanes of this machine.
    fn dispatch<W: Work<Self>>(work: W) -> W::Output;
}

/// Work done in lanes.
pub trait Work<R: Real> {
    type Output;
    fn run<L: Lanes<Real = R>>(self, lanes: L) -> Self::Output;
}

/// Columns of the records of some pebbles, one pebble per lane.
pub struct Columns<L: Lanes> {
    pub position: [Fine<L>; 3],
    pub radius: Fine<L>,
    pub velocity: Vector<L>,
    pub spin: Vector<L>,
    pub mass: Num<L>,
}

/// Eight numbers of one contact, in one cache line.
#[repr(C, align(32))]
#[derive(Debug, Clone, Copy, Default)]
pub struct Row<R>(pub [R; 8]);

impl<R> Index<usize> for Row<R> {
    type Output = R;
    #[inline(always)]
    fn index(&self, place: usize) -> &R {
        &self.0[place]
    }
}

/// A set of lanes, with the instructions that work on them.
pub trait Lanes: Copy {
    const WIDTH: usize;
    type Real: Real;
    /// A number in the precision of the contact in each lane.
    type Num: Copy;
    /// An `f64` in each lane.
    type Fine: Copy;
    type Mask: Copy;

    fn splat(self, value: Self::Real) -> Self::Num;
    fn load(self, from: &[Self::Real]) -> Self::Num;
    fn store(self, value: Self::Num, to: &mut [Self::Real]);
    fn add(self, a: Self::Num, b: Self::Num) -> Self::Num;
    fn sub(self, a: Self::Num, b: Self::Num) -> Self::Num;
    fn mul(self, a: Self::Num, b: Self::Num) -> Self::Num;
    fn div(self, a: Self::Num, b: Self::Num) -> Self::Num;
    /// `a b + c`, rounded once.
    fn fma(self, a: Self::Num, b: Self::Num, c: Self::Num) -> Self::Num;
    fn sqrt(self, a: Self::Num) -> Self::Num;
    fn min(self, a: Self::Num, b: Self::Num) -> Self::Num;
    fn max(self, a: Self::Num, b: Self::Num) -> Self::Num;
    fn less(self, a: Self::Num, b: Self::Num) -> Self::Mask;
    /// `yes` if the mask is set, otherwise `no`, lane by lane.
    fn select(self, mask: Self::Mask, yes: Self::Num, no: Self::Num) -> Self::Num;
    /// One bit per lane, the first lane lowest.
    fn bits(self, mask: Self::Mask) -> u32;

    fn fine_splat(self, value: f64) -> Self::Fine;
    fn fine_load(self, from: &[f64]) -> Self::Fine;
    fn fine_add(self, a: Self::Fine, b: Self::Fine) -> Self::Fine;
    fn fine_sub(self, a: Self::Fine, b: Self::Fine) -> Self::Fine;
    fn fine_fma(self, a: Self::Fine, b: Self::Fine, c: Self::Fine) -> Self::Fine;
    fn fine_store(self, value: Self::Fine, to: &mut [f64]);
    fn fine_mul(self, a: Self::Fine, b: Self::Fine) -> Self::Fine;
    fn fine_div(self, a: Self::Fine, b: Self::Fine) -> Self::Fine;
    fn fine_sqrt(self, a: Self::Fine) -> Self::Fine;
    fn fine_abs(self, a: Self::Fine) -> Self::Fine;
    /// `yes` if `a < b`, otherwise `no`, lane by lane.
    fn fine_where_less(self, a: Self::Fine, b: Self::Fine, yes: Self::Fine, no: Self::Fine) -> Self::Fine;
    fn fine_any_less(self, a: Self::Fine, b: Self::Fine) -> bool;
    fn narrow(self, a: Self::Fine) -> Self::Num;
    fn widen(self, a: Self::Num) -> Self::Fine;

    /// The records at `index`, transposed.
    fn gather(self, records: &[<Self::Real as Real>::Record], index: &[u32]) -> Columns<Self>;
    /// Moves the records at `index`; lanes at [`NOWHERE`] are left out.
    fn move_records(
        self,
        records: &mut [<Self::Real as Real>::Record],
        index: &[u32; BLOCK],
        position: FineVector<Self>,
        velocity: Vector<Self>,
        spin: Vector<Self>,
    );
    /// Rows of eight numbers, one per lane, transposed.
    fn columns(self, rows: [&[f64; 8]; BLOCK]) -> [Fine<Self>; 8];
    /// Rows of four numbers, one per lane, transposed.
    fn short_columns(self, rows: [&[f64; 4]; BLOCK]) -> [Fine<Self>; 4];
    /// Eight columns, transposed to a row per lane.
    fn rows(self, columns: [Fine<Self>; 8]) -> [[f64; 8]; BLOCK];
    /// The outcomes of contacts, one per lane, transposed.
    fn gather_rows(self, rows: &[Row<Self::Real>], entries: &[Entry]) -> [Num<Self>; 8];
    /// Set for the second of the two pebbles of a contact.
    fn of_second(self, entries: &[Entry]) -> Self::Mask;
    /// Eight numbers per lane, written lane by lane.
    fn scatter(self, columns: [Num<Self>; 8], to: &mut [Row<Self::Real>]);
}

/// A number in the precision of the contact in each lane.
#[derive(Clone, Copy)]
pub struct Num<L: Lanes> {
    pub lanes: L,
    pub value: L::Num,
}

/// An `f64` in each lane.
#[derive(Clone, Copy)]
pub struct Fine<L: Lanes> {
    pub lanes: L,
    pub value: L::Fine,
}

macro_rules! operator {
    ($type:ident, $trait:ident, $name:ident, $call:ident) => {
        impl<L: Lanes> $trait for $type<L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                $type { lanes: self.lanes, value: self.lanes.$call(self.value, other.value) }
            }
        }
    };
}

operator!(Num, Add, add, add);
operator!(Num, Sub, sub, sub);
operator!(Num, Mul, mul, mul);
operator!(Num, Div, div, div);
operator!(Fine, Add, add, fine_add);
operator!(Fine, Sub, sub, fine_sub);
operator!(Fine, Mul, mul, fine_mul);
operator!(Fine, Div, div, fine_div);

impl<L: Lanes> Neg for Num<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.alike(-L::Real::from_f64(1.0)) * self
    }
}

impl<L: Lanes> Num<L> {
    #[inline(always)]
    pub fn splat(lanes: L, value: f64) -> Self {
        Num { lanes, value: lanes.splat(L::Real::from_f64(value)) }
    }

    #[inline(always)]
    pub fn load(lanes: L, from: &[L::Real]) -> Self {
        Num { lanes, value: lanes.load(from) }
    }

    #[inline(always)]
    pub fn store(self, to: &mut [L::Real]) {
        self.lanes.store(self.value, to);
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn alike(self, value: L::Real) -> Self {
        Num { lanes: self.lanes, value: self.lanes.splat(value) }
    }

    /// `self factor + summand`, rounded once.
    #[inline(always)]
    pub fn fma(self, factor: Self, summand: Self) -> Self {
        Num { lanes: self.lanes, value: self.lanes.fma(self.value, factor.value, summand.value) }
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Num { lanes: self.lanes, value: self.lanes.sqrt(self.value) }
    }

    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Num { lanes: self.lanes, value: self.lanes.min(self.value, other.value) }
    }

    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Num { lanes: self.lanes, value: self.lanes.max(self.value, other.value) }
    }

    #[inline(always)]
    pub fn less(self, other: Self) -> L::Mask {
        self.lanes.less(self.value, other.value)
    }

    /// `self` if the mask is set, otherwise `other`, lane by lane.
    #[inline(always)]
    pub fn where_or(self, mask: L::Mask, other: Self) -> Self {
        Num { lanes: self.lanes, value: self.lanes.select(mask, self.value, other.value) }
    }

    #[inline(always)]
    pub fn widen(self) -> Fine<L> {
        Fine { lanes: self.lanes, value: self.lanes.widen(self.value) }
    }
}

/// A vector in each lane.
#[derive(Clone, Copy)]
pub struct Vector<L: Lanes>(pub [Num<L>; 3]);

impl<L: Lanes> Vector<L> {
    #[inline(always)]
    pub fn dot(self, b: Self) -> Num<L> {
        let (a, b) = (self.0, b.0);
        a[2].fma(b[2], a[1].fma(b[1], a[0] * b[0]))
    }

    /// Both products of a component are rounded, so that swapped signs give exactly swapped signs.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }

    #[inline(always)]
    pub fn scale(self, factor: Num<L>) -> Self {
        let [x, y, z] = self.0;
        Vector([x * factor, y * factor, z * factor])
    }

    /// `self factor + summand`.
    #[inline(always)]
    pub fn fma(self, factor: Num<L>, summand: Self) -> Self {
        let (a, b) = (self.0, summand.0);
        Vector([a[0].fma(factor, b[0]), a[1].fma(factor, b[1]), a[2].fma(factor, b[2])])
    }

    /// `self` if the mask is set, otherwise 0, lane by lane.
    #[inline(always)]
    pub fn only(self, mask: L::Mask) -> Self {
        let [x, y, z] = self.0;
        let zero = Num::splat(x.lanes, 0.0);
        Vector([x.where_or(mask, zero), y.where_or(mask, zero), z.where_or(mask, zero)])
    }

    #[inline(always)]
    pub fn widen(self) -> FineVector<L> {
        let [x, y, z] = self.0;
        FineVector([x.widen(), y.widen(), z.widen()])
    }

    #[inline(always)]
    pub fn load(lanes: L, from: &[[L::Real; BLOCK]; 3], at: usize) -> Self {
        let end = at + L::WIDTH;
        Vector([
            Num::load(lanes, &from[0][at..end]),
            Num::load(lanes, &from[1][at..end]),
            Num::load(lanes, &from[2][at..end]),
        ])
    }

    #[inline(always)]
    pub fn store(self, to: &mut [[L::Real; BLOCK]; 3], at: usize) {
        for c in 0..3 {
            self.0[c].store(&mut to[c][at..at + L::WIDTH]);
        }
    }
}

impl<L: Lanes> Add for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Vector([self.0[0] + b.0[0], self.0[1] + b.0[1], self.0[2] + b.0[2]])
    }
}

impl<L: Lanes> Sub for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Vector([self.0[0] - b.0[0], self.0[1] - b.0[1], self.0[2] - b.0[2]])
    }
}

//! Numbers, vectors and matrices in double precision, one per lane. Products and sums are rounded one by one, as in
//! [`vector`](super::super::vector): a body gets the same bits in any lane.

use super::{Fine, Lanes, Num, Vector};
use std::ops::{Add, Neg, Sub};

impl<L: Lanes> Fine<L> {
    #[inline(always)]
    pub fn splat(lanes: L, value: f64) -> Self {
        Fine { lanes, value: lanes.fine_splat(value) }
    }

    #[inline(always)]
    pub fn load(lanes: L, from: &[f64]) -> Self {
        Fine { lanes, value: lanes.fine_load(from) }
    }

    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        self.lanes.fine_store(self.value, to);
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn alike(self, value: f64) -> Self {
        Fine::splat(self.lanes, value)
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Fine { lanes: self.lanes, value: self.lanes.fine_sqrt(self.value) }
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Fine { lanes: self.lanes, value: self.lanes.fine_abs(self.value) }
    }

    /// `self` if `a < b`, otherwise `other`, lane by lane.
    #[inline(always)]
    pub fn where_less(self, a: Self, b: Self, other: Self) -> Self {
        Fine { lanes: self.lanes, value: self.lanes.fine_where_less(a.value, b.value, self.value, other.value) }
    }

    /// Whether any lane is less than the same lane of `other`.
    #[inline(always)]
    pub fn any_less(self, other: Self) -> bool {
        self.lanes.fine_any_less(self.value, other.value)
    }

    /// `self factor + summand`, rounded once.
    #[inline(always)]
    pub fn fma(self, factor: Self, summand: Self) -> Self {
        Fine { lanes: self.lanes, value: self.lanes.fine_fma(self.value, factor.value, summand.value) }
    }

    #[inline(always)]
    pub fn narrow(self) -> Num<L> {
        Num { lanes: self.lanes, value: self.lanes.narrow(self.value) }
    }
}

impl<L: Lanes> Neg for Fine<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.alike(-1.0) * self
    }
}

/// A vector of space in each lane.
#[derive(Clone, Copy)]
pub struct FineVector<L: Lanes>(pub [Fine<L>; 3]);

impl<L: Lanes> FineVector<L> {
    #[inline(always)]
    pub fn splat(lanes: L, value: [f64; 3]) -> Self {
        let [x, y, z] = value;
        FineVector([Fine::splat(lanes, x), Fine::splat(lanes, y), Fine::splat(lanes, z)])
    }

    /// Three columns.
    #[inline(always)]
    pub fn load(lanes: L, columns: [&[f64]; 3]) -> Self {
        let [x, y, z] = columns;
        FineVector([Fine::load(lanes, x), Fine::load(lanes, y), Fine::load(lanes, z)])
    }

    #[inline(always)]
    pub fn dot(self, b: Self) -> Fine<L> {
        let (a, b) = (self.0, b.0);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        FineVector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }

    #[inline(always)]
    pub fn scale(self, factor: Fine<L>) -> Self {
        let [x, y, z] = self.0;
        FineVector([x * factor, y * factor, z * factor])
    }

    /// Component by component.
    #[inline(always)]
    pub fn times(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        FineVector([a[0] * b[0], a[1] * b[1], a[2] * b[2]])
    }

    /// `self` if `a < b`, otherwise `other`, lane by lane.
    #[inline(always)]
    pub fn where_less(self, a: Fine<L>, b: Fine<L>, other: Self) -> Self {
        let ([x, y, z], o) = (self.0, other.0);
        FineVector([x.where_less(a, b, o[0]), y.where_less(a, b, o[1]), z.where_less(a, b, o[2])])
    }

    #[inline(always)]
    pub fn narrow(self) -> Vector<L> {
        let [x, y, z] = self.0;
        Vector([x.narrow(), y.narrow(), z.narrow()])
    }
}

impl<L: Lanes> Add for FineVector<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        FineVector([self.0[0] + b.0[0], self.0[1] + b.0[1], self.0[2] + b.0[2]])
    }
}

impl<L: Lanes> Sub for FineVector<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        FineVector([self.0[0] - b.0[0], self.0[1] - b.0[1], self.0[2] - b.0[2]])
    }
}

/// Rows of a matrix in each lane.
#[derive(Clone, Copy)]
pub struct Matrix<L: Lanes>(pub [FineVector<L>; 3]);

impl<L: Lanes> Matrix<L> {
    #[inline(always)]
    pub fn apply(&self, v: FineVector<L>) -> FineVector<L> {
        let [x, y, z] = self.0;
        FineVector([x.dot(v), y.dot(v), z.dot(v)])
    }

    /// By the transposed matrix.
    #[inline(always)]
    pub fn apply_back(&self, v: FineVector<L>) -> FineVector<L> {
        let ([x, y, z], [a, b, c]) = ([self.0[0].0, self.0[1].0, self.0[2].0], v.0);
        FineVector([x[0] * a + y[0] * b + z[0] * c, x[1] * a + y[1] * b + z[1] * c, x[2] * a + y[2] * b + z[2] * c])
    }
}

//! Eight lanes of AVX2.

use super::{Entered, halves_of};
use crate::solvers::granular::entry::Entry;
use crate::solvers::granular::lanes::{BLOCK, Columns, Fine, FineVector, Lanes, Num, Row, Vector, Work};
use crate::solvers::granular::record::Compact;
use bytemuck::{cast, cast_mut, cast_ref, must_cast};
use pulp::x86::V3;
use std::arch::x86_64::{__m128, __m256, __m256d};

/// AVX2 with fused products.
#[derive(Debug, Clone, Copy)]
pub struct Middle(V3);

impl Middle {
    #[inline(always)]
    pub fn detect() -> Option<Middle> {
        V3::try_new().map(Middle)
    }

    /// Runs `work` compiled for these instructions, in `lanes`.
    #[inline(always)]
    pub fn enter<L: Lanes, W: Work<L::Real>>(self, work: W, lanes: L) -> W::Output {
        self.0.vectorize(Entered { work, lanes })
    }
}

impl Middle {
    /// Words of four records, record by record, to eight words of one kind each.
    #[inline(always)]
    fn words(self, records: &[Compact], index: &[u32]) -> [__m256d; 8] {
        let mut rows = [[self.0.avx._mm256_setzero_pd(); 2]; 4];
        for l in 0..4 {
            rows[l] = *cast_ref(&records[index[l] as usize]);
        }
        let mut columns = [rows[0][0]; 8];
        for half in 0..2 {
            let four = self.transpose([rows[0][half], rows[1][half], rows[2][half], rows[3][half]]);
            columns[4 * half..4 * half + 4].copy_from_slice(&four);
        }
        columns
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
        let s = self.0.avx;
        let (even, odd) = (
            [s._mm256_unpacklo_pd(a, b), s._mm256_unpacklo_pd(c, d)],
            [s._mm256_unpackhi_pd(a, b), s._mm256_unpackhi_pd(c, d)],
        );
        [
            s._mm256_permute2f128_pd::<0x20>(even[0], even[1]),
            s._mm256_permute2f128_pd::<0x20>(odd[0], odd[1]),
            s._mm256_permute2f128_pd::<0x31>(even[0], even[1]),
            s._mm256_permute2f128_pd::<0x31>(odd[0], odd[1]),
        ]
    }

    /// The first and the second halves of eight pairs of numbers.
    #[inline(always)]
    fn halves(self, low: __m256d, high: __m256d) -> [Num<Self>; 2] {
        let (low, high) = (cast(low), cast(high));
        let first = self.0.avx._mm256_shuffle_ps::<0x88>(low, high);
        let second = self.0.avx._mm256_shuffle_ps::<0xdd>(low, high);
        // shuffles stay within halves of a register
        let first = self.0.avx2._mm256_permute4x64_pd::<0xd8>(cast(first));
        let second = self.0.avx2._mm256_permute4x64_pd::<0xd8>(cast(second));
        [Num { lanes: self, value: cast(first) }, Num { lanes: self, value: cast(second) }]
    }

    #[inline(always)]
    fn fine(self, low: __m256d, high: __m256d) -> Fine<Self> {
        Fine { lanes: self, value: [low, high] }
    }

    /// Eight pairs of numbers as two times four words.
    #[inline(always)]
    fn interleaved(self, first: Num<Self>, second: Num<Self>) -> [__m256d; 2] {
        let (s, [low, high]) = (self.0.avx, self.pair(first, second));
        [s._mm256_permute2f128_pd::<0x20>(low, high), s._mm256_permute2f128_pd::<0x31>(low, high)]
    }

    /// Numbers of two columns in turn, lower and upper halves of each four.
    #[inline(always)]
    fn pair(self, a: Num<Self>, b: Num<Self>) -> [__m256d; 2] {
        let s = self.0.avx;
        [cast(s._mm256_unpacklo_ps(a.value, b.value)), cast(s._mm256_unpackhi_ps(a.value, b.value))]
    }

    #[inline(always)]
    fn side_by_side(self, [a, b]: [__m128; 2]) -> __m256 {
        self.0.avx._mm256_insertf128_ps::<1>(self.0.avx._mm256_castps128_ps256(a), b)
    }

    /// Four columns as quarter rows: half `h` of the `r`th holds row `4 h + r`.
    #[inline(always)]
    fn quads(self, columns: [Num<Self>; 4]) -> [__m256d; 4] {
        let s = self.0.avx;
        let (a, b) = (self.pair(columns[0], columns[1]), self.pair(columns[2], columns[3]));
        [
            s._mm256_unpacklo_pd(a[0], b[0]),
            s._mm256_unpackhi_pd(a[0], b[0]),
            s._mm256_unpacklo_pd(a[1], b[1]),
            s._mm256_unpackhi_pd(a[1], b[1]),
        ]
    }
}

impl Lanes for Middle {
    const WIDTH: usize = 8;
    type Real = f32;
    type Num = __m256;
    type Fine = [__m256d; 2];
    type Mask = __m256;

    #[inline(always)]
    fn splat(self, value: f32) -> __m256 {
        self.0.avx._mm256_set1_ps(value)
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> __m256 {
        cast::<[f32; 8], _>(from[..8].try_into().expect("eight numbers"))
    }
    #[inline(always)]
    fn store(self, value: __m256, to: &mut [f32]) {
        to[..8].copy_from_slice(cast_ref::<_, [f32; 8]>(&value));
    }
    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_add_ps(a, b)
    }
    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_sub_ps(a, b)
    }
    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_mul_ps(a, b)
    }
    #[inline(always)]
    fn div(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_div_ps(a, b)
    }
    #[inline(always)]
    fn fma(self, a: __m256, b: __m256, c: __m256) -> __m256 {
        self.0.fma._mm256_fmadd_ps(a, b, c)
    }
    #[inline(always)]
    fn sqrt(self, a: __m256) -> __m256 {
        self.0.avx._mm256_sqrt_ps(a)
    }
    #[inline(always)]
    fn min(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_min_ps(a, b)
    }
    #[inline(always)]
    fn max(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_max_ps(a, b)
    }
    #[inline(always)]
    fn less(self, a: __m256, b: __m256) -> __m256 {
        self.0.avx._mm256_cmp_ps::<{ std::arch::x86_64::_CMP_LT_OQ }>(a, b)
    }
    #[inline(always)]
    fn select(self, mask: __m256, yes: __m256, no: __m256) -> __m256 {
        self.0.avx._mm256_blendv_ps(no, yes, mask)
    }
    #[inline(always)]
    fn bits(self, mask: __m256) -> u32 {
        self.0.avx._mm256_movemask_ps(mask) as u32
    }

    #[inline(always)]
    fn fine_splat(self, value: f64) -> [__m256d; 2] {
        [self.0.avx._mm256_set1_pd(value); 2]
    }
    #[inline(always)]
    fn fine_load(self, from: &[f64]) -> [__m256d; 2] {
        let all: [f64; 8] = from[..8].try_into().expect("eight numbers");
        must_cast(all)
    }
    #[inline(always)]
    fn fine_add(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
        [self.0.avx._mm256_add_pd(a[0], b[0]), self.0.avx._mm256_add_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_sub(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
        [self.0.avx._mm256_sub_pd(a[0], b[0]), self.0.avx._mm256_sub_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_fma(self, a: [__m256d; 2], b: [__m256d; 2], c: [__m256d; 2]) -> [__m256d; 2] {
        [self.0.fma._mm256_fmadd_pd(a[0], b[0], c[0]), self.0.fma._mm256_fmadd_pd(a[1], b[1], c[1])]
    }
    #[inline(always)]
    fn fine_store(self, value: [__m256d; 2], to: &mut [f64]) {
        to[..8].copy_from_slice(cast_ref::<_, [f64; 8]>(&value));
    }
    #[inline(always)]
    fn fine_mul(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
        [self.0.avx._mm256_mul_pd(a[0], b[0]), self.0.avx._mm256_mul_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_div(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
        [self.0.avx._mm256_div_pd(a[0], b[0]), self.0.avx._mm256_div_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_sqrt(self, a: [__m256d; 2]) -> [__m256d; 2] {
        [self.0.avx._mm256_sqrt_pd(a[0]), self.0.avx._mm256_sqrt_pd(a[1])]
    }
    #[inline(always)]
    fn fine_abs(self, a: [__m256d; 2]) -> [__m256d; 2] {
        let (s, sign) = (self.0.avx, self.0.avx._mm256_set1_pd(-0.0));
        [s._mm256_andnot_pd(sign, a[0]), s._mm256_andnot_pd(sign, a[1])]
    }
    #[inline(always)]
    fn fine_where_less(self, a: [__m256d; 2], b: [__m256d; 2], yes: [__m256d; 2], no: [__m256d; 2]) -> [__m256d; 2] {
        let s = self.0.avx;
        let mut out = no;
        for half in 0..2 {
            let mask = s._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_LT_OQ }>(a[half], b[half]);
            out[half] = s._mm256_blendv_pd(no[half], yes[half], mask);
        }
        out
    }
    #[inline(always)]
    fn fine_any_less(self, a: [__m256d; 2], b: [__m256d; 2]) -> bool {
        let s = self.0.avx;
        let mut any = 0;
        for half in 0..2 {
            any |= s._mm256_movemask_pd(s._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_LT_OQ }>(a[half], b[half]));
        }
        any != 0
    }
    #[inline(always)]
    fn narrow(self, a: [__m256d; 2]) -> __m256 {
        let s = self.0.avx;
        must_cast([s._mm256_cvtpd_ps(a[0]), s._mm256_cvtpd_ps(a[1])])
    }
    #[inline(always)]
    fn widen(self, a: __m256) -> [__m256d; 2] {
        let (s, [low, high]) = (self.0.avx, must_cast::<_, [__m128; 2]>(a));
        [s._mm256_cvtps_pd(low), s._mm256_cvtps_pd(high)]
    }

    #[inline(always)]
    fn gather(self, records: &[Compact], index: &[u32]) -> Columns<Self> {
        let (low, high) = (self.words(records, &index[..4]), self.words(records, &index[4..8]));
        let ([u, v], [w, p]) = (self.halves(low[3], high[3]), self.halves(low[4], high[4]));
        let ([q, r], [mass, _]) = (self.halves(low[5], high[5]), self.halves(low[7], high[7]));
        Columns {
            position: [self.fine(low[0], high[0]), self.fine(low[1], high[1]), self.fine(low[2], high[2])],
            radius: self.fine(low[6], high[6]),
            velocity: Vector([u, v, w]),
            spin: Vector([p, q, r]),
            mass,
        }
    }

    #[inline(always)]
    fn move_records(
        self,
        records: &mut [Compact],
        index: &[u32; BLOCK],
        position: FineVector<Self>,
        velocity: Vector<Self>,
        spin: Vector<Self>,
    ) {
        let (FineVector([x, y, z]), Vector([u, v, w]), Vector([p, q, r])) = (position, velocity, spin);
        let motion = [self.interleaved(u, v), self.interleaved(w, p), self.interleaved(q, r)];
        for half in 0..2 {
            let [uv, wp, qr] = [motion[0][half], motion[1][half], motion[2][half]];
            let front = self.transpose([x.value[half], y.value[half], z.value[half], uv]);
            let back = self.transpose([wp, qr, wp, qr]);
            for l in 0..4 {
                if let Some(record) = records.get_mut(index[4 * half + l] as usize) {
                    let words: &mut [__m256d; 2] = cast_mut(record);
                    // radius and mass keep their words
                    *words = [front[l], self.0.avx._mm256_blend_pd::<0b0011>(words[1], back[l])];
                }
            }
        }
    }

    #[inline(always)]
    fn columns(self, rows: [&[f64; 8]; BLOCK]) -> [Fine<Self>; 8] {
        let zero = self.0.avx._mm256_setzero_pd();
        let mut columns = [self.fine(zero, zero); 8];
        for half in 0..2 {
            let mut words = [[zero; 2]; 4];
            for l in 0..4 {
                words[l] = must_cast(*rows[4 * half + l]);
            }
            for side in 0..2 {
                let four = self.transpose([words[0][side], words[1][side], words[2][side], words[3][side]]);
                for c in 0..4 {
                    columns[4 * side + c].value[half] = four[c];
                }
            }
        }
        columns
    }

    #[inline(always)]
    fn short_columns(self, rows: [&[f64; 4]; BLOCK]) -> [Fine<Self>; 4] {
        let zero = self.0.avx._mm256_setzero_pd();
        let mut columns = [self.fine(zero, zero); 4];
        for half in 0..2 {
            let mut words = [zero; 4];
            for l in 0..4 {
                words[l] = must_cast(*rows[4 * half + l]);
            }
            let four = self.transpose(words);
            for c in 0..4 {
                columns[c].value[half] = four[c];
            }
        }
        columns
    }

    #[inline(always)]
    fn rows(self, columns: [Fine<Self>; 8]) -> [[f64; 8]; BLOCK] {
        let mut rows = [[0.0; 8]; BLOCK];
        for half in 0..2 {
            let mut sides = [[self.0.avx._mm256_setzero_pd(); 4]; 2];
            for side in 0..2 {
                let of = 4 * side;
                sides[side] = self.transpose([
                    columns[of].value[half],
                    columns[of + 1].value[half],
                    columns[of + 2].value[half],
                    columns[of + 3].value[half],
                ]);
            }
            for l in 0..4 {
                rows[4 * half + l] = must_cast([sides[0][l], sides[1][l]]);
            }
        }
        rows
    }

    #[inline(always)]
    fn gather_rows(self, rows: &[Row<f32>], entries: &[Entry]) -> [Num<Self>; 8] {
        let zero = Num { lanes: self, value: self.0.avx._mm256_setzero_ps() };
        let mut columns = [zero; 8];
        let (mut front, mut back) = ([zero; 4], [zero; 4]);
        for r in 0..4 {
            // half `h` of the `r`th register holds row `4 h + r`
            let a = halves_of(&rows[entries[r].place()]);
            let b = halves_of(&rows[entries[4 + r].place()]);
            front[r].value = self.side_by_side([a[0], b[0]]);
            back[r].value = self.side_by_side([a[1], b[1]]);
        }
        let (front, back) = (self.quads(front), self.quads(back));
        for c in 0..4 {
            (columns[c].value, columns[4 + c].value) = (cast(front[c]), cast(back[c]));
        }
        columns
    }

    #[inline(always)]
    fn of_second(self, entries: &[Entry]) -> __m256 {
        let numbers: [Entry; 8] = entries[..8].try_into().expect("eight entries");
        // the sign of a lane sets it
        cast(self.0.avx2._mm256_slli_epi32::<31>(must_cast(numbers)))
    }

    #[inline(always)]
    fn scatter(self, columns: [Num<Self>; 8], to: &mut [Row<f32>]) {
        let s = self.0.avx;
        let [c0, c1, c2, c3, c4, c5, c6, c7] = columns;
        let (front, back) = (self.quads([c0, c1, c2, c3]), self.quads([c4, c5, c6, c7]));
        for r in 0..4 {
            to[r].0 = cast(s._mm256_permute2f128_pd::<0x20>(front[r], back[r]));
            to[r + 4].0 = cast(s._mm256_permute2f128_pd::<0x31>(front[r], back[r]));
        }
    }
}

//! Sixteen lanes of AVX-512 and eight of AVX2, in mixed precision.
//!
//! Records are read in whole cache lines and transposed in registers: a gather instruction would fetch each number of a
//! line separately. No closures here: the compiler would not use the instructions of the calling function in their
//! bodies.

use super::{BLOCK, Columns, Fine, FineVector, Lanes, Num, Row, Vector, Work};
use crate::solvers::granular::entry::Entry;
use crate::solvers::granular::record::Compact;
use bytemuck::{cast, cast_mut, cast_ref, must_cast};
use pulp::NullaryFnOnce;
use pulp::x86::{V3, V4};
use std::arch::x86_64::{__m128, __m256, __m256d, __m512, __m512d, __m512i};

/// Work with its lanes. A closure would not do: the compiler may compile its body outside the function that has the
/// instructions.
struct Entered<W, L> {
    work: W,
    lanes: L,
}

impl<W: Work<L::Real>, L: Lanes> NullaryFnOnce for Entered<W, L> {
    type Output = W::Output;
    #[inline(always)]
    fn call(self) -> W::Output {
        self.work.run(self.lanes)
    }
}

/// AVX-512.
#[derive(Debug, Clone, Copy)]
pub struct Wide(V4);

impl Wide {
    #[inline(always)]
    pub fn detect() -> Option<Wide> {
        V4::try_new().map(Wide)
    }

    /// Runs `work` compiled for these instructions, in `lanes`.
    #[inline(always)]
    pub fn enter<L: Lanes, W: Work<L::Real>>(self, work: W, lanes: L) -> W::Output {
        self.0.vectorize(Entered { work, lanes })
    }

    /// Words of eight records, record by record, to eight words of one kind each.
    #[inline(always)]
    fn words(self, records: &[Compact], index: &[u32]) -> [__m512d; 8] {
        let mut rows = [self.0.avx512f._mm512_setzero_pd(); 8];
        for l in 0..8 {
            rows[l] = *cast_ref(&records[index[l] as usize]);
        }
        self.transpose(rows)
    }

    /// Eight rows of eight words to eight columns.
    #[inline(always)]
    fn transpose(self, rows: [__m512d; 8]) -> [__m512d; 8] {
        let mut columns = rows;
        let s = self.0.avx512f;
        for odd in 0..2 {
            let mut pairs = [rows[0]; 4];
            for p in 0..4 {
                let (a, b) = (rows[2 * p], rows[2 * p + 1]);
                pairs[p] = if odd == 0 { s._mm512_unpacklo_pd(a, b) } else { s._mm512_unpackhi_pd(a, b) };
            }
            let low = s._mm512_shuffle_f64x2::<0x88>(pairs[0], pairs[1]);
            let high = s._mm512_shuffle_f64x2::<0x88>(pairs[2], pairs[3]);
            columns[odd] = s._mm512_shuffle_f64x2::<0x88>(low, high);
            columns[odd + 4] = s._mm512_shuffle_f64x2::<0xdd>(low, high);
            let low = s._mm512_shuffle_f64x2::<0xdd>(pairs[0], pairs[1]);
            let high = s._mm512_shuffle_f64x2::<0xdd>(pairs[2], pairs[3]);
            columns[odd + 2] = s._mm512_shuffle_f64x2::<0x88>(low, high);
            columns[odd + 6] = s._mm512_shuffle_f64x2::<0xdd>(low, high);
        }
        columns
    }

    /// The first (`ODD` 0) or second halves of sixteen pairs of numbers.
    #[inline(always)]
    fn halves<const ODD: i32>(self, low: __m512d, high: __m512d) -> Num<Self> {
        let mut which = [ODD; 16];
        for l in 0..16 {
            which[l] += 2 * l as i32;
        }
        let value = self.0.avx512f._mm512_permutex2var_ps(cast(low), cast::<_, __m512i>(which), cast(high));
        Num { lanes: self, value }
    }

    /// Sixteen pairs of numbers as two times eight words.
    #[inline(always)]
    fn interleaved(self, first: Num<Self>, second: Num<Self>) -> [__m512d; 2] {
        let mut words = [self.0.avx512f._mm512_setzero_pd(); 2];
        for half in 0..2 {
            let mut which = [0; 16];
            for l in 0..16 {
                which[l] = (8 * half + l / 2 + 16 * (l % 2)) as i32;
            }
            let s = self.0.avx512f;
            words[half] = cast(s._mm512_permutex2var_ps(first.value, cast::<_, __m512i>(which), second.value));
        }
        words
    }

    #[inline(always)]
    fn fine(self, low: __m512d, high: __m512d) -> Fine<Self> {
        Fine { lanes: self, value: [low, high] }
    }

    /// Numbers of two columns in turn, lower and upper halves of each four.
    #[inline(always)]
    fn pair(self, a: Num<Self>, b: Num<Self>) -> [__m512d; 2] {
        let s = self.0.avx512f;
        [cast(s._mm512_unpacklo_ps(a.value, b.value)), cast(s._mm512_unpackhi_ps(a.value, b.value))]
    }

    /// Four columns as quarter rows: group `g` of the `r`th holds row `4 g + r`.
    #[inline(always)]
    fn quads(self, columns: [Num<Self>; 4]) -> [__m512; 4] {
        let s = self.0.avx512f;
        let (a, b) = (self.pair(columns[0], columns[1]), self.pair(columns[2], columns[3]));
        [
            cast(s._mm512_unpacklo_pd(a[0], b[0])),
            cast(s._mm512_unpackhi_pd(a[0], b[0])),
            cast(s._mm512_unpacklo_pd(a[1], b[1])),
            cast(s._mm512_unpackhi_pd(a[1], b[1])),
        ]
    }
}

impl Lanes for Wide {
    const WIDTH: usize = 16;
    type Real = f32;
    type Num = __m512;
    type Fine = [__m512d; 2];
    type Mask = u16;

    #[inline(always)]
    fn splat(self, value: f32) -> __m512 {
        self.0.avx512f._mm512_set1_ps(value)
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> __m512 {
        cast::<[f32; 16], _>(from[..16].try_into().expect("sixteen numbers"))
    }
    #[inline(always)]
    fn store(self, value: __m512, to: &mut [f32]) {
        to[..16].copy_from_slice(cast_ref::<_, [f32; 16]>(&value));
    }
    #[inline(always)]
    fn add(self, a: __m512, b: __m512) -> __m512 {
        self.0.avx512f._mm512_add_ps(a, b)
    }
    #[inline(always)]
    fn sub(self, a: __m512, b: __m512) -> __m512 {
        self.0.avx512f._mm512_sub_ps(a, b)
    }
    #[inline(always)]
    fn mul(self, a: __m512, b: __m512) -> __m512 {
        self.0.avx512f._mm512_mul_ps(a, b)
    }
    #[inline(always)]
    fn div(self, a: __m512, b: __m512) -> __m512 {
        self.0.avx512f._mm512_div_ps(a, b)
    }
    #[inline(always)]
    fn fma(self, a: __m512, b: __m512, c: __m512) -> __m512 {
        self.0.avx512f._mm512_fmadd_ps(a, b, c)
    }
    #[inline(always)]
    fn sqrt(self, a: __m512) -> __m512 {
        self.0.avx512f._mm512_sqrt_ps(a)
    }
    #[inline(always)]
    fn min(self, a: __m512, b: __m512) -> __m512 {
        self.0.avx512f._mm512_min_ps(a, b)
    }
    #[inline(always)]
    fn max(self, a: __m512, b: __m512) -> __m512 {
        self.0.avx512f._mm512_max_ps(a, b)
    }
    #[inline(always)]
    fn less(self, a: __m512, b: __m512) -> u16 {
        self.0.avx512f._mm512_cmp_ps_mask::<{ std::arch::x86_64::_CMP_LT_OQ }>(a, b)
    }
    #[inline(always)]
    fn select(self, mask: u16, yes: __m512, no: __m512) -> __m512 {
        self.0.avx512f._mm512_mask_blend_ps(mask, no, yes)
    }
    #[inline(always)]
    fn any(self, mask: u16) -> bool {
        mask != 0
    }

    #[inline(always)]
    fn fine_splat(self, value: f64) -> [__m512d; 2] {
        [self.0.avx512f._mm512_set1_pd(value); 2]
    }
    #[inline(always)]
    fn fine_load(self, from: &[f64]) -> [__m512d; 2] {
        let all: [f64; 16] = from[..16].try_into().expect("sixteen numbers");
        must_cast(all)
    }
    #[inline(always)]
    fn fine_add(self, a: [__m512d; 2], b: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_add_pd(a[0], b[0]), self.0.avx512f._mm512_add_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_sub(self, a: [__m512d; 2], b: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_sub_pd(a[0], b[0]), self.0.avx512f._mm512_sub_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_fma(self, a: [__m512d; 2], b: [__m512d; 2], c: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_fmadd_pd(a[0], b[0], c[0]), self.0.avx512f._mm512_fmadd_pd(a[1], b[1], c[1])]
    }
    #[inline(always)]
    fn fine_store(self, value: [__m512d; 2], to: &mut [f64]) {
        to[..16].copy_from_slice(cast_ref::<_, [f64; 16]>(&value));
    }
    #[inline(always)]
    fn fine_mul(self, a: [__m512d; 2], b: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_mul_pd(a[0], b[0]), self.0.avx512f._mm512_mul_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_div(self, a: [__m512d; 2], b: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_div_pd(a[0], b[0]), self.0.avx512f._mm512_div_pd(a[1], b[1])]
    }
    #[inline(always)]
    fn fine_sqrt(self, a: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_sqrt_pd(a[0]), self.0.avx512f._mm512_sqrt_pd(a[1])]
    }
    #[inline(always)]
    fn fine_abs(self, a: [__m512d; 2]) -> [__m512d; 2] {
        [self.0.avx512f._mm512_abs_pd(a[0]), self.0.avx512f._mm512_abs_pd(a[1])]
    }
    #[inline(always)]
    fn fine_where_less(self, a: [__m512d; 2], b: [__m512d; 2], yes: [__m512d; 2], no: [__m512d; 2]) -> [__m512d; 2] {
        let s = self.0.avx512f;
        let mut out = no;
        for half in 0..2 {
            let mask = s._mm512_cmp_pd_mask::<{ std::arch::x86_64::_CMP_LT_OQ }>(a[half], b[half]);
            out[half] = s._mm512_mask_blend_pd(mask, no[half], yes[half]);
        }
        out
    }
    #[inline(always)]
    fn fine_any_less(self, a: [__m512d; 2], b: [__m512d; 2]) -> bool {
        let s = self.0.avx512f;
        let mut any = 0;
        for half in 0..2 {
            any |= s._mm512_cmp_pd_mask::<{ std::arch::x86_64::_CMP_LT_OQ }>(a[half], b[half]);
        }
        any != 0
    }
    #[inline(always)]
    fn narrow(self, a: [__m512d; 2]) -> __m512 {
        let s = self.0.avx512f;
        must_cast([s._mm512_cvtpd_ps(a[0]), s._mm512_cvtpd_ps(a[1])])
    }
    #[inline(always)]
    fn widen(self, a: __m512) -> [__m512d; 2] {
        let (s, [low, high]) = (self.0.avx512f, must_cast::<_, [__m256; 2]>(a));
        [s._mm512_cvtps_pd(low), s._mm512_cvtps_pd(high)]
    }

    #[inline(always)]
    fn gather(self, records: &[Compact], index: &[u32]) -> Columns<Self> {
        let (low, high) = (self.words(records, &index[..8]), self.words(records, &index[8..16]));
        Columns {
            position: [self.fine(low[0], high[0]), self.fine(low[1], high[1]), self.fine(low[2], high[2])],
            radius: self.fine(low[6], high[6]),
            velocity: Vector([
                self.halves::<0>(low[3], high[3]),
                self.halves::<1>(low[3], high[3]),
                self.halves::<0>(low[4], high[4]),
            ]),
            spin: Vector([
                self.halves::<1>(low[4], high[4]),
                self.halves::<0>(low[5], high[5]),
                self.halves::<1>(low[5], high[5]),
            ]),
            mass: self.halves::<0>(low[7], high[7]),
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
            let [x, y, z] = [x.value[half], y.value[half], z.value[half]];
            let [uv, wp, qr] = [motion[0][half], motion[1][half], motion[2][half]];
            // radius and mass keep their words
            let rows = self.transpose([x, y, z, uv, wp, qr, qr, qr]);
            for l in 0..8 {
                if let Some(record) = records.get_mut(index[8 * half + l] as usize) {
                    let words: &mut __m512d = cast_mut(record);
                    *words = self.0.avx512f._mm512_mask_blend_pd(0b0011_1111, *words, rows[l]);
                }
            }
        }
    }

    #[inline(always)]
    fn columns(self, rows: [&[f64; 8]; BLOCK]) -> [Fine<Self>; 8] {
        let mut halves = [[self.0.avx512f._mm512_setzero_pd(); 8]; 2];
        for half in 0..2 {
            for l in 0..8 {
                halves[half][l] = must_cast(*rows[8 * half + l]);
            }
            halves[half] = self.transpose(halves[half]);
        }
        let mut columns = [self.fine(halves[0][0], halves[1][0]); 8];
        for c in 0..8 {
            columns[c] = self.fine(halves[0][c], halves[1][c]);
        }
        columns
    }

    #[inline(always)]
    fn short_columns(self, rows: [&[f64; 4]; BLOCK]) -> [Fine<Self>; 4] {
        let s = self.0.avx512f;
        let mut columns = [self.fine(s._mm512_setzero_pd(), s._mm512_setzero_pd()); 4];
        for half in 0..2 {
            // rows 0 and 2, 1 and 3, 4 and 6, 5 and 7 of the half side by side
            let mut sides = [s._mm512_setzero_pd(); 4];
            for (side, first) in [0, 1, 4, 5].into_iter().enumerate() {
                let (left, right) = (*rows[8 * half + first], *rows[8 * half + first + 2]);
                sides[side] = must_cast([left, right]);
            }
            let [a, b, c, d] = sides;
            let even = [s._mm512_unpacklo_pd(a, b), s._mm512_unpacklo_pd(c, d)];
            let odd = [s._mm512_unpackhi_pd(a, b), s._mm512_unpackhi_pd(c, d)];
            columns[0].value[half] = s._mm512_shuffle_f64x2::<0x88>(even[0], even[1]);
            columns[1].value[half] = s._mm512_shuffle_f64x2::<0x88>(odd[0], odd[1]);
            columns[2].value[half] = s._mm512_shuffle_f64x2::<0xdd>(even[0], even[1]);
            columns[3].value[half] = s._mm512_shuffle_f64x2::<0xdd>(odd[0], odd[1]);
        }
        columns
    }

    #[inline(always)]
    fn rows(self, columns: [Fine<Self>; 8]) -> [[f64; 8]; BLOCK] {
        let mut halves = [[self.0.avx512f._mm512_setzero_pd(); 8]; 2];
        for half in 0..2 {
            for c in 0..8 {
                halves[half][c] = columns[c].value[half];
            }
            halves[half] = self.transpose(halves[half]);
        }
        must_cast(halves)
    }

    // products of two numbers in single precision are exact in double: fused or not, the same bits
    #[inline(always)]
    fn add_row(self, row: &Row<f32>, entry: Entry, sums: [f64; 8]) -> [f64; 8] {
        let (s, row) = (self.0.avx512f, must_cast::<_, __m256>(row.0));
        let (avx, second) = (self.0.avx, u32::from(entry.is_second()));
        let arm = self.0.avx2._mm256_permutevar8x32_ps(row, avx._mm256_set1_epi32(6 + second as i32));
        let arm = avx._mm256_xor_ps(arm, avx._mm256_set1_ps(-0.0));
        let sign = avx._mm256_set1_ps(f32::from_bits(1f32.to_bits() | second << 31));
        let factors = avx._mm256_blend_ps::<0b1111_1000>(sign, arm);
        let sums = s._mm512_maskz_mov_pd(u8::from(entry.begins()).wrapping_sub(1), must_cast(sums));
        must_cast(s._mm512_fmadd_pd(s._mm512_cvtps_pd(row), s._mm512_cvtps_pd(factors), sums))
    }

    #[inline(always)]
    fn scatter(self, columns: [Num<Self>; 8], to: &mut [Row<f32>]) {
        let s = self.0.avx512f;
        let [c0, c1, c2, c3, c4, c5, c6, c7] = columns;
        let (front, back) = (self.quads([c0, c1, c2, c3]), self.quads([c4, c5, c6, c7]));
        for r in [0, 2] {
            let t = [
                s._mm512_shuffle_f32x4::<0x44>(front[r], back[r]),
                s._mm512_shuffle_f32x4::<0xee>(front[r], back[r]),
                s._mm512_shuffle_f32x4::<0x44>(front[r + 1], back[r + 1]),
                s._mm512_shuffle_f32x4::<0xee>(front[r + 1], back[r + 1]),
            ];
            let groups = [
                s._mm512_shuffle_f32x4::<0x88>(t[0], t[2]),
                s._mm512_shuffle_f32x4::<0xdd>(t[0], t[2]),
                s._mm512_shuffle_f32x4::<0x88>(t[1], t[3]),
                s._mm512_shuffle_f32x4::<0xdd>(t[1], t[3]),
            ];
            for g in 0..4 {
                [to[4 * g + r].0, to[4 * g + r + 1].0] = cast(groups[g]);
            }
        }
    }
}

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
    fn any(self, mask: __m256) -> bool {
        self.0.avx._mm256_movemask_ps(mask) != 0
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

    // products of two numbers in single precision are exact in double: fused or not, the same bits
    #[inline(always)]
    fn add_row(self, row: &Row<f32>, entry: Entry, sums: [f64; 8]) -> [f64; 8] {
        let (s, row) = (self.0.avx, must_cast::<_, __m256>(row.0));
        let second = u32::from(entry.is_second());
        let arm = self.0.avx2._mm256_permutevar8x32_ps(row, s._mm256_set1_epi32(6 + second as i32));
        let arm = s._mm256_xor_ps(arm, s._mm256_set1_ps(-0.0));
        let sign = s._mm256_set1_ps(f32::from_bits(1f32.to_bits() | second << 31));
        let factors = s._mm256_blend_ps::<0b1111_1000>(sign, arm);
        let kept = s._mm256_set1_pd(f64::from_bits(u64::from(entry.begins()).wrapping_sub(1)));
        let [low, high]: [__m256d; 2] = must_cast(sums);
        let sums = [s._mm256_and_pd(low, kept), s._mm256_and_pd(high, kept)];
        must_cast(self.fine_fma(self.widen(row), self.widen(factors), sums))
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

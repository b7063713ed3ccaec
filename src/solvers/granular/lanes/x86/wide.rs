//! Sixteen lanes of AVX-512.

use super::{Entered, halves_of};
use crate::solvers::granular::entry::Entry;
use crate::solvers::granular::lanes::{BLOCK, Columns, Fine, FineVector, Lanes, Num, Row, Vector, Work};
use crate::solvers::granular::record::Compact;
use bytemuck::{cast, cast_mut, cast_ref, must_cast};
use pulp::x86::V4;
use std::arch::x86_64::{__m128, __m256, __m512, __m512d, __m512i};

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

    #[inline(always)]
    fn side_by_side(self, [a, b, c, d]: [__m128; 4]) -> __m512 {
        let s = self.0.avx512f;
        let two = s._mm512_insertf32x4::<1>(s._mm512_castps128_ps512(a), b);
        s._mm512_insertf32x4::<3>(s._mm512_insertf32x4::<2>(two, c), d)
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
    fn bits(self, mask: u16) -> u32 {
        u32::from(mask)
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

    #[inline(always)]
    fn gather_rows(self, rows: &[Row<f32>], entries: &[Entry]) -> [Num<Self>; 8] {
        let zero = Num { lanes: self, value: self.0.avx512f._mm512_setzero_ps() };
        let mut columns = [zero; 8];
        let (mut front, mut back) = ([zero; 4], [zero; 4]);
        for r in 0..4 {
            // group `g` of the `r`th register holds row `4 g + r`
            let a = halves_of(&rows[entries[r].place()]);
            let b = halves_of(&rows[entries[4 + r].place()]);
            let c = halves_of(&rows[entries[8 + r].place()]);
            let d = halves_of(&rows[entries[12 + r].place()]);
            front[r].value = self.side_by_side([a[0], b[0], c[0], d[0]]);
            back[r].value = self.side_by_side([a[1], b[1], c[1], d[1]]);
        }
        let (front, back) = (self.quads(front), self.quads(back));
        for c in 0..4 {
            (columns[c].value, columns[4 + c].value) = (front[c], back[c]);
        }
        columns
    }

    #[inline(always)]
    fn of_second(self, entries: &[Entry]) -> u16 {
        let numbers: [Entry; 16] = entries[..16].try_into().expect("sixteen entries");
        let s = self.0.avx512f;
        s._mm512_test_epi32_mask(must_cast(numbers), s._mm512_set1_epi32(1))
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

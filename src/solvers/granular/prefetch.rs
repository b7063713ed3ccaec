//! Prefetching memory before it is needed.

/// Prefetches the cache line at the start of `what`; does nothing if the processor cannot.
///
/// A bed larger than the cache waits for memory longer than it computes. With prefetch four blocks ahead, 100,000
/// spheres step 1.7 times as fast as without, and 1.3 times as fast as with plain reads ahead, which stop the processor
/// until the data arrive.
#[inline(always)]
pub(super) fn prefetch<T>(what: &T) {
    prefetch_at(std::slice::from_ref(what), 0);
}

/// Prefetches the cache line at the start of `list[index]`; of an index beyond the list any line, or none.
#[inline(always)]
pub(super) fn prefetch_at<T>(list: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch has no observable effect and never faults, whatever the address; and it belongs to SSE, which
    // every x86_64 has.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(list.as_ptr().wrapping_add(index).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (list, index);
}

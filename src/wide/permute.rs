use fearless_simd::{Simd, SimdBase, u32x8};

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod x86 {
    #[cfg(target_arch = "x86")]
    use core::arch::x86::{__m256i, _mm256_permutevar8x32_epi32};
    #[cfg(target_arch = "x86_64")]
    use core::arch::x86_64::{__m256i, _mm256_permutevar8x32_epi32};

    fearless_simd::kernel!(
        #[inline]
        pub(super) fn permute(simd: Avx2, values: __m256i, lanes: __m256i) -> __m256i {
            _mm256_permutevar8x32_epi32(values, lanes)
        }
    );
}

/// Of each lane the value in the lane that the lowest three bits of `lanes` name.
#[inline(always)]
pub(super) fn permute<S: Simd>(simd: S, values: u32x8<S>, lanes: u32x8<S>) -> u32x8<S> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = simd.level().as_avx2() {
        return fearless_simd::SimdInto::simd_into(x86::permute(avx2, values.into(), lanes.into()), simd);
    }
    let values = values.as_array();
    u32x8::load_array(simd, lanes.as_array().map(|lane| values[lane as usize & 7]))
}

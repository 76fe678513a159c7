/* SPDX-License-Identifier: MIT */
#include "bench/kernels.h"

#if defined(__GNUC__) && defined(__x86_64__)
#define HAVE_X86
#include <immintrin.h>
#elif defined(__GNUC__) && defined(__aarch64__)
#define HAVE_NEON
#include <arm_neon.h>
#endif

#ifdef HAVE_X86
/* Four lanes by loads and inserts: there is no gather. */
__attribute__((target("sse4.1"))) static inline __m128 gather_sse4(const float *from,
                                                                   const int32_t *at)
{
    __m128 a = _mm_load_ss(from + at[0]);

    a = _mm_insert_ps(a, _mm_load_ss(from + at[1]), 0x10);
    a = _mm_insert_ps(a, _mm_load_ss(from + at[2]), 0x20);
    return _mm_insert_ps(a, _mm_load_ss(from + at[3]), 0x30);
}

/* KEEP: chains that begin equal stay equal; without it a compiler computes one of them.
 */
#define NAME(x)          x##_sse4_kernel
#define TARGET           __attribute__((target("sse4.1")))
#define LANES            4
#define V                __m128
#define ZERO             _mm_setzero_ps()
#define SET(a)           _mm_set1_ps(a)
#define LOAD(p)          _mm_loadu_ps(p)
#define GATHER(p, at)    gather_sse4(p, at)
#define ADD(a, b)        _mm_add_ps(a, b)
#define FMA(a, b, c)     _mm_add_ps(_mm_mul_ps(a, b), c)
#define STORE(p, a)      _mm_storeu_ps(p, a)
#define KEEP(a, b, c, d) __asm__("" : "+x"(a), "+x"(b), "+x"(c), "+x"(d))
#include "bench/kernels_tmpl.h"

#define NAME(x) x##_avx2_kernel
#define TARGET  __attribute__((target("avx2,fma")))
#define LANES   8
#define V       __m256
#define ZERO    _mm256_setzero_ps()
#define SET(a)  _mm256_set1_ps(a)
#define LOAD(p) _mm256_loadu_ps(p)
#define GATHER(p, at)                                                                    \
    _mm256_i32gather_ps(p, _mm256_loadu_si256((const __m256i *)(const void *)(at)), 4)
#define ADD(a, b)        _mm256_add_ps(a, b)
#define FMA(a, b, c)     _mm256_fmadd_ps(a, b, c)
#define STORE(p, a)      _mm256_storeu_ps(p, a)
#define KEEP(a, b, c, d) __asm__("" : "+x"(a), "+x"(b), "+x"(c), "+x"(d))
#include "bench/kernels_tmpl.h"

#define NAME(x)          x##_avx512_kernel
#define TARGET           __attribute__((target("avx512f")))
#define LANES            16
#define V                __m512
#define ZERO             _mm512_setzero_ps()
#define SET(a)           _mm512_set1_ps(a)
#define LOAD(p)          _mm512_loadu_ps(p)
#define GATHER(p, at)    _mm512_i32gather_ps(_mm512_loadu_si512(at), p, 4)
#define ADD(a, b)        _mm512_add_ps(a, b)
#define FMA(a, b, c)     _mm512_fmadd_ps(a, b, c)
#define STORE(p, a)      _mm512_storeu_ps(p, a)
#define KEEP(a, b, c, d) __asm__("" : "+v"(a), "+v"(b), "+v"(c), "+v"(d))
#include "bench/kernels_tmpl.h"
#endif

#ifdef HAVE_NEON
static inline float32x4_t gather_neon(const float *from, const int32_t *at)
{
    float32x4_t a = vdupq_n_f32(from[at[0]]);

    a = vld1q_lane_f32(from + at[1], a, 1);
    a = vld1q_lane_f32(from + at[2], a, 2);
    return vld1q_lane_f32(from + at[3], a, 3);
}

#define NAME(x) x##_neon_kernel
#define TARGET
#define LANES            4
#define V                float32x4_t
#define ZERO             vdupq_n_f32(0.0f)
#define SET(a)           vdupq_n_f32(a)
#define LOAD(p)          vld1q_f32(p)
#define GATHER(p, at)    gather_neon(p, at)
#define ADD(a, b)        vaddq_f32(a, b)
#define FMA(a, b, c)     vfmaq_f32(c, a, b)
#define STORE(p, a)      vst1q_f32(p, a)
#define KEEP(a, b, c, d) __asm__("" : "+w"(a), "+w"(b), "+w"(c), "+w"(d))
#include "bench/kernels_tmpl.h"
#endif

#define SET_OF(isa_, lanes_, name)                                                       \
    {                                                                                    \
        .isa = isa_, .lanes = lanes_, .gather = gather_##name##_kernel,                  \
        .load = load_##name##_kernel, .fma = fma_##name##_kernel                         \
    }

const bench_kernels bench_kernels_list[] = {
#ifdef HAVE_X86
    SET_OF(CRV_ISA_SSE4, 4, sse4),
    SET_OF(CRV_ISA_AVX2, 8, avx2),
    SET_OF(CRV_ISA_AVX512, 16, avx512),
#endif
#ifdef HAVE_NEON
    SET_OF(CRV_ISA_NEON, 4, neon),
#endif
    {.isa = CRV_ISA_SCALAR},
};

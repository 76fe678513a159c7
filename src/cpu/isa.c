/* SPDX-License-Identifier: MIT */
/* Which instruction sets were compiled in and which the machine has. Features are asked
 * one by one: the levels of x86-64 are not known to every compiler. */
#include "cpu/isa.h"

#include <string.h>

#ifdef CRV__HAVE_X86
extern const crv__kernels crv__kernels_sse4, crv__kernels_avx2, crv__kernels_avx512;

static int has_sse4(void)
{
    return __builtin_cpu_supports("sse4.1");
}

static int has_avx2(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

static int has_avx512(void)
{
    return has_avx2() && __builtin_cpu_supports("avx512f")
           && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq")
           && __builtin_cpu_supports("avx512vl");
}
#endif

#ifdef CRV__HAVE_NEON
extern const crv__kernels crv__kernels_neon;

static int has_neon(void)
{
    return 1; /* every AArch64 */
}
#endif

static const struct set {
    crv_isa isa;
    int (*is_there)(void);
    const crv__kernels *kernels;
} SETS[] = {
/* the fastest first */
#ifdef CRV__HAVE_X86
    {CRV_ISA_AVX512, has_avx512, &crv__kernels_avx512},
    {CRV_ISA_AVX2, has_avx2, &crv__kernels_avx2},
    {CRV_ISA_SSE4, has_sse4, &crv__kernels_sse4},
#endif
#ifdef CRV__HAVE_NEON
    {CRV_ISA_NEON, has_neon, &crv__kernels_neon},
#endif
    {CRV_ISA_SCALAR, NULL, NULL},
};

/* The first of SETS that may be used. */
static const struct set *best(uint32_t allowed)
{
    const struct set *set = SETS;
    while (set->is_there && !(allowed & (1u << set->isa) && set->is_there()))
        set++;
    return set;
}

const char *crv_isa_name(crv_isa isa)
{
    static const char *const NAMES[] = {"scalar", "sse4", "avx2", "avx512", "neon"};
    return (unsigned)isa < sizeof NAMES / sizeof NAMES[0] ? NAMES[isa] : NULL;
}

uint32_t crv_isa_available(void)
{
    uint32_t mask = 1u << CRV_ISA_SCALAR;
    for (const struct set *set = SETS; set->is_there; set++) {
        if (set->is_there())
            mask |= 1u << set->isa;
    }
    return mask;
}

crv_isa crv_context_isa(const crv_context *context)
{
    return context ? best(context->isa_mask)->isa : CRV_ISA_SCALAR;
}

const crv__kernels *crv__kernels_best(uint32_t allowed)
{
    return best(allowed)->kernels;
}

const crv__conversions *crv__cpu_conversions(const crv_context *context)
{
    const crv__kernels *kernels = crv__kernels_best(context->isa_mask);
    return kernels ? &kernels->conversions : NULL;
}

static crv__estimate_kernel named(const crv__named_estimate *e, const char *name)
{
    while (e->name && strcmp(e->name, name) != 0)
        e++;
    return e->run;
}

crv__estimate_kernel crv__kernels_estimate(const crv__kernels *kernels, const char *name,
                                           int exact)
{
    const crv__estimate_kernel lean =
        kernels && !exact ? named(kernels->lean, name) : NULL;
    return lean || !kernels ? lean : named(kernels->estimates, name);
}

crv__filter_kernel crv__kernels_filter(const crv__kernels *kernels, const char *name)
{
    for (const crv__named_filter *e = kernels ? kernels->filters : NULL; e && e->name;
         e++) {
        if (strcmp(e->name, name) == 0)
            return e->run;
    }
    return NULL;
}

const crv__fast_kind *crv__kernels_fast(const crv__kernels *kernels, const char *name)
{
    for (const crv__fast_kind *e = kernels ? kernels->fast : NULL; e && e->name; e++) {
        if (strcmp(e->name, name) == 0)
            return e;
    }
    return NULL;
}

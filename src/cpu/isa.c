/* SPDX-License-Identifier: MIT */
/* Which instruction sets were compiled in and which the machine has. Features are asked
 * one by one: the levels of x86-64 are not known to every compiler. */
#include "cpu/isa.h"

/* crevice_sets.h is made by kernels.cmake: CRV__SET(name, NAME, is_there) for each set,
 * the fastest first. */
#define CRV__SET(name, NAME, is_there)                                                   \
    extern const crv__kernels crv__kernels_##name;                                       \
    static bool has_##name(void)                                                         \
    {                                                                                    \
        return is_there;                                                                 \
    }
#include "crevice_sets.h"
#undef CRV__SET

static bool has_scalar(void)
{
    return true;
}

static const struct set {
    crv_isa isa;
    bool (*is_there)(void);
    const crv__kernels *kernels;
} SETS[] = {
#define CRV__SET(name, NAME, is_there) {CRV_ISA_##NAME, has_##name, &crv__kernels_##name},
#include "crevice_sets.h"
#undef CRV__SET
    {CRV_ISA_SCALAR, has_scalar, NULL},
};

enum { SET_COUNT = sizeof SETS / sizeof SETS[0] };

const char *crv_isa_name(crv_isa isa)
{
    static const char *const NAMES[] = {"scalar", "sse4", "avx2",
                                        "avx512", "neon", "wasm"};
    return (unsigned)isa < sizeof NAMES / sizeof NAMES[0] ? NAMES[isa] : NULL;
}

uint32_t crv_isa_available(void)
{
    uint32_t mask = 0;
    for (int i = 0; i < SET_COUNT; i++) {
        if (SETS[i].is_there())
            mask |= 1u << SETS[i].isa;
    }
    return mask;
}

crv_isa crv_context_isa(const crv_context *context)
{
    return context ? context->isa : CRV_ISA_SCALAR;
}

void crv__isa_choose(crv_context *context)
{
    const struct set *set = SETS;
    while (set->kernels && !(context->isa_mask & (1u << set->isa) && set->is_there()))
        set++;
    context->isa = set->isa;
    context->kernels = set->kernels;
}

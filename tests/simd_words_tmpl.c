/* SPDX-License-Identifier: MIT */
/* The vocabulary of one instruction set against the C library; compiled once per set. */
#include "simd.h"

#include "cpu/simd/vector.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5000, N = CRV__LANES };

static int faults;

static void fault(const char *word, int lane, double expected, double got)
{
    if (faults++ < 20)
        printf("  %s: lane %d is %.9g and not %.9g\n", word, lane, got, expected);
}

static int same(float a, float b)
{
    return (isnan(a) && isnan(b)) || a == b;
}

static int32_t bits_of(float a)
{
    int32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

typedef struct floats {
    float lane[N];
} floats;

typedef struct ints {
    int32_t lane[N];
} ints;

static floats taken(vf a)
{
    floats out;
    vf_store(out.lane, a);
    return out;
}

static ints taken_ints(vi a)
{
    const floats bits = taken(vf_of_bits(a));
    ints out;
    memcpy(out.lane, bits.lane, sizeof out.lane);
    return out;
}

static int lane_set(vm mask, int lane)
{
    return taken(vf_select(mask, vf_set(1), vf_zero())).lane[lane] == 1;
}

/* Numbers of every size, and what is not one. */
static float any_float(simd_random *r)
{
    static const float SPECIAL[] = {
        0,    -0.0f, 1,       -1,          INFINITY, -INFINITY, NAN,     0.5f,      1.5f,
        2.5f, -0.5f, -1e-30f, 16777216.0f, 3e9f,     -3e9f,     FLT_MAX, 0.9999999f};
    if (simd_chance(r, 4))
        return SPECIAL[simd_int(r, 0, (int)(sizeof SPECIAL / sizeof SPECIAL[0]) - 1)];
    const double sign = simd_chance(r, 2) ? -1 : 1;
    return (float)(sign * simd_log(r, 1e-12, 1e12));
}

static vf any_vector(simd_random *r, floats *a)
{
    for (int i = 0; i < N; i++)
        a->lane[i] = any_float(r);
    return vf_load(a->lane);
}

static vi any_ints(simd_random *r, int32_t low, int32_t high, ints *a)
{
    for (int i = 0; i < N; i++)
        a->lane[i] = simd_int(r, low, high);
    return vi_load(a->lane);
}

static void expect_float(const char *word, int lane, float expected, float got)
{
    if (!same(expected, got))
        fault(word, lane, (double)expected, (double)got);
}

static void expect_int(const char *word, int lane, int64_t expected, int64_t got)
{
    if (expected != got)
        fault(word, lane, (double)expected, (double)got);
}

/* The second where either is a NaN. */
static float least(float a, float b)
{
    return a < b ? a : b;
}

static float most(float a, float b)
{
    return a > b ? a : b;
}

static void check_bits(simd_random *r)
{
    ints bits, from;
    for (int i = 0; i < N; i++)
        bits.lane[i] = (int32_t)simd_bits(r);
    const vi counts = vi_count_bits(vi_load(bits.lane));
    const vi above = vi_from_bit(any_ints(r, 0, 33, &from));
    for (int i = 0; i < N; i++) {
        int32_t count = 0;
        for (int k = 0; k < 32; k++)
            count += (int32_t)((uint32_t)bits.lane[i] >> k & 1);
        expect_int("vi_count_bits", i, count, taken_ints(counts).lane[i]);
        const uint32_t expected =
            from.lane[i] < 32 ? UINT32_MAX << (uint32_t)from.lane[i] : 0;
        expect_int("vi_from_bit", i, (int32_t)expected, taken_ints(above).lane[i]);
    }
}

static void check_comparisons(simd_random *r)
{
    floats a, b;
    ints m, n;
    const vf va = any_vector(r, &a), vb = any_vector(r, &b);
    const vi vm_ = any_ints(r, -3, 3, &m), vn = any_ints(r, -3, 3, &n);
    const vm lt = vf_lt(va, vb), le = vf_le(va, vb);
    for (int i = 0; i < N; i++) {
        const float x = a.lane[i], y = b.lane[i];
        expect_int("vf_lt", i, x < y, lane_set(lt, i));
        expect_int("vf_le", i, x <= y, lane_set(le, i));
        expect_int("vi_lt", i, m.lane[i] < n.lane[i], lane_set(vi_lt(vm_, vn), i));
        expect_int("vi_eq", i, m.lane[i] == n.lane[i], lane_set(vi_eq(vm_, vn), i));
        expect_int("vi_below", i, m.lane[i] >= 0 && m.lane[i] < 2,
                   lane_set(vi_below(vm_, vi_set(2)), i));
        expect_int("vm_and", i, x < y && x <= y, lane_set(vm_and(lt, le), i));
        expect_int("vm_or", i, x < y || x <= y, lane_set(vm_or(lt, le), i));
        expect_int("vm_not", i, !(x < y), lane_set(vm_not(lt), i));
        expect_float("vf_select", i, x < y ? x : y, taken(vf_select(lt, va, vb)).lane[i]);
        expect_float("vf_where", i, x < y ? x : 0, taken(vf_where(lt, va)).lane[i]);
        expect_int("vi_select", i, x < y ? m.lane[i] : n.lane[i],
                   taken_ints(vi_select(lt, vm_, vn)).lane[i]);
        expect_int("vi_min", i, m.lane[i] < n.lane[i] ? m.lane[i] : n.lane[i],
                   taken_ints(vi_min(vm_, vn)).lane[i]);
        expect_int("vi_max", i, m.lane[i] > n.lane[i] ? m.lane[i] : n.lane[i],
                   taken_ints(vi_max(vm_, vn)).lane[i]);
        expect_float("vf_min", i, least(x, y), taken(vf_min(va, vb)).lane[i]);
        expect_float("vf_max", i, most(x, y), taken(vf_max(va, vb)).lane[i]);
        expect_float("vf_clamp01", i, least(most(x, 0), 1),
                     taken(vf_clamp01(va)).lane[i]);
        expect_float("vf_abs", i, fabsf(x), taken(vf_abs(va)).lane[i]);
        if (!isnan(x) && !isnan(y)) {
            expect_float("vf_least_abs", i, least(fabsf(x), fabsf(y)),
                         taken(vf_least_abs(va, vb)).lane[i]);
            expect_float("vf_most_abs", i, most(fabsf(x), fabsf(y)),
                         taken(vf_most_abs(va, vb)).lane[i]);
        }
    }
    int any = 0, count = 0;
    int32_t largest = INT32_MIN;
    for (int i = 0; i < N; i++) {
        any |= a.lane[i] < b.lane[i];
        count += a.lane[i] < b.lane[i];
        largest = m.lane[i] > largest ? m.lane[i] : largest;
    }
    expect_int("vm_any", 0, any, vm_any(lt));
    expect_int("vm_count", 0, count, vm_count(lt));
    expect_int("vi_largest", 0, largest, vi_largest(vm_));
    expect_int("vm_none", 0, 0, vm_any(vm_none()));
}

/* Horizons in [0, 2], what may raise them, and squared distances about a limit. */
static void check_max_within(simd_random *r)
{
    floats a, b, q;
    for (int i = 0; i < N; i++) {
        a.lane[i] = simd_chance(r, 4) ? 0 : (float)simd_log(r, 1e-6, 2);
        b.lane[i] = (simd_chance(r, 2) ? -1.0f : 1.0f) * (float)simd_log(r, 1e-6, 2);
        q.lane[i] = (float)simd_log(r, 1e-12, 1e12);
    }
    const float limit = (float)simd_log(r, 1e-6, 1e6);
    const floats got = taken(
        vf_max_within(vf_load(a.lane), vf_load(b.lane), vf_load(q.lane), vf_set(limit)));
    for (int i = 0; i < N; i++) {
        const float expected = q.lane[i] < limit ? most(b.lane[i], a.lane[i]) : a.lane[i];
        if (q.lane[i] < limit || q.lane[i] > limit)
            expect_float("vf_max_within", i, expected, got.lane[i]);
    }
}

static void check_rounding(simd_random *r)
{
    floats a, b, c;
    const vf va = any_vector(r, &a), vb = any_vector(r, &b), vc = any_vector(r, &c);
    const floats floors = taken(vf_floor(va)), roots = taken(vf_sqrt(vf_abs(va)));
    const ints integers = taken_ints(vi_floor(va)), ceilings = taken_ints(vi_ceil(va));
    const floats sums = taken(vf_fma(va, vb, vc));
    for (int i = 0; i < N; i++) {
        const float x = a.lane[i];
        expect_float("vf_floor", i, floorf(x), floors.lane[i]);
        expect_float("vf_sqrt", i, sqrtf(fabsf(x)), roots.lane[i]);
        if (fabsf(x) < 2147483648.0f) {
            expect_int("vi_floor", i, (int64_t)floorf(x), integers.lane[i]);
            expect_int("vi_ceil", i, (int64_t)ceilf(x), ceilings.lane[i]);
            expect_int("vi_trunc", i, (int64_t)x, taken_ints(vi_trunc(va)).lane[i]);
            expect_int("vi_round", i, lrintf(x), taken_ints(vi_round(va)).lane[i]);
        } else if (integers.lane[i] >= 0 && integers.lane[i] != INT32_MAX) {
            fault("vi_floor of what does not fit", i, -1, integers.lane[i]);
        } else if (ceilings.lane[i] >= 0 && ceilings.lane[i] != INT32_MAX) {
            fault("vi_ceil of what does not fit", i, -1, ceilings.lane[i]);
        }
        expect_float("vf_of", i, (float)integers.lane[i],
                     taken(vf_of(vi_floor(va))).lane[i]);
        const float product = x * b.lane[i];
        expect_float("vf_fma", i,
                     CRV__FMA_ROUNDS_ONCE ? fmaf(x, b.lane[i], c.lane[i])
                                          : product + c.lane[i],
                     sums.lane[i]);
    }
}

/* What vector.h promises of the approximations. */
static void check_approximations(simd_random *r)
{
    floats a, e;
    for (int i = 0; i < N; i++) {
        a.lane[i] = (float)simd_log(r, 1e-30, 1e30);
        e.lane[i] = -(float)simd_log(r, 1e-6, 200);
    }
    const floats fine = taken(vf_rsqrt(vf_load(a.lane)));
    const floats fair = taken(vf_rsqrt_fair(vf_load(a.lane)));
    const floats rough = taken(vf_rsqrt_rough(vf_load(a.lane)));
    const floats power = taken(vf_exp(vf_load(e.lane)));
    for (int i = 0; i < N; i++) {
        const double exact = 1 / sqrt((double)a.lane[i]), x = (double)e.lane[i];
        if (!(fabs((double)fine.lane[i] / exact - 1) < 1e-6))
            fault("vf_rsqrt", i, exact, (double)fine.lane[i]);
        if (!(fabs((double)fair.lane[i] / exact - 1) < 1e-4))
            fault("vf_rsqrt_fair", i, exact, (double)fair.lane[i]);
        if (!(fabs((double)rough.lane[i] / exact - 1) < 4e-4))
            fault("vf_rsqrt_rough", i, exact, (double)rough.lane[i]);
        const double bound = x < -87 ? 1e-37 : exp(x) * 2e-7 * (1 + fabs(x));
        if (!(fabs((double)power.lane[i] - exp(x)) <= bound))
            fault("vf_exp", i, exp(x), (double)power.lane[i]);
    }
    for (int32_t n = 1; n <= 32; n++) {
        const float part = taken(vi_rcp(vi_set(n))).lane[N - 1];
        if (!(fabs((double)part * n - 1) < 4e-4))
            fault("vi_rcp", n, 1.0 / n, (double)part);
        if (!isfinite(taken(vi_rcp(vi_set(n - 33))).lane[0]))
            fault("vi_rcp of none", n, 0, NAN);
    }
    const float at_zero = taken(vf_rsqrt_rough(vf_zero())).lane[0];
    if (isfinite(at_zero))
        fault("vf_rsqrt_rough of 0", 0, (double)INFINITY, (double)at_zero);
    if (taken(vf_exp(vf_zero())).lane[0] != 1)
        fault("vf_exp of 0", 0, 1, taken(vf_exp(vf_zero())).lane[0]);
}

/* Lanes whose mask is clear must not be read: their indices lead nowhere. */
static void check_gather(simd_random *r)
{
    enum { COUNT = 37 };
    float *base = malloc(COUNT * sizeof *base);
    ints index, wild;
    if (!base)
        return;
    for (int i = 0; i < COUNT; i++)
        base[i] = (float)(i + 1);
    any_ints(r, 0, COUNT - 1, &index);
    const vm mask = vi_lt(any_ints(r, 0, 3, &wild), vi_set(2));
    for (int i = 0; i < N; i++) {
        if (!lane_set(mask, i))
            index.lane[i] = simd_chance(r, 2) ? INT32_MAX : INT32_MIN;
    }
    const floats got = taken(vf_gather(base, vi_load(index.lane), mask));
    for (int i = 0; i < N; i++)
        expect_float("vf_gather", i, lane_set(mask, i) ? (float)(index.lane[i] + 1) : 0,
                     got.lane[i]);
    free(base);
}

/* Blocks of exactly the size, so that AddressSanitizer sees a read past the end, and
 * guards for a write. */
static void check_memory(simd_random *r)
{
    const int count = simd_int(r, 0, N);
    float *from = malloc((size_t)(count ? count : 1) * sizeof *from);
    float to[N + 2];
    if (!from)
        return;
    for (int i = 0; i < count; i++)
        from[i] = (float)(i + 1);
    for (int i = 0; i < N + 2; i++)
        to[i] = -1;
    const vf loaded = vf_load_n(from, count);
    vf_store_n(to + 1, loaded, count);
    for (int i = 0; i < N; i++) {
        expect_float("vf_load_n", i, i < count ? (float)(i + 1) : 0,
                     taken(loaded).lane[i]);
        expect_int("vm_first", i, i < count, lane_set(vm_first(count), i));
    }
    for (int i = 0; i < N + 2; i++)
        expect_float("vf_store_n", i, i >= 1 && i <= count ? (float)i : -1, to[i]);
    free(from);
}

static void check_fours(void)
{
    float from[4 * N], back[4 * N + 2];
    vf four[4];
    for (int i = 0; i < 4 * N; i++)
        from[i] = (float)i;
    for (int i = 0; i < 4 * N + 2; i++)
        back[i] = -1;
    vf_split4(from, four);
    vf_join4(back + 1, four);
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < N; i++)
            expect_float("vf_split4", i, (float)(4 * i + k), taken(four[k]).lane[i]);
    }
    for (int i = 0; i < 4 * N + 2; i++)
        expect_float("vf_join4", i, i >= 1 && i <= 4 * N ? (float)(i - 1) : -1, back[i]);
}

int CRV__NAME(words)(uint64_t seed);
int CRV__NAME(words)(uint64_t seed)
{
    simd_random r = simd_random_make(seed, 1, 0);
    faults = 0;
    for (int i = 0; i < N; i++) {
        expect_int("vi_iota", i, i, taken_ints(vi_iota()).lane[i]);
        expect_int("vf_bits", i, bits_of(1.5f),
                   taken_ints(vf_bits(vf_set(1.5f))).lane[i]);
    }
    check_fours();
    for (int round = 0; round < ROUNDS; round++) {
        check_bits(&r);
        check_comparisons(&r);
        check_max_within(&r);
        check_rounding(&r);
        check_approximations(&r);
        check_gather(&r);
        check_memory(&r);
    }
    return faults;
}

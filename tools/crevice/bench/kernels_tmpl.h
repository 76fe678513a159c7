/* SPDX-License-Identifier: MIT */
/* kernels_tmpl.h: included once for every instruction set, which defines NAME(x), TARGET,
 * LANES, the vector type V and ZERO, SET, LOAD, GATHER, ADD, FMA and STORE on it. */

TARGET static float NAME(sum)(V a, V b)
{
    float lanes[LANES], total = 0.0f;

    STORE(lanes, ADD(a, b));
    for (int i = 0; i < LANES; i++)
        total += lanes[i];
    return total;
}

TARGET static float NAME(gather)(const float *row, const int32_t *offsets, int32_t width)
{
    V a = ZERO, b = ZERO, c = ZERO, d = ZERO;

    for (int32_t x = 0; x + LANES <= width; x += LANES) {
        for (int k = 0; k < BENCH_PLACES; k += 4) {
            const int32_t *at = offsets + k * BENCH_LANES_MAX;
            a = ADD(a, GATHER(row + x, at));
            b = ADD(b, GATHER(row + x, at + BENCH_LANES_MAX));
            c = ADD(c, GATHER(row + x, at + 2 * BENCH_LANES_MAX));
            d = ADD(d, GATHER(row + x, at + 3 * BENCH_LANES_MAX));
        }
    }
    return NAME(sum)(ADD(a, b), ADD(c, d));
}

/* Eight sums, so that no addition waits for the one before. */
TARGET static float NAME(load)(const float *row, const int32_t *offsets, int32_t width)
{
    V s[8] = {ZERO, ZERO, ZERO, ZERO, ZERO, ZERO, ZERO, ZERO};

    for (int32_t x = 0; x + LANES <= width; x += LANES) {
        for (int k = 0; k < BENCH_PLACES; k += 8) {
            const int32_t *at = offsets + k * BENCH_LANES_MAX;
            const float *from = row + x;
            s[0] = ADD(s[0], LOAD(from + at[0]));
            s[1] = ADD(s[1], LOAD(from + at[BENCH_LANES_MAX]));
            s[2] = ADD(s[2], LOAD(from + at[2 * BENCH_LANES_MAX]));
            s[3] = ADD(s[3], LOAD(from + at[3 * BENCH_LANES_MAX]));
            s[4] = ADD(s[4], LOAD(from + at[4 * BENCH_LANES_MAX]));
            s[5] = ADD(s[5], LOAD(from + at[5 * BENCH_LANES_MAX]));
            s[6] = ADD(s[6], LOAD(from + at[6 * BENCH_LANES_MAX]));
            s[7] = ADD(s[7], LOAD(from + at[7 * BENCH_LANES_MAX]));
        }
    }
    return NAME(sum)(ADD(ADD(s[0], s[1]), ADD(s[2], s[3])),
                     ADD(ADD(s[4], s[5]), ADD(s[6], s[7])));
}

TARGET static float NAME(fma)(float factor, int32_t rounds)
{
    V a = SET(factor), b = a, c = a, d = a, e = a, f = a, g = a, h = a, i = a, j = a,
      k = a, l = a;
    const V m = a;

    for (int32_t n = 0; n < rounds; n++) {
        a = FMA(a, m, m);
        b = FMA(b, m, m);
        c = FMA(c, m, m);
        d = FMA(d, m, m);
        e = FMA(e, m, m);
        f = FMA(f, m, m);
        g = FMA(g, m, m);
        h = FMA(h, m, m);
        i = FMA(i, m, m);
        j = FMA(j, m, m);
        k = FMA(k, m, m);
        l = FMA(l, m, m);
        KEEP(a, b, c, d);
        KEEP(e, f, g, h);
        KEEP(i, j, k, l);
    }
    return NAME(sum)(ADD(ADD(ADD(a, b), ADD(c, d)), ADD(e, f)),
                     ADD(ADD(ADD(g, h), ADD(i, j)), ADD(k, l)));
}

#undef NAME
#undef TARGET
#undef LANES
#undef V
#undef ZERO
#undef SET
#undef LOAD
#undef GATHER
#undef ADD
#undef FMA
#undef STORE
#undef KEEP

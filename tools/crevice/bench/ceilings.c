/* SPDX-License-Identifier: MIT */
#include "bench/ceilings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/kernels.h"

enum {
    WIDTH = 1920,
    RADIUS = 64,
    ROWS = 4 * RADIUS,
    NEAR_FLOATS = 2048,
    FMA_ROUNDS = 20000,
    STREAM_BYTES = 1 << 27, /* more than any cache of today */
    BLOCK_BYTES = 1 << 20,
    TRIES = 7
};

typedef struct reading {
    bench_read_kernel kernel;
    const float *row;
    const int32_t *offsets;
    int32_t width;
    float sum;
} reading;

static bool read_once(void *data)
{
    reading *r = data;

    r->sum += r->kernel(r->row, r->offsets, r->width);
    return true;
}

/* The shortest of the runs: what disturbs a loop of microseconds only makes it longer. */
static double floats_a_second(const bench_clock *clock, reading *r)
{
    bench_time t;

    bench_time_runs(clock, read_once, r, &t);
    return (double)r->width * BENCH_PLACES / (1e-3 * t.ms_min);
}

typedef struct adding {
    float (*kernel)(float factor, int32_t rounds);
    float sum;
} adding;

static bool add_once(void *data)
{
    adding *a = data;

    a->sum += a->kernel(0.25f, FMA_ROUNDS);
    return true;
}

static double fmas_a_second(const bench_clock *clock, const bench_kernels *k)
{
    adding a = {.kernel = k->fma};
    bench_time t;

    bench_time_runs(clock, add_once, &a, &t);
    return (double)FMA_ROUNDS * BENCH_CHAINS * k->lanes / (1e-3 * t.ms_min);
}

/* Places drawn evenly, always the same ones. */
static int32_t draw(uint32_t *state, int32_t low, int32_t high)
{
    *state = *state * 1664525u + 1013904223u;
    return low
           + (int32_t)((*state >> 8) * (uint64_t)(uint32_t)(high - low + 1) / (1u << 24));
}

static void choose_places(int32_t *near_places, int32_t *disk_places)
{
    uint32_t state = 1;

    for (int i = 0; i < BENCH_PLACES * BENCH_LANES_MAX; i++) {
        int32_t x, y;
        do {
            x = draw(&state, -RADIUS, RADIUS);
            y = draw(&state, -RADIUS, RADIUS);
        } while (x * x + y * y > RADIUS * RADIUS);
        disk_places[i] = y * WIDTH + x + i % BENCH_LANES_MAX;
        near_places[i] = draw(&state, 0, NEAR_FLOATS - 1) + i % BENCH_LANES_MAX;
    }
}

static void measure_set(const bench_clock *clock, const bench_kernels *k,
                        const float *plane, bench_ceiling *out)
{
    int32_t near_places[BENCH_PLACES * BENCH_LANES_MAX];
    int32_t disk_places[BENCH_PLACES * BENCH_LANES_MAX];
    const float *middle = plane + (size_t)(2 * RADIUS) * WIDTH;
    reading near_reading = {.row = plane, .offsets = near_places, .width = WIDTH};
    /* Not the edges, whose disks leave the rows above and below. */
    reading disk_reading = {.row = middle, .offsets = disk_places, .width = WIDTH};

    choose_places(near_places, disk_places);
    *out = (bench_ceiling){.isa = k->isa, .lanes = k->lanes};
    near_reading.kernel = disk_reading.kernel = k->gather;
    out->gather_near = floats_a_second(clock, &near_reading);
    out->gather_disk = floats_a_second(clock, &disk_reading);
    near_reading.kernel = disk_reading.kernel = k->load;
    out->load_near = floats_a_second(clock, &near_reading);
    out->load_disk = floats_a_second(clock, &disk_reading);
    out->fma = fmas_a_second(clock, k);
}

typedef struct streaming {
    char *from, *to;
    int32_t threads;
    uint64_t sum;
} streaming;

static uint64_t sum_block(const char *from)
{
    const uint64_t *words = (const uint64_t *)(const void *)from;
    uint64_t sum = 0;

    for (size_t i = 0; i < BLOCK_BYTES / sizeof *words; i++)
        sum ^= words[i];
    return sum;
}

static bool read_stream(void *data)
{
    streaming *s = data;
    uint64_t sum = 0;

#ifdef _OPENMP
#pragma omp parallel for num_threads(s->threads) reduction(^ : sum)
#endif
    for (int i = 0; i < STREAM_BYTES / BLOCK_BYTES; i++)
        sum ^= sum_block(s->from + (size_t)i * BLOCK_BYTES);
    s->sum ^= sum;
    return true;
}

static bool copy_stream(void *data)
{
    streaming *s = data;

#ifdef _OPENMP
#pragma omp parallel for num_threads(s->threads)
#endif
    for (int i = 0; i < STREAM_BYTES / BLOCK_BYTES; i++)
        memcpy(s->to + (size_t)i * BLOCK_BYTES, s->from + (size_t)i * BLOCK_BYTES,
               BLOCK_BYTES);
    return true;
}

static bool measure_streams(bench_ceilings *out, const bench_clock *clock,
                            const int32_t *threads, int32_t count)
{
    streaming s = {.from = malloc(STREAM_BYTES), .to = malloc(STREAM_BYTES)};
    bool good = s.from != NULL && s.to != NULL;

    if (good) {
        memset(s.from, 1, STREAM_BYTES);
        memset(s.to, 2, STREAM_BYTES);
    }
    for (int32_t i = 0; i < count && good && i < BENCH_STREAMS_MAX; i++) {
        bench_stream *stream = &out->streams[out->stream_count++];
        bench_time t;

        s.threads = threads[i];
        *stream = (bench_stream){.threads = threads[i]};
        bench_time_runs(clock, read_stream, &s, &t);
        stream->read = STREAM_BYTES / (1e-3 * t.ms_min);
        bench_time_runs(clock, copy_stream, &s, &t);
        stream->copy = 2.0 * STREAM_BYTES / (1e-3 * t.ms_min);
    }
    free(s.from);
    free(s.to);
    return good;
}

bool bench_ceilings_measure(bench_ceilings *out, const bench_clock *clock,
                            const int32_t *threads, int32_t count)
{
    bench_clock brief = *clock;
    float *plane = malloc((size_t)ROWS * WIDTH * sizeof *plane);

    *out = (bench_ceilings){0};
    if (plane == NULL)
        return false;
    for (size_t i = 0; i < (size_t)ROWS * WIDTH; i++)
        plane[i] = 1.0f; /* pages that were never written share one */
    brief.repeats = TRIES;
    brief.seconds = 2.0;
    for (const bench_kernels *k = bench_kernels_list; k->lanes > 0; k++)
        if (crv_isa_available() & 1u << k->isa && out->set_count < BENCH_SETS_MAX)
            measure_set(&brief, k, plane, &out->sets[out->set_count++]);
    free(plane);
    return measure_streams(out, &brief, threads, count);
}

const bench_ceiling *bench_ceiling_of(const bench_ceilings *c, crv_isa isa)
{
    for (int32_t i = 0; i < c->set_count; i++)
        if (c->sets[i].isa == isa)
            return &c->sets[i];
    return NULL;
}

const bench_stream *bench_stream_of(const bench_ceilings *c, int32_t threads)
{
    for (int32_t i = 0; i < c->stream_count; i++)
        if (c->streams[i].threads == threads)
            return &c->streams[i];
    return NULL;
}

/* SPDX-License-Identifier: MIT */
/* ceilings.h: what the machine can do at most of what the kernels do most: read floats
 * around a pixel, multiply and add, stream whole pictures. */
#ifndef TOOL_BENCH_CEILINGS_H
#define TOOL_BENCH_CEILINGS_H

#include "bench/clock.h"
#include "crevice/crevice.h"

/* Floats or multiply-adds in a second, one thread. Near: within 16 KiB, so from the
 * first cache; disk: on 64 places of a disk of 64 px around pixels that follow each other
 * in rows of 1920, as estimators read. */
typedef struct bench_ceiling {
    crv_isa isa;
    int32_t lanes;
    double gather_near, gather_disk; /* every lane at a place of its own */
    double load_near, load_disk;     /* the lanes at places side by side, unaligned */
    double fma;
} bench_ceiling;

/* Bytes in a second, from and to memory that no cache holds. */
typedef struct bench_stream {
    int32_t threads;
    double read, copy; /* copy: bytes read plus bytes written */
} bench_stream;

enum { BENCH_SETS_MAX = 8, BENCH_STREAMS_MAX = 32 };

typedef struct bench_ceilings {
    int32_t set_count, stream_count;
    bench_ceiling sets[BENCH_SETS_MAX];
    bench_stream streams[BENCH_STREAMS_MAX];
} bench_ceilings;

/* Measures the sets that this machine has, and streams with these numbers of threads.
 * False where memory is short. */
bool bench_ceilings_measure(bench_ceilings *out, const bench_clock *clock,
                            const int32_t *threads, int32_t count);

/* NULL where that was not measured. */
const bench_ceiling *bench_ceiling_of(const bench_ceilings *c, crv_isa isa);
const bench_stream *bench_stream_of(const bench_ceilings *c, int32_t threads);

#endif

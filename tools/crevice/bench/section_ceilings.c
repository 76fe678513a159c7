/* SPDX-License-Identifier: MIT */
/* section_ceilings.c: what the machine can do, in the same run as all the rest. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "study/study.h"

static double cycles_a_vector(const bench *b, double rate, int32_t lanes)
{
    return b->clock.ghz > 0.0 ? 1e9 * b->clock.ghz * lanes / rate : NAN;
}

static void add_set(bench *b, const bench_ceiling *s)
{
    cJSON *row = cJSON_CreateObject();

    cJSON_AddStringToObject(row, "isa", crv_isa_name(s->isa));
    cJSON_AddNumberToObject(row, "lanes", s->lanes);
    cJSON_AddNumberToObject(row, "gather_near_per_s", s->gather_near);
    cJSON_AddNumberToObject(row, "gather_disk_per_s", s->gather_disk);
    cJSON_AddNumberToObject(row, "load_near_per_s", s->load_near);
    cJSON_AddNumberToObject(row, "load_disk_per_s", s->load_disk);
    cJSON_AddNumberToObject(row, "fma_per_s", s->fma);
    study_add_number(row, "gather_near_cycles",
                     cycles_a_vector(b, s->gather_near, s->lanes));
    study_add_number(row, "gather_disk_cycles",
                     cycles_a_vector(b, s->gather_disk, s->lanes));
    study_add_number(row, "load_near_cycles", cycles_a_vector(b, s->load_near, s->lanes));
    study_add_number(row, "load_disk_cycles", cycles_a_vector(b, s->load_disk, s->lanes));
    study_add_number(row, "fma_cycles", cycles_a_vector(b, s->fma, s->lanes));
    bench_append(b, "ceilings", row);
}

static void add_stream(bench *b, const bench_stream *s)
{
    cJSON *row = cJSON_CreateObject();

    cJSON_AddNumberToObject(row, "threads", s->threads);
    cJSON_AddNumberToObject(row, "read_bytes_per_s", s->read);
    cJSON_AddNumberToObject(row, "copy_bytes_per_s", s->copy);
    bench_append(b, "streams", row);
}

static void print(const bench *b)
{
    static const bench_column sets[] = {
        {"isa", "isa", -1, 0},
        {"lanes", "lanes", 0, 0},
        {"gather near", "gather_near_per_s", 2, 1e-9},
        {"disk", "gather_disk_per_s", 2, 1e-9},
        {"load near", "load_near_per_s", 2, 1e-9},
        {"disk", "load_disk_per_s", 2, 1e-9},
        {"fma", "fma_per_s", 1, 1e-9},
        {"cycles: gather", "gather_disk_cycles", 1, 0},
        {"load", "load_disk_cycles", 1, 0},
        {"fma", "fma_cycles", 2, 0},
    };
    static const bench_column streams[] = {
        {"threads", "threads", 0, 0},
        {"read GB/s", "read_bytes_per_s", 1, 1e-9},
        {"copy GB/s", "copy_bytes_per_s", 1, 1e-9},
    };

    bench_print_list(b,
                     "Ceilings of one thread, 10^9 floats a second: near, in the first "
                     "cache; disk, 64 px about the pixel",
                     "ceilings", sets, sizeof sets / sizeof sets[0]);
    bench_print_list(b, "Streaming from memory", "streams", streams,
                     sizeof streams / sizeof streams[0]);
}

/* Streams also of one thread and of all, which growth over threads wants. */
int bench_ceilings_section(bench *b)
{
    const bench_choices *c = b->choices;
    int32_t threads[BENCH_CHOICES_MAX + 2] = {1, b->all_threads}, count = 2;

    if (b->all_threads == 1)
        count = 1;
    for (int32_t i = 0; i < c->thread_count; i++) {
        bool known = false;
        for (int32_t k = 0; k < count; k++)
            known = known || threads[k] == c->threads[i];
        if (!known)
            threads[count++] = c->threads[i];
    }
    bench_progress(b, "ceilings of this machine");
    if (!bench_ceilings_measure(&b->ceilings, &b->clock, threads,
                                count < BENCH_STREAMS_MAX ? count : BENCH_STREAMS_MAX))
        return report_no_memory(b->r);
    for (int32_t i = 0; i < b->ceilings.set_count; i++)
        add_set(b, &b->ceilings.sets[i]);
    for (int32_t i = 0; i < b->ceilings.stream_count; i++)
        add_stream(b, &b->ceilings.streams[i]);
    print(b);
    return EXIT_DONE;
}

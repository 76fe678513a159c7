/* SPDX-License-Identifier: MIT */
/* section_memory.c: what the library takes through its allocator hook for a G-buffer and
 * a plan, beyond the pictures that the host gives and gets; and what a run takes. */
#include "bench/bench.h"

static int measure(bench *b, const bench_frame *frame, int32_t method, bool filtered,
                   bool exact)
{
    bench_case c;
    bench_outcome outcome;
    cJSON *row;
    int result = bench_case_make(b, frame, method, 0, 0, 1.0, &c);
    double pixels = (double)frame->width * (double)frame->height;

    if (result != EXIT_DONE)
        return result;
    if (filtered)
        c.options.filter = crv_filter_find("bilateral13");
    else
        c.options.filter = NULL;
    c.exact = exact;
    result = bench_measure(b, &c, NULL, &outcome);
    if (result != EXIT_DONE)
        return result;
    row = cJSON_CreateObject();
    cJSON_AddStringToObject(row, "method", c.options.method->name);
    cJSON_AddStringToObject(row, "filter", filtered ? "bilateral13" : "none");
    cJSON_AddStringToObject(row, "structure", bench_structure(&c));
    cJSON_AddStringToObject(row, "isa", bench_isa_name(b, c.isa));
    cJSON_AddNumberToObject(row, "width", frame->width);
    cJSON_AddNumberToObject(row, "height", frame->height);
    cJSON_AddNumberToObject(row, "bytes", outcome.bytes);
    cJSON_AddNumberToObject(row, "bytes_per_pixel", outcome.bytes / pixels);
    cJSON_AddNumberToObject(row, "run_allocations", (double)outcome.run_allocations);
    bench_append(b, "memory", row);
    return EXIT_DONE;
}

int bench_memory_section(bench *b)
{
    static const bench_column columns[] = {
        {"method", "method", -1, 0},
        {"filter", "filter", -1, 0},
        {"isa", "isa", -1, 0},
        {"", "structure", -1, 0},
        {"width", "width", 0, 0},
        {"bytes/px", "bytes_per_pixel", 1, 0},
        {"allocations of a run", "run_allocations", 0, 0},
    };
    bench_frame frame;
    bench_clock clock = b->clock;
    int result = bench_frame_make(
        &b->sources[0], b->choices->sizes[0].width, b->choices->sizes[0].height,
        b->settings->common.threads.value, &b->quiet_logger, b->r, &frame);

    /* One run is enough to count. */
    b->clock.seconds = 0.0;
    bench_progress(b, "memory");
    for (int32_t m = 0; m < b->choices->method_count; m++)
        for (int32_t s = 0; s < b->choices->structure_count; s++)
            for (int filtered = 0; filtered < 2 && result == EXIT_DONE; filtered++)
                result = measure(b, &frame, m, filtered != 0, b->choices->exact[s]);
    b->clock = clock;
    bench_frame_free(&frame);
    if (result == EXIT_DONE)
        bench_print_list(b, "Memory of G-buffer and plan beyond input and output",
                         "memory", columns, sizeof columns / sizeof columns[0]);
    return result;
}

/* SPDX-License-Identifier: MIT */
/* rows.c: what was measured, as JSON and as a line of the table. */
#include <stdio.h>
#include <string.h>

#include "bench/bench.h"
#include "common/device.h"
#include "common/json.h"

static void add_options(cJSON *row, const bench_case *c)
{
    const crv_options *o = &c->options;
    cJSON *options = cJSON_AddObjectToObject(row, "options");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        if (crv_option_applies(option, c->filter_only ? NULL : o->method, o->filter))
            json_add_number(options, option->key, crv_options_get(o, option));
    }
}

static void add_device(cJSON *row, const bench_settings *s, const bench_case *c)
{
    const bool cpu = device_is_cpu(&s->common);
    /* The scalar code has no other structure. */
    const int32_t structure = c->isa == (int32_t)CRV_ISA_SCALAR ? 1 : c->structure;
    json_add_text(row, "device", cpu ? "cpu" : s->common.device);
    json_add_text(row, "isa", cpu ? crv_isa_name((crv_isa)c->isa) : NULL);
    json_add_text(row, "structure", cpu ? bench_structures[structure] : NULL);
    json_add_text(row, "depth_layout", cpu ? NULL : bench_layouts[c->layout]);
    json_add_text(row, "arithmetic", cpu ? NULL : bench_arithmetic[c->arithmetic]);
    json_add_number(row, "threads", c->threads);
}

static void add_times(cJSON *row, const bench_time *t, double pixels)
{
    json_add_number(row, "runs", t->runs);
    json_add_number(row, "ms", t->ms);
    json_add_number(row, "ms_min", t->ms_min);
    json_add_number(row, "ms_q1", t->ms_q1);
    json_add_number(row, "ms_q3", t->ms_q3);
    json_add_number(row, "ms_max", t->ms_max);
    json_add_number(row, "cpu_ms", t->cpu_ms);
    json_add_number(row, "mpix_per_s", 1e-3 * pixels / t->ms);
    json_add_number(row, "cycles_per_pixel", t->cycles / pixels);
}

static void add_steps(cJSON *row, const bench_outcome *o)
{
    cJSON *steps = o->step_count > 0 ? cJSON_AddArrayToObject(row, "steps") : NULL;
    for (int32_t i = 0; i < o->step_count; i++) {
        cJSON *step = cJSON_CreateObject();
        json_add_text(step, "name", o->steps[i].name);
        json_add_number(step, "ms", o->steps[i].ms);
        cJSON_AddItemToArray(steps, step);
    }
}

cJSON *bench_row(const bench_settings *s, const bench_case *c, const bench_outcome *o)
{
    const double pixels = (double)c->scene->width * (double)c->scene->height;
    const crv_filter *filter = c->options.filter;
    cJSON *row = cJSON_CreateObject();
    json_add_text(row, "scene", c->scene->name);
    json_add_number(row, "width", c->scene->width);
    json_add_number(row, "height", c->scene->height);
    json_add_text(row, "method", c->filter_only ? "none" : c->options.method->name);
    json_add_text(row, "preset", c->preset);
    json_add_text(row, "filter", filter ? filter->name : "none");
    add_device(row, s, c);
    json_add_number(row, "radius_factor", c->factor);
    add_options(row, c);
    add_times(row, &o->time, pixels);
    json_add_number(row, "bytes_per_pixel", o->bytes / pixels);
    json_add_number(row, "run_allocations", (double)o->allocations);
    add_steps(row, o);
    return row;
}

/* A column: a member of the row. digits: after the point, -1: text. */
typedef struct column {
    const char *heading, *key;
    int width, digits;
    enum { ALWAYS, CPU_ONLY, DEVICE_ONLY } shown;
} column;

static const column columns[] = {
    {.heading = "scene", .key = "scene", .width = 18, .digits = -1},
    {.heading = "width", .key = "width", .width = 5},
    {.heading = "height", .key = "height", .width = 6},
    {.heading = "method", .key = "method", .width = 11, .digits = -1},
    {.heading = "preset", .key = "preset", .width = 6, .digits = -1},
    {.heading = "filter", .key = "filter", .width = 11, .digits = -1},
    {.heading = "isa", .key = "isa", .width = 6, .digits = -1, .shown = CPU_ONLY},
    {.heading = "structure",
     .key = "structure",
     .width = 13,
     .digits = -1,
     .shown = CPU_ONLY},
    {.heading = "depth",
     .key = "depth_layout",
     .width = 13,
     .digits = -1,
     .shown = DEVICE_ONLY},
    {.heading = "filter in",
     .key = "arithmetic",
     .width = 9,
     .digits = -1,
     .shown = DEVICE_ONLY},
    {.heading = "thr", .key = "threads", .width = 3, .shown = CPU_ONLY},
    {.heading = "radius", .key = "radius_factor", .width = 6, .digits = 2},
    {.heading = "ms", .key = "ms", .width = 9, .digits = 2},
    {.heading = "least", .key = "ms_min", .width = 9, .digits = 2},
    {.heading = "MPix/s", .key = "mpix_per_s", .width = 7, .digits = 1},
    {.heading = "cycles/px", .key = "cycles_per_pixel", .width = 9, .digits = 1},
    {.heading = "bytes/px", .key = "bytes_per_pixel", .width = 8, .digits = 1},
};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

static bool is_shown(const column *c, bool device)
{
    return c->shown == ALWAYS || (c->shown == DEVICE_ONLY) == device;
}

static void print_cell(const column *c, const char *words)
{
    printf("%*s  ", c->digits < 0 ? -c->width : c->width, words);
}

void bench_print_head(bool device)
{
    for (int i = 0; i < COLUMNS; i++)
        if (is_shown(&columns[i], device))
            print_cell(&columns[i], columns[i].heading);
    printf("%s\n", device ? "steps by the device's clock, ms" : "");
}

void bench_print_row(const cJSON *row, bool device)
{
    for (int i = 0; i < COLUMNS; i++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(row, columns[i].key);
        char number[64] = "-";

        if (!is_shown(&columns[i], device))
            continue;
        if (cJSON_IsNumber(value))
            snprintf(number, sizeof number, "%.*f", columns[i].digits,
                     value->valuedouble);
        print_cell(&columns[i], cJSON_IsString(value) ? value->valuestring : number);
    }
    const cJSON *step;
    cJSON_ArrayForEach(step, cJSON_GetObjectItemCaseSensitive(row, "steps"))
        printf("%s %.3f  ", cJSON_GetObjectItemCaseSensitive(step, "name")->valuestring,
               cJSON_GetObjectItemCaseSensitive(step, "ms")->valuedouble);
    printf("\n");
    fflush(stdout);
}

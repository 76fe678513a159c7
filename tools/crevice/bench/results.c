/* SPDX-License-Identifier: MIT */
/* results.c: rows of what was measured, and tables of them. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "bench/bench.h"
#include "study/study.h"

/* Read once, depth and normals; written once, the result. */
#define BYTES_A_PIXEL 20.0

enum { TEXT_SIZE = 64, COLUMNS_MAX = 16 };

/* Of all threads on one pixel; NAN where nothing tells. */
static double cycles_of(const bench *b, const bench_time *t)
{
    if (b->clock.counter >= 0)
        return t->cycles;
    return b->clock.ghz > 0.0 ? 1e6 * t->cpu_ms * b->clock.ghz : NAN;
}

void bench_add_time(const bench *b, cJSON *row, const bench_time *t, double pixels)
{
    cJSON_AddNumberToObject(row, "runs", t->runs);
    study_add_number(row, "ms", t->ms);
    study_add_number(row, "ms_min", t->ms_min);
    study_add_number(row, "ms_q1", t->ms_q1);
    study_add_number(row, "ms_q3", t->ms_q3);
    study_add_number(row, "ms_max", t->ms_max);
    study_add_number(row, "ms_spread", 0.5 * (t->ms_q3 - t->ms_q1));
    study_add_number(row, "cpu_ms", t->cpu_ms);
    study_add_number(row, "mpixels_per_s", 1e-3 * pixels / t->ms);
    study_add_number(row, "ns_per_pixel", 1e6 * t->ms / pixels);
    study_add_number(row, "cycles_per_pixel", cycles_of(b, t) / pixels);
}

/* Shares of what the threads together could do at most. */
static void add_shares(const bench *b, cJSON *row, const bench_case *c,
                       const bench_time *t, double pixels, double samples)
{
    const bench_ceiling *set = bench_ceiling_of(&b->ceilings, c->isa);
    const bench_stream *stream = bench_stream_of(&b->ceilings, c->threads);
    double rate = pixels * samples / (1e-3 * t->ms), threads = c->threads;

    study_add_number(row, "share_of_gather",
                     set != NULL ? rate / (threads * set->gather_disk) : NAN);
    study_add_number(row, "share_of_load",
                     set != NULL ? rate / (threads * set->load_disk) : NAN);
    study_add_number(row, "fma_at_ceiling_per_sample",
                     set != NULL ? threads * set->fma / rate : NAN);
    study_add_number(
        row, "share_of_copy",
        stream != NULL ? pixels * BYTES_A_PIXEL / (1e-3 * t->ms) / stream->copy : NAN);
}

/* The preset whose numbers these are comes from the caller, who chose it. */
cJSON *bench_row(bench *b, const bench_case *c, const bench_outcome *o)
{
    cJSON *row = cJSON_CreateObject();
    const crv_options *options = &c->options;
    double pixels = (double)c->frame->width * (double)c->frame->height;
    double samples = study_samples(options);

    cJSON_AddStringToObject(row, "frame", c->frame->source->name);
    cJSON_AddNumberToObject(row, "width", c->frame->width);
    cJSON_AddNumberToObject(row, "height", c->frame->height);
    cJSON_AddStringToObject(row, "method", options->method->name);
    cJSON_AddStringToObject(row, "filter",
                            options->filter != NULL ? options->filter->name : "none");
    cJSON_AddStringToObject(row, "structure", bench_structure(c));
    cJSON_AddStringToObject(row, "isa", bench_isa_name(b, c->isa));
    cJSON_AddNumberToObject(row, "threads", c->threads);
    cJSON_AddNumberToObject(row, "radius", (double)options->radius);
    cJSON_AddNumberToObject(row, "radius_factor",
                            (double)options->radius / (double)c->frame->radius);
    cJSON_AddNumberToObject(row, "samples", samples);
    bench_add_time(b, row, &o->time, pixels);
    study_add_number(row, "ns_per_pixel_sample", 1e6 * o->time.ms / pixels / samples);
    study_add_number(row, "cycles_per_pixel_sample",
                     cycles_of(b, &o->time) / pixels / samples);
    add_shares(b, row, c, &o->time, pixels, samples);
    cJSON_AddNumberToObject(row, "bytes_per_pixel", o->bytes / pixels);
    cJSON_AddNumberToObject(row, "run_allocations", (double)o->run_allocations);
    return row;
}

void bench_append(bench *b, const char *list, cJSON *row)
{
    cJSON *rows = cJSON_GetObjectItemCaseSensitive(b->results, list);

    if (rows == NULL)
        rows = cJSON_AddArrayToObject(b->results, list);
    cJSON_AddItemToArray(rows, row);
}

static void cell_text(const cJSON *row, const bench_column *column, char out[TEXT_SIZE])
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(row, column->key);
    double scale = column->scale > 0.0 ? column->scale : 1.0;

    if (cJSON_IsString(value))
        snprintf(out, TEXT_SIZE, "%s", value->valuestring);
    else if (cJSON_IsNumber(value))
        snprintf(out, TEXT_SIZE, "%.*f", column->digits > 0 ? column->digits : 0,
                 scale * value->valuedouble);
    else
        snprintf(out, TEXT_SIZE, "-");
}

void bench_print(const bench *b, const char *title, const cJSON *rows,
                 const bench_column *columns, int32_t count)
{
    int widths[COLUMNS_MAX];
    char text[TEXT_SIZE];
    const cJSON *row;

    if (!b->print || !cJSON_IsArray(rows) || rows->child == NULL || count > COLUMNS_MAX)
        return;
    for (int32_t i = 0; i < count; i++)
        widths[i] = (int)strlen(columns[i].heading);
    for (row = rows->child; row != NULL; row = row->next) {
        for (int32_t i = 0; i < count; i++) {
            cell_text(row, &columns[i], text);
            widths[i] = (int)strlen(text) > widths[i] ? (int)strlen(text) : widths[i];
        }
    }
    printf("\n%s\n\n", title);
    for (int32_t i = 0; i < count; i++)
        printf("%s%*s", i > 0 ? "  " : "", columns[i].digits < 0 ? -widths[i] : widths[i],
               columns[i].heading);
    for (row = rows->child; row != NULL; row = row->next) {
        printf("\n");
        for (int32_t i = 0; i < count; i++) {
            cell_text(row, &columns[i], text);
            printf("%s%*s", i > 0 ? "  " : "",
                   columns[i].digits < 0 ? -widths[i] : widths[i], text);
        }
    }
    printf("\n");
    fflush(stdout);
}

void bench_print_list(const bench *b, const char *title, const char *list,
                      const bench_column *columns, int32_t count)
{
    bench_print(b, title, cJSON_GetObjectItemCaseSensitive(b->results, list), columns,
                count);
}

void bench_progress(bench *b, const char *format, ...)
{
    char line[256];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    report_info(b->r, "[%6.1f s] %s", report_seconds() - b->started, line);
}

double bench_exponent(const double *x, const double *y, int32_t count)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, spread;

    for (int32_t i = 0; i < count; i++) {
        double lx = log(x[i]), ly = log(y[i]);

        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    spread = count * sxx - sx * sx;
    return spread > 1e-9 ? (count * sxy - sx * sy) / spread : NAN;
}

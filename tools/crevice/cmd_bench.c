/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "bench/bench.h"
#include "commands.h"
#include "common/device.h"
#include "common/json.h"
#include "bench/machine.h"
#include "system/interrupt.h"

/* Longer than this is announced. */
#define LONG_SECONDS 10.0
/* After a signal, to write what was measured. */
enum { GRACE_S = 5 };

static const arg input_rows[] = {
    {.name = "INPUT",
     ARG_INTO(ARG_TEXTS, bench_settings, inputs),
     .computed = "builtin:courtyard",
     .help = "mesh files or builtin:NAME, each framed by itself, and .exr frames with a "
             "depth pass, which keep their size; `crevice gbuffer` makes such frames of "
             "any camera"},
    {.name = "--vfov",
     .value = "DEG",
     ARG_RANGE(0.1, 179.0),
     .unit = "degrees",
     ARG_INTO(ARG_NUMBER, bench_settings, vfov_deg),
     .computed = "from the file's metadata",
     .help = "full vertical field of view of .exr frames"},
    {.name = "--json",
     ARG_INTO(ARG_FLAG, bench_settings, json),
     .help = "write JSON to standard output instead of the table"},
};
static const arg_table input_table = ARG_TABLE("Files", input_rows);

static const arg choice_rows[] = {
    {.name = "--method",
     .value = "METHOD,...",
     ARG_INTO(ARG_TEXTS, bench_settings, methods),
     .computed = "all",
     .help = "methods, or all; none: the filters alone"},
    {.name = "--preset",
     .value = "PRESET,...",
     ARG_INTO(ARG_TEXTS, bench_settings, presets),
     .computed = "medium",
     .help = "presets of the methods, or all"},
    {.name = "--filter",
     .value = "FILTER,...",
     ARG_INTO(ARG_TEXTS, bench_settings, filters),
     .computed = "none",
     .help = "filters, none, preset (the preset's own), or all filters"},
    {.name = "--set",
     .value = "KEY=VALUE",
     ARG_INTO(ARG_TEXTS, bench_settings, sets),
     .help = "an option (`crevice methods`) of the methods that read it; may be given "
             "again. radius=R replaces the radius that suits the scene"},
    {.name = "--radius-factor",
     .value = "X,...",
     ARG_INTO(ARG_TEXTS, bench_settings, radius_factors),
     .computed = "1",
     .help = "factors of the radius: how time grows with it"},
    {.name = "--size",
     .value = "WxH,...",
     ARG_INTO(ARG_TEXTS, bench_settings, sizes),
     .computed = "1280x720",
     .help = "sizes of the pictures, WIDTHxHEIGHT; .exr frames keep theirs"},
    {.name = "--isa",
     .value = "ISA,...",
     ARG_INTO(ARG_TEXTS, bench_settings, isas),
     .computed = "the best and scalar",
     .help = "instruction sets of the CPU, or all that this machine has"},
    {.name = "--structure",
     .value = "KIND,...",
     ARG_INTO(ARG_TEXTS, bench_settings, structures),
     .computed = "deinterleaved",
     .help = "deinterleaved (what runs by default), exact (what --exact chooses in other "
             "commands), or all"},
    {.name = "--threads",
     .value = "N,...",
     ARG_INTO(ARG_TEXTS, bench_settings, threads),
     .computed = "all processors",
     .help = "numbers of threads"},
    {.name = "--device",
     .value = "DEVICE",
     .computed = "cpu",
     ARG_INTO(ARG_TEXT, common_settings, device),
     .help = "cpu, or vulkan or vulkan:N, the GPU that `crevice devices` gives that "
             "number; every step of a run is then timed by the device's own clock, too"},
    {.name = "--depth-layout",
     .value = "KIND,...",
     ARG_INTO(ARG_TEXTS, bench_settings, depth_layouts),
     .computed = "linear",
     .help = "on a GPU, how depth lies in its memory: linear, deinterleaved, levels "
             "(coarser for far samples), or all"},
    {.name = "--arithmetic",
     .value = "KIND,...",
     ARG_INTO(ARG_TEXTS, bench_settings, arithmetic),
     .computed = "single",
     .help = "on a GPU, what filters compute in: single, half, or all"},
};
static const arg_table choice_table =
    ARG_TABLE("What is measured, as lists with commas or flags given again", choice_rows);

static const arg run_rows[] = {
    {.name = "--repeats",
     .value = "N",
     ARG_RANGE(1, BENCH_RUNS_MAX),
     .initial = "9",
     ARG_INTO(ARG_INT, bench_settings, repeats),
     .help = "timed runs after one to warm up; more if they are short"},
    {.name = "--seconds",
     .value = "S",
     ARG_RANGE(0.0, 3600.0),
     .unit = "s",
     .initial = "1",
     ARG_INTO(ARG_NUMBER, bench_settings, seconds),
     .help = "time for the runs of one measurement, after three of them; a first run of "
             "half of it is the only one"},
};
static const arg_table run_table = ARG_TABLE("How it is measured", run_rows);

static const arg_table *const tables[] = {&input_table, &choice_table, &run_table,
                                          &args_output_lines, NULL};

static const char *const examples[] = {
    "the built-in scene, in half a minute",
    "crevice bench",
    "two methods with every instruction set, on one and two threads",
    "crevice bench --method hbao,alchemy --isa all --threads 1,2",
    "your own scene in full high definition, numbers to a file",
    "crevice bench hall.glb --size 1920x1080 --json >hall.json",
    "a renderer's frame, without and with a filter",
    "crevice bench frame.exr --vfov 60 --filter none,bilateral13",
    "the filters alone, and a GPU",
    "crevice bench --method none --filter all --device vulkan",
    NULL,
};

typedef struct bench {
    const bench_settings *settings;
    bench_choices choices;
    bench_clock clock;
    report *r;
    cJSON *rows; /* NULL: a table */
    bool device;
    double started;
    int32_t done, count;
} bench;

/* Splits --set KEY=VALUE; NULL if it sets no option. */
static const crv_option *split_set(const char *given, const char **value)
{
    const char *equals = strchr(given, '=');
    char key[64] = "";
    if (!equals || (size_t)(equals - given) >= sizeof key)
        return NULL;
    memcpy(key, given, (size_t)(equals - given));
    *value = equals + 1;
    return crv_option_find(key);
}

static const crv_method *method_of(int32_t index)
{
    return index == BENCH_METHOD_NONE ? NULL : crv_method_at(index - BENCH_METHOD_FIRST);
}

/* A typing error must not pass in silence: some chosen method or a filter reads what is
 * set. */
static int check_sets(const bench *b)
{
    const bench_list *methods = &b->choices.methods;
    for (int32_t i = 0; i < b->settings->sets.count; i++) {
        const char *given = b->settings->sets.value[i], *value;
        const crv_option *option = split_set(given, &value);
        bool is_read = false;
        if (!option) {
            report_error(b->r,
                         "--set: \"%s\" sets no option; give KEY=VALUE, a key of "
                         "`crevice methods`",
                         given);
            return EXIT_USAGE;
        }
        for (int32_t m = 0; m < methods->count; m++)
            for (int32_t f = 0; f < crv_filter_count(); f++)
                is_read = is_read
                          || crv_option_applies(option, method_of(methods->at[m]),
                                                crv_filter_at(f));
        if (!is_read) {
            report_error(b->r, "--set: no chosen method reads %s; see `crevice methods`",
                         option->key);
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

static int apply_sets(const bench *b, crv_options *o)
{
    for (int32_t i = 0; i < b->settings->sets.count; i++) {
        const char *value = NULL;
        const crv_option *option = split_set(b->settings->sets.value[i], &value);
        if (crv_option_applies(option, o->method, o->filter)
            && crv_options_set(o, option->key, value, &b->r->logger) != CRV_OK)
            return EXIT_USAGE;
    }
    return EXIT_DONE;
}

/* A filter alone needs a plan, too, whose method is not run. */
static int make_options(const bench *b, const bench_scene *on, int32_t method,
                        int32_t preset, int32_t filter, bench_case *out)
{
    const crv_logger log = report_errors_only(b->r);
    const crv_method *chosen = method_of(method);
    crv_options *o = &out->options;
    *out = (bench_case){.scene = on, .filter_only = !chosen, .preset = "none"};
    crv_options_init(o, sizeof *o, chosen ? chosen->name : NULL);
    if (chosen) {
        crv_options_preset(o, (crv_preset)preset);
        out->preset = crv_preset_name((crv_preset)preset);
    }
    if (filter == BENCH_FILTER_NONE)
        o->filter = NULL;
    else if (filter >= BENCH_FILTER_FIRST)
        o->filter = crv_filter_at(filter - BENCH_FILTER_FIRST);
    o->radius = on->radius;
    if (apply_sets(b, o) != EXIT_DONE)
        return EXIT_USAGE;
    return crv_options_check(o, &log) == CRV_OK ? EXIT_DONE : EXIT_USAGE;
}

static void tell_progress(const bench *b, const bench_case *c)
{
    const double seconds = report_seconds() - b->started;
    const double left = b->done > 0 ? seconds / b->done * (b->count - b->done) : 0.0;
    if (!b->rows)
        return; /* the table's lines tell */
    report_info(b->r, "%d of %d: %s %s, %s; %.0f s left", b->done + 1, b->count,
                c->scene->name, c->filter_only ? "none" : c->options.method->name,
                c->options.filter ? c->options.filter->name : "no filter", left);
}

static int measure(bench *b, const bench_case *c)
{
    bench_outcome outcome;
    tell_progress(b, c);
    const int result = bench_measure(b->settings, &b->clock, c, b->r, &outcome);
    b->done++;
    if (result != EXIT_DONE)
        return result;
    cJSON *row = bench_row(b->settings, c, &outcome);
    if (!row)
        return report_no_memory(b->r);
    if (b->rows) {
        cJSON_AddItemToArray(b->rows, row);
        return EXIT_DONE;
    }
    bench_print_row(row, b->device);
    cJSON_Delete(row);
    return EXIT_DONE;
}

/* The case with every set, structure, number of threads, layout and arithmetic. Scalar
 * code has one structure only. */
static int run_ways(bench *b, bench_case *c)
{
    const bench_choices *o = &b->choices;
    const int32_t sizes[] = {o->isas.count, o->structures.count, o->threads.count,
                             o->layouts.count, o->arithmetic.count};
    int32_t total = 1;
    int result = EXIT_DONE;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        total *= sizes[i];
    for (int32_t k = 0; k < total && result == EXIT_DONE; k++) {
        int32_t at[sizeof sizes / sizeof sizes[0]], rest = k;
        for (int i = (int)(sizeof sizes / sizeof sizes[0]) - 1; i >= 0; i--) {
            at[i] = rest % sizes[i];
            rest /= sizes[i];
        }
        c->isa = o->isas.at[at[0]];
        c->structure = o->structures.at[at[1]];
        c->threads = o->threads.at[at[2]];
        c->layout = o->layouts.at[at[3]];
        c->arithmetic = o->arithmetic.at[at[4]];
        if (c->isa == (int32_t)CRV_ISA_SCALAR && at[1] > 0)
            continue;
        result = measure(b, c);
    }
    return result;
}

/* A filter alone has no preset, and there must be one. */
static bool is_empty(int32_t method, int32_t preset_index, int32_t filter)
{
    return method == BENCH_METHOD_NONE
           && (preset_index > 0 || filter < BENCH_FILTER_FIRST);
}

static int run_scene(bench *b, const bench_scene *on)
{
    const bench_choices *o = &b->choices;
    int result = EXIT_DONE;
    for (int32_t m = 0; m < o->methods.count; m++)
        for (int32_t p = 0; p < o->presets.count; p++)
            for (int32_t f = 0; f < o->filters.count; f++)
                for (int32_t k = 0; k < o->factor_count && result == EXIT_DONE; k++) {
                    const int32_t method = o->methods.at[m], filter = o->filters.at[f];
                    bench_case c;
                    if (is_empty(method, p, filter))
                        continue;
                    result = make_options(b, on, method, o->presets.at[p], filter, &c);
                    c.factor = o->factors[k];
                    c.options.radius *= (float)c.factor;
                    if (result == EXIT_DONE)
                        result = run_ways(b, &c);
                }
    return result;
}

static int run_input(bench *b, const char *input)
{
    const int32_t sizes = bench_is_frame(input) ? 1 : b->choices.size_count;
    scene *model = NULL;
    int result = EXIT_DONE;
    if (!bench_is_frame(input))
        result = bench_load_model(input, &model, b->r);
    for (int32_t i = 0; i < sizes && result == EXIT_DONE; i++) {
        bench_scene made;
        result = bench_scene_make(b->settings, input, model, &b->choices.sizes[i], b->r,
                                  &made);
        if (result == EXIT_DONE)
            result = run_scene(b, &made);
        bench_scene_free(&made);
    }
    scene_free(model);
    return result;
}

/* The measurements of one scene in one size. */
static int32_t count_cases(const bench_choices *o)
{
    int32_t ways = 0, works = 0;
    for (int32_t i = 0; i < o->isas.count; i++)
        ways += o->isas.at[i] == (int32_t)CRV_ISA_SCALAR ? 1 : o->structures.count;
    for (int32_t m = 0; m < o->methods.count; m++)
        for (int32_t p = 0; p < o->presets.count; p++)
            for (int32_t f = 0; f < o->filters.count; f++)
                works += !is_empty(o->methods.at[m], p, o->filters.at[f]);
    return works * o->factor_count * ways * o->threads.count * o->layouts.count
           * o->arithmetic.count;
}

/* Said before the work: how much there is, and about how long it takes. */
static int announce(bench *b, const arg_texts *inputs)
{
    int32_t scenes = 0;
    for (int32_t i = 0; i < inputs->count; i++)
        scenes += bench_is_frame(inputs->value[i]) ? 1 : b->choices.size_count;
    b->count = scenes * count_cases(&b->choices);
    if (b->count == 0) {
        report_error(b->r, "--method none: there is no filter to measure; give --filter");
        return EXIT_USAGE;
    }
    const double seconds = b->count * b->settings->seconds.value;
    if (seconds > LONG_SECONDS)
        report_info(b->r, "%d measurements, about %.0f s; an interrupt ends them",
                    b->count, seconds);
    return EXIT_DONE;
}

static int run_inputs(bench *b, const arg_texts *inputs, const machine *m)
{
    int result = EXIT_DONE;
    /* Before anything is measured. A frame that comes first is read at once anyway. */
    const int32_t first = bench_is_frame(inputs->value[0]) ? 1 : 0;
    for (int32_t i = first; i < inputs->count && result == EXIT_DONE; i++)
        result = bench_check_input(b->settings, inputs->value[i], b->r);
    if (result == EXIT_DONE)
        result = announce(b, inputs);
    b->started = report_seconds();
    if (result == EXIT_DONE && !b->rows) {
        printf("crevice %s, %s, %s, %d threads\n\n", crv_version(), m->compiler,
               m->processor, m->threads);
        bench_print_head(b->device);
    }
    for (int32_t i = 0; i < inputs->count && result == EXIT_DONE; i++)
        result = run_input(b, inputs->value[i]);
    return result;
}

static cJSON *describe(bench *b, const machine *m)
{
    cJSON *root = cJSON_CreateObject();
    json_add_text(root, "version", crv_version());
    json_add_text(root, "compiler", m->compiler);
    json_add_text(root, "processor", m->processor);
    json_add_number(root, "threads", m->threads);
    b->rows = cJSON_AddArrayToObject(root, "rows");
    return root;
}

static int run(const void *settings, report *r)
{
    static const arg_texts courtyard = {.count = 1, .value = {"builtin:courtyard"}};
    const bench_settings *s = settings;
    bench b = {.settings = s, .r = r, .device = !device_is_cpu(&s->common)};
    int result = bench_choose(s, &b.choices, r);
    if (result == EXIT_DONE)
        result = check_sets(&b);
    if (result != EXIT_DONE)
        return result;
    interrupt_hold(GRACE_S);
    bench_clock_open(&b.clock, s->repeats.value, s->seconds.value);
    const machine m = machine_look(0);
    cJSON *root = s->json ? describe(&b, &m) : NULL;
    if (s->json && !b.rows)
        result = report_no_memory(r);
    if (result == EXIT_DONE)
        result = run_inputs(&b, s->inputs.count > 0 ? &s->inputs : &courtyard, &m);
    /* What was measured before something failed may have taken an hour. */
    if (s->json && b.done > 0) {
        const int written = json_print(root, r);
        result = result == EXIT_DONE ? written : result;
    } else {
        cJSON_Delete(root);
    }
    bench_clock_close(&b.clock);
    fflush(stdout);
    interrupt_release();
    return result;
}

const command command_bench = {
    .name = "bench",
    .summary = "measure how fast the methods are on this machine",
    .synopsis = "[INPUT...] [options]",
    .details =
        "Measures the library on frames that are ready in memory, a line for each "
        "combination: the median of the runs, and the shortest. Times of a busy machine "
        "say little: run it alone. JSON has `rows`, one for each line: scene, width, "
        "height, method, preset, filter, device, isa, structure, threads, radius_factor, "
        "options (what the method reads), runs, ms (median; also ms_min, ms_q1, ms_q3, "
        "ms_max), cpu_ms (of all threads), mpix_per_s, cycles_per_pixel (null if they "
        "cannot "
        "be counted), bytes_per_pixel (of G-buffer and plan), run_allocations and, on a "
        "GPU, steps (name, ms).",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(bench_settings),
    .run = run,
};

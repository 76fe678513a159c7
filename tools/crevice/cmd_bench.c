/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bench/bench.h"
#include "commands.h"
#include "common/device.h"
#include "common/output.h"
#include "common/machine.h"
#include "common/text.h"

static const struct {
    const char *name;
    int (*run)(bench *b);
} sections[] = {
    {"methods", bench_methods_section}, {"passes", bench_passes_section},
    {"memory", bench_memory_section},   {"growth", bench_growth_section},
    {"embree", bench_embree_section},   {"whole", bench_whole_section},
    {"device", bench_device_section},
};
enum { SECTION_COUNT = sizeof sections / sizeof sections[0] };

static const arg input_rows[] = {
    {.name = "INPUT",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, inputs),
     .computed = "builtin:courtyard",
     .help = "mesh files or builtin:NAME, each framed by itself, and .exr frames with a "
             "depth pass, which keep their size"},
    {.name = "--views",
     .value = "FILE.json",
     .type = ARG_TEXT,
     .offset = offsetof(bench_settings, views),
     .help = "views of models, a list as `crevice help report` describes it"},
    {.name = "--view",
     .value = "NAME",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, views_named),
     .computed = "all",
     .help = "only this view; may be given again"},
    {.name = "--vfov",
     .value = "DEG",
     .type = ARG_NUMBER,
     .min = 0.1,
     .max = 179.0,
     .unit = "degrees",
     .offset = offsetof(bench_settings, vfov_deg),
     .computed = "from the file's metadata",
     .help = "full vertical field of view of .exr frames"},
    {.name = "--json",
     .value = "FILE",
     .type = ARG_TEXT,
     .offset = offsetof(bench_settings, json),
     .help = "write all numbers there; -: to standard output, instead of the tables"},
};
static const arg_table input_table = ARG_TABLE("Files", input_rows);

static const arg choice_rows[] = {
    {.name = "--methods",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, methods),
     .computed = "all",
     .help = "methods, or all"},
    {.name = "--presets",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, presets),
     .computed = "medium",
     .help = "presets of these, or all"},
    {.name = "--filters",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, filters),
     .computed = "none",
     .help = "filters, none, preset (what the preset brings), or all"},
    {.name = "--set",
     .value = "KEY=VALUE",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, sets),
     .help = "an option (`crevice methods`) of the methods that read it; may be given "
             "again"},
    {.name = "--radii",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, radii),
     .computed = "1",
     .help = "radii, as factors of the view's own"},
    {.name = "--sizes",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, sizes),
     .computed = "1280x720",
     .help = "sizes of the pictures, WIDTHxHEIGHT"},
    {.name = "--isas",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, isas),
     .computed = "the best and scalar, or --isa",
     .help = "instruction sets, or all that this machine has"},
    {.name = "--structures",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, structures),
     .computed = "fast, or exact with --exact",
     .help = "fast, exact or both: whether kernels may move samples a little"},
    {.name = "--threads-list",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, threads),
     .computed = "--threads",
     .help = "numbers of threads"},
    {.name = "--layouts",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, layouts),
     .computed = "plain",
     .help = "on a GPU, how depth lies in its memory: plain; apart, by the phases of the "
             "noise tile; levels, coarser for far samples; or all"},
    {.name = "--arithmetic",
     .value = "LIST",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, arithmetic),
     .computed = "single",
     .help = "on a GPU, single, half or both: whether filters compute in half floats"},
};
static const arg_table choice_table =
    ARG_TABLE("What is measured, as lists with commas or flags given again", choice_rows);

static const arg run_rows[] = {
    {.name = "--only",
     .value = "SECTION",
     .type = ARG_TEXTS,
     .offset = offsetof(bench_settings, only),
     .computed = "methods, passes, memory, whole; device on a GPU",
     .help = "methods|passes|memory|growth|embree|whole|device, a list, too; "
             "device: every step of a plan by the GPU's clock, the others by the host's"},
    {.name = "--full",
     .type = ARG_FLAG,
     .offset = offsetof(bench_settings, full),
     .help = "all sections, presets, instruction sets and structures, without and with "
             "the presets' filters, at 1920x1080, growth up to 7680x4320; takes an hour "
             "or so and 3 GB. Lists that are given still hold"},
    {.name = "--repeats",
     .value = "N",
     .type = ARG_INT,
     .min = 1,
     .max = 500,
     .initial = "9",
     .offset = offsetof(bench_settings, repeats),
     .help = "timed runs after one to warm up; more where they are short"},
    {.name = "--seconds",
     .value = "S",
     .type = ARG_NUMBER,
     .min = 0.0,
     .max = 3600.0,
     .unit = "s",
     .initial = "1",
     .offset = offsetof(bench_settings, seconds),
     .help = "time for the runs of one measurement, after three of them; a first run of "
             "half of it is the only one"},
};
static const arg_table run_table = ARG_TABLE("How it is measured", run_rows);

static const arg_table *const tables[] = {
    &input_table, &choice_table,      &run_table, &args_threads,
    &args_device, &args_output_lines, NULL};

static const char *const examples[] = {
    "the built-in scene, in about a minute",
    "crevice bench",
    "two methods with every instruction set, on one and two threads",
    "crevice bench --methods hbao,alchemy --isas all --threads-list 1,2 --only methods",
    "your own scene in full high definition, numbers to a file",
    "crevice bench hall.glb --sizes 1920x1080 --json hall.json",
    "a renderer's frame",
    "crevice bench frame.exr --vfov 60 --filters none,bilateral13",
    NULL,
};

/* A typing error must not pass in silence: some chosen method reads what is set. */
static int check_sets(const bench_settings *s, const bench_choices *c, report *r)
{
    for (int32_t i = 0; i < s->sets.count; i++) {
        const char *given = s->sets.value[i], *equals = strchr(given, '=');
        char key[64] = "";
        const crv_option *option;
        bool is_read = false;

        if (equals != NULL && (size_t)(equals - given) < sizeof key)
            memcpy(key, given, (size_t)(equals - given));
        option = crv_option_find(key);
        if (option == NULL || strcmp(option->key, "radius") == 0) {
            report_error(r,
                         "--set: \"%s\" sets no option; give KEY=VALUE, a key of "
                         "`crevice methods`, and --radii for the radius",
                         given);
            return EXIT_USAGE;
        }
        for (int32_t m = 0; m < c->method_count; m++)
            for (int32_t f = 0; f < crv_filter_count(); f++)
                is_read = is_read
                          || crv_option_applies(option, c->methods[m], crv_filter_at(f));
        if (!is_read) {
            report_error(r, "--set: no chosen method reads %s; see `crevice methods`",
                         option->key);
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

/* The section of a GPU's own clock has nothing to read on a CPU. */
static int check_device(const bench_settings *s, const bench_choices *c, report *r)
{
    for (int32_t i = 0; i < c->section_count; i++) {
        const char *name = c->sections[i];
        if (strcmp(name, "device") == 0 && device_is_cpu(&s->common)) {
            report_error(r,
                         "--only %s: is of a GPU's own clock; give --device vulkan, "
                         "too",
                         name);
            return EXIT_USAGE;
        }
    }
    return EXIT_DONE;
}

static int check(const bench_settings *s, bench_choices *c, report *r)
{
    static const char *names[SECTION_COUNT + 1];
    int result;

    for (int i = 0; i < SECTION_COUNT; i++)
        names[i] = sections[i].name;
    result = bench_choose(s, names, c, r);
    if (result == EXIT_DONE)
        result = check_sets(s, c, r);
    if (result == EXIT_DONE)
        result = check_device(s, c, r);
    return result;
}

static bool to_stdout(const bench_settings *s)
{
    return s->json != NULL && strcmp(s->json, "-") == 0;
}

static void add_texts(text *out, const char *flag, const arg_texts *texts)
{
    for (int32_t i = 0; i < texts->count; i++)
        text_addf(out, "%s%s %s", flag[0] != '\0' ? " " : "", flag, texts->value[i]);
}

/* What would measure this again. */
static void describe_command(const bench_settings *s, text *out)
{
    text_add(out, "crevice bench");
    add_texts(out, "", &s->inputs);
    if (s->views != NULL)
        text_addf(out, " --views %s", s->views);
    add_texts(out, "--view", &s->views_named);
    if (s->vfov_deg.given)
        text_addf(out, " --vfov %g", s->vfov_deg.value);
    if (s->full)
        text_add(out, " --full");
    add_texts(out, "--only", &s->only);
    add_texts(out, "--methods", &s->methods);
    add_texts(out, "--presets", &s->presets);
    add_texts(out, "--filters", &s->filters);
    add_texts(out, "--set", &s->sets);
    add_texts(out, "--radii", &s->radii);
    add_texts(out, "--sizes", &s->sizes);
    add_texts(out, "--isas", &s->isas);
    add_texts(out, "--structures", &s->structures);
    add_texts(out, "--threads-list", &s->threads);
    add_texts(out, "--layouts", &s->layouts);
    add_texts(out, "--arithmetic", &s->arithmetic);
    text_addf(out, " --repeats %d --seconds %g", s->repeats.value, s->seconds.value);
    if (s->common.threads.given)
        text_addf(out, " --threads %d", s->common.threads.value);
    device_describe(&s->common, out);
}

static int describe(bench *b)
{
    machine m = machine_look(b->all_threads);
    const char *source = bench_clock_source(&b->clock);
    text line = {0};
    cJSON *sets;

    describe_command(b->settings, &line);
    if (line.failed) {
        text_free(&line);
        return report_no_memory(b->r);
    }
    cJSON_AddStringToObject(b->results, "command", line.data);
    text_free(&line);
    cJSON_AddStringToObject(b->results, "version", crv_version());
    cJSON_AddStringToObject(b->results, "compiler", m.compiler);
    cJSON_AddStringToObject(b->results, "processor", m.processor);
    cJSON_AddNumberToObject(b->results, "threads", b->all_threads);
    sets = cJSON_AddArrayToObject(b->results, "isas");
    for (int i = 0; crv_isa_name((crv_isa)i) != NULL; i++)
        if (crv_isa_available() >> i & 1)
            cJSON_AddItemToArray(sets, cJSON_CreateString(crv_isa_name((crv_isa)i)));
    cJSON_AddNumberToObject(b->results, "repeats", b->clock.repeats);
    cJSON_AddNumberToObject(b->results, "seconds", b->clock.seconds);
    cJSON_AddNumberToObject(b->results, "clock_ghz", b->clock.ghz);
    cJSON_AddStringToObject(b->results, "cycles_from", source);
    if (b->print)
        printf("crevice %s, %s, %s, %d thread%s, %.2f GHz\n", crv_version(), m.compiler,
               m.processor, b->all_threads, b->all_threads == 1 ? "" : "s", b->clock.ghz);
    if (b->print && b->clock.counter < 0)
        printf("The cycle counter cannot be read here; cycles are %s.\n",
               b->clock.ghz > 0.0 ? "processor time by the clock of a chain of additions"
                                  : "left out");
    return EXIT_DONE;
}

static bool is_wanted(const bench_choices *c, const char *section)
{
    for (int32_t i = 0; i < c->section_count; i++)
        if (strcmp(c->sections[i], section) == 0)
            return true;
    return false;
}

static int run_sections(bench *b)
{
    int result = describe(b);

    /* Of the host, whose clock times all sections but that of the device. */
    if (result == EXIT_DONE
        && (b->choices->section_count > 1 || !is_wanted(b->choices, "device")))
        result = bench_ceilings_section(b);
    for (int i = 0; i < SECTION_COUNT && result == EXIT_DONE; i++)
        if (is_wanted(b->choices, sections[i].name))
            result = sections[i].run(b);
    return result;
}

typedef struct bytes {
    const char *path, *data;
    const crv_logger *log;
} bytes;

static int write_bytes(void *data)
{
    const bytes *w = data;

    return io_write_bytes(w->path, w->data, strlen(w->data), w->log);
}

static int write_json(const bench *b)
{
    char *words = cJSON_Print(b->results);
    text line = {0};
    bytes work = {.path = b->settings->json, .log = &b->r->logger};
    int result = EXIT_DONE;

    if (words != NULL)
        text_addf(&line, "%s\n", words);
    cJSON_free(words);
    work.data = line.data;
    if (line.data == NULL || line.failed)
        result = report_no_memory(b->r);
    else if (to_stdout(b->settings))
        fputs(line.data, stdout);
    else if (output_guarded(write_bytes, &work) != 0)
        result = EXIT_FAILED;
    else
        report_info(b->r, "wrote %s", work.path);
    text_free(&line);
    return result;
}

/* Before the work: whether the numbers can be written at its end. A file that is there is
 * left alone until then. */
static int check_json(const bench_settings *s, report *r)
{
    bytes work = {s->json, "{}\n", &r->logger};
    struct stat info;

    if (s->json == NULL || to_stdout(s))
        return EXIT_DONE;
    if (stat(s->json, &info) == 0) {
        if (S_ISREG(info.st_mode) && access(s->json, W_OK) == 0)
            return EXIT_DONE;
        report_error(r, "%s: is no file that may be written; choose another name",
                     s->json);
        return EXIT_FAILED;
    }
    if (output_guarded(write_bytes, &work) != 0)
        return EXIT_FAILED;
    unlink(s->json);
    return EXIT_DONE;
}

/* The numbers must not replace what is measured. */
static int spare_inputs(const bench_settings *s, const views_list *views, report *r)
{
    int result;

    if (s->json == NULL || to_stdout(s))
        return EXIT_DONE;
    result = output_spare_all(s->json, &s->inputs, r);
    for (int32_t i = 0; i < views->model_count && result == EXIT_DONE; i++)
        result = output_spare(s->json, views->models[i].path, r);
    return result == EXIT_DONE ? output_spare(s->json, s->views, r) : result;
}

static int run(const void *settings, report *r)
{
    const bench_settings *s = settings;
    bench_choices choices;
    views_list views = {0};
    bench b = {.r = r,
               .settings = s,
               .choices = &choices,
               .quiet_logger = report_errors_only(r),
               .started = report_seconds(),
               .print = !to_stdout(s),
               .all_threads = machine_look(s->common.threads.value).threads};
    int result = check(s, &choices, r);

    if (result != EXIT_DONE)
        return result;
    bench_clock_open(&b.clock, s->repeats.value, s->seconds.value);
    b.results = cJSON_CreateObject();
    if (b.results == NULL)
        result = report_no_memory(r);
    if (result == EXIT_DONE)
        result = check_json(s, r);
    if (result == EXIT_DONE)
        result =
            bench_sources_open(&s->inputs, s->views, &s->views_named, s->vfov_deg.value,
                               &views, &b.sources, &b.source_count, r);
    if (result == EXIT_DONE)
        result = spare_inputs(s, &views, r);
    if (result == EXIT_DONE)
        result = bench_sources_check(b.sources, b.source_count, r);
    if (result == EXIT_DONE) {
        result = run_sections(&b);
        /* What was measured before something failed may have taken an hour. */
        if (s->json != NULL) {
            const int written = write_json(&b);
            result = result == EXIT_DONE ? written : result;
        }
    }
    bench_sources_close(&views, b.sources);
    cJSON_Delete(b.results);
    bench_clock_close(&b.clock);
    return result;
}

const command command_bench = {
    .name = "bench",
    .summary = "how fast the methods are, and how near to what the machine can do",
    .synopsis = "[INPUT...] [options]",
    .details =
        "Measures what the machine can do at most, then the library on frames that are "
        "ready in memory, and prints tables; medians over repeated runs. Times of a busy "
        "machine say little: run it alone. With --json all numbers are kept, times in "
        "ms, rates in millions of pixels a second. With --device vulkan it times the "
        "steps of each method by the GPU's own clock, unless --only asks for other "
        "sections.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(bench_settings),
    .run = run,
};

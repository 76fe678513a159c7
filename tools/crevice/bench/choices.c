/* SPDX-License-Identifier: MIT */
/* choices.c: lists of what to measure, "a,b,c" or given again, as arrays. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "common/device.h"
#include "common/machine.h"

enum { WORD_SIZE = 64, NAMES_MAX = 64 };

typedef struct list {
    const char *flag;
    const arg_texts *texts;
    report *r;
} list;

/* Calls take(choices, word) for every word of the list. */
static int each(const list *l, bench_choices *choices,
                int (*take)(const list *l, const char *word, bench_choices *choices))
{
    int result = EXIT_DONE;

    for (int32_t i = 0; i < l->texts->count; i++) {
        const char *at = l->texts->value[i];

        for (bool more = true; more && result == EXIT_DONE;) {
            size_t length = strcspn(at, ",");
            char word[WORD_SIZE];

            if (length == 0 || length >= sizeof word) {
                report_error(l->r,
                             "%s: \"%s\" is no list; give words with commas between",
                             l->flag, l->texts->value[i]);
                return EXIT_USAGE;
            }
            memcpy(word, at, length);
            word[length] = '\0';
            result = take(l, word, choices);
            more = at[length] == ',';
            at += length + 1;
        }
    }
    return result;
}

static int unknown(const list *l, const char *word, const char *const *names,
                   int32_t count)
{
    const char *nearest = crv_nearest_name(word, names, count);

    if (nearest != NULL)
        report_error(l->r, "%s: no \"%s\"; did you mean %s?", l->flag, word, nearest);
    else
        report_error(l->r, "%s: no \"%s\"; see `crevice help bench`", l->flag, word);
    return EXIT_USAGE;
}

/* Whether there is room for one more. */
static bool fits(const list *l, int32_t count)
{
    if (count < BENCH_CHOICES_MAX)
        return true;
    report_error(l->r, "%s: is longer than %d words; leave some out", l->flag,
                 BENCH_CHOICES_MAX);
    return false;
}

static int take_method(const list *l, const char *word, bench_choices *c)
{
    const char *names[NAMES_MAX] = {"all"};
    int32_t count = 1;

    for (int32_t i = 0; i < crv_method_count(); i++) {
        const crv_method *method = crv_method_at(i);
        bool all = strcmp(word, "all") == 0;

        if (count < NAMES_MAX)
            names[count++] = method->name;
        if (!all && strcmp(word, method->name) != 0)
            continue;
        if (!fits(l, c->method_count))
            return EXIT_USAGE;
        c->methods[c->method_count++] = method;
        if (!all)
            return EXIT_DONE;
    }
    return strcmp(word, "all") == 0 ? EXIT_DONE : unknown(l, word, names, count);
}

static int take_preset(const list *l, const char *word, bench_choices *c)
{
    const char *names[CRV_PRESET_COUNT + 1] = {"all"};
    bool all = strcmp(word, "all") == 0, found = all;

    for (int i = 0; i < CRV_PRESET_COUNT; i++) {
        names[i + 1] = crv_preset_name((crv_preset)i);
        if (!all && strcmp(word, names[i + 1]) != 0)
            continue;
        if (!fits(l, c->preset_count))
            return EXIT_USAGE;
        c->presets[c->preset_count++] = (crv_preset)i;
        found = true;
    }
    return found ? EXIT_DONE : unknown(l, word, names, CRV_PRESET_COUNT + 1);
}

static int add_filter(const list *l, bench_choices *c, bool preset,
                      const crv_filter *filter)
{
    if (!fits(l, c->filter_count))
        return EXIT_USAGE;
    c->filters[c->filter_count].use_preset_filter = preset;
    c->filters[c->filter_count++].filter = filter;
    return EXIT_DONE;
}

static int take_filter(const list *l, const char *word, bench_choices *c)
{
    const char *names[NAMES_MAX] = {"all", "none", "preset"};
    int32_t count = 3;
    bool all = strcmp(word, "all") == 0;
    int result = EXIT_DONE;

    if (strcmp(word, "preset") == 0)
        return add_filter(l, c, true, NULL);
    if (all || strcmp(word, "none") == 0)
        result = add_filter(l, c, false, NULL);
    if (!all && strcmp(word, "none") == 0)
        return result;
    for (int32_t i = 0; i < crv_filter_count() && result == EXIT_DONE; i++) {
        if (count < NAMES_MAX)
            names[count++] = crv_filter_at(i)->name;
        if (all)
            result = add_filter(l, c, false, crv_filter_at(i));
        else if (strcmp(word, crv_filter_at(i)->name) == 0)
            return add_filter(l, c, false, crv_filter_at(i));
    }
    return all ? result : unknown(l, word, names, count);
}

static int not_here(const list *l, const char *word)
{
    char names[128];

    device_list_isas(names, sizeof names);
    report_error(l->r, "%s %s: not on this machine; there are %s", l->flag, word, names);
    return EXIT_USAGE;
}

/* The best first: sections that need one set only take the first. */
static int take_isa(const list *l, const char *word, bench_choices *c)
{
    const char *names[NAMES_MAX] = {"all"};
    int32_t count = 1;
    bool all = strcmp(word, "all") == 0, found = all;

    while (crv_isa_name((crv_isa)(count - 1)) != NULL) {
        names[count] = crv_isa_name((crv_isa)(count - 1));
        count++;
    }
    for (int i = count - 2; i >= 0; i--) {
        if (!all && strcmp(word, names[i + 1]) != 0)
            continue;
        found = true;
        if (!(crv_isa_available() >> i & 1) && all)
            continue;
        if (!(crv_isa_available() >> i & 1))
            return not_here(l, word);
        if (!fits(l, c->isa_count))
            return EXIT_USAGE;
        c->isas[c->isa_count++] = (crv_isa)i;
    }
    return found ? EXIT_DONE : unknown(l, word, names, count);
}

static int take_structure(const list *l, const char *word, bench_choices *c)
{
    static const char *const names[] = {"fast", "exact", "both"};
    bool both = strcmp(word, "both") == 0;

    if (!both && strcmp(word, "fast") != 0 && strcmp(word, "exact") != 0)
        return unknown(l, word, names, 3);
    if (!fits(l, c->structure_count + both))
        return EXIT_USAGE;
    if (both || strcmp(word, "fast") == 0)
        c->exact[c->structure_count++] = false;
    if (both || strcmp(word, "exact") == 0)
        c->exact[c->structure_count++] = true;
    return EXIT_DONE;
}

static int wrong_number(const list *l, const char *word, const char *range)
{
    report_error(l->r, "%s: \"%s\" is not valid; give %s", l->flag, word, range);
    return EXIT_USAGE;
}

static int take_threads(const list *l, const char *word, bench_choices *c)
{
    double value;

    if (!args_number(word, &value) || !(value >= 1.0 && value <= 1024.0)
        || value > (double)(int32_t)value)
        return wrong_number(l, word, "whole numbers from 1 to 1024");
    if (!fits(l, c->thread_count))
        return EXIT_USAGE;
    c->threads[c->thread_count++] = (int32_t)value;
    return EXIT_DONE;
}

static int take_size(const list *l, const char *word, bench_choices *c)
{
    static const arg row = {.name = "--sizes", .type = ARG_SIZE};

    if (!fits(l, c->size_count))
        return EXIT_USAGE;
    if (!args_set_value(&row, word, &c->sizes[c->size_count])
        || c->sizes[c->size_count].width < 16 || c->sizes[c->size_count].height < 16)
        return wrong_number(l, word, "WIDTHxHEIGHT, each 16 to 32768 px");
    c->size_count++;
    return EXIT_DONE;
}

static int take_radius(const list *l, const char *word, bench_choices *c)
{
    double value;

    if (!args_number(word, &value) || !(value >= 0.001 && value <= 1000.0))
        return wrong_number(l, word, "factors from 0.001 to 1000");
    if (!fits(l, c->radius_count))
        return EXIT_USAGE;
    c->radii[c->radius_count++] = value;
    return EXIT_DONE;
}

static const char *const layout_names[] = {"plain", "apart", "levels"};

const char *bench_layout_name(crv_depth_layout layout)
{
    return layout_names[layout];
}

static int take_layout(const list *l, const char *word, bench_choices *c)
{
    const bool all = strcmp(word, "all") == 0;
    bool found = all;

    for (int i = 0; i < 3; i++) {
        if (!all && strcmp(word, layout_names[i]) != 0)
            continue;
        if (!fits(l, c->layout_count))
            return EXIT_USAGE;
        c->layouts[c->layout_count++] = (crv_depth_layout)i;
        found = true;
    }
    return found ? EXIT_DONE : unknown(l, word, layout_names, 3);
}

static int take_arithmetic(const list *l, const char *word, bench_choices *c)
{
    static const char *const names[] = {"single", "half", "both"};
    const bool both = strcmp(word, "both") == 0;

    if (!both && strcmp(word, names[0]) != 0 && strcmp(word, names[1]) != 0)
        return unknown(l, word, names, 3);
    if (!fits(l, c->arithmetic_count + both))
        return EXIT_USAGE;
    if (both || strcmp(word, names[0]) == 0)
        c->half[c->arithmetic_count++] = false;
    if (both || strcmp(word, names[1]) == 0)
        c->half[c->arithmetic_count++] = true;
    return EXIT_DONE;
}

static int take_section(const list *l, const char *word, bench_choices *c)
{
    int32_t count = 0;

    for (; c->all_sections[count] != NULL; count++) {
        if (strcmp(word, c->all_sections[count]) != 0)
            continue;
        if (!fits(l, c->section_count))
            return EXIT_USAGE;
        c->sections[c->section_count++] = c->all_sections[count];
        return EXIT_DONE;
    }
    return unknown(l, word, c->all_sections, count);
}

/* What --isa, --exact and --threads say holds where there is no list. */
static int check_contradictions(const bench_settings *s, report *r)
{
    const char *plural = NULL, *single = NULL;

    if (s->isas.count > 0 && !device_is_cpu(&s->common))
        plural = "--isas", single = "--device";
    else if (s->structures.count > 0 && !device_is_cpu(&s->common))
        plural = "--structures", single = "--device";
    else if (s->layouts.count + s->arithmetic.count > 0 && device_is_cpu(&s->common)) {
        report_error(r, "%s: is for a GPU; give --device vulkan, too",
                     s->layouts.count > 0 ? "--layouts" : "--arithmetic");
        return EXIT_USAGE;
    } else if (s->isas.count > 0 && s->common.isa.given)
        plural = "--isas", single = "--isa";
    else if (s->structures.count > 0 && s->common.exact)
        plural = "--structures", single = "--exact";
    else if (s->threads.count > 0 && s->common.threads.given)
        plural = "--threads-list", single = "--threads";
    if (plural == NULL)
        return EXIT_DONE;
    report_error(r, "%s: contradicts %s; give one of them", plural, single);
    return EXIT_USAGE;
}

/* The best set, and the plain code to compare it with. */
static const char *default_isas(const bench_settings *s, char *out, size_t size)
{
    crv_isa best = CRV_ISA_SCALAR;

    if (!device_is_cpu(&s->common))
        return "scalar"; /* the device's one kind */
    if (s->common.isa.value > 0)
        return crv_isa_name((crv_isa)(s->common.isa.value - 1));
    if (s->full)
        return "all";
    for (int i = 0; crv_isa_name((crv_isa)i) != NULL; i++)
        if (crv_isa_available() >> i & 1)
            best = (crv_isa)i;
    snprintf(out, size, "%s%s", crv_isa_name(best),
             best != CRV_ISA_SCALAR ? ",scalar" : "");
    return out;
}

int bench_choose(const bench_settings *s, const char *const *section_names,
                 bench_choices *out, report *r)
{
    char isas[64], threads[16];
    const struct {
        const char *flag;
        const arg_texts *texts;
        const char *initial;
        int (*take)(const list *l, const char *word, bench_choices *c);
    } lists[] = {
        {"--methods", &s->methods, "all", take_method},
        {"--presets", &s->presets, s->full ? "all" : "medium", take_preset},
        {"--filters", &s->filters, s->full ? "none,preset" : "none", take_filter},
        {"--isas", &s->isas, default_isas(s, isas, sizeof isas), take_isa},
        {"--structures", &s->structures,
         s->common.exact || !device_is_cpu(&s->common) ? "exact"
         : s->full                                     ? "both"
                                                       : "fast",
         take_structure},
        {"--threads-list", &s->threads, threads, take_threads},
        {"--sizes", &s->sizes, s->full ? "1920x1080" : "1280x720", take_size},
        {"--radii", &s->radii, "1", take_radius},
        {"--layouts", &s->layouts, s->full ? "all" : "plain", take_layout},
        {"--arithmetic", &s->arithmetic, s->full ? "both" : "single", take_arithmetic},
        {"--only", &s->only,
         !device_is_cpu(&s->common) ? "device"
         : s->full                  ? "methods,passes,memory,growth,embree,whole"
                                    : "methods,passes,memory,whole",
         take_section},
    };
    int result = check_contradictions(s, r);

    *out = (bench_choices){.all_sections = section_names};
    snprintf(threads, sizeof threads, "%d",
             machine_look(s->common.threads.value).threads);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0] && result == EXIT_DONE; i++) {
        arg_texts initial = {.count = 1, .value = {lists[i].initial}};
        list l = {lists[i].flag, lists[i].texts->count > 0 ? lists[i].texts : &initial,
                  r};
        result = each(&l, out, lists[i].take);
    }
    return result;
}

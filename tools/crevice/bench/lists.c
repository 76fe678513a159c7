/* SPDX-License-Identifier: MIT */
/* lists.c: what to measure, "a,b" or a flag given again, as indices and numbers. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/bench.h"
#include "common/device.h"
#include "bench/machine.h"
#include "common/nearest.h"

enum { WORD_SIZE = 64, NAMES_MAX = 64 };

const char *const bench_structures[2] = {"deinterleaved", "exact"};
const char *const bench_layouts[3] = {"linear", "deinterleaved", "levels"};
const char *const bench_arithmetic[2] = {"single", "half"};

/* The next word of a list with commas, and the place after it; NULL at its end. */
static const char *next_word(const char *flag, const char *at, char word[WORD_SIZE],
                             const char *whole, report *r)
{
    const size_t length = strcspn(at, ",");
    if (length == 0 || length >= WORD_SIZE) {
        report_error(r, "%s: \"%s\" is no list; give words with commas between", flag,
                     whole);
        word[0] = '\0';
        return NULL;
    }
    memcpy(word, at, length);
    word[length] = '\0';
    return at[length] == ',' ? at + length + 1 : NULL;
}

/* Calls take(to, word), which returns an exit code, for every word. */
static int each_word(const char *flag, const arg_texts *texts, void *to,
                     int (*take)(void *to, const char *word), report *r)
{
    int result = EXIT_DONE;
    for (int32_t i = 0; i < texts->count; i++) {
        const char *at = texts->value[i];
        while (at && result == EXIT_DONE) {
            char word[WORD_SIZE];
            at = next_word(flag, at, word, texts->value[i], r);
            result = word[0] != '\0' ? take(to, word) : EXIT_USAGE;
        }
    }
    return result;
}

static int too_long(const char *flag, report *r)
{
    report_error(r, "%s: is longer than %d words; leave some out", flag, BENCH_LIST_MAX);
    return EXIT_USAGE;
}

typedef struct named_list {
    const char *flag;
    const char *names[NAMES_MAX];
    int32_t count, all_from; /* "all" is the names from this one on */
    uint32_t missing;        /* bits 1u << index: not on this machine */
    bench_list *to;
    report *r;
} named_list;

static int not_here(const named_list *l, const char *word)
{
    char names[128];
    device_list_isas(names, sizeof names);
    report_error(l->r, "%s %s: not on this machine; there are %s", l->flag, word, names);
    return EXIT_USAGE;
}

static int take_name(void *to, const char *word)
{
    named_list *l = to;
    const bool all = strcmp(word, "all") == 0;
    bool found = all;
    for (int32_t i = 0; i < l->count; i++) {
        if (all ? i < l->all_from : strcmp(word, l->names[i]) != 0)
            continue;
        found = true;
        if (l->missing != 0 && l->missing >> i & 1) {
            if (!all)
                return not_here(l, word);
            continue;
        }
        if (l->to->count == BENCH_LIST_MAX)
            return too_long(l->flag, l->r);
        l->to->at[l->to->count++] = i;
    }
    if (found)
        return EXIT_DONE;
    const char *nearest = nearest_name(word, l->names, l->count);
    if (nearest)
        report_error(l->r, "%s: no \"%s\"; did you mean %s?", l->flag, word, nearest);
    else
        report_error(l->r, "%s: no \"%s\"; see `crevice help bench`", l->flag, word);
    return EXIT_USAGE;
}

static int choose_names(named_list *l, const arg_texts *texts, const char *initial)
{
    const arg_texts without = {.count = 1, .value = {initial}};
    return each_word(l->flag, texts->count > 0 ? texts : &without, l, take_name, l->r);
}

static int choose_of(const char *flag, const char *const *names, int32_t count,
                     const arg_texts *texts, const char *initial, bench_list *to,
                     report *r)
{
    named_list l = {.flag = flag, .count = count, .to = to, .r = r};
    memcpy(l.names, names, (size_t)count * sizeof *names);
    return choose_names(&l, texts, initial);
}

/* Names of the registry behind those that are none of its. */
static int choose_methods(const bench_settings *s, bench_choices *c, report *r)
{
    named_list l = {.flag = "--method",
                    .names = {"none"},
                    .count = 1,
                    .all_from = 1,
                    .to = &c->methods,
                    .r = r};
    for (int32_t i = 0; i < crv_method_count() && l.count < NAMES_MAX; i++)
        l.names[l.count++] = crv_method_at(i)->name;
    return choose_names(&l, &s->methods, "all");
}

static int choose_filters(const bench_settings *s, bench_choices *c, report *r)
{
    named_list l = {.flag = "--filter",
                    .names = {"none", "preset"},
                    .count = 2,
                    .all_from = 2,
                    .to = &c->filters,
                    .r = r};
    for (int32_t i = 0; i < crv_filter_count() && l.count < NAMES_MAX; i++)
        l.names[l.count++] = crv_filter_at(i)->name;
    return choose_names(&l, &s->filters, "none");
}

static int choose_presets(const bench_settings *s, bench_choices *c, report *r)
{
    const char *names[CRV_PRESET_COUNT];
    for (int i = 0; i < CRV_PRESET_COUNT; i++)
        names[i] = crv_preset_name((crv_preset)i);
    return choose_of("--preset", names, CRV_PRESET_COUNT, &s->presets, "medium",
                     &c->presets, r);
}

static int choose_isas(const bench_settings *s, bench_choices *c, report *r)
{
    named_list l = {
        .flag = "--isa", .missing = ~crv_isa_available(), .to = &c->isas, .r = r};
    char initial[WORD_SIZE] = "scalar";
    for (; crv_isa_name((crv_isa)l.count); l.count++) {
        l.names[l.count] = crv_isa_name((crv_isa)l.count);
        if (l.count > 0 && !(l.missing >> l.count & 1) && device_is_cpu(&s->common))
            snprintf(initial, sizeof initial, "%s,scalar", l.names[l.count]);
    }
    return choose_names(&l, &s->isas, initial);
}

typedef struct number_list {
    const char *flag;
    bench_choices *c;
    report *r;
} number_list;

static int wrong_number(const number_list *l, const char *word, const char *range)
{
    report_error(l->r, "%s: \"%s\" is not valid; give %s", l->flag, word, range);
    return EXIT_USAGE;
}

static int take_threads(void *to, const char *word)
{
    const number_list *l = to;
    bench_list *threads = &l->c->threads;
    double value;
    if (!args_number(word, &value) || !(value >= 1.0 && value <= 1024.0)
        || value > floor(value))
        return wrong_number(l, word, "whole numbers from 1 to 1024");
    if (threads->count == BENCH_LIST_MAX)
        return too_long(l->flag, l->r);
    threads->at[threads->count++] = (int32_t)value;
    return EXIT_DONE;
}

static int take_size(void *to, const char *word)
{
    static const arg row = {.name = "--size", .type = ARG_SIZE};
    const number_list *l = to;
    arg_size size;
    if (!args_set_value(&row, word, &size) || size.width < 16 || size.height < 16)
        return wrong_number(l, word, "WIDTHxHEIGHT, each 16 to 32768 px");
    if (l->c->size_count == BENCH_LIST_MAX)
        return too_long(l->flag, l->r);
    l->c->sizes[l->c->size_count++] = size;
    return EXIT_DONE;
}

static int take_factor(void *to, const char *word)
{
    const number_list *l = to;
    double value;
    if (!args_number(word, &value) || !(value >= 0.001 && value <= 1000.0))
        return wrong_number(l, word, "factors from 0.001 to 1000");
    if (l->c->factor_count == BENCH_LIST_MAX)
        return too_long(l->flag, l->r);
    l->c->factors[l->c->factor_count++] = value;
    return EXIT_DONE;
}

static int choose_numbers(const bench_settings *s, bench_choices *c, report *r)
{
    char threads[16];
    const struct {
        const char *flag;
        const arg_texts *texts;
        const char *initial;
        int (*take)(void *to, const char *word);
    } lists[] = {
        {"--threads", &s->threads, threads, take_threads},
        {"--size", &s->sizes, "1280x720", take_size},
        {"--radius-factor", &s->radius_factors, "1", take_factor},
    };
    int result = EXIT_DONE;

    snprintf(threads, sizeof threads, "%d", machine_look(0).threads);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0] && result == EXIT_DONE; i++) {
        const arg_texts initial = {.count = 1, .value = {lists[i].initial}};
        number_list l = {lists[i].flag, c, r};
        result = each_word(l.flag, lists[i].texts->count > 0 ? lists[i].texts : &initial,
                           &l, lists[i].take, r);
    }
    return result;
}

/* Flags of the CPU with a GPU, and the other way round. */
static int check_device(const bench_settings *s, report *r)
{
    const bool cpu = device_is_cpu(&s->common);
    const char *flag = NULL;
    if (cpu && s->depth_layouts.count > 0)
        flag = "--depth-layout";
    else if (cpu && s->arithmetic.count > 0)
        flag = "--arithmetic";
    else if (!cpu && s->isas.count > 0)
        flag = "--isa";
    else if (!cpu && s->structures.count > 0)
        flag = "--structure";
    if (!flag)
        return EXIT_DONE;
    report_error(r, "%s: is for %s", flag,
                 cpu ? "a GPU; give --device vulkan, too"
                     : "the CPU; leave it out with --device");
    return EXIT_USAGE;
}

int bench_choose(const bench_settings *s, bench_choices *out, report *r)
{
    int result = check_device(s, r);
    *out = (bench_choices){0};
    if (result == EXIT_DONE)
        result = choose_methods(s, out, r);
    if (result == EXIT_DONE)
        result = choose_presets(s, out, r);
    if (result == EXIT_DONE)
        result = choose_filters(s, out, r);
    if (result == EXIT_DONE)
        result = choose_isas(s, out, r);
    if (result == EXIT_DONE)
        result = choose_of("--structure", bench_structures, 2, &s->structures,
                           "deinterleaved", &out->structures, r);
    if (result == EXIT_DONE)
        result = choose_of("--depth-layout", bench_layouts, 3, &s->depth_layouts,
                           "linear", &out->layouts, r);
    if (result == EXIT_DONE)
        result = choose_of("--arithmetic", bench_arithmetic, 2, &s->arithmetic, "single",
                           &out->arithmetic, r);
    return result == EXIT_DONE ? choose_numbers(s, out, r) : result;
}

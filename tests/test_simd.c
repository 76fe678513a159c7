/* SPDX-License-Identifier: MIT */
/*
 * Every kernel of every instruction set against the scalar specification, on random and
 * pathological data, in the manner of dav1d's checkasm. Needs no test framework, so that
 * it runs wherever the library does.
 *
 *   test_simd [--seed N] [--test NAME] [--isa NAME] [--cases N] [--bench]
 *
 * A fault is printed with what repeats it. --bench times the kernels instead; nothing
 * that is timed decides a test.
 */
#include "simd.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/*
 * A kernel rounds sums and weights otherwise than the scalar code, by some 1e-6; what
 * differs by more than 1e-3 is a sample that was taken on one side of a limit and not on
 * the other, or at the neighbouring texel. That may happen to one pixel in ten thousand,
 * and to one in a test of few.
 *
 * Of bent normals, in radians, the approximate angles of bitmask's groups of sectors are
 * 5e-4 off.
 */
static const double TOLERANCE = 1e-3, SHARE = 1e-4, BENT_TOLERANCE = 2e-3;

enum { SIZE = 90, SETS = 32 }; /* a bit of crv_isa_available() each */

typedef struct settings {
    uint64_t seed;
    const char *test, *isa; /* NULL: all */
    int32_t cases, only;    /* only: this case, where >= 0 */
    int bench;
} settings;

/* What a set's kernels of one test came to. */
typedef struct tally {
    int64_t pixels, over;
    double largest;
    double largest_bent; /* of bent normals */
} tally;

static int is_wanted(const char *wanted, const char *name)
{
    return !wanted || strcmp(wanted, name) == 0;
}

static uint64_t stream_of(const char *name)
{
    uint64_t hash = 1469598103934665603u; /* FNV-1a */
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 1099511628211u;
    return hash;
}

/* The sets to try against the scalar code. */
static uint32_t wanted_sets(const settings *s)
{
    uint32_t sets = crv_isa_available() & ~(1u << CRV_ISA_SCALAR);
    for (int i = 0; i < SETS; i++) {
        if (sets >> i & 1 && !is_wanted(s->isa, crv_isa_name((crv_isa)i)))
            sets &= ~(1u << i);
    }
    return sets;
}

/* ---- kernels against the specification ---- */

static int64_t pixel_count(const simd_case *c)
{
    const crv_gbuffer_desc *d = &c->desc;
    return (int64_t)(d->width - d->guard_left - d->guard_right)
           * (d->height - d->guard_top - d->guard_bottom);
}

/* Returns how many pixels are over the tolerance. */
static int64_t compare(const simd_case *c, const float *expected, const float *got,
                       tally *t)
{
    const int64_t count = pixel_count(c);
    int64_t over = 0;
    for (int64_t i = 0; i < count; i++) {
        const double error = fabs((double)got[i] - (double)expected[i]);
        if (!(error <= TOLERANCE)) /* a NaN on either side as well */
            over++;
        if (!(error <= t->largest))
            t->largest = error;
    }
    for (int64_t i = 0; c->options.bent_normal && i < count; i++) {
        const float *a = expected + count + 3 * i, *b = got + count + 3 * i;
        const double x = (double)a[0] - (double)b[0], y = (double)a[1] - (double)b[1],
                     z = (double)a[2] - (double)b[2];
        const double error = sqrt(x * x + y * y + z * z);
        over += !(error <= BENT_TOLERANCE);
        if (!(error <= t->largest_bent))
            t->largest_bent = error;
    }
    t->pixels += count;
    t->over += over;
    return over;
}

/* One case with every set. Returns the number of faults. */
static int check_case(const settings *s, const char *test, int32_t index,
                      const simd_case *c, tally tallies[SETS])
{
    float *expected = simd_run(c, CRV_ISA_SCALAR);
    int faults = expected == NULL;
    for (int isa = 1; expected && isa < SETS; isa++) {
        if (!(wanted_sets(s) >> isa & 1))
            continue;
        float *got = simd_run(c, (crv_isa)isa);
        const int64_t over = got ? compare(c, expected, got, &tallies[isa]) : 0;
        free(got);
        if (!got)
            faults++;
        if (!got || over > 2 + pixel_count(c) / 100) {
            printf("%s, %s, case %d: %d of %d px over %g\n", test,
                   crv_isa_name((crv_isa)isa), index, (int)over, (int)pixel_count(c),
                   TOLERANCE);
            simd_case_print(c);
        }
    }
    free(expected);
    return faults;
}

/* Cases of one method, or of one filter alone. Returns the number of faults. */
static int check_kernels(const settings *s, const char *test, const crv_method *method,
                         const crv_filter *filter)
{
    tally tallies[SETS] = {{0}};
    int faults = 0;
    for (int32_t i = 0; i < s->cases; i++) {
        if (s->only >= 0 && i != s->only)
            continue;
        simd_random r = simd_random_make(s->seed, stream_of(test), (uint64_t)i);
        /* Every third run of a method goes through a filter as well. */
        const crv_filter *after =
            filter               ? filter
            : simd_chance(&r, 3) ? crv_filter_at(simd_int(&r, 0, crv_filter_count() - 1))
                                 : NULL;
        simd_case *c = simd_case_make(&r, method, after, filter != NULL, SIZE,
                                      (simd_scene)(i % SIMD_SCENES));
        faults += c ? check_case(s, test, i, c, tallies) : 1;
        simd_case_free(c);
    }
    for (int isa = 1; isa < SETS; isa++) {
        const tally *t = &tallies[isa];
        if (t->pixels == 0)
            continue;
        const int failed = (double)t->over > fmax(1, SHARE * (double)t->pixels);
        printf("%-16s %-7s %8d px, %d over %g, largest difference %.2g, of bent normals "
               "%.2g%s\n",
               test, crv_isa_name((crv_isa)isa), (int)t->pixels, (int)t->over, TOLERANCE,
               t->largest, t->largest_bent, failed ? "  FAILED" : "");
        faults += failed;
    }
    return faults;
}

/* ---- the vocabulary ---- */

/* simd_words_tmpl.c: the number of faults, a line for each. */
#define CRV__SET(name, NAME, is_there) int crv__words_##name(uint64_t seed);
#include "crevice_sets.h"
#undef CRV__SET

static int check_words(const settings *s)
{
    static int (*const WORDS[SETS])(uint64_t) = {
        [CRV_ISA_SCALAR] = NULL, /* an empty list is no C */
#define CRV__SET(name, NAME, is_there) [CRV_ISA_##NAME] = crv__words_##name,
#include "crevice_sets.h"
#undef CRV__SET
    };
    int faults = 0;
    for (int isa = 1; isa < SETS; isa++) {
        if (!(wanted_sets(s) >> isa & 1))
            continue;
        const int count = WORDS[isa] ? WORDS[isa](s->seed) : 1;
        printf("%-16s %-7s %s\n", "words", crv_isa_name((crv_isa)isa),
               count ? "FAILED" : "good");
        faults += count;
    }
    return faults;
}

/* ---- timing ---- */

/* A frame that every set is timed on: boxes before a wavy wall, defaults but for a radius
 * of a sixteenth of the width. */
static simd_case *bench_case(const settings *s, const crv_method *method,
                             const crv_filter *filter)
{
    simd_random r = simd_random_make(s->seed, 0, 0);
    simd_case *c = simd_case_make(&r, method, filter, filter != NULL, 1, SIMD_SMOOTH);
    if (!c)
        return NULL;
    const int32_t width = 640, height = 360;
    const size_t count = (size_t)width * (size_t)height;
    crv_options_init(&c->options, sizeof c->options, method->name);
    c->options.filter = filter;
    crv_gbuffer_desc_init(&c->desc, sizeof c->desc, width, height);
    c->camera = crv_camera_perspective(width, height, 1);
    float *depth = realloc(c->depth[0], count * sizeof(float));
    float *input = filter ? realloc(c->input, count * sizeof(float)) : NULL;
    c->depth[0] = depth ? depth : c->depth[0];
    c->input = input ? input : c->input;
    free(c->normals);
    c->normals = NULL;
    if (!depth || (filter && !input)) {
        simd_case_free(c);
        return NULL;
    }
    c->options.radius = 5 * 40 / c->camera.fx_px;
    for (size_t i = 0; i < count; i++) {
        const double x = (double)(i % (size_t)width), y = (double)(i / (size_t)width);
        const int box = fmod(x, 53) < 20 && fmod(y, 47) < 25;
        depth[i] = (float)(5 + 0.1 * sin(0.05 * x) + 0.1 * cos(0.07 * y) - 0.3 * box);
        if (input)
            input[i] = (float)simd_unit(&r);
    }
    return c;
}

static int bench(const settings *s, const char *test, const crv_method *method,
                 const crv_filter *filter)
{
    simd_case *c = bench_case(s, method, filter);
    if (!c)
        return 1;
    const double scalar = simd_time(c, CRV_ISA_SCALAR);
    int faults = !(scalar > 0);
    printf("%-16s scalar  %9.2f ns/px\n", test, scalar);
    for (int isa = 1; isa < SETS; isa++) {
        if (!(wanted_sets(s) >> isa & 1))
            continue;
        const double time = simd_time(c, (crv_isa)isa);
        printf("%-16s %-7s %9.2f ns/px  x %.1f\n", test, crv_isa_name((crv_isa)isa), time,
               scalar / time);
        faults += !(time > 0);
    }
    simd_case_free(c);
    return faults;
}

/* ---- the program ---- */

static int usage(void)
{
    fprintf(stderr, "usage: test_simd [--seed N] [--test NAME] [--isa NAME] [--cases N] "
                    "[--case N] [--bench]\n");
    return 2;
}

static int parse(int argc, char **argv, settings *s)
{
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (strcmp(argv[i], "--bench") == 0) {
            s->bench = 1;
            continue;
        }
        if (!value)
            return 0;
        if (strcmp(argv[i], "--seed") == 0)
            s->seed = strtoull(value, NULL, 0);
        else if (strcmp(argv[i], "--test") == 0)
            s->test = value;
        else if (strcmp(argv[i], "--isa") == 0)
            s->isa = value;
        else if (strcmp(argv[i], "--cases") == 0)
            s->cases = (int32_t)strtol(value, NULL, 0);
        else if (strcmp(argv[i], "--case") == 0)
            s->only = (int32_t)strtol(value, NULL, 0);
        else
            return 0;
        i++;
    }
    return 1;
}

int main(int argc, char **argv)
{
    settings s = {.seed = (uint64_t)time(NULL), .cases = 60, .only = -1};
    if (!parse(argc, argv, &s))
        return usage();
    printf("test_simd --seed %llu\n", (unsigned long long)s.seed);
    if (!wanted_sets(&s))
        printf("no instruction set to test: the library has scalar code only here\n");
    int faults = 0, tests = 0;
    if (!s.bench && is_wanted(s.test, "words")) {
        faults += check_words(&s);
        tests++;
    }
    for (int32_t i = 0; i < crv_method_count(); i++) {
        const crv_method *method = crv_method_at(i);
        if (!is_wanted(s.test, method->name))
            continue;
        faults += (s.bench ? bench : check_kernels)(&s, method->name, method, NULL);
        tests++;
    }
    for (int32_t i = 0; i < crv_filter_count(); i++) {
        const crv_filter *filter = crv_filter_at(i);
        if (!is_wanted(s.test, filter->name))
            continue;
        faults +=
            (s.bench ? bench : check_kernels)(&s, filter->name, crv_method_at(0), filter);
        tests++;
    }
    if (tests == 0) {
        fprintf(stderr, "test_simd: no test %s; a method, a filter or words\n", s.test);
        return 2;
    }
    if (faults)
        printf("%d faults; repeat with --seed %llu --test NAME [--case N]\n", faults,
               (unsigned long long)s.seed);
    return faults ? 1 : 0;
}

/* SPDX-License-Identifier: MIT */
/*
 * Every method and filter on a Vulkan device against the scalar code: random frames and
 * options, through the public interface.
 *
 *   test_vulkan_agreement [--seed N] [--test NAME] [--cases N] [--case N]
 *                         [--half 1] [--layout N]
 *
 * What differs is printed with what repeats it. Exit code 77: there is no device.
 */
#include "simd.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "crevice/vulkan.h"

/*
 * Both read the same texels and round sums otherwise. What differs by more than 2e-3 is a
 * sample at a limit or at the border of two texels: a device may round a division
 * otherwise, by 2.5 units in the last place, which moves one place in 10^4 at most.
 */
static const double TOLERANCE = 2e-3, SHARE = 1e-3;

/*
 * Of bent normals, radians, where A is open. They are sums of unit vectors, two thirds of
 * A long with all weightings but half of it with the uniform one: what moves A by the
 * tolerance moves the tip by as much, and the direction by 2 / A as much.
 */
static double bent_tolerance(double A)
{
    return TOLERANCE * 2 / fmax(A, 0.02);
}

enum { SIZE = 90 };

typedef struct settings {
    uint64_t seed;
    const char *test; /* NULL: all */
    int32_t cases, only;
    int32_t half, layout; /* as in crv_vulkan_context_set_plans() */
} settings;

static void print_errors(void *user, crv_log_level level, const char *line)
{
    (void)user;
    if (level == CRV_LOG_ERROR)
        printf("  %s\n", line);
}

/* ---- a run ---- */

static crv_status set_frame(crv_gbuffer *gbuffer, const simd_case *c)
{
    const int32_t width = c->desc.width, height = c->desc.height;
    crv_status status = crv_gbuffer_set_camera(gbuffer, &c->camera);
    for (int32_t i = 0; status == CRV_OK && i < c->desc.layers; i++) {
        const crv_const_image depth =
            crv_const_image_packed(c->depth[i], width, height, 1);
        status = crv_gbuffer_set_depth(gbuffer, i, &depth, NULL);
    }
    if (status == CRV_OK && c->normals) {
        const crv_const_image normals =
            crv_const_image_packed(c->normals, width, height, 3);
        status = crv_gbuffer_set_normals(gbuffer, &normals, CRV_NORMAL_VIEW);
    }
    return status;
}

static int32_t result_width(const simd_case *c)
{
    return c->desc.width - c->desc.guard_left - c->desc.guard_right;
}

static int32_t result_height(const simd_case *c)
{
    return c->desc.height - c->desc.guard_top - c->desc.guard_bottom;
}

/* Whether bent normals are computed as well. */
static int has_bent(const simd_case *c)
{
    return c->options.bent_normal && c->options.method->bent_normal && !c->input;
}

/* The result, packed, and bent normals behind it, which the caller frees; NULL after a
 * line. */
static float *computed(crv_context *context, const simd_case *c)
{
    const int32_t width = result_width(c), height = result_height(c);
    const size_t count = (size_t)width * (size_t)height;
    float *pixels = calloc(4 * count, sizeof *pixels);
    const crv_image result = crv_image_packed(pixels, width, height, 1);
    crv_result both;
    crv_result_init(&both, sizeof both);
    both.accessibility = result;
    if (has_bent(c) && pixels)
        both.bent_normal = crv_image_packed(pixels + count, width, height, 3);
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_status status = pixels ? CRV_OK : CRV_ERROR_OUT_OF_MEMORY;
    if (status == CRV_OK)
        status = crv_gbuffer_create(context, &c->desc, &gbuffer);
    if (status == CRV_OK)
        status = crv_plan_create(context, &c->options, &c->desc, &plan);
    if (status == CRV_OK)
        status = set_frame(gbuffer, c);
    if (status == CRV_OK && c->input) {
        const crv_const_image input = crv_const_image_packed(c->input, width, height, 1);
        status = crv_plan_filter(plan, gbuffer, &input, &result);
    } else if (status == CRV_OK) {
        status = crv_plan_run_result(plan, gbuffer, &both);
    }
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    if (status == CRV_OK)
        return pixels;
    free(pixels);
    return NULL;
}

/* ---- the comparison ---- */

typedef struct devices {
    crv_context *cpu, *vulkan;
} devices;

typedef struct tally {
    int64_t pixels, over;
    double largest;
    int64_t bent; /* pixels of which bent normals were compared */
    double largest_rad;
} tally;

/* Returns how many pixels are over the tolerance. */
static int64_t compare(const float *expected, const float *got, int64_t count, tally *t)
{
    int64_t over = 0;
    for (int64_t i = 0; i < count; i++) {
        const double error = fabs((double)got[i] - (double)expected[i]);
        over += !(error <= TOLERANCE); /* a NaN on either side as well */
        if (!(error <= t->largest))
            t->largest = error;
    }
    t->pixels += count;
    t->over += over;
    return over;
}

/* The angle between two vectors, radians. 0 if both are zero, as of background. */
static double angle_between(const float *a, const float *b)
{
    double cross = 0, dot = 0, largest = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double part = (double)a[j] * (double)b[k] - (double)a[k] * (double)b[j];
        cross += part * part;
        dot += (double)a[i] * (double)b[i];
        largest = fmax(largest, fmax(fabs((double)a[i]), fabs((double)b[i])));
    }
    return largest > 0 && dot == 0 && cross == 0 ? 4 : atan2(sqrt(cross), dot);
}

/* The same of bent normals. */
static int64_t compare_bent(const float *expected, const float *got, int64_t count,
                            tally *t)
{
    int64_t over = 0;
    for (int64_t i = 0; i < count; i++) {
        const double angle = angle_between(expected + count + 3 * i, got + count + 3 * i);
        over += !(angle <= bent_tolerance((double)expected[i]));
        if (!(angle <= t->largest_rad))
            t->largest_rad = angle;
    }
    t->bent += count;
    t->over += over;
    return over;
}

/* Returns the number of faults. */
static int check_case(const devices *d, const char *test, int32_t index,
                      const simd_case *c, tally *t)
{
    const int64_t count = (int64_t)result_width(c) * result_height(c);
    float *expected = computed(d->cpu, c), *got = computed(d->vulkan, c);
    const int done = expected && got;
    int64_t over = done ? compare(expected, got, count, t) : 0;
    if (done && has_bent(c))
        over += compare_bent(expected, got, count, t);
    if (!done || over > 2 + count / 100) {
        printf("%s, case %d: %d of %d px over %g\n", test, index, (int)over, (int)count,
               TOLERANCE);
        simd_case_print(c);
    }
    free(expected);
    free(got);
    return !done;
}

static uint64_t stream_of(const char *name)
{
    uint64_t hash = 1469598103934665603u; /* FNV-1a */
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 1099511628211u;
    return hash;
}

static int report(const char *test, const tally *t)
{
    const int failed = (double)t->over > fmax(1, SHARE * (double)t->pixels);
    printf("%-12s %8d px, %d over %g, largest difference %.2g%s\n", test, (int)t->pixels,
           (int)t->over, TOLERANCE, t->largest, failed ? "  FAILED" : "");
    if (t->bent)
        printf("%12s %8d bent normals, largest angle %.2g degrees\n", "", (int)t->bent,
               t->largest_rad * 57.29577951);
    return failed;
}

/* Cases of one method, or of one filter alone. Returns the number of faults. */
static int check(const settings *s, const devices *d, const char *test,
                 const crv_method *method, const crv_filter *filter)
{
    tally t = {0};
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
        simd_case *c = simd_case_make(&r, method, after, filter ? 1 : 0, SIZE,
                                      (simd_scene)(i % SIMD_SCENES));
        if (c) /* half of the cases: the others show that nothing else changes */
            c->options.bent_normal = i % 2 == 0;
        faults += c ? check_case(d, test, i, c, &t) : 1;
        simd_case_free(c);
    }
    return faults + report(test, &t);
}

/* So many samples that an estimate takes several dispatches, which hand on their sums.
 * Returns the number of faults. */
static int check_many(const settings *s, const devices *d)
{
    enum { FEW_PIXELS = 14 }; /* a side, at most */
    tally t = {0};
    int faults = 0;
    for (int32_t i = 0; s->cases > 0 && i < crv_method_count(); i++) {
        const crv_method *method = crv_method_at(i);
        simd_random r = simd_random_make(s->seed, stream_of("many"), (uint64_t)i);
        simd_case *c = simd_case_make(&r, method, NULL, 0, FEW_PIXELS, SIMD_SMOOTH);
        if (c) {
            c->options.directions = simd_int(&r, 200, 256);
            c->options.steps = simd_int(&r, 220, 256);
            c->options.normal_rays = simd_int(&r, 2, 8);
            c->options.samples = simd_int(&r, 3000, 4096);
            c->options.bent_normal = 1;
        }
        faults += c ? check_case(d, "many", i, c, &t) : 1;
        simd_case_free(c);
    }
    return faults + report("many", &t);
}

static int check_all(const settings *s, const devices *d)
{
    int faults = 0, tests = 0;
    /* A single case each is for the layer that instruments shaders: that takes minutes
     * for so many samples. */
    if (s->test ? strcmp(s->test, "many") == 0 : s->cases > 1) {
        faults += check_many(s, d);
        tests++;
    }
    for (int32_t i = 0; i < crv_method_count() + crv_filter_count(); i++) {
        const int32_t k = i - crv_method_count();
        const crv_filter *filter = k >= 0 ? crv_filter_at(k) : NULL;
        /* ssao is the quickest to compile. */
        const crv_method *method = filter ? crv_method_find("ssao") : crv_method_at(i);
        const char *name = filter ? filter->name : method->name;
        if (s->test && strcmp(s->test, name) != 0)
            continue;
        faults += check(s, d, name, method, filter);
        tests++;
    }
    return tests ? faults : 1;
}

/* ---- the program ---- */

static int parse(int argc, char **argv, settings *s)
{
    for (int i = 1; i + 1 < argc; i += 2) {
        const char *value = argv[i + 1];
        if (strcmp(argv[i], "--seed") == 0)
            s->seed = strtoull(value, NULL, 0);
        else if (strcmp(argv[i], "--test") == 0)
            s->test = value;
        else if (strcmp(argv[i], "--cases") == 0)
            s->cases = (int32_t)strtol(value, NULL, 0);
        else if (strcmp(argv[i], "--case") == 0)
            s->only = (int32_t)strtol(value, NULL, 0);
        else if (strcmp(argv[i], "--half") == 0)
            s->half = (int32_t)strtol(value, NULL, 0);
        else if (strcmp(argv[i], "--layout") == 0)
            s->layout = (int32_t)strtol(value, NULL, 0);
        else
            return 0;
    }
    return argc % 2;
}

static crv_status make_context(crv_device device, const settings *s, crv_context **out)
{
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger.fn = print_errors;
    desc.isa_mask = 1u << CRV_ISA_SCALAR;
    desc.exact = 1;
    desc.device = device;
    const crv_status status = crv_context_create(&desc, out);
    if (status || device == CRV_DEVICE_CPU)
        return status;
    return crv_vulkan_context_set_plans(*out, (crv_vulkan_depth_layout)s->layout,
                                        s->half ? CRV_VULKAN_HALF_ON
                                                : CRV_VULKAN_HALF_OFF);
}

int main(int argc, char **argv)
{
    settings s = {.seed = (uint64_t)time(NULL), .cases = 20, .only = -1};
    devices d = {NULL, NULL};
    if (!parse(argc, argv, &s)) {
        fprintf(stderr, "usage: test_vulkan_agreement [--seed N] [--test NAME] "
                        "[--cases N] [--case N] [--half 1] [--layout N]\n");
        return 2;
    }
    printf("test_vulkan_agreement --seed %llu\n", (unsigned long long)s.seed);
    const crv_status status = make_context(CRV_DEVICE_VULKAN, &s, &d.vulkan);
    if (status == CRV_ERROR_UNSUPPORTED && !getenv("CI"))
        return 77;
    if (status || make_context(CRV_DEVICE_CPU, &s, &d.cpu))
        return 1;
    const int faults = check_all(&s, &d);
    crv_context_destroy(d.cpu);
    crv_context_destroy(d.vulkan);
    if (faults)
        printf("%d faults; repeat with --seed %llu --test NAME [--case N]\n", faults,
               (unsigned long long)s.seed);
    return faults ? 1 : 0;
}

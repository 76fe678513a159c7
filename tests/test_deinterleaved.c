/* SPDX-License-Identifier: MIT */
/*
 * The deinterleaved structure: every instruction set against its scalar reference, on
 * random and pathological data between guard bytes; and against the exact structure, from
 * which it differs in noise only.
 */
#include "deinterleaved_reference.h"
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const METHODS[] = {"hbao", "gtao", "bitmask", "alchemy", "vo"};

enum {
    METHOD_COUNT = sizeof METHODS / sizeof METHODS[0],
    CASES = 60,
    SIZE = 150,
    SETS = 5
};

/* Runs a case with noise tiles that the structure takes. */
static simd_case *make_case(const char *method, int32_t index)
{
    simd_random r =
        simd_random_make(1, (uint64_t)(method[0] + 256 * method[1]), (uint64_t)index);
    simd_case *c = simd_case_make(&r, crv_method_find(method), NULL, 0, SIZE,
                                  (simd_scene)(index % SIMD_SCENES));
    assert_non_null(c);
    /* Of a single slice all may be rounding: those seen at grazing angles have a measure
     * near 0, which counts little beside the others'. */
    const bool is_bitmask = strcmp(method, "bitmask") == 0;
    if ((is_bitmask || strcmp(method, "gtao") == 0) && c->options.directions == 1)
        c->options.directions = 2;
    if (is_bitmask)
        c->options.intensity = c->options.contrast = 1;
    static const int32_t TILES[] = {4, 4, 2, 1};
    c->options.noise_size = TILES[index / SIMD_SCENES % 4];
    if (c->desc.layers > 3 || ((is_bitmask || strcmp(method, "vo") == 0) && index % 3))
        c->desc.layers = 1; /* others are computed exactly */
    c->exact = 0;
    return c;
}

/*
 * Reciprocals and roots of at least 11 bits in sums of weights of one: 4e-4. More than
 * 1e-3 is a sample on the other side of a limit, or a tie of two texels rounded the other
 * way, as in the test of the exact kernels.
 */
static const double TOLERANCE = 1e-3, SHARE = 1e-4;

/* Of bitmask a rounding sets a sector or does not: a 32nd of a slice, which may be most
 * of two. */
static double tolerance_of(const simd_case *c)
{
    return strcmp(c->options.method->name, "bitmask") == 0 ? 1.1 / 32 : TOLERANCE;
}

static int32_t count_beyond(const float *a, const float *b, int32_t count,
                            double tolerance)
{
    int32_t beyond = 0;
    for (int32_t i = 0; i < count; i++)
        beyond += !(fabs((double)a[i] - (double)b[i]) <= tolerance);
    return beyond;
}

/* How many bent normals are more than 0.05 apart, about 3 degrees: a sector of bitmask
 * set or not, as above. */
static int32_t count_bent_beyond(const float *expected, const float *got, int32_t count)
{
    int32_t beyond = 0;
    for (int32_t i = 0; i < count; i++) {
        double squared = 0;
        for (int32_t k = 3 * i; k < 3 * i + 3; k++)
            squared += ((double)expected[k] - (double)got[k])
                       * ((double)expected[k] - (double)got[k]);
        beyond += squared > 0.05 * 0.05; /* NaN: no surface */
    }
    return beyond;
}

static int32_t pixel_count(const simd_case *c)
{
    const crv_gbuffer_desc *d = &c->desc;
    return (d->width - d->guard_left - d->guard_right)
           * (d->height - d->guard_top - d->guard_bottom);
}

/* Runs a case with every set and counts the pixels that are not the expected ones. */
static void count_by_set(const simd_case *c, int32_t index, const float *expected,
                         int64_t beyond[SETS])
{
    const int32_t count = pixel_count(c);
    for (int isa = 1; isa < SETS; isa++) {
        if (!(crv_isa_available() >> isa & 1))
            continue;
        float *got = simd_run(c, (crv_isa)isa);
        assert_non_null(got);
        int32_t over = count_beyond(got, expected, count, tolerance_of(c));
        if (c->options.bent_normal)
            over += count_bent_beyond(expected + count, got + count, count);
        if (over > 2 + count / 200) {
            printf("%s, case %d: %d of %d px\n", crv_isa_name((crv_isa)isa), index, over,
                   count);
            simd_case_print(c);
        }
        beyond[isa] += over;
        free(got);
    }
}

static void sets_compute_the_reference(void **state)
{
    (void)state;
    for (int m = 0; m < METHOD_COUNT; m++) {
        int64_t pixels = 0, structured = 0, beyond[SETS] = {0};
        for (int32_t i = 0; i < CASES; i++) {
            simd_case *c = make_case(METHODS[m], i);
            int32_t with_bucket;
            float *expected = deinterleaved_reference(c, &with_bucket);
            assert_non_null(expected);
            count_by_set(c, i, expected, beyond);
            pixels += pixel_count(c);
            structured += with_bucket;
            free(expected);
            simd_case_free(c);
        }
        for (int isa = 1; isa < SETS; isa++) {
            printf("%s %s: %lld of %lld px beyond %g, %lld in buckets\n", METHODS[m],
                   crv_isa_name((crv_isa)isa), (long long)beyond[isa], (long long)pixels,
                   TOLERANCE, (long long)structured);
            assert_true((double)beyond[isa] <= SHARE * (double)pixels + 1);
        }
        assert_true(structured > pixels / 4); /* or nothing was tested */
    }
}

/* A case's result with this depth in the upper rows of its first layer. */
static float *run_below(simd_case *c, crv_isa isa, float depth)
{
    enum { ROWS = 2 };
    for (int32_t i = 0; i < ROWS * c->desc.width; i++)
        c->depth[0][i] = depth;
    float *result = simd_run(c, isa);
    assert_non_null(result);
    return result;
}

/* Beyond a border whose depth has no reciprocal but a denormal one, and yet is finite,
 * nothing blocks, as beyond background. */
static void huge_depth_at_a_border_is_background(void **state)
{
    (void)state;
    enum { FIRST = 4 }; /* the row from which on normals do not see the border */
    static const char *const NAMES[] = {"gtao", "bitmask"};
    int32_t compared = 0;
    for (int32_t k = 0; k < CASES / SIMD_SCENES * 2; k++) {
        simd_case *c = make_case(NAMES[k & 1], (k >> 1) * SIMD_SCENES + SIMD_SMOOTH);
        c->options.bent_normal = 1;
        c->options.attenuation = CRV_ATTENUATION_SLAB;
        c->options.border = CRV_BORDER_EXTRAPOLATE;
        c->desc.layers = 1;
        const int32_t count = pixel_count(c);
        const int32_t rest = c->desc.guard_top < FIRST ? FIRST - c->desc.guard_top : 0;
        const int32_t from =
            rest * (c->desc.width - c->desc.guard_left - c->desc.guard_right);
        for (int isa = 0; isa < SETS && from < count; isa++) {
            if (isa && !(crv_isa_available() >> isa & 1))
                continue;
            float *huge = run_below(c, (crv_isa)isa, 3e38f),
                  *background = run_below(c, (crv_isa)isa, INFINITY);
            const int32_t over =
                count_beyond(huge + from, background + from, count - from, 1e-6)
                + count_bent_beyond(background + count + 3 * from,
                                    huge + count + 3 * from, count - from);
            if (over) {
                simd_case_print(c);
                fail_msg("%s: %d of %d px", crv_isa_name((crv_isa)isa), over, count);
            }
            compared += count - from;
            free(huge);
            free(background);
        }
        simd_case_free(c);
    }
    assert_true(compared > 10000);
}

static float *compute(const fixture *f, const crv_options *options, int32_t exact)
{
    return fixture_compute(f, options, &(fixture_run){.exact = exact});
}

/* Both structures' estimates of a smooth scene have the same mean: their pixels'
 * difference is noise. */
static void the_mean_is_the_exact_one(void **state)
{
    (void)state;
    enum { WIDTH = 640, HEIGHT = 360 };
    static const double ONE = 1;
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 0.8f);
    fixture f = fixture_make(fixture_spheres, &ONE, &camera, WIDTH, HEIGHT);
    for (int m = 0; m < METHOD_COUNT; m++) {
        crv_options options = fixture_options(METHODS[m]);
        options.filter = NULL;
        options.radius = 0.7f;
        float *exact = compute(&f, &options, 1), *moved = compute(&f, &options, 0);
        double sum = 0, squares = 0;
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const double difference = (double)moved[i] - (double)exact[i];
            sum += difference;
            squares += difference * difference;
        }
        const double rms = sqrt(squares / (WIDTH * HEIGHT)),
                     bias = sum / (WIDTH * HEIGHT);
        printf("%s: deinterleaved - exact: mean %+.5f, rms %.5f\n", METHODS[m], bias,
               rms);
        assert_true(rms > 1e-3); /* its noise is different */
        /* Neighbours of a tile share their samples: 16 samples for each of some hundred
         * places; a twentieth of the noise, and no step to be seen in 8 bits. */
        assert_true(fabs(bias) < fmin(0.05 * rms + 2e-4, 0.002));
        free(exact);
        free(moved);
    }
    fixture_free(&f);
}

static void many_samples_converge_to_the_exact_value(void **state)
{
    (void)state;
    enum { EDGE = 800 }; /* for tables of so many samples the picture must be large */
    static const double GROOVE[] = {5};
    const crv_camera camera = crv_camera_orthographic(EDGE, EDGE, 4);
    fixture f = fixture_make(fixture_groove, GROOVE, &camera, EDGE, EDGE);
    for (int m = 0; m < METHOD_COUNT; m++) {
        crv_options options = fixture_options(METHODS[m]);
        options.filter = NULL;
        options.radius = 1;
        options.directions = strcmp(METHODS[m], "bitmask") == 0 ? 8 : 16;
        options.steps = 16;
        options.samples = 140;
        float *exact = compute(&f, &options, 1), *moved = compute(&f, &options, 0);
        double squares = 0;
        for (int32_t i = 0; i < EDGE * EDGE; i++)
            squares += pow((double)moved[i] - (double)exact[i], 2);
        const double rms = sqrt(squares / (EDGE * EDGE));
        printf("%s: groove, many samples: RMS difference %.4f\n", METHODS[m], rms);
        free(exact);
        free(moved);
        /* Independent points in [0, 1] err by 1/sqrt(4 n) at most, 0.042 (2010); patterns
         * that are well spread by less than half of it. */
        assert_true(rms > 0 && rms < 0.021);
    }
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_compute_the_reference),
        cmocka_unit_test(huge_depth_at_a_border_is_background),
        cmocka_unit_test(the_mean_is_the_exact_one),
        cmocka_unit_test(many_samples_converge_to_the_exact_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

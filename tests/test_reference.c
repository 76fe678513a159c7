/* SPDX-License-Identifier: MIT */
/*
 * The ray-traced reference against closed forms and quadrature.
 */
#include "reference.h"
#include "test_scene_support.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 128, HEIGHT = 32 };

static reference_options options_of(crv_weighting weighting, crv_falloff falloff,
                                    double radius, int32_t rays)
{
    return (reference_options){.weighting = weighting,
                               .falloff = falloff,
                               .tau = 3.0f,
                               .u = 0.1f,
                               .radius = (float)radius,
                               .rays = rays};
}

static reference *make(const scene *s, const scene_gbuffer *g, const reference_options *o)
{
    reference *r = NULL;
    messages m;
    crv_logger log = catch_messages(&m);
    assert_int_equal(reference_create(s, g, o, &r, &log), 0);
    assert_int_equal(m.errors + m.warnings, 0);
    return r;
}

/* The built-in groove, 64 pixels a unit: columns have one distance from the edge. */
typedef struct groove {
    scene *s;
    scene_gbuffer g;
} groove;

static groove open_groove(void)
{
    groove v = {0};
    scene_view view;
    assert_int_equal(scene_builtin("groove", &v.s, NULL), 0);
    scene_frame(v.s, 1.0f, 4.0f, &view);
    view.view_height = 0.5f;
    scene_gbuffer_request request = request_of(&view, WIDTH, HEIGHT);
    v.g = render(v.s, &request);
    return v;
}

static void close_groove(groove *v)
{
    scene_gbuffer_free(&v->g);
    scene_free(v->s);
}

/* Distance from the wall of the floor point that column x shows; the floor is at 45
 * degrees to the picture. */
static double distance_of(int32_t x)
{
    return fabs(x + 0.5 - 0.5 * WIDTH) / 64.0 * sqrt(2.0);
}

static double cosine_none(double c)
{
    return (acos(c) - c * sqrt(1.0 - c * c)) / PI;
}

static double cosine_linear(double c)
{
    double s = sqrt(1.0 - c * c);
    return (acos(c) + c * s - 2.0 * c * log((1.0 + s) / c)) / PI;
}

static double uniform_none(double c)
{
    return 0.5 * (1.0 - c);
}

static double uniform_linear(double c)
{
    return 0.5 * (1.0 - c + c * log(c));
}

/* R = 1, so rho = 1/2. */
static double tangent_sphere(double c)
{
    double rho = 0.5, e = fmax(0.0, rho - c);
    return e * e * (3.0 * rho - e) / (4.0 * rho * rho * rho);
}

typedef struct row {
    const char *name;
    reference_definition definition;
    crv_weighting weighting;
    crv_falloff falloff;
    double (*occlusion)(double c);
} row;

static const row rows[] = {
    {"cosine, none", REFERENCE_HEMISPHERE, CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE,
     cosine_none},
    {"cosine, linear", REFERENCE_HEMISPHERE, CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR,
     cosine_linear},
    {"uniform, none", REFERENCE_HEMISPHERE, CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE,
     uniform_none},
    {"uniform, linear", REFERENCE_HEMISPHERE, CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_LINEAR,
     uniform_linear},
    {"tangent sphere", REFERENCE_TANGENT_SPHERE, CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE,
     tangent_sphere},
};
enum { ROWS = sizeof rows / sizeof *rows };

static reference_options options_of_row(const row *w, int32_t rays)
{
    reference_options o = options_of(w->weighting, w->falloff, 1.0, rays);
    o.definition = w->definition;
    return o;
}

/* What is measured over many pixels whose value is known. */
typedef struct tally {
    int count, beyond_three;
    double error, error2, claimed2, score2;
} tally;

static void count_value(tally *t, reference_value v, double expected)
{
    /* Rays begin 3e-5 off the surface (1e-6 of 32 units, the scene's size), R is 1, and
     * dA/dD is below 2/R: what is no sampling error is below 1e-4. */
    double error = (double)v.accessibility - expected;
    double claimed = hypot((double)v.error, 1e-4);
    t->count++;
    t->error += error;
    t->error2 += error * error;
    t->claimed2 += claimed * claimed;
    t->score2 += error * error / (claimed * claimed);
    t->beyond_three += fabs(error) > 3.0 * claimed;
    assert_true(fabs(error) < 8.0 * claimed);
}

static const int32_t columns[] = {64, 66, 71, 78, 85, 92, 99, 104, 108, 60, 50, 40};
enum { COLUMNS = sizeof columns / sizeof *columns };

static tally measure_groove(const groove *v, const reference_options *o,
                            double (*occlusion)(double c))
{
    reference *r = make(v->s, &v->g, o);
    tally t = {0};
    for (size_t i = 0; i < COLUMNS; i++)
        for (int32_t y = 0; y < HEIGHT; y++)
            count_value(&t, reference_pixel(r, columns[i], y),
                        1.0 - occlusion(distance_of(columns[i])));
    reference_free(r);
    return t;
}

static void print_tally(const char *name, const tally *t)
{
    print_message("%s: mean error %+.1e, RMS error %.1e, claimed %.1e, beyond three "
                  "standard errors %.2f %%\n",
                  name, t->error / t->count, sqrt(t->error2 / t->count),
                  sqrt(t->claimed2 / t->count), 100.0 * t->beyond_three / t->count);
}

static void test_closed_forms(void **state)
{
    groove v = open_groove();
    (void)state;
    for (size_t i = 0; i < ROWS; i++) {
        reference_options o = options_of_row(&rows[i], 1024);
        tally t = measure_groove(&v, &o, rows[i].occlusion);
        print_tally(rows[i].name, &t);
        /* The mean of all pixels within three of its standard errors, offset included. */
        assert_true(fabs(t.error / t.count) < 3.0 * sqrt(t.claimed2) / t.count + 1e-4);
        /* Student's t of 15 degrees of freedom is beyond 3 in 0.9 %; of 384 pixels more
         * than 12 would be one case in 10^4. */
        assert_true(t.beyond_three <= 12);
        /* Its mean square is 15/13. Twice that were an error claimed too small. */
        assert_true(t.score2 / t.count < 2.0);
    }
    close_groove(&v);
}

/* Four times the rays: at least half the error, whatever the integrand. */
static void test_convergence(void **state)
{
    groove v = open_groove();
    (void)state;
    for (size_t i = 0; i < ROWS; i++) {
        double former = 0.0, first = 0.0, last = 0.0;
        print_message("%s:", rows[i].name);
        for (int32_t rays = 128; rays <= 8192; rays *= 4) {
            reference_options o = options_of_row(&rows[i], rays);
            tally t = measure_groove(&v, &o, rows[i].occlusion);
            last = sqrt(t.error2 / t.count);
            print_message("  %d rays %.2e", (int)rays, last);
            /* 384 pixels know an RMS to 4 %, two of them to 5 %: four of those. */
            if (former > 0.0)
                assert_true(last < 0.5 * 1.2 * former);
            former = last;
            first = rays == 128 ? last : first;
        }
        print_message("  order %.2f\n", log(first / last) / log(64.0));
        assert_true(last < first / 8.0);
    }
    close_groove(&v);
}

/* Weight of an occluder as the options define it, a second time. */
static double weight(crv_falloff falloff, double q)
{
    const double w[] = {1.0,           1.0 - q,
                        1.0 - sqrt(q), 1.0 - q * q * q,
                        exp(-3.0 * q), q < 0.1 ? q / 0.1 : 0.1 / q};
    return w[falloff];
}

/* A ceiling at height h: the ray of sine c meets it at h / c. Midpoint rule over c. */
static double under_ceiling(crv_weighting weighting, crv_falloff falloff, double h)
{
    enum { N = 200000 };
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        double c = h + (1.0 - h) * (i + 0.5) / N;
        double density = weighting == CRV_WEIGHTING_COSINE ? 2.0 * c : 1.0;
        sum += density * weight(falloff, h / c) * (1.0 - h) / N;
    }
    return sum;
}

static const char ceiling[] = "v -50 0 50\nv 50 0 50\nv 50 0 -50\nv -50 0 -50\n"
                              "v -50 0.3 50\nv 50 0.3 50\nv 50 0.3 -50\nv -50 0.3 -50\n"
                              "f 1 2 3 4\nf 5 6 7 8\n";

/* All falloffs with both weightings; R = 1, h = 0.3. The ceiling's upper side is its
 * front, so it blocks with its back. */
static void test_falloffs(void **state)
{
    scene *s = load_text("ceiling.obj", ceiling);
    scene_view view =
        look(CRV_PERSPECTIVE, (double[3]){0, 0.2, 1}, (double[3]){0, 0, 0}, 0.0);
    scene_gbuffer_request request = request_of(&view, 8, 4);
    (void)state;
    view.vfov_rad = 0.1f;
    request.view = view;
    scene_gbuffer g = render(s, &request);
    for (int falloff = CRV_FALLOFF_NONE; falloff <= CRV_FALLOFF_ALCHEMY; falloff++) {
        for (int weighting = 0; weighting <= 1; weighting++) {
            reference_options o =
                options_of((crv_weighting)weighting, (crv_falloff)falloff, 1.0, 1024);
            double expected =
                1.0 - under_ceiling((crv_weighting)weighting, (crv_falloff)falloff, 0.3);
            reference *r = make(s, &g, &o);
            tally t = {0};
            for (int32_t i = 0; i < 32; i++)
                count_value(&t, reference_pixel(r, i % 8, i / 8), expected);
            /* 100 units of plane: the offset is 1e-4, and the tolerance with it. */
            assert_true(fabs(t.error / t.count)
                        < 3.0 * sqrt(t.claimed2) / t.count + 2e-4);
            reference_free(r);
        }
    }
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* The least and the greatest accessibility of a whole picture. */
static void extremes(const scene *s, const scene_gbuffer *g, const reference_options *o,
                     float *least, float *greatest)
{
    reference *r = make(s, g, o);
    *least = INFINITY;
    *greatest = -INFINITY;
    reference_advance(r, reference_total(r), 0);
    for (int64_t i = 0; i < reference_total(r); i++) {
        *least = fminf(*least, reference_accessibility(r)[i]);
        *greatest = fmaxf(*greatest, reference_accessibility(r)[i]);
    }
    reference_free(r);
}

/* Nothing shades itself, from above to grazing, near the origin and far from it. */
static void test_plane(void **state)
{
    static const double eyes[][3] = {{0, 30, 0.1}, {3, 3, 6}, {0, 0.05, 15}};
    scene *s = NULL;
    (void)state;
    assert_int_equal(scene_builtin("plane", &s, NULL), 0);
    for (size_t eye = 0; eye < 3; eye++) {
        scene_view view = look(CRV_PERSPECTIVE, eyes[eye], (double[3]){0, 0, 0}, 0.0);
        scene_gbuffer_request request = request_of(&view, 48, 32);
        scene_gbuffer g = render(s, &request);
        for (int kind = 0; kind <= 1; kind++) {
            reference_options o =
                options_of(CRV_WEIGHTING_UNIFORM, CRV_FALLOFF_NONE, 5.0, 256);
            float least, greatest;
            o.kind = (reference_kind)kind;
            extremes(s, &g, &o, &least, &greatest);
            print_message("plane %zu, kind %d: least %.5f\n", eye, kind, (double)least);
            /* A sheet ends at the horizon within its last pixel's own depth, a little
             * above the plane. */
            assert_true((double)least >= (kind == 0 ? 1.0 : 1.0 - 4.0 / 256.0));
            assert_true(greatest <= 1.0f);
        }
        scene_gbuffer_free(&g);
    }
    scene_free(s);
}

/* A closed solid much smaller than R, seen from within: no ray leaves. */
static void test_closed(void **state)
{
    scene *s = load_text("closed.obj",
                         "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                         "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n"
                         "f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    scene_view view =
        look(CRV_PERSPECTIVE, (double[3]){0.1, 0.1, 0.1}, (double[3]){1, 0.2, 0}, 0.0);
    scene_gbuffer_request request = request_of(&view, 48, 32);
    scene_gbuffer g = render(s, &request);
    (void)state;
    for (int weighting = 0; weighting <= 1; weighting++) {
        reference_options o =
            options_of((crv_weighting)weighting, CRV_FALLOFF_NONE, 100.0, 256);
        float least, greatest;
        extremes(s, &g, &o, &least, &greatest);
        assert_true(greatest <= 0.0f);
        /* Nothing is open: the bent normal is the normal, to the rounding of floats. */
        reference *r = make(s, &g, &o);
        reference_advance(r, reference_total(r), 0);
        for (int64_t i = 0; i < 3 * reference_total(r); i++)
            assert_true(fabsf(reference_bent_normal(r)[i] - g.normals[i]) < 1e-6f);
        reference_free(r);
    }
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* The visible kind is the scene itself where one layer holds all that there is. */
static void test_visible_groove(void **state)
{
    groove v = open_groove();
    reference_options o = options_of(CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, 0.2, 1024);
    double sum = 0.0;
    (void)state;
    o.kind = REFERENCE_VISIBLE;
    reference *r = make(v.s, &v.g, &o);
    for (int32_t y = 13; y < 19; y++)
        for (int32_t x = 67; x < 72; x++)
            sum += (double)reference_pixel(r, x, y).accessibility - 1.0
                   + cosine_none(distance_of(x) / 0.2);
    /* The buffer cuts the edge off by half a pixel, 0.02 of D for a sheet between the
     * centres beside it, at slope -dA/dD < 2/(pi R): 0.006 at D = 0.08 and less beyond.
     */
    print_message("visible groove: mean error %+.4f\n", sum / 30.0);
    assert_true(fabs(sum / 30.0) < 0.006);
    reference_free(r);
    close_groove(&v);
}

/* A rod before a distant wall, seen end on: what stands behind its silhouette is not
 * known, and what stands beside it far behind must stay open. */
static void test_visible_distance(void **state)
{
    scene *s = load_text("distance.obj",
                         "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                         "v -50 -50 -20\nv 50 -50 -20\nv 50 50 -20\nv -50 50 -20\n"
                         "f 1 2 3 4\nf 5 6 7 8\n");
    scene_view view =
        look(CRV_PERSPECTIVE, (double[3]){0, 0, 10}, (double[3]){0, 0, 0}, 0.0);
    scene_gbuffer_request request = request_of(&view, 48, 32);
    scene_gbuffer g = render(s, &request);
    reference_options o = options_of(CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, 2.0, 256);
    float least, greatest;
    (void)state;
    o.kind = REFERENCE_VISIBLE;
    extremes(s, &g, &o, &least, &greatest);
    print_message("distant wall: least %.5f\n", (double)least);
    assert_true((double)least >= 1.0 - 2.0 / 256.0);
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* Where the picture is empty nothing occludes, whatever the kind. */
static void test_empty(void **state)
{
    scene *s = NULL;
    scene_view view =
        look(CRV_PERSPECTIVE, (double[3]){0, 3, 0}, (double[3]){0, 9, 1}, 0.0);
    scene_gbuffer_request request = request_of(&view, 5, 3);
    (void)state;
    assert_int_equal(scene_builtin("plane", &s, NULL), 0);
    scene_gbuffer g = render(s, &request);
    for (int kind = 0; kind <= 1; kind++) {
        reference_options o = options_of(CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, 1.0, 16);
        float least, greatest;
        o.kind = (reference_kind)kind;
        extremes(s, &g, &o, &least, &greatest);
        assert_true(least >= 1.0f && greatest <= 1.0f);
        reference *r = make(s, &g, &o);
        const reference_value value = reference_pixel(r, 0, 0);
        for (int k = 0; k < 3; k++)
            assert_float_equal(value.bent_normal[k], 0.0f, 0.0f);
        reference_free(r);
    }
    scene_gbuffer_free(&g);
    scene_free(s);
}

/* Stopping at an error: every pixel claims it or has all rays, most have far fewer, and
 * the truth is as near as claimed. */
static void test_adaptive(void **state)
{
    groove v = open_groove();
    reference_options o = options_of(CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, 1.0, 65536);
    tally t = {0};
    int64_t rays = 0;
    (void)state;
    o.max_error = 0.004f;
    reference *r = make(v.s, &v.g, &o);
    for (size_t i = 0; i < COLUMNS; i++) {
        for (int32_t y = 0; y < HEIGHT; y++) {
            reference_value value = reference_pixel(r, columns[i], y);
            assert_true(value.error <= 0.004f && value.rays >= 256);
            rays += value.rays;
            count_value(&t, value, 1.0 - cosine_none(distance_of(columns[i])));
        }
    }
    print_tally("adaptive", &t);
    print_message("adaptive: %.0f rays a pixel\n", (double)rays / t.count);
    assert_true(rays / t.count < 4096);
    assert_true(sqrt(t.error2 / t.count) < 0.004);
    reference_free(r);
    close_groove(&v);
}

/* The mean open direction on the floor of the groove: along its normal, and towards the
 * edge. With u = w.t the sine towards the wall, directions are open if u < c, and for
 * c / u under the linear falloff: rings about t, of half a turn. */
static void bent_in_groove(const reference_options *o, double c, double *along_normal,
                           double *to_edge)
{
    const double s = sqrt(1.0 - c * c);
    const bool linear = o->falloff == CRV_FALLOFF_LINEAR;
    if (o->weighting == CRV_WEIGHTING_COSINE) {
        *along_normal = 0.5 * (2.0 / 3.0 + c - c * c * c / 3.0);
        *to_edge = -2.0 / (3.0 * PI) * s * s * s;
        *along_normal += linear ? 0.5 * c * (0.5 * (c * c - 1.0) - log(c)) : 0.0;
        *to_edge += linear ? c / PI * (acos(c) - c * s) : 0.0;
    } else {
        *along_normal = (c * s + asin(c) + 0.5 * PI) / (2.0 * PI);
        *to_edge = 0.25 * (c * c - 1.0);
        *along_normal += linear ? c / PI * (log((1.0 + s) / c) - s) : 0.0;
        *to_edge += linear ? 0.5 * c * (1.0 - c) : 0.0;
    }
}

static double angle_deg(const double a[3], const double b[3])
{
    return acos(fmin(dot(a, b) / sqrt(dot(a, a) * dot(b, b)), 1.0)) * 180.0 / PI;
}

/* The mean open direction of a column, view space. Both walls are at 45 degrees to the
 * picture, and meet far from the viewer. */
static void mean_of_column(const reference_options *o, int32_t x, double mean[3])
{
    const double left = x < WIDTH / 2 ? 1.0 : -1.0, half = sqrt(0.5);
    const double normal[3] = {left * half, 0.0, half}, edge[3] = {left * half, 0, -half};
    double along_normal, to_edge;
    bent_in_groove(o, distance_of(x), &along_normal, &to_edge);
    for (int k = 0; k < 3; k++)
        mean[k] = along_normal * normal[k] + to_edge * edge[k];
}

/* The bent normals of a column against the closed form: the angle of their mean, and the
 * largest of them. */
static void measure_bent(const reference *r, const reference_options *o, int32_t x,
                         double *of_mean, double *largest)
{
    double mean[3] = {0.0, 0.0, 0.0}, expected[3];
    mean_of_column(o, x, expected);
    *largest = 0.0;
    for (int32_t y = 0; y < HEIGHT; y++) {
        const reference_value value = reference_pixel(r, x, y);
        double bent[3];
        for (int k = 0; k < 3; k++) {
            bent[k] = (double)value.bent_normal[k];
            mean[k] += bent[k];
        }
        assert_true(fabs(dot(bent, bent) - 1.0) < 1e-6);
        *largest = fmax(*largest, angle_deg(bent, expected));
    }
    *of_mean = angle_deg(mean, expected);
}

static void test_bent_normals(void **state)
{
    groove v = open_groove();
    (void)state;
    for (size_t i = 0; i < ROWS - 1; i++) { /* all but the tangent sphere */
        const reference_options o = options_of_row(&rows[i], 1024);
        reference *r = make(v.s, &v.g, &o);
        double worst_mean = 0.0, worst = 0.0;
        for (size_t k = 0; k < COLUMNS; k++) {
            double of_mean, largest;
            measure_bent(r, &o, columns[k], &of_mean, &largest);
            worst_mean = fmax(worst_mean, of_mean);
            worst = fmax(worst, largest);
        }
        print_message("bent normals, %s: %.3f degrees of a column's mean, %.2f of one\n",
                      rows[i].name, worst_mean, worst);
        /* 1024 stratified rays know a component of the mean, which is longer than 0.3, to
         * about 0.002: 0.4 degrees, and a column's mean of 32 such to 0.07. Three of
         * those, and four for the worst of 384. */
        assert_true(worst_mean < 0.2);
        assert_true(worst < 1.6);
        reference_free(r);
    }
    close_groove(&v);
}

/* Skies of which the closed forms are known: an even one, and two that are brighter on
 * one side. */
static void linear_radiance(const void *user, const float direction[3], float rgb[3])
{
    (void)user;
    rgb[0] = 1.0f;
    rgb[1] = 2.0f + direction[0];
    rgb[2] = 2.0f + direction[2];
}

static void test_irradiance(void **state)
{
    groove v = open_groove();
    const reference_options o =
        options_of(CRV_WEIGHTING_COSINE, CRV_FALLOFF_NONE, 1.0, 1024);
    reference *r = make(v.s, &v.g, &o);
    (void)state;
    for (size_t i = 0; i < COLUMNS; i++) {
        const int32_t x = columns[i];
        const double A = 1.0 - cosine_none(distance_of(x));
        double mean[3], world[3], sum[3] = {0.0, 0.0, 0.0};
        mean_of_column(&o, x, mean);
        to_world(&v.g, (float[]){(float)mean[0], (float)mean[1], (float)mean[2]}, world);
        for (int32_t y = 0; y < HEIGHT; y++) {
            float rgb[3];
            reference_irradiance(r, x, y, linear_radiance, NULL, rgb);
            const double open = (double)reference_pixel(r, x, y).accessibility;
            assert_true(fabs((double)rgb[0] - PI * open) < 1e-5); /* the same rays */
            for (int c = 0; c < 3; c++)
                sum[c] += (double)rgb[c] / HEIGHT;
        }
        /* A column's A and mean are known to 0.0006 and 0.0004. */
        assert_true(fabs(sum[0] - PI * A) < 0.006);
        assert_true(fabs(sum[1] - PI * (2.0 * A + world[0])) < 0.015);
        assert_true(fabs(sum[2] - PI * (2.0 * A + world[2])) < 0.015);
    }
    reference_free(r);
    close_groove(&v);
}

/* One set of rays for all falloffs gives what each alone does, which other tests hold to
 * closed forms. */
static void test_all_falloffs(void **state)
{
    static const crv_weighting weightings[] = {CRV_WEIGHTING_UNIFORM,
                                               CRV_WEIGHTING_COSINE};
    groove v = open_groove();
    (void)state;
    for (int w = 0; w < 2; w++) {
        reference_options o = options_of(weightings[w], CRV_FALLOFF_SQRT, 0.7, 96);
        o.all_falloffs = true;
        reference *all = make(v.s, &v.g, &o);
        reference_advance(all, reference_total(all), 0);
        o.all_falloffs = false;
        for (int f = 0; f < REFERENCE_FALLOFFS; f++) {
            const float *a = reference_falloff_accessibility(all, (crv_falloff)f);
            const float *e = reference_falloff_error(all, (crv_falloff)f);
            o.falloff = (crv_falloff)f;
            reference *one = make(v.s, &v.g, &o);
            size_t size = (size_t)reference_total(one) * sizeof *a;
            reference_advance(one, reference_total(one), 0);
            assert_memory_equal(a, reference_accessibility(one), size);
            assert_memory_equal(e, reference_error(one), size);
            if (f == CRV_FALLOFF_SQRT) {
                assert_memory_equal(a, reference_accessibility(all), size);
                assert_memory_equal(reference_bent_normal(one),
                                    reference_bent_normal(all), 3 * size);
            }
            reference_free(one);
        }
        reference_free(all);
    }
    close_groove(&v);
}

/* A pixel gets rays until the worst of its falloffs is done. */
static void test_all_falloffs_stop_together(void **state)
{
    groove v = open_groove();
    reference_options o =
        options_of(CRV_WEIGHTING_COSINE, CRV_FALLOFF_LINEAR, 0.7, REFERENCE_MAX_RAYS);
    messages m;
    crv_logger log = catch_messages(&m);
    (void)state;
    o.max_error = 0.01f;
    o.all_falloffs = true;
    reference *r = make(v.s, &v.g, &o);
    reference_advance(r, reference_total(r), 0);
    for (int f = 0; f < REFERENCE_FALLOFFS; f++)
        for (int64_t i = 0; i < reference_total(r); i++)
            assert_true(reference_falloff_error(r, (crv_falloff)f)[i] <= 0.01f);
    assert_int_equal(reference_save(r, "all_falloffs.checkpoint", &log), -1);
    assert_int_equal(m.errors, 1);
    reference_free(r);
    close_groove(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_closed_forms),
                                       cmocka_unit_test(test_convergence),
                                       cmocka_unit_test(test_falloffs),
                                       cmocka_unit_test(test_plane),
                                       cmocka_unit_test(test_closed),
                                       cmocka_unit_test(test_visible_groove),
                                       cmocka_unit_test(test_visible_distance),
                                       cmocka_unit_test(test_empty),
                                       cmocka_unit_test(test_adaptive),
                                       cmocka_unit_test(test_bent_normals),
                                       cmocka_unit_test(test_irradiance),
                                       cmocka_unit_test(test_all_falloffs),
                                       cmocka_unit_test(test_all_falloffs_stop_together)};
    int result = cmocka_run_group_tests(tests, NULL, NULL);
    remove_files(NULL);
    return result;
}

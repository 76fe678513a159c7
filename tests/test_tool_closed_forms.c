/* SPDX-License-Identifier: MIT */
/* The closed forms of the tool against quadrature. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "quadrature.h"
#include "study/closed_forms.h"
#include "study/fitted_order.h"

static const double PI = 3.14159265358979323846;

/*
 * 1 - A by the midpoint rule over directions: the floor's normal is z, the wall stands
 * across x at distance c; a ray of x part u > 0 meets it at r = c / u.
 */
static double hemisphere(double c, int cosine, int linear)
{
    enum { N = 2000 };
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        const double z = (i + 0.5) / N, across = sqrt(1.0 - z * z);
        for (int k = 0; k < N; k++) {
            const double u = across * cos(2.0 * PI * (k + 0.5) / N);
            if (u > c)
                sum += (cosine ? 2.0 * z : 1.0) * (linear ? 1.0 - c / u : 1.0);
        }
    }
    return sum / N / N;
}

static void hemispheres(void **state)
{
    (void)state;
    for (double c = 0.15; c < 1.0; c += 0.2) {
        /* The cells that the edge of what is blocked crosses, 1/N of the range each way.
         */
        assert_true(fabs(closed_form_cosine_none(c) - hemisphere(c, 1, 0)) < 1e-3);
        assert_true(fabs(closed_form_cosine_linear(c) - hemisphere(c, 1, 1)) < 1e-3);
        assert_true(fabs(closed_form_uniform_none(c) - hemisphere(c, 0, 0)) < 1e-3);
        assert_true(fabs(closed_form_uniform_linear(c) - hemisphere(c, 0, 1)) < 1e-3);
    }
}

/* Volumes beyond the wall by slices of the ball parallel to it. */
static void volumes(void **state)
{
    enum { N = 10000 };
    (void)state;
    for (double c = 0.05; c < 1.0; c += 0.15) {
        double ball = 0.0, tangent = 0.0;
        for (int i = 0; i < N; i++) {
            const double x = c + (1.0 - c) * (i + 0.5) / N;
            ball += PI * (1.0 - x * x) * (1.0 - c) / N;
            tangent += PI * fmax(0.0, 0.25 - x * x) * (1.0 - c) / N;
        }
        /* Half of the cap is over the floor, and the floor itself hides half the ball. */
        assert_true(fabs(closed_form_vo(c) - 0.5 * ball / (2.0 * PI / 3.0)) < 1e-6);
        assert_true(fabs(closed_form_ssao(c) - 0.5 - 0.5 * ball / (4.0 * PI / 3.0))
                    < 1e-6);
        assert_true(fabs(closed_form_tangent_sphere(c) - tangent / (PI / 6.0)) < 1e-6);
    }
}

static void sums(void **state)
{
    const quadrature_alchemy numbers = {1, 1e-4, 1e-4};
    (void)state;
    for (double c = 0.1; c < 1.05; c += 0.3) {
        const quadrature_site site = {c * sqrt(0.5), 10, 1};
        const double depth = site.depth - site.x;
        /* 1/1000: what the rings of the quadrature resolve. */
        assert_true(fabs(closed_form_alchemy(c, depth, 1e-4, 1e-4)
                         - (1.0 - quadrature_of_alchemy(&site, &numbers)))
                    < 1e-3);
        assert_true(fabs(closed_form_vo(c) - (1.0 - quadrature_of_vo(&site))) < 1e-3);
    }
}

/* Lines in log-log with a known slope, and one that ends on a floor. */
static void orders(void **state)
{
    const double x[] = {1, 2, 4, 8, 16, 32, 64};
    double error[7];
    (void)state;
    for (int i = 0; i < 7; i++)
        error[i] = 3.0 * pow(x[i], -1.25);
    assert_true(fabs(fitted_order(x, error, 7) - 1.25) < 1e-12);
    assert_true(fabs(fitted_order(x, error, 2) - 1.25) < 1e-12);
    assert_true(isnan(fitted_order(x, error, 1)));
    /* 8, 4, 2, 1 and then a floor of 0.7: the slope of the first four. */
    for (int i = 0; i < 7; i++)
        error[i] = i < 4 ? 8.0 / x[i] : 0.7;
    assert_true(fabs(fitted_order(x, error, 7) - 1.0) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hemispheres),
        cmocka_unit_test(volumes),
        cmocka_unit_test(sums),
        cmocka_unit_test(orders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

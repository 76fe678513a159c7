/* SPDX-License-Identifier: MIT */
#include "closed_forms.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

double closed_form_cosine_none(double c)
{
    return (acos(c) - c * sqrt(1.0 - c * c)) / PI;
}

double closed_form_cosine_linear(double c)
{
    double s = sqrt(1.0 - c * c);

    return (acos(c) + c * s - 2.0 * c * log((1.0 + s) / c)) / PI;
}

double closed_form_uniform_none(double c)
{
    return 0.5 * (1.0 - c);
}

double closed_form_uniform_linear(double c)
{
    return 0.5 * (1.0 - c + c * log(c));
}

double closed_form_tangent_sphere(double c)
{
    double rho = 0.5, e = fmax(0.0, rho - c);

    return e * e * (3.0 * rho - e) / (4.0 * rho * rho * rho);
}

/* The wall cuts a cap of height h = 1 - c off the ball, pi h^2 (3 - h) / 3, of which one
 * half is in front of the floor; the open half of the ball is 2 pi / 3. */
double closed_form_vo(double c)
{
    double h = 1.0 - c;

    return 0.25 * h * h * (3.0 - h);
}

double closed_form_ssao(double c)
{
    return 0.5 + 0.5 * closed_form_vo(c);
}

/* What the wall's points at height w over the edge's line add: those within the radius
 * reach y to both sides, and the sum over y is an arc tangent. */
static double alchemy_row(double w, double c, double bias, double eps)
{
    double squared = w * w + c * c, root = sqrt(squared + eps);
    double reach = sqrt(fmax(0.0, 1.0 - squared));

    return 2.0 * fmax(0.0, w - bias) * atan(reach / root) / root;
}

/*
 * 2 / pi Int max(0, v.n - d beta) / (v.v + eps) over the disk. Only the wall's points
 * rise over the floor. At height w along the wall and y along the edge, v.n = w and v.v =
 * w^2
 * + c^2 + y^2; seen from the camera, an area dw dy of the wall is dw dy / sqrt 2.
 */
double closed_form_alchemy(double c, double depth, double beta, double eps)
{
    enum { PARTS = 4096 };
    double bias = depth * beta, top = sqrt(fmax(0.0, 1.0 - c * c)), sum = 0.0;

    if (bias >= top)
        return 0.0;
    /* From where a point counts, so that the integrand has no kink inside. */
    for (int i = 0; i <= PARTS; i++) {
        double w = bias + (top - bias) * i / PARTS;
        double weight = i == 0 || i == PARTS ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        sum += weight * alchemy_row(w, c, bias, eps);
    }
    return 2.0 / PI * sqrt(0.5) * sum * (top - bias) / (3.0 * PARTS);
}

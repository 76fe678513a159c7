/* SPDX-License-Identifier: MIT */
/*
 * normal_fit.c: Wahba's problem (SIAM Review 7(3), 1965), solved with the unit quaternion
 * of Horn, "Closed-form solution of absolute orientation using unit quaternions" (JOSA A
 * 4(4), 1987), and repeated with weights that take the outliers out (Geman and McClure).
 */
#include "normal_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear.h"

enum { ROUNDS = 25 };

/* Radians. Where most pixels show one flat floor, the median vanishes; a scale as small
 * would leave nothing of the rest, which alone fixes the rotation about the floor's
 * normal. */
static const double narrowest = 0.02;

static void source(const io__normal_pairs *pairs, bool mirrored, size_t i, double out[3])
{
    out[0] = (double)pairs->from[i][0];
    out[1] = (double)pairs->from[i][1];
    out[2] = mirrored ? -(double)pairs->from[i][2] : (double)pairs->from[i][2];
}

static double angle(const io__normal_pairs *pairs, bool mirrored, const double r[9],
                    size_t i)
{
    double a[3], square = 0.0;
    source(pairs, mirrored, i, a);
    for (int k = 0; k < 3; k++) {
        const double turned = r[3 * k] * a[0] + r[3 * k + 1] * a[1] + r[3 * k + 2] * a[2];
        const double difference = turned - (double)pairs->to[i][k];
        square += difference * difference;
    }
    /* By the chord, which is exact for small angles, the cosine is not. */
    return 2.0 * asin(fmin(1.0, 0.5 * sqrt(square)));
}

/* Hoare's FIND (CACM 4(7), 1961): the values change places until the median is in its
 * own; in linear time, where sorting took most of a fit. No value is a NaN. */
static double median(double *values, size_t count)
{
    const size_t wanted = count / 2;
    size_t first = 0, last = count - 1;
    while (first < last) {
        const double pivot = values[first + (last - first) / 2];
        size_t i = first, j = last;
        for (;;) {
            while (values[i] < pivot)
                i++;
            while (pivot < values[j])
                j--;
            if (i >= j)
                break;
            const double swapped = values[i];
            values[i++] = values[j];
            values[j--] = swapped;
        }
        /* first .. j are not above the pivot, j + 1 .. last not below. */
        if (wanted <= j)
            last = j;
        else
            first = j + 1;
    }
    return values[wanted];
}

static void rotation_of_quaternion(const double q[4], double r[9])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    r[0] = w * w + x * x - y * y - z * z;
    r[1] = 2.0 * (x * y - w * z);
    r[2] = 2.0 * (x * z + w * y);
    r[3] = 2.0 * (x * y + w * z);
    r[4] = w * w - x * x + y * y - z * z;
    r[5] = 2.0 * (y * z - w * x);
    r[6] = 2.0 * (x * z - w * y);
    r[7] = 2.0 * (y * z + w * x);
    r[8] = w * w - x * x - y * y + z * z;
}

/* Horn's matrix N from the correlation s[i][j] = sum of from_i * to_j, and its solution.
 */
static void solve(double s[3][3], double rotation[9])
{
    double n[4][4], values[4], vectors[4][4];
    n[0][0] = s[0][0] + s[1][1] + s[2][2];
    n[1][1] = s[0][0] - s[1][1] - s[2][2];
    n[2][2] = -s[0][0] + s[1][1] - s[2][2];
    n[3][3] = -s[0][0] - s[1][1] + s[2][2];
    n[0][1] = n[1][0] = s[1][2] - s[2][1];
    n[0][2] = n[2][0] = s[2][0] - s[0][2];
    n[0][3] = n[3][0] = s[0][1] - s[1][0];
    n[1][2] = n[2][1] = s[0][1] + s[1][0];
    n[1][3] = n[3][1] = s[2][0] + s[0][2];
    n[2][3] = n[3][2] = s[1][2] + s[2][1];
    io__eigenvectors(n[0], 4, values, vectors[0]);
    rotation_of_quaternion(vectors[3], rotation); /* of the largest */
}

/* One weighted solution; weights by the angles to the rotation before, or all 1. */
static void fit_round(const io__normal_pairs *pairs, bool mirrored, const double *angles,
                      double scale, double rotation[9])
{
    double s[3][3] = {{0}};
    for (size_t i = 0; i < pairs->count; i++) {
        double a[3], weight = 1.0;
        if (angles) {
            const double e = angles[i] / scale;
            weight = 1.0 / ((1.0 + e * e) * (1.0 + e * e));
        }
        source(pairs, mirrored, i, a);
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                s[j][k] += weight * a[j] * (double)pairs->to[i][k];
    }
    solve(s, rotation);
}

int io__normal_fit(const io__normal_pairs *pairs, bool mirrored, double rotation[9])
{
    if (pairs->count == 0)
        return -1;
    double *angles = malloc(2 * pairs->count * sizeof *angles);
    if (!angles)
        return -1;
    double *sorted = angles + pairs->count;
    fit_round(pairs, mirrored, NULL, 1.0, rotation);
    for (int round = 0; round < ROUNDS; round++) {
        for (size_t i = 0; i < pairs->count; i++)
            angles[i] = angle(pairs, mirrored, rotation, i);
        memcpy(sorted, angles, pairs->count * sizeof *sorted);
        const double scale = fmax(median(sorted, pairs->count), narrowest);
        fit_round(pairs, mirrored, angles, scale, rotation);
    }
    free(angles);
    return 0;
}

double io__normal_deviation(const io__normal_pairs *pairs, bool mirrored,
                            const double rotation[9])
{
    double *angles = pairs->count ? malloc(pairs->count * sizeof *angles) : NULL;
    if (!angles)
        return -1.0;
    for (size_t i = 0; i < pairs->count; i++)
        angles[i] = angle(pairs, mirrored, rotation, i);
    const double result = median(angles, pairs->count);
    free(angles);
    return result;
}

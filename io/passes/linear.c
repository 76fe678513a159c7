/* SPDX-License-Identifier: MIT */
#include "linear.h"

#include <math.h>
#include <string.h>

/* Turns rows and columns p and q so that their common element vanishes. */
static void rotate(double *a, double *v, int n, int p, int q)
{
    const double apq = a[n * p + q];
    if (!(fabs(apq) > 0.0))
        return;
    const double theta = (a[n * q + q] - a[n * p + p]) / (2.0 * apq);
    const double t =
        (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < n; k++) {
        const double akp = a[n * k + p], akq = a[n * k + q];
        a[n * k + p] = c * akp - s * akq;
        a[n * k + q] = s * akp + c * akq;
    }
    for (int k = 0; k < n; k++) {
        const double apk = a[n * p + k], aqk = a[n * q + k];
        a[n * p + k] = c * apk - s * aqk;
        a[n * q + k] = s * apk + c * aqk;
        const double vp = v[n * p + k], vq = v[n * q + k];
        v[n * p + k] = c * vp - s * vq;
        v[n * q + k] = s * vp + c * vq;
    }
}

static void swap_rows(double *values, double *vectors, int n, int i, int k)
{
    double row[LINEAR_MAX];
    const double value = values[i];
    const size_t size = (size_t)n * sizeof *row;
    values[i] = values[k];
    values[k] = value;
    memcpy(row, vectors + n * i, size);
    memcpy(vectors + n * i, vectors + n * k, size);
    memcpy(vectors + n * k, row, size);
}

void io__eigenvectors(double *matrix, int n, double *values, double *vectors)
{
    enum { SWEEPS = 30 };
    for (int i = 0; i < n * n; i++)
        vectors[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++)
                rotate(matrix, vectors, n, p, q);
    for (int i = 0; i < n; i++)
        values[i] = matrix[n * i + i];
    for (int i = 0; i < n; i++)
        for (int k = i + 1; k < n; k++)
            if (values[k] < values[i])
                swap_rows(values, vectors, n, i, k);
}

bool io__solve(double *e, int n, double *out)
{
    const int columns = n + 1;
    for (int i = 0; i < n; i++) {
        int best = i;
        for (int k = i + 1; k < n; k++)
            if (fabs(e[columns * k + i]) > fabs(e[columns * best + i]))
                best = k;
        for (int c = 0; c < columns; c++) {
            const double kept = e[columns * i + c];
            e[columns * i + c] = e[columns * best + c];
            e[columns * best + c] = kept;
        }
        if (!(fabs(e[columns * i + i]) > 1e-300))
            return false;
        for (int k = 0; k < n; k++) {
            const double factor = e[columns * k + i] / e[columns * i + i];
            for (int c = i; c < columns && k != i; c++)
                e[columns * k + c] -= factor * e[columns * i + c];
        }
    }
    for (int i = 0; i < n; i++)
        out[i] = e[columns * i + n] / e[columns * i + i];
    return true;
}

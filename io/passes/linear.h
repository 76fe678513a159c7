/* SPDX-License-Identifier: MIT */
/* linear.h: small systems of linear equations, row by row. */
#ifndef CREVICE_IO_PASSES_LINEAR_H
#define CREVICE_IO_PASSES_LINEAR_H

#include <stdbool.h>

enum { LINEAR_MAX = 12 };

/* The eigenvalues of a symmetric matrix of n rows, in ascending order, and a unit
 * eigenvector each, row by row (Jacobi 1846). The matrix is lost. */
void io__eigenvectors(double *matrix, int n, double *values, double *vectors);

/* Solves n equations of n + 1 columns, the right-hand side last, which are lost. False if
 * they do not decide. */
bool io__solve(double *equations, int n, double *out);

#endif

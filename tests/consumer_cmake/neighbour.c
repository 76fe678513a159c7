/* SPDX-License-Identifier: MIT */
/* A library of the project that takes Crevice in. */
int neighbour(void);

int neighbour(void)
{
    return 1;
}

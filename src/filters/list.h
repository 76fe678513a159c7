/* SPDX-License-Identifier: MIT */
/* The registry of filters, in the order in which they are listed: one line each. */
CRV__FILTER(bilateral13)
CRV__FILTER(box4)
CRV__FILTER(edges15)
CRV__FILTER(gauss5)

/* SPDX-License-Identifier: MIT */
/* What has a kernel in every instruction set: one line each. */
CRV__ESTIMATE(hbao)
CRV__FILTER(bilateral13)
CRV__FILTER(box4)
CRV__FILTER(gauss5)

/* SPDX-License-Identifier: MIT */
/* What has a kernel in every instruction set: one line each. FAST:
 * crv__fast_kind. */
CRV__ESTIMATE(alchemy)
CRV__ESTIMATE(containment)
CRV__ESTIMATE(hbao)
CRV__ESTIMATE(hsao)
CRV__ESTIMATE(raymarch)
CRV__ESTIMATE(ssao)
CRV__ESTIMATE(vao)
CRV__ESTIMATE(vo)
CRV__FILTER(bilateral13)
CRV__FILTER(box4)
CRV__FILTER(gauss5)
CRV__FAST(alchemy)
CRV__FAST(hbao)
CRV__FAST(vo)

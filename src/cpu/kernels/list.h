/* SPDX-License-Identifier: MIT */
/* What has a kernel in every instruction set: one line each. DEINTERLEAVED: methods with
 * a kernel in the deinterleaved structure (deinterleaved.h). */
CRV__ESTIMATE(alchemy)
CRV__ESTIMATE(containment)
CRV__ESTIMATE(gtao)
CRV__ESTIMATE(hbao)
CRV__ESTIMATE(hsao)
CRV__ESTIMATE(raymarch)
CRV__ESTIMATE(ssao)
CRV__ESTIMATE(vao)
CRV__ESTIMATE(vo)
CRV__FILTER(bilateral13)
CRV__FILTER(box4)
CRV__FILTER(gauss5)
CRV__DEINTERLEAVED(alchemy)
CRV__DEINTERLEAVED(gtao)
CRV__DEINTERLEAVED(hbao)
CRV__DEINTERLEAVED(vo)

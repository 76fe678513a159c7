/* SPDX-License-Identifier: MIT */
/* The registry of methods, in the order in which they are listed: one line each. */
CRV__METHOD(hbao)
CRV__METHOD(bitmask)
CRV__METHOD(gtao)
CRV__METHOD(hsao)
CRV__METHOD(raymarch)
CRV__METHOD(alchemy)
CRV__METHOD(vo)
CRV__METHOD(containment)
CRV__METHOD(vao)
CRV__METHOD(ssao)

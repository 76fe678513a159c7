/* SPDX-License-Identifier: MIT */
/* The registry of methods, in the order in which they are listed: one line each. */
CRV__METHOD(hbao)

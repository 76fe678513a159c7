/* SPDX-License-Identifier: MIT */
/* A host in C++ alone: does the package configure, compile and link without a C compiler? */
#include <cstdio>
#include <cstring>

#include "crevice/crevice.h"

int main()
{
    crv_context *context = nullptr;
    if (crv_context_create(nullptr, &context) != CRV_OK)
        return 1;
    std::printf("crevice %s from C++\n", crv_version());
    crv_context_destroy(context);
    return std::strlen(crv_version()) > 0 ? 0 : 1;
}

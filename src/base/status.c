/* SPDX-License-Identifier: MIT */
#include "crevice/base.h"

#define CRV__STRINGIFY_(x) #x
#define CRV__STRINGIFY(x)  CRV__STRINGIFY_(x)

const char *crv_version(void)
{
    return CRV__STRINGIFY(CRV_VERSION_MAJOR) "." CRV__STRINGIFY(
        CRV_VERSION_MINOR) "." CRV__STRINGIFY(CRV_VERSION_PATCH);
}

const char *crv_status_string(crv_status status)
{
    switch (status) {
    case CRV_OK:
        return "ok";
    case CRV_ERROR_INVALID_ARGUMENT:
        return "invalid argument";
    case CRV_ERROR_OUT_OF_MEMORY:
        return "out of memory";
    case CRV_ERROR_UNSUPPORTED:
        return "unsupported";
    case CRV_ERROR_NOT_READY:
        return "not ready";
    case CRV_ERROR_DEVICE:
        return "device failure";
    case CRV_ERROR_STOPPED:
        return "stopped";
    }
    return "unknown status";
}

/* SPDX-License-Identifier: MIT */
#ifndef CRV_CORE_CAMERA_H
#define CRV_CORE_CAMERA_H

#include "crevice/camera.h"

#include <stdbool.h>

/* INVALID_ARGUMENT with a line unless the camera can be computed with. */
crv_status crv__camera_check(const crv_logger *logger, const crv_camera *camera);

#endif

/* SPDX-License-Identifier: MIT */
#include "exact.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180.0;

const char *exact_number(float value, double unit, char out[32])
{
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(out, 32, "%.*g", digits, (double)value / unit);
        const float again = (float)(strtod(out, NULL) * unit);
        if (memcmp(&again, &value, sizeof again) == 0)
            break;
    }
    return out;
}

const char *exact_vector(const scene *model, const double p[3], char out[96])
{
    for (int digits = 6; digits <= 17; digits++) {
        float was[3], is[3];
        double again[3];
        char *rest = out;

        snprintf(out, 96, "%.*g,%.*g,%.*g", digits, p[0], digits, p[1], digits, p[2]);
        for (int i = 0; i < 3; i++) {
            again[i] = strtod(rest, &rest);
            rest += *rest == ',';
            was[i] = (float)p[i];
            is[i] = (float)again[i];
        }
        if (model) {
            scene_local_point(model, p, was);
            scene_local_point(model, again, is);
        }
        if (memcmp(was, is, sizeof was) == 0)
            break;
    }
    return out;
}

const char *exact_view(const scene *model, const scene_view *v, char out[384])
{
    const bool ortho = v->projection == CRV_ORTHOGRAPHIC;
    char eye[96], target[96], up[96], number[32];
    snprintf(out, 384, "--eye %s --target %s --up %s %s %s",
             exact_vector(model, v->eye, eye), exact_vector(model, v->target, target),
             exact_vector(NULL, v->up, up), ortho ? "--ortho" : "--vfov",
             ortho ? exact_number(v->view_height, 1.0, number)
                   : exact_number(v->vfov_rad, degree, number));
    return out;
}

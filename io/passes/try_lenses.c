/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "internal.h"
#include "trial.h"

static int try_focal_length(const io__court *c, const io__trial *first, double scale,
                            io__trial *better, bool *found)
{
    io__trial t = *first;
    t.camera.fx_px *= (float)scale;
    t.camera.fy_px *= (float)scale;
    const double height = c->frame->image.display_height / (double)t.camera.fy_px;
    snprintf(t.text, sizeof t.text, "its vertical field of view were about %.0f degrees",
             2.0 * atan(0.5 * height) * 57.29577951308232);
    return io__compare_trials(c, first, &t, better, found);
}

int io__try_cameras(const io__court *c, const io__camera_guess *cameras, int count,
                    const io__trial *first, io__trial *better, bool *found)
{
    int result = 0;
    for (int i = 1; !result && i < count; i++) {
        io__trial t = *first;
        t.camera = cameras[i].camera;
        t.guess = &cameras[i];
        snprintf(t.text, sizeof t.text, "its camera came from %s", cameras[i].text);
        result = io__compare_trials(c, first, &t, better, found);
    }
    if (*found || !c->has_normals || first->camera.projection != CRV_PERSPECTIVE)
        return result;
    /* From 0.2 to 5 times the focal length, then finer about the best. */
    for (int k = -12; !result && k <= 12; k++)
        result = try_focal_length(c, first, pow(1.15, k), better, found);
    const double best =
        *found ? (double)(better->camera.fy_px / first->camera.fy_px) : 1.0;
    for (int k = -4; *found && !result && k <= 4; k++)
        result = try_focal_length(c, first, best * pow(1.035, k), better, found);
    return result;
}

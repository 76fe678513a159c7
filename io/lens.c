/* SPDX-License-Identifier: MIT */
/* lens.c: fields of view as renderers write them into attributes: a row each. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exr.h"

typedef struct lens_row {
    const char *angle;                   /* in degrees; NULL: from the following two */
    const char *focal_length, *aperture; /* in one unit */
    bool vertical;
} lens_row;

static const lens_row rows[] = {
    {.angle = "fieldOfViewVertical", .vertical = true},
    {.angle = "cameraFov"},     /* V-Ray */
    {.angle = "rs/camera/fov"}, /* Redshift */
    {.angle = "fieldOfViewHorizontal"},
    {.angle = "fieldOfView"},
    {.focal_length = "cameraFocalLength", .aperture = "cameraAperture"}, /* V-Ray */
    {.focal_length = "focalLength", .aperture = "horizontalAperture"},
    {.focal_length = "focal", .aperture = "haperture"}, /* Nuke's names */
};

/* A positive number, whatever type it has. */
static bool find_number(const io__exr *exr, int part, const char *name, double *out)
{
    const exr_attribute_t *found = NULL;
    if (exr_get_attribute_by_name(exr->context, part, name, &found) != EXR_ERR_SUCCESS
        || !found)
        return false;
    if (found->type == EXR_ATTR_FLOAT)
        *out = (double)found->f;
    else if (found->type == EXR_ATTR_DOUBLE)
        *out = found->d;
    else if (found->type == EXR_ATTR_INT)
        *out = found->i;
    else if (found->type == EXR_ATTR_V2F)
        *out = (double)found->v2f->x;
    else
        return false;
    return isfinite(*out) && *out > 0.0;
}

void io__exr_find_lens(const io__exr *exr, int part, io_lens *lens)
{
    static const double degree = 3.14159265358979323846 / 180.0;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const lens_row *row = &rows[i];
        double angle = 0.0, focal_length = 0.0, aperture = 0.0;
        if (row->angle) {
            if (!find_number(exr, part, row->angle, &angle))
                continue;
        } else {
            if (!find_number(exr, part, row->focal_length, &focal_length)
                || !find_number(exr, part, row->aperture, &aperture))
                continue;
            angle = 2.0 * atan(0.5 * aperture / focal_length) / degree;
        }
        if (!(angle < 180.0))
            continue;
        if (row->vertical)
            lens->vfov_rad = (float)(angle * degree);
        else
            lens->hfov_rad = (float)(angle * degree);
        snprintf(lens->source, sizeof lens->source, "%s",
                 row->angle ? row->angle : row->focal_length);
        return;
    }
}

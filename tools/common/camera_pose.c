/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "camera_parse.h"

/* Makes a vector unit; false if it has no direction. */
static bool normalise(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return isfinite(length) && length > 1e-30;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

const char *camera_pose_look_at(const double eye[3], const double target[3],
                                const double up[3], camera_entry *entry)
{
    double *right = entry->to_view, *back = entry->to_view + 6;
    double unit_up[3];
    memcpy(unit_up, up, sizeof unit_up);
    memcpy(entry->eye, eye, sizeof entry->eye);
    memcpy(entry->target, target, sizeof entry->target);
    memcpy(entry->up, up, sizeof entry->up);
    for (int i = 0; i < 3; i++)
        back[i] = eye[i] - target[i];
    if (!normalise(back) || !normalise(unit_up))
        return "its eye is its target, or its up has no length";
    cross(unit_up, back, right);
    if (!normalise(right))
        return "its up lies along the view";
    cross(back, right, entry->to_view + 3);
    entry->has_pose = true;
    return NULL;
}

void camera_pose_aim(camera_entry *entry)
{
    entry->has_pose = true;
    for (int i = 0; i < 3; i++) {
        entry->target[i] = entry->eye[i] - entry->to_view[6 + i];
        entry->up[i] = entry->to_view[3 + i];
    }
}

static bool is_origin_row(const double m[16], int first, int step)
{
    return fabs(m[first]) + fabs(m[first + step]) + fabs(m[first + 2 * step]) < 1e-9
           && fabs(m[first + 3 * step] - 1.0) < 1e-9;
}

/* The matrix for column vectors, whichever it is: translation in the last column. */
static bool stand_up(double m[16])
{
    if (is_origin_row(m, 12, 1))
        return true;
    if (!is_origin_row(m, 3, 4))
        return false;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++) {
            const double kept = m[4 * i + k];
            m[4 * i + k] = m[4 * k + i];
            m[4 * k + i] = kept;
        }
    return true;
}

const char *camera_pose_matrix(double m[16], bool to_world, camera_entry *entry)
{
    double axis[3][3], third[3];
    if (!stand_up(m))
        return "its matrix has no row or column 0, 0, 0, 1";
    /* The columns of camera_to_world, or the rows of world_to_camera. */
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            axis[i][k] = to_world ? m[4 * k + i] : m[4 * i + k];
        if (!normalise(axis[i]))
            return "its matrix is no rotation";
        memcpy(entry->to_view + 3 * i, axis[i], sizeof axis[i]);
    }
    cross(axis[0], axis[1], third);
    for (int k = 0; k < 3; k++)
        if (!(fabs(third[k] - axis[2][k]) < 1e-3))
            return "its matrix is no rotation";
    for (int k = 0; k < 3; k++) {
        entry->eye[k] = to_world ? m[4 * k + 3] : 0.0;
        /* A point maps to the origin; scaled axes, as of a scaled parent, divide. */
        for (int i = 0; i < 3 && !to_world; i++) {
            const double scale = m[4 * i] * axis[i][0] + m[4 * i + 1] * axis[i][1]
                                 + m[4 * i + 2] * axis[i][2];
            entry->eye[k] -= axis[i][k] * m[4 * i + 3] / scale;
        }
    }
    camera_pose_aim(entry);
    return NULL;
}

/* SPDX-License-Identifier: MIT */
#include "motion.h"

#include <math.h>

static const double nearest_pole_rad = 3.14159265358979323846 / 180.0;

typedef struct vector {
    double v[3];
} vector;

/* Unit axes; `up` is the view's own, perpendicular to the other two. */
typedef struct axes {
    vector right, up, forward;
    double distance;
} axes;

static vector cross(vector a, vector b)
{
    return (vector){{a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
                     a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
}

static double dot(vector a, vector b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

static vector along(vector from, vector direction, double length)
{
    for (int i = 0; i < 3; i++)
        from.v[i] += direction.v[i] * length;
    return from;
}

static vector scaled(vector a, double by)
{
    return (vector){{a.v[0] * by, a.v[1] * by, a.v[2] * by}};
}

static vector unit(vector a)
{
    return scaled(a, 1.0 / sqrt(dot(a, a)));
}

static vector from_array(const double a[3])
{
    return (vector){{a[0], a[1], a[2]}};
}

static void to_array(vector a, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a.v[i];
}

static axes axes_of(const scene_view *v)
{
    const vector sight = along(from_array(v->target), from_array(v->eye), -1.0);
    axes a = {.distance = sqrt(dot(sight, sight)), .forward = unit(sight)};
    a.right = unit(cross(a.forward, from_array(v->up)));
    a.up = cross(a.right, a.forward);
    return a;
}

/* `direction` turned by the angles about the view's up and then towards it. */
static vector turned(const scene_view *v, vector direction, double azimuth,
                     double elevation)
{
    const vector up = unit(from_array(v->up));
    const double height = fmax(-1.0, fmin(1.0, dot(direction, up)));
    const vector level = unit(along(direction, up, -height));
    const vector side = cross(up, level);
    const double limit = 0.5 * 3.14159265358979323846 - nearest_pole_rad;
    const double angle = fmax(-limit, fmin(limit, asin(height) + elevation));
    const vector heading = along(scaled(level, cos(azimuth)), side, sin(azimuth));
    return along(scaled(heading, cos(angle)), up, sin(angle));
}

void motion_orbit(scene_view *v, double azimuth, double elevation)
{
    const axes a = axes_of(v);
    const vector out = turned(v, scaled(a.forward, -1.0), azimuth, elevation);
    to_array(along(from_array(v->target), out, a.distance), v->eye);
}

void motion_look(scene_view *v, double azimuth, double elevation)
{
    const axes a = axes_of(v);
    const vector out = turned(v, a.forward, -azimuth, elevation);
    to_array(along(from_array(v->eye), out, a.distance), v->target);
}

static void move(scene_view *v, vector direction, double length)
{
    to_array(along(from_array(v->eye), direction, length), v->eye);
    to_array(along(from_array(v->target), direction, length), v->target);
}

void motion_pan(scene_view *v, double right, double down)
{
    const axes a = axes_of(v);
    const double height = v->projection == CRV_ORTHOGRAPHIC
                              ? (double)v->view_height
                              : 2.0 * a.distance * tan(0.5 * (double)v->vfov_rad);
    move(v, a.right, -right * height);
    move(v, a.up, down * height);
}

void motion_dolly(scene_view *v, double factor)
{
    const axes a = axes_of(v);
    to_array(along(from_array(v->target), a.forward, -a.distance * factor), v->eye);
    v->view_height *= (float)factor;
}

void motion_focus(scene_view *v, const double p[3], double factor)
{
    const axes a = axes_of(v);
    const vector eye = from_array(v->eye);
    const vector at =
        along(along(along(eye, a.right, p[0]), a.up, p[1]), a.forward, -p[2]);
    to_array(at, v->target);
    to_array(along(scaled(at, 1.0 - factor), eye, factor), v->eye);
    v->view_height *= (float)factor;
}

void motion_fly(scene_view *v, double right, double up, double forward)
{
    const axes a = axes_of(v);
    move(v, a.right, right * a.distance);
    move(v, a.up, up * a.distance);
    move(v, a.forward, forward * a.distance);
}

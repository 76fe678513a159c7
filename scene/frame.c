/* SPDX-License-Identifier: MIT */
/*
 * Cameras: axes of a view, a view that shows everything, a radius that suits a view.
 */
#include "internal.h"

#define AZIMUTH_RAD   (30.0 * SCENE_PI / 180.0)
#define ELEVATION_RAD (20.0 * SCENE_PI / 180.0)
#define MARGIN        1.05

static bool finite3(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static vec3 rounded(const double point[3], const double origin[3])
{
    return v3((double)(float)(point[0] - origin[0]),
              (double)(float)(point[1] - origin[1]),
              (double)(float)(point[2] - origin[2]));
}

void scene_local_point(const scene *s, const double world[3], float local[3])
{
    v3_store(rounded(world, s->mesh.origin), local);
}

bool scene_axes_of_view(const scene_view *view, const double origin[3], scene_axes *out)
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    scene_axes a;
    if (!finite3(view->eye) || !finite3(view->target) || !finite3(view->up))
        return false;
    a.eye = rounded(view->eye, origin);
    a.back = v3_normalise(v3_sub(a.eye, rounded(view->target, origin)));
    vec3 side = v3_cross(v3_normalise(rounded(view->up, zero)), a.back);
    /* Zero where eye is target or up is zero, too. */
    if (!(v3_length(side) > 1e-6))
        return false;
    a.right = v3_normalise(side);
    a.up = v3_cross(a.back, a.right);
    *out = a;
    return true;
}

typedef struct box_corners {
    double side[2][8]; /* to the right, up */
    double toward[8];  /* to the viewer */
} box_corners;

/* The box's corners about its centre, in the view's axes. */
static box_corners corners_of_box(const scene *s, const scene_axes *axes)
{
    box_corners box;
    for (int corner = 0; corner < 8; corner++) {
        vec3 r = v3_sub(v3((double)(corner & 1 ? s->upper : s->lower)[0],
                           (double)(corner & 2 ? s->upper : s->lower)[1],
                           (double)(corner & 4 ? s->upper : s->lower)[2]),
                        axes->eye);
        box.side[0][corner] = v3_dot(r, axes->right);
        box.side[1][corner] = v3_dot(r, axes->up);
        box.toward[corner] = v3_dot(r, axes->back);
    }
    return box;
}

/* The smallest distance from which all corners fit between two sides of the picture; half
 * is the tangent of half the angle between them. The eye may move sideways. */
static double fitting_distance(const double side[8], const double toward[8], double half)
{
    double plus = -INFINITY, minus = -INFINITY;
    for (int i = 0; i < 8; i++) {
        plus = fmax(plus, side[i] + half * toward[i]);
        minus = fmax(minus, half * toward[i] - side[i]);
    }
    return 0.5 * (plus + minus) / half;
}

/* How far the eye moves sideways for the box to be in the middle of the picture. */
static double centring_shift(const double side[8], const double toward[8],
                             double distance)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 8; i++) {
        low = fmin(low, side[i]);
        high = fmax(high, side[i]);
    }
    /* Bisection: what is seen moves one way with the eye. */
    for (int round = 0; round < 60; round++) {
        double middle = 0.5 * (low + high), left = INFINITY, right = -INFINITY;
        for (int i = 0; i < 8; i++) {
            left = fmin(left, (side[i] - middle) / (distance - toward[i]));
            right = fmax(right, (side[i] - middle) / (distance - toward[i]));
        }
        if (left + right > 0.0)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

/* A point from the scene's origin, rounded to floats there, in world space. */
static void store_rounded(vec3 local, const scene *s, double world[3])
{
    float point[3];
    v3_store(local, point);
    for (int i = 0; i < 3; i++)
        world[i] = s->mesh.origin[i] + (double)point[i];
}

/* The scene's own view from where this field of view and aspect show as much of it. */
static scene_view fit_own_view(const scene *s, double half_height, double aspect)
{
    scene_view view = s->view;
    vec3 target = v3_from_double(view.target);
    vec3 offset = v3_sub(v3_from_double(view.eye), target);
    double widen = fmax(1.0, (double)s->view_aspect / aspect);
    double closer = tan(0.5 * (double)view.vfov_rad) / half_height;
    if (view.projection == CRV_ORTHOGRAPHIC)
        view.view_height = (float)((double)view.view_height * widen);
    else
        store_rounded(v3_along(target, offset, closer * widen), s, view.eye);
    view.vfov_rad = (float)(2.0 * atan(half_height));
    return view;
}

void scene_frame(const scene *s, float vfov_rad, float aspect, scene_view *out)
{
    vec3 centre = v3(0.5 * ((double)s->lower[0] + (double)s->upper[0]),
                     0.5 * ((double)s->lower[1] + (double)s->upper[1]),
                     0.5 * ((double)s->lower[2] + (double)s->upper[2]));
    vec3 to_eye = v3(cos(ELEVATION_RAD) * sin(AZIMUTH_RAD), sin(ELEVATION_RAD),
                     cos(ELEVATION_RAD) * cos(AZIMUTH_RAD));
    vec3 up = v3(0.0, 1.0, 0.0), right = v3_normalise(v3_cross(up, to_eye));
    scene_axes axes = {centre, right, v3_cross(to_eye, right), to_eye};
    double half_height = tan(0.5 * (double)vfov_rad);
    scene_view view = {.projection = CRV_PERSPECTIVE, .up = {0.0f, 1.0f, 0.0f}};
    if (s->has_view) {
        *out = fit_own_view(s, half_height, (double)aspect);
        return;
    }
    box_corners box = corners_of_box(s, &axes);
    const double distance = fmax(
        fitting_distance(box.side[0], box.toward, half_height * (double)aspect / MARGIN),
        fitting_distance(box.side[1], box.toward, half_height / MARGIN));
    centre = v3_along(centre, right, centring_shift(box.side[0], box.toward, distance));
    centre = v3_along(centre, axes.up, centring_shift(box.side[1], box.toward, distance));
    store_rounded(v3_along(centre, to_eye, distance), s, view.eye);
    store_rounded(centre, s, view.target);
    view.vfov_rad = vfov_rad;
    view.view_height = (float)(2.0 * distance * half_height);
    *out = view;
}

static double rounded_to_two_digits(double value)
{
    double unit = pow(10.0, floor(log10(value)) - 1.0);
    return round(value / unit) * unit;
}

float scene_suggest_radius(const scene *s, const scene_view *view)
{
    vec3 size = v3_sub(v3_from(s->upper), v3_from(s->lower));
    double distance =
        v3_length(v3_sub(v3_from_double(view->eye), v3_from_double(view->target)));
    double height = view->projection == CRV_ORTHOGRAPHIC
                        ? (double)view->view_height
                        : 2.0 * distance * tan(0.5 * (double)view->vfov_rad);
    /* Extents are diagonals: of the square that is as high as the view, and of the box.
     */
    double extent = fmin(sqrt(2.0) * height, v3_length(size));
    if (!(extent > 0.0) || !isfinite(extent))
        extent = v3_length(size);
    return (float)rounded_to_two_digits(extent / 20.0);
}

/* SPDX-License-Identifier: MIT */
#include "tune_work.h"

#include <math.h>

#include "common/motion.h"
#include "common/target.h"

static const double degree = 3.14159265358979323846 / 180.0;

/* What the truth is, whatever the options become. */
static reference_options target(const tune_work *w)
{
    const tune_settings *s = w->s;
    reference_options o = target_of(&w->start);
    o.normals = s->in.view.normals_from.value == 0 ? SCENE_NORMALS_INTERPOLATED
                                                   : SCENE_NORMALS_FACE;
    if (s->truth_radius.given)
        o.radius = (float)s->truth_radius.value;
    if (s->truth_weighting.given || s->truth_falloff.given)
        o.definition = REFERENCE_HEMISPHERE;
    if (s->truth_weighting.given)
        o.weighting = (crv_weighting)s->truth_weighting.value;
    if (s->truth_falloff.given)
        o.falloff = (crv_falloff)s->truth_falloff.value;
    return o;
}

static int trace(tune_work *w, int index)
{
    const tune_settings *s = w->s;
    tune_view *v = &w->view[index];
    const double start = report_seconds();
    char flags[256];
    progress p = progress_begin(w->r, "truth", 0, PROGRESS_SHARES);
    const tune_trace t = {
        .model = w->model,
        .g = &w->cast[index],
        .target = target(w),
        .threads = s->in.view.common.threads.value,
        .rays = s->rays.given          ? s->rays.value
                : s->evaluations.given ? 64
                                       : 0,
        .seconds = w->truth_share * s->time_s.value,
        .stop = tune_work_stop,
        .watch = progress_share,
        .user = &p,
    };
    const int traced = tune_view_trace(v, &t, &w->r->logger);
    progress_end(&p);
    if (traced != 0)
        return EXIT_FAILED;
    if (index == TUNE_FITTED)
        w->truth_s = report_seconds() - start;
    if (index == TUNE_FITTED)
        report_info(w->r, "truth: crevice reference%s",
                    target_flags(&t.target, flags, sizeof flags));
    report_info(w->r, "truth: %d pixels, %d rays each, standard error %.3f: %.2f s",
                v->count, v->rays, sqrt(v->noise), report_seconds() - start);
    return EXIT_DONE;
}

/* Casts a view and lists its surfaces. */
static int cast(tune_work *w, const view_settings *s, int index)
{
    scene_gbuffer *g = &w->cast[index];
    const int result = view_render(s, w->model, false, g, w->r);
    if (result != EXIT_DONE)
        return result;
    if (!report_ok(w->r, scene_gbuffer_upload(g, w->e.context, &w->gbuffer[index]),
                   "G-buffer"))
        return EXIT_FAILED;
    return tune_view_open(&w->view[index], w->e.context, w->gbuffer[index], &g->desc,
                          g->depth[0], TUNE_PIXELS)
               ? EXIT_DONE
               : report_no_memory(w->r);
}

int tune_mesh_load(tune_work *w)
{
    const tune_settings *s = w->s;
    int result = view_check(&s->in.view, w->r);
    w->truth_share = 0.2;
    if (result == EXIT_DONE)
        result = view_load(&s->in.view, &w->model, w->r);
    if (result == EXIT_DONE)
        result = cast(w, &s->in.view, TUNE_FITTED);
    if (result != EXIT_DONE)
        return result;
    if (!s->in.view.common.radius_given) {
        w->start.radius = scene_suggest_radius(w->model, &w->cast[TUNE_FITTED].view);
        report_info(w->r, "radius: --radius %g, chosen to suit the view",
                    (double)w->start.radius);
    }
    result = trace(w, TUNE_FITTED);
    if (result == EXIT_DONE && w->view[TUNE_FITTED].count > 0
        && tune_view_is_open(&w->view[TUNE_FITTED])) {
        report_error(w->r,
                     "%s: nothing in view is occluded within the radius %g; give a "
                     "larger --radius",
                     s->in.view.model, (double)w->start.radius);
        return EXIT_FAILED;
    }
    return result;
}

static arg_vector vector_of(const double v[3])
{
    return (arg_vector){.given = true, .value = {v[0], v[1], v[2]}};
}

int tune_mesh_other(tune_work *w, bool *shows)
{
    const tune_settings *s = w->s;
    view_settings other = s->in.view;
    scene_view v = w->cast[TUNE_FITTED].view;
    if (!s->check_eye.given && !(fabs(s->check_orbit_deg.value) > 0.0))
        return EXIT_DONE;
    if (!s->check_eye.given)
        motion_orbit(&v, s->check_orbit_deg.value * degree, 0.0);
    other.camera = NULL;
    other.eye = s->check_eye.given ? s->check_eye : vector_of(v.eye);
    other.target = vector_of(v.target);
    other.up = vector_of(v.up);
    other.vfov_deg = (arg_number){.given = v.projection == CRV_PERSPECTIVE,
                                  .value = (double)v.vfov_rad / degree};
    other.ortho = (arg_number){.given = v.projection == CRV_ORTHOGRAPHIC,
                               .value = (double)v.view_height};
    int result = cast(w, &other, TUNE_OTHER);
    *shows = result == EXIT_DONE && w->view[TUNE_OTHER].count > 0;
    if (*shows)
        result = trace(w, TUNE_OTHER);
    return result;
}

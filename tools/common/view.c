/* SPDX-License-Identifier: MIT */
#include "view.h"

#include "camera_file.h"
#include "exact.h"
#include "nearest.h"
#include "progress.h"
#include "system/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180.0;

/* What importers read: OBJ 19e6 and glTF 40e6 bytes a second, in 2024 on one processor.
 * Between lines that they still do: */
#define READ_BYTES_PER_SECOND 2e7
#define WAIT_SECONDS          10.0

/* In the order of crv_layers. */
static const char *const layer_kinds[] = {"surfaces", "solid", NULL};
static const char *const normal_kinds[] = {"interpolated", "face", NULL};

static const arg camera_rows[] = {VIEW_CAMERA_ROWS(
    NULL, "45",
    "a camera of the model (glTF, FBX, ...), by its name or its number from 1, or a file "
    "of one camera, .json or .chan, instead of --eye, --target and --up")};
const arg_table view_camera =
    ARG_TABLE("Camera (framed by itself without these)", camera_rows);

static const arg buffer_rows[] = {
    {.name = "--layers",
     .value = "N",
     ARG_RANGE(1, CRV_MAX_LAYERS),
     .initial = "1",
     ARG_INTO(ARG_INT, view_settings, layers),
     .help = "depth layers: further ones occlude from behind the first surface. A second "
             "one can halve the error if near things hide far ones; `crevice methods` "
             "says who reads it"},
    {.name = "--layer-kind",
     .value = "KIND",
     .initial = "surfaces",
     .choices = layer_kinds,
     ARG_INTO(ARG_CHOICE, view_settings, layer_kind),
     .help = "surfaces: each further layer is the next surface; solid: layers alternate "
             "between fronts and backs of solids, which occlude in between only"},
    {.name = "--normals-from",
     .value = "KIND",
     .initial = "interpolated",
     .choices = normal_kinds,
     ARG_INTO(ARG_CHOICE, view_settings, normals_from),
     .help = "normals of the mesh's vertices, or of its triangles"},
    {.name = "--guard-px",
     .value = "N",
     ARG_RANGE(0, CRV_MAX_SIZE),
     .unit = "px",
     ARG_INTO(ARG_INT, view_settings, guard_px),
     .computed = "a tenth of the height",
     .help = "width of the guard band: a margin beyond each border of the picture that "
             "occludes but gets no result; with 0 occlusion fades at the borders"},
};
const arg_table view_buffers = ARG_TABLE("Buffers", buffer_rows);

int32_t view_guard_px(const view_settings *s)
{
    return s->guard_px.given ? s->guard_px.value : (s->size.height + 9) / 10;
}

static const char *builtin_name(const char *model)
{
    return strncmp(model, "builtin:", 8) == 0 ? model + 8 : NULL;
}

int view_check(const view_settings *s, report *r)
{
    int64_t guard = view_guard_px(s);
    const double *up = s->up.value;
    if (s->camera && (s->eye.given || s->target.given || s->up.given)) {
        report_error(r, "--camera: contradicts --eye, --target and --up; give one or the "
                        "other");
        return EXIT_USAGE;
    }
    if (s->vfov_deg.given && s->ortho.given) {
        report_error(r, "--ortho: contradicts --vfov; give one of them");
        return EXIT_USAGE;
    }
    if (s->size.width + 2 * guard > CRV_MAX_SIZE
        || s->size.height + 2 * guard > CRV_MAX_SIZE) {
        report_error(
            r,
            "--guard-px: %d px on each side make more than %d px; give a smaller "
            "--size or --guard-px",
            (int32_t)guard, CRV_MAX_SIZE);
        return EXIT_USAGE;
    }
    if (s->up.given && !(fabs(up[0]) + fabs(up[1]) + fabs(up[2]) > 0.0)) {
        report_error(r, "--up: has no length; give a direction such as 0,1,0");
        return EXIT_USAGE;
    }
    if (builtin_name(s->model)
        && scene_builtin_check(builtin_name(s->model), &r->logger) != 0)
        return EXIT_USAGE;
    return EXIT_DONE;
}

/* While a model is read: nobody knows how far its importer has come. */
typedef struct waiting {
    report *r;
    const char *model;
    double told;
} waiting;

static void tell_waiting(void *user, double seconds)
{
    waiting *w = user;
    if (seconds - w->told < WAIT_SECONDS)
        return;
    w->told = seconds;
    report_info(w->r, "%s: is being read, %.0f s so far", w->model, seconds);
}

int view_load(const view_settings *s, scene **out, report *r)
{
    waiting w = {.r = r, .model = s->model};
    const scene_limits limits = {
        .timeout_s = s->import_timeout_s.value, .waits = tell_waiting, .user = &w};
    const char *name = builtin_name(s->model);
    const double start = report_seconds();
    file_facts facts;
    if (!name && file_look(s->model, &facts))
        progress_announce(r, s->model, (double)facts.size / READ_BYTES_PER_SECOND);
    const int result = name ? scene_builtin(name, out, &r->logger)
                            : scene_load_limited(s->model, &limits, out, &r->logger);
    if (result != 0)
        return EXIT_FAILED;
    report_info(r, "%s: %lld triangles, %.2f s", s->model,
                (long long)scene_triangle_count(*out), report_seconds() - start);
    return EXIT_DONE;
}

static void copy3(double to[3], const double from[3])
{
    memcpy(to, from, 3 * sizeof *to);
}

void view_cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

double view_up_slant(const scene_view *v)
{
    double d[3], up[3], cross[3], d2 = 0.0, up2 = 0.0, cross2 = 0.0;
    for (int i = 0; i < 3; i++) {
        d[i] = (double)v->target[i] - (double)v->eye[i];
        up[i] = (double)v->up[i];
        d2 += d[i] * d[i];
        up2 += up[i] * up[i];
    }
    view_cross(d, up, cross);
    for (int i = 0; i < 3; i++)
        cross2 += cross[i] * cross[i];
    return cross2 / (d2 * up2);
}

/* By its name, else by its number; NULL: there is none. */
static const scene_camera *find_camera(const scene *model, const char *name)
{
    char *end;
    for (int32_t i = 0; i < scene_camera_count(model); i++)
        if (strcmp(scene_camera_at(model, i)->name, name) == 0)
            return scene_camera_at(model, i);
    const long number = strtol(name, &end, 10);
    return *end == '\0' && number >= 1 && number <= scene_camera_count(model)
               ? scene_camera_at(model, (int32_t)number - 1)
               : NULL;
}

static int refuse_camera(const view_settings *s, const scene *model, report *r)
{
    char names[400] = "";
    size_t used = 0;
    for (int32_t i = 0; i < scene_camera_count(model) && used < sizeof names; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s",
                                 i > 0 ? ", " : "", scene_camera_at(model, i)->name);
    if (names[0])
        report_error(r, "%s: has no camera \"%s\"; choose one of %s", s->model, s->camera,
                     names);
    else
        report_error(r, "%s: has no camera; give --eye and --target", s->model);
    return EXIT_FAILED;
}

/* What was told of is the width that is seen. */
static float vfov_of(const view_settings *s, double hfov_rad)
{
    return (float)(2.0
                   * atan(tan(0.5 * hfov_rad) * (double)s->size.height
                          / (double)s->size.width));
}

static int read_camera(const view_settings *s, scene_view *v, report *r)
{
    camera_file file;
    int result = camera_file_load(s->camera, CAMERA_FILE_ZXY, &file, r);
    if (result != EXIT_DONE)
        return result;
    const camera_entry *entry = &file.entries[0];
    if (file.count > 1 || !entry->has_pose) {
        report_error(r, "--camera: %s %s; name a file of one camera", s->camera,
                     file.count > 1 ? "holds several cameras"
                                    : "does not say where its camera stands");
        result = EXIT_USAGE;
    }
    for (int i = 0; i < 3 && result == EXIT_DONE; i++) {
        v->eye[i] = entry->eye[i];
        v->target[i] = entry->target[i];
        v->up[i] = entry->up[i];
    }
    v->projection = entry->view_height > 0.0 ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE;
    if (entry->view_height > 0.0)
        v->view_height = (float)entry->view_height;
    if (entry->vfov_rad > 0.0)
        v->vfov_rad = (float)entry->vfov_rad;
    if (entry->hfov_rad > 0.0)
        v->vfov_rad = vfov_of(s, entry->hfov_rad);
    camera_file_free(&file);
    return result;
}

static int choose_camera(const view_settings *s, const scene *model, scene_view *v,
                         report *r)
{
    const scene_camera *camera = find_camera(model, s->camera);
    if (!camera && camera_file_is_named(s->camera))
        return read_camera(s, v, r);
    if (!camera)
        return refuse_camera(s, model, r);
    *v = camera->view;
    const bool has_lens =
        v->projection != CRV_PERSPECTIVE || v->vfov_rad > 0.0f || camera->hfov_rad > 0.0f;
    if (!has_lens && !s->vfov_deg.given && !s->ortho.given) {
        report_error(r,
                     "--camera: %s does not say the field of view of \"%s\" (its focal "
                     "length is not read); add --vfov",
                     s->model, camera->name);
        return EXIT_FAILED;
    }
    if (camera->hfov_rad > 0.0f)
        v->vfov_rad = vfov_of(s, (double)camera->hfov_rad);
    return EXIT_DONE;
}

int view_choose(const view_settings *s, const scene *model, scene_view *v, report *r)
{
    const float vfov = (float)((s->vfov_deg.given ? s->vfov_deg.value : 45.0) * degree);
    double lower[3], upper[3];
    scene_frame(model, vfov, (float)s->size.width / (float)s->size.height, v);
    const int result = s->camera ? choose_camera(s, model, v, r) : EXIT_DONE;
    if (result != EXIT_DONE)
        return result;
    scene_bounds(model, lower, upper);
    for (int i = 0; i < 3; i++) {
        const double offset = v->eye[i] - v->target[i];
        if (s->target.given)
            v->target[i] = s->target.value[i];
        else if (s->eye.given)
            v->target[i] = 0.5 * (lower[i] + upper[i]);
        v->eye[i] = s->eye.given ? s->eye.value[i]
                                 : (s->target.given ? v->target[i] + offset : v->eye[i]);
    }
    if (s->eye.given || s->target.given)
        copy3(v->up, (const double[3]){0.0, 1.0, 0.0});
    if (s->up.given)
        copy3(v->up, s->up.value);
    if (s->vfov_deg.given || s->ortho.given)
        v->projection = s->ortho.given ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE;
    if (s->vfov_deg.given)
        v->vfov_rad = vfov;
    if (s->ortho.given)
        v->view_height = (float)s->ortho.value;
    if (isnan(view_up_slant(v))) {
        report_error(r, "--eye: is the same point as the target; move one of them");
        return EXIT_USAGE;
    }
    if (view_up_slant(v) > 1e-10)
        return EXIT_DONE;
    if (s->up.given) {
        report_error(r, "--up: lies along the view; give another direction");
        return EXIT_USAGE;
    }
    copy3(v->up, (const double[3]){0.0, 0.0, -1.0});
    return EXIT_DONE;
}

bool view_shows_something(const scene_gbuffer *g)
{
    const crv_gbuffer_desc *d = &g->desc;
    for (int32_t y = d->guard_top; y < d->height - d->guard_bottom; y++)
        for (int32_t x = d->guard_left; x < d->width - d->guard_right; x++)
            if (isfinite(g->depth[0][(size_t)y * (size_t)d->width + (size_t)x]))
                return true;
    return false;
}

int view_render(const view_settings *s, const scene *model, bool texture_frames,
                scene_gbuffer *out, report *r)
{
    scene_gbuffer_request request = {
        .width = s->size.width,
        .height = s->size.height,
        .guard_px = view_guard_px(s),
        .layers = s->layers.value,
        .layer_kind = (crv_layers)s->layer_kind.value,
        .normals =
            s->normals_from.value == 0 ? SCENE_NORMALS_INTERPOLATED : SCENE_NORMALS_FACE,
        .threads = s->common.threads.value,
        .texture_frames = texture_frames,
    };
    const double start = report_seconds();
    char camera[384];
    const int result = view_choose(s, model, &request.view, r);
    if (result != EXIT_DONE)
        return result;
    report_info(r, "camera: %s", exact_view(model, &request.view, camera));
    progress p = progress_begin(r, "G-buffer", 0, request.height + 2 * request.guard_px);
    request.watch = progress_rows;
    request.user = &p;
    const int cast = scene_render_gbuffer(model, &request, out, &r->logger);
    progress_end(&p);
    if (cast != 0)
        return EXIT_FAILED;
    if (!view_shows_something(out))
        report_warning(
            r,
            "%s: nothing of it is in view; change --eye, --target or --vfov, or "
            "leave them out to have it framed",
            s->model);
    report_info(r, "G-buffer %dx%d, guard band %d px, layers %d: %.2f s", s->size.width,
                s->size.height, request.guard_px, request.layers,
                report_seconds() - start);
    return EXIT_DONE;
}

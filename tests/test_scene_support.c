/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "test_scene_support.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void catch (void *user, crv_log_level level, const char *line)
{
    messages *m = user;
    if (level == CRV_LOG_ERROR) {
        m->errors++;
        snprintf(m->error, sizeof m->error, "%s", line);
    } else if (level == CRV_LOG_WARNING) {
        m->warnings++;
        snprintf(m->warning, sizeof m->warning, "%s", line);
    }
}

crv_logger catch_messages(messages *m)
{
    memset(m, 0, sizeof *m);
    return (crv_logger){catch, m};
}

void assert_error_line(const messages *m, const char *name)
{
    const char *cure = strchr(m->error, ';');
    assert_int_equal(m->errors, 1);
    assert_int_equal(strncmp(m->error, name, strlen(name)), 0);
    assert_int_equal(strncmp(m->error + strlen(name), ": ", 2), 0);
    assert_non_null(cure);
    assert_true(strlen(cure) > 5);
    assert_null(strchr(m->error, '\n'));
}

const char *test_folder(void)
{
    static char folder[64];
    if (!folder[0]) {
        strcpy(folder, "/tmp/crevice-scene-XXXXXX");
        assert_non_null(mkdtemp(folder));
    }
    return folder;
}

const char *write_file(const char *name, const void *data, size_t size)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", test_folder(), name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

const char *write_text(const char *name, const char *text)
{
    return write_file(name, text, strlen(text));
}

int remove_files(void **state)
{
    (void)state;
    char path[512];
    DIR *folder = opendir(test_folder());
    struct dirent *entry;
    assert_non_null(folder);
    while ((entry = readdir(folder))) {
        snprintf(path, sizeof path, "%s/%.255s", test_folder(), entry->d_name);
        if (entry->d_name[0] != '.')
            unlink(path);
    }
    closedir(folder);
    rmdir(test_folder());
    return 0;
}

scene *load_text(const char *name, const char *text)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene *s = NULL;
    assert_int_equal(scene_load(write_text(name, text), &s, &log), 0);
    assert_int_equal(m.errors + m.warnings, 0);
    return s;
}

scene_view look(crv_projection projection, const double eye[3], const double target[3],
                double view_height)
{
    scene_view view = {.projection = projection,
                       .up = {0.0f, 1.0f, 0.0f},
                       .vfov_rad = (float)(45.0 * PI / 180.0),
                       .view_height = (float)view_height};
    for (int i = 0; i < 3; i++) {
        view.eye[i] = (double)(float)eye[i];
        view.target[i] = (double)(float)target[i];
    }
    return view;
}

scene_gbuffer_request request_of(const scene_view *view, int32_t width, int32_t height)
{
    return (scene_gbuffer_request){
        .view = *view, .width = width, .height = height, .layers = 1};
}

scene_gbuffer render(const scene *s, const scene_gbuffer_request *request)
{
    messages m;
    crv_logger log = catch_messages(&m);
    scene_gbuffer g;
    assert_int_equal(scene_render_gbuffer(s, request, &g, &log), 0);
    assert_int_equal(m.errors + m.warnings, 0);
    return g;
}

double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross_unit(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    const double length = sqrt(dot(out, out));
    for (int i = 0; i < 3; i++)
        out[i] /= length;
}

static void axes_of(const scene_view *v, double right[3], double up[3], double back[3])
{
    double given[3];
    for (int i = 0; i < 3; i++) {
        back[i] = (double)v->eye[i] - (double)v->target[i];
        given[i] = (double)v->up[i];
    }
    const double length = sqrt(dot(back, back));
    for (int i = 0; i < 3; i++)
        back[i] /= length;
    cross_unit(given, back, right);
    cross_unit(back, right, up);
}

ray ray_of_pixel(const scene_gbuffer *g, int32_t x, int32_t y)
{
    double right[3], up[3], back[3];
    double u = ((double)x + 0.5 - (double)g->camera.cx_px) / (double)g->camera.fx_px;
    double v = -((double)y + 0.5 - (double)g->camera.cy_px) / (double)g->camera.fy_px;
    bool parallel = g->view.projection == CRV_ORTHOGRAPHIC;
    ray r;
    axes_of(&g->view, right, up, back);
    for (int i = 0; i < 3; i++) {
        double offset = u * right[i] + v * up[i];
        r.origin[i] = (double)g->view.eye[i] + (parallel ? offset : 0.0);
        r.direction[i] = -back[i] + (parallel ? 0.0 : offset);
    }
    return r;
}

void to_world(const scene_gbuffer *g, const float view[3], double world[3])
{
    double axis[3][3];
    axes_of(&g->view, axis[0], axis[1], axis[2]);
    for (int i = 0; i < 3; i++) {
        world[i] = 0.0;
        for (int k = 0; k < 3; k++)
            world[i] += axis[k][i] * (double)view[k];
    }
}

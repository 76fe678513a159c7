/* SPDX-License-Identifier: MIT */
#include "command_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/exact.h"
#include "common/option_text.h"
#include "common/target.h"
#include "common/text.h"

static const double degree = 3.14159265358979323846 / 180.0;

/* As one word of a shell. */
static void append_word(char out[COMMAND_SIZE], const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                        "_-./:,=+@%";
    if (word[0] != '\0' && strspn(word, plain) == strlen(word)) {
        append_to(out, COMMAND_SIZE, "%s", word);
        return;
    }
    append_to(out, COMMAND_SIZE, "'");
    for (; *word != '\0'; word++)
        append_to(out, COMMAND_SIZE, *word == '\'' ? "'\\''" : "%c", *word);
    append_to(out, COMMAND_SIZE, "'");
}

static void append_device(char out[COMMAND_SIZE], const common_settings *c)
{
    if (c->device) {
        append_to(out, COMMAND_SIZE, " --device ");
        append_word(out, c->device);
    }
    if (c->exact)
        append_to(out, COMMAND_SIZE, " --exact");
}

/* What of the G-buffer is not as it is by itself. */
static void append_mesh(char out[COMMAND_SIZE], const source *s, const wish *w)
{
    const view_settings *v = s->settings;
    char camera[384];
    append_word(out, v->model);
    append_to(out, COMMAND_SIZE, " --size %dx%d %s", w->width, w->height,
              exact_view(s->model, &w->view, camera));
    if (v->layers.value > 1)
        append_to(out, COMMAND_SIZE, " --layers %d", v->layers.value);
    if (v->layer_kind.value != CRV_LAYERS_SURFACES)
        append_to(out, COMMAND_SIZE, " --layer-kind solid");
    if (v->normals_from.value != 0)
        append_to(out, COMMAND_SIZE, " --normals-from face");
    if (v->guard_px.given)
        append_to(out, COMMAND_SIZE, " --guard-px %d", v->guard_px.value);
}

static void append_number(char out[COMMAND_SIZE], const char *flag, const arg_number *n)
{
    if (n->given)
        append_to(out, COMMAND_SIZE, " %s %.9g", flag, n->value);
}

static void append_text(char out[COMMAND_SIZE], const char *flag, const char *text)
{
    if (!text)
        return;
    append_to(out, COMMAND_SIZE, " %s ", flag);
    append_word(out, text);
}

static void append_passes(char out[COMMAND_SIZE], const pass_settings *p)
{
    append_text(out, "--depth", p->depth);
    append_text(out, "--normal", p->normal);
    append_text(out, "--normal-flip", p->normal_flip);
    if (p->normal_space.given)
        append_text(out, "--normal-space", pass_spaces[p->normal_space.value]);
    if (p->depth_encoding.given)
        append_text(out, "--depth-encoding", pass_encoding(p->depth_encoding.value));
    append_number(out, "--near", &p->z_near);
    append_number(out, "--far", &p->z_far);
    append_number(out, "--background", &p->background);
}

/* A field of view that was found is told as it is: one frame need not find it again. */
static void append_camera(char out[COMMAND_SIZE], const source *s)
{
    const frame_camera_settings *c = &s->camera;
    char number[32];
    append_text(out, "--camera", c->file);
    if (c->order.given)
        append_text(out, "--camera-order", camera_file_orders[c->order.value]);
    if (c->vfov_deg.given && isnan(c->vfov_deg.value))
        append_to(out, COMMAND_SIZE, " --vfov %s",
                  s->request.vfov_rad > 0.0f
                      ? exact_number(s->request.vfov_rad, degree, number)
                      : "fit");
    else if (c->vfov_deg.given)
        append_to(out, COMMAND_SIZE, " --vfov %s",
                  exact_number((float)c->vfov_deg.value, 1.0, number));
    append_number(out, "--hfov", &c->hfov_deg);
    append_number(out, "--lens", &c->lens_mm);
    append_number(out, "--sensor", &c->sensor_mm);
    if (c->ortho.given)
        append_to(out, COMMAND_SIZE, " --ortho %s",
                  exact_number((float)c->ortho.value, 1.0, number));
}

static void append_frame(char out[COMMAND_SIZE], const source *s, const wish *w)
{
    const view_settings *v = s->settings;
    char path[4096];
    const char *name = source_frame_name(s, w->frame, path, sizeof path);
    append_word(out, name ? name : v->model);
    append_camera(out, s);
    if (v->layer_kind.given)
        append_text(out, "--layer-kind", v->layer_kind.value == 0 ? "surfaces" : "solid");
    append_passes(out, s->passes);
}

/* The accessibility of a half to a file named `output`. */
static void append_content(char out[COMMAND_SIZE], const source *s, const wish *w,
                           int half, const char *shade, const char *output)
{
    const half_wish *own = &w->half[half];
    char flags[OPTION_TEXT_SIZE];
    if (own->content == HALF_TRUTH) {
        const reference_options target = wish_target(w, half);
        append_to(out, COMMAND_SIZE, "crevice reference ");
        append_mesh(out, s, w);
        append_to(out, COMMAND_SIZE, "%s --rays 1024",
                  target_flags(&target, flags, sizeof flags));
    } else {
        append_to(out, COMMAND_SIZE, "crevice %s ", s->model ? "render" : "ao");
        if (s->model)
            append_mesh(out, s, w);
        else
            append_frame(out, s, w);
        append_to(out, COMMAND_SIZE, "%s", option_flags(&own->options, flags));
        append_device(out, &s->settings->common);
        append_to(out, COMMAND_SIZE, "%s", shade);
    }
    append_to(out, COMMAND_SIZE, " -o %s", output);
}

/* The frame's picture is named as a layer if it is one. */
static void append_apply(char out[COMMAND_SIZE], const source *s)
{
    char names[3 * IO_NAME_SIZE];
    const size_t length = strlen(s->beauty[0]);
    if (length > 2 && s->beauty[0][length - 2] == '.')
        snprintf(names, sizeof names, "%.*s", (int)(length - 2), s->beauty[0]);
    else
        snprintf(names, sizeof names, "%s,%s,%s", s->beauty[0], s->beauty[1],
                 s->beauty[2]);
    append_text(out, "--apply", names);
}

static const char *reason(const source *s, const wish *w, int half)
{
    const half_wish *own = &w->half[half];
    const bool difference = own->look == LOOK_DIFFERENCE;
    for (int i = 0; i < HALVES; i++)
        if ((i == half || difference) && !s->model && w->half[i].content == HALF_TRUTH)
            return "# no command traces rays through the depth of a frame";
    if (own->look == LOOK_LIT && own->content == HALF_TRUTH)
        return "# no command lights a mesh with its ray-traced accessibility";
    if (own->content == HALF_OPEN && own->look == LOOK_ACCESSIBILITY)
        return "# every pixel is 1";
    if (own->content == HALF_OPEN && own->look == LOOK_LIT && !s->model)
        return "# the frame's picture as it is";
    if (difference
        && (w->half[0].content == HALF_OPEN || w->half[1].content == HALF_OPEN))
        return "# one half is 1 everywhere: there is no file to compare with";
    return NULL;
}

const char *command_text(const source *s, const wish *w, int half, char out[COMMAND_SIZE])
{
    const half_wish *own = &w->half[half];
    const char *why = reason(s, w, half);
    out[0] = '\0';
    if (why) {
        append_to(out, COMMAND_SIZE, "%s", why);
    } else if (own->look == LOOK_DIFFERENCE) {
        append_content(out, s, w, 0, "", "left.exr");
        append_to(out, COMMAND_SIZE, " && ");
        append_content(out, s, w, 1, "", "right.exr");
        append_to(out, COMMAND_SIZE,
                  " && crevice compare left.exr right.exr --heat-scale %.6g --heat-map "
                  "difference.png",
                  w->heat_scale);
    } else if (own->look == LOOK_LIT && !s->model && s->has_beauty) {
        char apply[COMMAND_SIZE] = "";
        append_apply(apply, s);
        append_content(out, s, w, half, apply, "lit.exr");
    } else if (own->look == LOOK_LIT && s->model) {
        append_content(out, s, w, half,
                       own->content == HALF_OPEN ? " --shade lit-no-ao" : " --shade lit",
                       "lit.png");
    } else {
        append_content(out, s, w, half, "",
                       own->content == HALF_TRUTH ? "truth.exr" : "ao.png");
    }
    return out;
}

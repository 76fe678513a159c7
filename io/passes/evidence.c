/* SPDX-License-Identifier: MIT */
#include "evidence.h"

#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "trial.h"

/* A radial distance needs no number that the file does not hold: it is taken. Others are
 * named, for the user to say. */
static bool is_taken(const io__court *c, const io__trial *better, const io__trial *first)
{
    if (!c->has_normals)
        return false;
    if (better->guess != first->guess)
        return true;
    return better->format.encoding == CRV_DEPTH_RADIAL && !c->request->encoding_given
           && first->format.encoding == CRV_DEPTH_PLANAR;
}

/* How to say that the other trial is right. */
static const char *remedy_of(const io__court *c, const io__trial *first,
                             const io__trial *better)
{
    const io_passes_remedies *remedies = &c->request->remedies;
    if (better->format.encoding == first->format.encoding)
        return remedies->vfov ? remedies->vfov : "check the field of view";
    return remedies->encoding ? remedies->encoding : "check the depth's encoding";
}

/* Share of the pairs. Frames whose passes belong together had 0.02 at 1280x720, and 0.08
 * at 96x54, where grass is as fine as a pixel; one that is upside down had 0.1. */
#define CONTRARY_SHARE 0.09

static void tell_contradiction(const io__court *c, const io__trial *first,
                               const io__trial *better, bool found, bool taken)
{
    const double deviation = first->reading.deviation;
    if (found && !c->has_normals)
        io__warn(c->log, c->path, "walls and floors would come out flat if %s; %s",
                 better->text, remedy_of(c, first, better));
    else if (taken)
        io__warn(c->log, c->path,
                 "it is read as if %s: then normals and depth agree to %.1f degrees, "
                 "otherwise to %.1f; %s",
                 better->text, better->reading.deviation, deviation,
                 remedy_of(c, first, better));
    else if (found)
        io__warn(c->log, c->path,
                 "normals and depth disagree by %.1f degrees, but by %.1f if %s; %s",
                 deviation, better->reading.deviation, better->text,
                 remedy_of(c, first, better));
    else if (c->has_normals && deviation > IO__SUSPICIOUS && deviation <= IO__WORST)
        io__warn(
            c->log, c->path,
            "normals and depth disagree by %.1f degrees in any encoding and field of "
            "view: bump maps do that, and depth under depth of field or motion blur, "
            "which must be rendered without either; so do normals of another frame",
            deviation);
    else if (c->has_normals && first->reading.contrary > CONTRARY_SHARE
             && deviation <= IO__WORST)
        io__warn(c->log, c->path,
                 "normals and depth disagree by more than 20 degrees on %.0f %% of the "
                 "surfaces: are they of the same frame, and neither upside down?",
                 100.0 * first->reading.contrary);
}

static int look_further(const io__court *c, const io__camera_guess *cameras, int count,
                        io__trial *t, bool *encoding_told)
{
    io__trial better = {0};
    bool found = false;
    if (io__try_encodings(c, t, &better, &found)
        || io__try_cameras(c, cameras, count, t, &better, &found))
        return -1;
    const bool taken = found && is_taken(c, &better, t);
    tell_contradiction(c, t, &better, found, taken);
    *encoding_told = found && better.format.encoding != t->format.encoding;
    if (taken)
        *t = better;
    return 0;
}

/* What to do if depth cannot tell the space of the normals. */
static io__reading settle_without_pairs(const io__court *c,
                                        const io__camera_guess *camera)
{
    io__reading reading = {.id = IO__READ_METADATA};
    memcpy(reading.turn, camera->to_view, sizeof reading.turn);
    if (camera->has_rotation && c->request->normal_space != IO_NORMALS_VIEW) {
        io__info(c->log, c->path,
                 "normals: taken as world space, rotation from the camera (too few "
                 "pixels to check)");
        return reading;
    }
    if (c->request->normal_space != IO_NORMALS_VIEW)
        io__warn(c->log, c->path,
                 "normals are ignored: too few smooth pixels to find the space that they "
                 "are in; %s",
                 c->request->remedies.normal_space ? c->request->remedies.normal_space
                                                   : "say which one it is");
    return (io__reading){0};
}

static io__reading as_given_view(void)
{
    return (io__reading){.id = IO__READ_VIEW,
                         .text = "view space",
                         .turn = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                         .decided = true};
}

static void settle_reading(const io__court *c, io__trial *t)
{
    if (!c->has_normals)
        return;
    io__reading *reading = &t->reading;
    if (c->request->normal_space == IO_NORMALS_VIEW) {
        if (reading->id && reading->id != IO__READ_VIEW)
            io__warn(
                c->log, c->path,
                "normals are said to be in view space, but agree with depth as %s; %s",
                reading->text,
                c->request->remedies.normal_flip ? c->request->remedies.normal_flip
                                                 : "check their axes");
        *reading = as_given_view();
        return;
    }
    if (reading->id == 0) {
        *reading = settle_without_pairs(c, t->guess);
        return;
    }
    if (reading->deviation > IO__WORST) {
        io__warn(c->log, c->path,
                 "normals are ignored: whatever space they are taken in, they do not "
                 "agree with depth (by %.0f degrees); check the field of view and the "
                 "depth's encoding",
                 reading->deviation);
        *reading = (io__reading){0};
        return;
    }
    if (c->request->pose.given && reading->id >= IO__READ_FITTED && !c->request->is_later)
        io__warn(c->log, c->path,
                 "the given camera is turned otherwise than normals and depth say; their "
                 "rotation is used; check the file of the camera and the order of its "
                 "rotations");
    io__info(c->log, c->path, "normals: %s (deviation %.1f degrees)", reading->text,
             reading->deviation);
}

/* A frame that is noise has no surfaces to be judged by. */
static void tell_of_noise(const io__court *c, const io__trial *t)
{
    const double largest = 5e-4; /* a step of half floats; surfaces stay far below */
    const crv_const_image given = crv_image_const(c->frame->depth[0]);
    if (c->request->is_later
        || crv_depth_convert(&given, &t->format, &t->camera, &c->planar, c->log)
               != CRV_OK)
        return;
    const double noise = io__surface_noise(&c->planar);
    if (noise > largest)
        io__warn(
            c->log, c->path,
            "depth is noise: it jumps by %.2g %% from pixel to pixel, as under depth "
            "of field or motion blur; render it without either",
            100.0 * noise);
}

/* A later frame may have been seen with another lens than the first. */
static bool tell_of_zoom(const io__court *c, const io__trial *t)
{
    io__trial better = {0};
    bool found = false;
    const double deviation = t->reading.deviation;
    if (!c->has_normals || c->request->zoom_told || deviation < IO__SUSPICIOUS
        || deviation < 2.0 * c->request->usual_deviation
        || io__try_cameras(c, NULL, 0, t, &better, &found) || !found)
        return false;
    io__warn(c->log, c->path,
             "normals and depth disagree by %.1f degrees, unlike in the shot's first "
             "frame, but by %.1f if %s: the shot zooms, perhaps; %s",
             deviation, better.reading.deviation, better.text,
             c->request->remedies.camera ? c->request->remedies.camera
                                         : "give each frame's field of view");
    return true;
}

static int judge(const io__court *c, const crv_depth_format *format,
                 const io__camera_guess *cameras, int count, io__verdict *out)
{
    out->encoding_told = false;
    io__trial t = {.camera = cameras[0].camera, .guess = &cameras[0], .format = *format};
    if (cameras[0].needs_lens ? io__fit_focal_length(c, &t) : io__try(c, &t))
        return -1;
    for (int i = 1; i < count && c->has_normals; i++) {
        io__trial other = t;
        other.camera = cameras[i].camera;
        other.guess = &cameras[i];
        if (io__try(c, &other))
            return -1;
        if (io__is_better(c, &other, &t))
            t = other;
    }
    const bool is_doubtful = c->has_normals
                                 ? t.reading.id && t.reading.deviation > IO__DOUBTFUL
                                 : t.bend > 0.05;
    /* A shot's later frames are as its first. */
    if (is_doubtful && !c->request->is_later
        && look_further(c, cameras, count, &t, &out->encoding_told))
        return -1;
    out->zooms = c->request->is_later && is_doubtful && tell_of_zoom(c, &t);
    settle_reading(c, &t);
    tell_of_noise(c, &t);
    out->camera = *t.guess;
    out->camera.camera = t.camera;
    out->format = t.format;
    out->reading = t.reading;
    return 0;
}

int io__judge(const char *path, const io_passes_request *request,
              const crv_depth_format *format, const io__camera_guess *cameras, int count,
              bool has_normals, const io_frame *frame, io__verdict *out,
              const crv_logger *log)
{
    const int32_t width = frame->desc.width, height = frame->desc.height;
    io__court c = {.path = path,
                   .log = log,
                   .request = request,
                   .frame = frame,
                   .has_normals = has_normals,
                   .memory = malloc((size_t)width * (size_t)height * sizeof(float))};
    c.planar = crv_image_packed(c.memory, width, height, 1);
    int result = 0;
    if (!c.memory)
        result =
            io__fail(log, path, "no memory to convert its depth; close other programs");
    if (!result)
        result = judge(&c, format, cameras, count, out);
    for (int32_t i = 0; !result && i < frame->desc.layers; i++) {
        const crv_const_image depth = crv_image_const(frame->depth[i]);
        if (crv_depth_convert(&depth, &out->format, &out->camera.camera, &frame->depth[i],
                              log)
            != CRV_OK)
            result = -1;
    }
    free(c.memory);
    return result;
}

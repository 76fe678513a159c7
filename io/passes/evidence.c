/* SPDX-License-Identifier: MIT */
#include "evidence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depth.h"
#include "internal.h"

enum { FEWEST_PAIRS = 50, /* fewer say nothing */ TEXT = 128 };

/* Degrees. From the first on, others are tried; from the second on, normals and depth
 * contradict each other; beyond the third, the normals are noise. */
static const double doubtful = 2.0, suspicious = 4.0, worst = 20.0;

/* What is at hand while a frame is judged. */
typedef struct court {
    const char *path;
    const crv_logger *log;
    const io_passes_request *request;
    const io_frame *frame;
    bool has_normals;
    float *memory; /* planar depth of the trial; owned */
    crv_image planar;
} court;

/* One way to take the frame, and how well it goes. */
typedef struct trial {
    crv_camera camera;
    const io__camera_guess *guess;
    crv_depth_format format;
    char text[TEXT]; /* what is different from the first, for messages */
    io__reading reading;
    size_t pairs;
    double bend;
} trial;

static int try_it(const court *c, trial *t)
{
    const crv_const_image given = crv_image_const(c->frame->depth[0]);
    if (crv_depth_convert(&given, &t->format, &t->camera, &c->planar, c->log) != CRV_OK)
        return -1;
    t->reading = (io__reading){0};
    t->pairs = 0;
    if (!c->has_normals) {
        t->bend = io__surface_bend(&c->planar, &t->camera);
        return 0;
    }
    const io_normal_space space = c->request->normal_space;
    const io__reading_request request = {
        .try_view = space != IO_NORMALS_WORLD,
        .try_world = space != IO_NORMALS_VIEW,
        .to_view = t->guess->has_rotation ? t->guess->to_view : NULL,
        .usual = c->request->usual_reading};
    io__pair_list pairs;
    io__find_pairs(&c->planar, &t->camera, &c->frame->normals, &pairs);
    t->pairs = pairs.count;
    if (pairs.count >= FEWEST_PAIRS)
        t->reading = io__choose_reading(&pairs, &request);
    io__free_pairs(&pairs);
    return 0;
}

/* Whether a trial contradicts the first one by far. */
static bool is_better(const court *c, const trial *t, const trial *first)
{
    if (!c->has_normals)
        return t->bend >= 0.0 && t->bend < 0.05 && t->bend < 0.1 * first->bend;
    return t->reading.id && 2 * t->pairs > first->pairs
           && t->reading.deviation < 0.5 * first->reading.deviation
           && t->reading.deviation < suspicious;
}

static bool is_best(const court *c, const trial *t, const trial *best)
{
    return c->has_normals ? t->reading.deviation < best->reading.deviation
                          : t->bend < best->bend;
}

/* The encodings that are tried. Only the ratio of far to near matters to directions. */
typedef struct encoding_row {
    crv_depth_encoding encoding;
    float low, high;     /* the range of numbers that it can hold */
    float far_values[6]; /* near is 1, for logarithmic 0; 0 ends the list */
    const char *text;
} encoding_row;

static const encoding_row encoding_rows[] = {
    {.encoding = CRV_DEPTH_PLANAR,
     .low = 0.0f,
     .high = INFINITY,
     .far_values = {1.0f},
     .text = "depth were planar (along the viewing axis)"},
    {.encoding = CRV_DEPTH_RADIAL,
     .low = 0.0f,
     .high = INFINITY,
     .far_values = {1.0f},
     .text = "depth were radial (distance from the eye)"},
    {.encoding = CRV_DEPTH_DISPARITY,
     .low = 0.0f,
     .high = INFINITY,
     .far_values = {1.0f},
     .text = "depth were disparity (1/distance), or reversed with an infinite far plane"},
    {.encoding = CRV_DEPTH_HARDWARE,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were hardware, far about %g times near"},
    {.encoding = CRV_DEPTH_REVERSED,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were reversed, far about %g times near"},
    {.encoding = CRV_DEPTH_GL,
     .low = -1.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were gl (-1 to 1), far about %g times near"},
    {.encoding = CRV_DEPTH_NORMALISED_REVERSED,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 1000.0f},
     .text = "depth were normalised-reversed (1 at near, 0 at far), far about %g times "
             "near"},
    {.encoding = CRV_DEPTH_LOGARITHMIC,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were logarithmic with its far plane at about %g"},
};

/* Tries t; better keeps the best of those that contradict `first`. */
static int compare(const court *c, const trial *first, trial *t, trial *better,
                   bool *found)
{
    if (try_it(c, t))
        return -1;
    if (is_better(c, t, first) && (!*found || is_best(c, t, better))) {
        *better = *t;
        *found = true;
    }
    return 0;
}

static int try_encodings(const court *c, const trial *first, trial *better, bool *found)
{
    const io__depth_facts facts = io__depth_facts_of(&c->frame->depth[0], NULL, INFINITY);
    const float background =
        first->format.background > 0.0f ? first->format.background : INFINITY;
    int result = 0;
    for (size_t i = 0; i < sizeof encoding_rows / sizeof encoding_rows[0]; i++) {
        const encoding_row *row = &encoding_rows[i];
        if (row->encoding == first->format.encoding || facts.smallest < row->low
            || facts.largest > row->high)
            continue;
        for (int k = 0; !result && k < 6 && row->far_values[k] > 0.0f; k++) {
            trial t = *first;
            t.format = (crv_depth_format){.encoding = row->encoding,
                                          .z_near = 1.0f,
                                          .z_far = row->far_values[k],
                                          .background = background};
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
            snprintf(t.text, sizeof t.text, row->text, (double)row->far_values[k]);
#pragma GCC diagnostic pop
            result = compare(c, first, &t, better, found);
        }
    }
    return result;
}

static int try_focal_length(const court *c, const trial *first, double scale,
                            trial *better, bool *found)
{
    trial t = *first;
    t.camera.fx_px *= (float)scale;
    t.camera.fy_px *= (float)scale;
    const double height = c->frame->image.display_height / (double)t.camera.fy_px;
    snprintf(t.text, sizeof t.text, "its vertical field of view were about %.0f degrees",
             2.0 * atan(0.5 * height) * 57.29577951308232);
    return compare(c, first, &t, better, found);
}

static int try_cameras(const court *c, const io__camera_guess *cameras, int count,
                       const trial *first, trial *better, bool *found)
{
    int result = 0;
    for (int i = 1; !result && i < count; i++) {
        trial t = *first;
        t.camera = cameras[i].camera;
        t.guess = &cameras[i];
        snprintf(t.text, sizeof t.text, "its camera came from %s", cameras[i].text);
        result = compare(c, first, &t, better, found);
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

/* A radial distance needs no number that the file does not hold: it is taken. Others are
 * named, for the user to say. */
static bool is_taken(const court *c, const trial *better, const trial *first)
{
    if (!c->has_normals)
        return false;
    if (better->guess != first->guess)
        return true;
    return better->format.encoding == CRV_DEPTH_RADIAL && !c->request->encoding_given
           && first->format.encoding == CRV_DEPTH_PLANAR;
}

static const char *encoding_remedy(const court *c)
{
    return c->request->remedies.encoding ? c->request->remedies.encoding
                                         : "check the depth's encoding";
}

static void tell_contradiction(const court *c, const trial *first, const trial *better,
                               bool found, bool taken)
{
    const double deviation = first->reading.deviation;
    if (found && !c->has_normals)
        io__warn(c->log, c->path, "walls and floors would come out flat if %s; %s",
                 better->text, encoding_remedy(c));
    else if (taken)
        io__warn(c->log, c->path,
                 "it is read as if %s: then normals and depth agree to %.1f degrees, "
                 "otherwise to %.1f; %s",
                 better->text, better->reading.deviation, deviation, encoding_remedy(c));
    else if (found)
        io__warn(c->log, c->path,
                 "normals and depth disagree by %.1f degrees, but by %.1f if %s; %s",
                 deviation, better->reading.deviation, better->text, encoding_remedy(c));
    else if (c->has_normals && deviation > suspicious && deviation <= worst)
        io__warn(
            c->log, c->path,
            "normals and depth disagree by %.1f degrees in any encoding and field of "
            "view: bump maps do that, and depth under depth of field or motion blur, "
            "which must be rendered without either; %s",
            deviation, encoding_remedy(c));
}

static int look_further(const court *c, const io__camera_guess *cameras, int count,
                        trial *t)
{
    trial better = {0};
    bool found = false;
    if (try_encodings(c, t, &better, &found)
        || try_cameras(c, cameras, count, t, &better, &found))
        return -1;
    const bool taken = found && is_taken(c, &better, t);
    tell_contradiction(c, t, &better, found, taken);
    if (taken)
        *t = better;
    return 0;
}

/* What to do if depth cannot tell the space of the normals. */
static io__reading settle_without_pairs(const court *c, const io__camera_guess *camera)
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

static void settle_reading(const court *c, trial *t)
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
    if (reading->deviation > worst) {
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
static void tell_of_noise(const court *c, const trial *t)
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

static int judge(const court *c, const crv_depth_format *format,
                 const io__camera_guess *cameras, int count, io__verdict *out)
{
    trial t = {.camera = cameras[0].camera, .guess = &cameras[0], .format = *format};
    if (try_it(c, &t))
        return -1;
    for (int i = 1; i < count && c->has_normals; i++) {
        trial other = t;
        other.camera = cameras[i].camera;
        other.guess = &cameras[i];
        if (try_it(c, &other))
            return -1;
        if (is_better(c, &other, &t))
            t = other;
    }
    const bool is_doubtful =
        c->has_normals ? t.reading.id && t.reading.deviation > doubtful : t.bend > 0.05;
    /* A shot's later frames are as its first. */
    if (is_doubtful && !c->request->is_later && look_further(c, cameras, count, &t))
        return -1;
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
    court c = {.path = path,
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

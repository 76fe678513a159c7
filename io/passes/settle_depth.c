/* SPDX-License-Identifier: MIT */
#include "settle_depth.h"

#include <math.h>

#include "halves.h"
#include "internal.h"
#include "steps.h"
#include "trial.h"

/* Blender writes this if a ray met nothing; no renderer writes more for a surface. */
static const float usual_background = 1e10f;

static bool is_distance(crv_depth_encoding encoding)
{
    return encoding == CRV_DEPTH_PLANAR || encoding == CRV_DEPTH_RADIAL;
}

/* Depth along -z, as view space has it, is positive depth. */
static void negate_depth(const char *path, io_frame *frame, const crv_logger *log)
{
    for (int32_t i = 0; i < frame->desc.layers; i++) {
        float *data = frame->depth[i].data;
        for (size_t k = 0; k < (size_t)frame->desc.width * (size_t)frame->desc.height;
             k++)
            data[k] = -data[k];
    }
    io__info(log, path,
             "depth is negative everywhere, as z of view space; it is negated");
}

/* Steps of half floats darken flat surfaces far away. */
static void smooth_halves(const char *path, const io_passes_request *request,
                          const io_frame *frame, const crv_logger *log)
{
    for (int32_t i = 0; i < frame->desc.layers; i++)
        if (io__smooth_halves(&frame->depth[i])) {
            io__warn(
                log, path,
                "depth holds nothing but half floats, and there is no memory to take "
                "their steps out; write it in 32-bit floats");
            return;
        }
    if (request->is_later)
        return;
    io__warn(
        log, path,
        "depth holds nothing but half floats: their steps are smoothed, detail below "
        "them is lost; write it in 32-bit floats");
}

static void tell_of_steps(const char *path, const io_frame *frame, float background,
                          const crv_logger *log)
{
    float size = 0.0f;
    const int32_t steps = io__depth_steps(&frame->depth[0], background, &size);
    if (steps)
        io__warn(log, path,
                 "depth has %d steps of %.3g, as if written in 8 bits: surfaces come out "
                 "as stairs; write it in 32-bit floats",
                 steps, (double)size);
}

crv_depth_format io__settle_format(const char *path, const io_passes_request *request,
                                   io_frame *frame, bool has_normals,
                                   io__depth_facts *settled, const crv_logger *log)
{
    crv_depth_format format = request->depth_format;
    const crv_image *normals = has_normals ? &frame->normals : NULL;
    /* 0 is what a zeroed request holds; it would make everything background. */
    const bool find_background =
        is_distance(format.encoding)
        && (isinf(format.background) || format.background == 0.0f);
    if (find_background)
        format.background = usual_background;
    const float limit = find_background ? usual_background : INFINITY;
    io__depth_facts facts = io__depth_facts_of(&frame->depth[0], normals, limit);
    if (is_distance(format.encoding) && facts.count && facts.largest <= 0.0f
        && facts.smallest < 0.0f) {
        negate_depth(path, frame, log);
        facts = io__depth_facts_of(&frame->depth[0], normals, limit);
    }
    *settled = facts;
    if (facts.is_half && is_distance(format.encoding))
        smooth_halves(path, request, frame, log);
    else if (!request->is_later)
        tell_of_steps(path, frame, limit, log);
    if (find_background && io__largest_is_sky(&facts)) {
        format.background = facts.largest;
        io__info(log, path, "depth from %g on is background: %zu pixels hold just that",
                 (double)facts.largest, facts.at_largest);
    }
    return format;
}

/* Directions do not tell how far the planes are, nor can smoothness tell much. */
void io__tell_of_unit_range(const char *path, const io_passes_request *request,
                            const io__depth_facts *facts, bool has_normals,
                            const io__verdict *verdict, const crv_logger *log)
{
    const bool fits =
        has_normals && verdict->reading.id && verdict->reading.deviation < IO__DOUBTFUL;
    const bool ends_at_1 = facts->largest == 1.0f && facts->at_largest < facts->count;
    const bool begins_at_0 =
        facts->smallest == 0.0f && facts->largest < 1.0f && !has_normals;
    if (verdict->encoding_told || request->encoding_given || request->is_later
        || !is_distance(request->depth_format.encoding) || facts->smallest < -1.0f
        || !(ends_at_1 || begins_at_0))
        return;
    io__warn(log, path, "depth lies between %g and %g%s but is read as distances; %s",
             (double)facts->smallest, (double)facts->largest,
             fits ? ", and its normals agree: it is normalised, 0 near the eye and 1 at "
                    "far,"
                  : ": it looks normalised, or like a depth buffer,",
             request->remedies.encoding ? request->remedies.encoding
                                        : "say what its numbers mean");
}

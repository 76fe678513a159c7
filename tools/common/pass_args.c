/* SPDX-License-Identifier: MIT */
#include "pass_args.h"

#include <math.h>
#include <string.h>

const char *const pass_spaces[] = {"find", "view", "world", NULL};

const char *pass_encoding(int32_t index)
{
    return crv_depth_encoding_name((crv_depth_encoding)index);
}

static bool is_linear(const pass_settings *p, bool ortho)
{
    return p->depth_encoding.value == CRV_DEPTH_NORMALISED
           || p->depth_encoding.value == CRV_DEPTH_NORMALISED_REVERSED || ortho;
}

static bool uses_far(const pass_settings *p)
{
    return p->depth_encoding.value == CRV_DEPTH_HARDWARE
           || p->depth_encoding.value == CRV_DEPTH_REVERSED
           || p->depth_encoding.value > CRV_DEPTH_DISPARITY;
}

static bool uses_near(const pass_settings *p)
{
    return uses_far(p) && p->depth_encoding.value != CRV_DEPTH_LOGARITHMIC;
}

static const char *depth_mistake(const pass_settings *p, bool ortho)
{
    const bool distance = p->depth_encoding.value == CRV_DEPTH_PLANAR
                          || p->depth_encoding.value == CRV_DEPTH_RADIAL;
    if (!uses_near(p) && p->z_near.given)
        return "--near: is for --depth-encoding hardware, reversed, normalised, "
               "normalised-reversed or gl; leave it out or add that";
    if (!uses_far(p) && p->z_far.given)
        return "--far: is for a --depth-encoding between planes; leave it out or add "
               "that";
    if (!distance && p->background.given)
        return "--background: is for planar or radial depth; leave it out";
    if (!uses_far(p))
        return NULL;
    if ((uses_near(p) && !p->z_near.given) || !p->z_far.given)
        return uses_near(p) ? "--depth-encoding: such depth has near and far planes; add "
                              "--near and --far"
                            : "--depth-encoding: logarithmic depth has a far plane; add "
                              "--far";
    if (uses_near(p) && !is_linear(p, ortho) && p->z_near.value <= 0.0)
        return "--near: must be greater than 0";
    if (p->z_far.value <= (uses_near(p) ? p->z_near.value : 0.0))
        return uses_near(p) ? "--far: must be greater than --near"
                            : "--far: must be greater than 0";
    if ((is_linear(p, ortho) || !uses_near(p)) && isinf(p->z_far.value))
        return "--far: must be finite in an orthographic view, and for normalised and "
               "logarithmic depth";
    return NULL;
}

const char *pass_mistake(const pass_settings *p, bool ortho)
{
    const char *mistake = depth_mistake(p, ortho);
    if (!mistake && p->normal_flip
        && strspn(p->normal_flip, "xyz") != strlen(p->normal_flip))
        mistake = "--normal-flip: names axes out of x, y and z, such as y or xz";
    return mistake;
}

io_passes_request pass_request(const pass_settings *p)
{
    io_passes_request request = {
        .depth = p->depth,
        .normal = p->normal,
        .depth_format = crv_depth_format_planar(),
        .normal_space = (io_normal_space)p->normal_space.value,
        .remedies = {.depth = "choose with --depth NAME",
                     .normal = "choose with --normal NAME, or --normal none",
                     .normal_space = "say --normal-space view if that is what they are",
                     .normal_flip = "add --normal-flip x, y or z",
                     .encoding = "say so with --depth-encoding",
                     .vfov = "say so with --vfov",
                     .camera = "give its vertical field of view with --vfov DEGREES, or "
                               "--hfov, or --lens and --sensor (or --ortho HEIGHT for "
                               "an orthographic one)"},
    };
    request.depth_format.encoding = (crv_depth_encoding)p->depth_encoding.value;
    request.encoding_given = p->depth_encoding.given;
    if (uses_near(p))
        request.depth_format.z_near = (float)p->z_near.value;
    if (uses_far(p))
        request.depth_format.z_far = (float)p->z_far.value;
    for (int i = 0; p->normal_flip && p->normal_flip[i]; i++)
        request.flip_normals[p->normal_flip[i] - 'x'] = true;
    if (p->background.given)
        request.depth_format.background = (float)p->background.value;
    return request;
}

bool pass_is_frame(const char *input)
{
    static const char *const extensions[] = {".exr", ".EXR", ".png",
                                             ".PNG", ".pfm", ".PFM"};
    const char *dot = strrchr(input, '.');
    for (size_t i = 0; dot && i < sizeof extensions / sizeof extensions[0]; i++)
        if (strcmp(dot, extensions[i]) == 0)
            return true;
    return false;
}

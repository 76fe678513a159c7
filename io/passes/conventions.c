/* SPDX-License-Identifier: MIT */
/*
 * conventions.c: a renderer's pass is a row. The order of the rows is that of preference
 * if a file has several; case does not matter.
 */
#include "conventions.h"

/* A renderer, the name of its pass, and what is known of that. */
#define DEPTH(renderer_, ...)                                                            \
    {                                                                                    \
        .kind = IO_PASS_DEPTH, .renderer = renderer_, .name = __VA_ARGS__                \
    }
#define POSITION(renderer_, ...)                                                         \
    {                                                                                    \
        .kind = IO_PASS_POSITION, .renderer = renderer_, .name = __VA_ARGS__             \
    }
#define AO(renderer_, ...)                                                               \
    {                                                                                    \
        .kind = IO_PASS_AO, .renderer = renderer_, .name = __VA_ARGS__                   \
    }
#define BENT_NORMAL(renderer_, ...)                                                      \
    {                                                                                    \
        .kind = IO_PASS_BENT_NORMAL, .renderer = renderer_, .name = __VA_ARGS__          \
    }
#define BEAUTY(renderer_, ...)                                                           \
    {                                                                                    \
        .kind = IO_PASS_BEAUTY, .renderer = renderer_, .name = __VA_ARGS__               \
    }
#define NORMAL(renderer_, ...)                                                           \
    {                                                                                    \
        .kind = IO_PASS_NORMAL, .renderer = renderer_, .name = __VA_ARGS__               \
    }

const io_convention io_conventions[] = {
    DEPTH("Blender", "Depth", .encoding = "planar", .unit = "scene",
          .background = "1e10"),
    DEPTH("Redshift, Karma, LuxCore, Mitsuba, Clarisse", "Depth", .unit = "scene"),
    DEPTH("Nuke", "depth", .encoding = "disparity or planar", .background = "0"),
    DEPTH("Arnold, RenderMan, Redshift", "Z", .encoding = "planar", .unit = "scene"),
    DEPTH("V-Ray, Octane", "ZDepth"),
    DEPTH("Octane", "Z-depth"),
    DEPTH("Corona", "Z_depth"),
    DEPTH("Octane, older", "Z depth"),
    DEPTH("V-Ray for 3ds Max", "VRayZDepth"),
    DEPTH("V-Ray for Maya", "VRay_ZDepth"),
    DEPTH("Corona", "CGeometry_ZDepth"),
    DEPTH("Mantra", "Pz", .encoding = "planar", .unit = "scene"),
    DEPTH("RenderMan, for its denoiser", "__depth", .unit = "scene"),
    DEPTH("Unreal", "SceneDepth", .encoding = "planar", .unit = "centimetres"),
    DEPTH("Unreal", "WorldDepth", .encoding = "planar", .unit = "centimetres"),
    DEPTH("Unreal", "FinalImageWorldDepth", .encoding = "planar", .unit = "centimetres"),
    DEPTH("Unreal, Movie Render Queue", "FinalImageMovieRenderQueue_WorldDepth",
          .encoding = "planar", .unit = "centimetres"),
    DEPTH("Octane, info passes", "Info_ZDepth"),
    DEPTH("RenderMan", "zfiltered", .encoding = "planar, antialiased", .unit = "scene"),
    DEPTH("any", "depth_filtered", .encoding = "planar, antialiased"),
    /* Last, because it sees through mirrors. */
    DEPTH("Blender, for its denoiser", "Denoising Depth", .unit = "scene"),

    POSITION("Blender", "Position", .unit = "scene", .background = "0, 0, 0",
             .axes = "world"),
    POSITION("LuxCore, Mitsuba, Octane", "Position", .unit = "scene"),
    POSITION("Arnold, Redshift, Karma, Mantra, RenderMan", "P", .unit = "scene",
             .axes = "world or camera"),
    POSITION("pbrt", "P", .axes = "world or camera"),
    POSITION("any", "WorldPosition", .axes = "world"),
    POSITION("any", "World_Position", .axes = "world"),
    POSITION("any", "World Position", .axes = "world"),
    POSITION("RenderMan", "Pworld", .axes = "world"),
    POSITION("RenderMan, for its denoiser", "__Pworld", .axes = "world"),
    POSITION("any", "Pcam", .axes = "camera"),
    POSITION("Corona", "CGeometry_WorldPosition", .axes = "world"),
    POSITION("Octane, info passes", "Info_Position", .axes = "world"),

    AO("Crevice, Blender, Redshift", "AO", .encoding = "1 open, 0 occluded"),
    AO("any", "Ambient Occlusion"),
    AO("any", "AmbientOcclusion"),
    AO("any", "Ambient_Occlusion"),
    AO("any", "Occlusion"),

    BENT_NORMAL("Crevice", "bent", .axes = "world or view"),

    BEAUTY("Blender", "Combined"),
    BEAUTY("Arnold", "RGBA"),
    BEAUTY("any", "Beauty"),
    BEAUTY("Unreal", "FinalImage"),
    BEAUTY("Karma, Mantra", "C"),
    BEAUTY("RenderMan", "Ci"),
    BEAUTY("V-Ray", "RGB_color"),
    BEAUTY("any", "rgb"),

    NORMAL("Arnold, Redshift, Karma, Mantra, Cycles", "N", .axes = "world"),
    NORMAL("Blender", "Normal", .axes = "world, right-handed, z up"),
    NORMAL("Cinema 4D, Clarisse", "Normal"),
    NORMAL("Redshift, V-Ray, Nuke", "Normals"),
    NORMAL("RenderMan, Mitsuba", "Nn", .axes = "view or world"),
    NORMAL("V-Ray for 3ds Max", "VRayNormals"),
    NORMAL("Octane", "Shading normal", .encoding = "n/2 + 1/2"),
    NORMAL("LuxCore", "Shading_Normal", .axes = "world"),
    NORMAL("Mitsuba", "sh_normal", .axes = "world"),
    NORMAL("pbrt", "Ns", .axes = "world or view"),
    NORMAL("Karma", "hitN", .axes = "world"),
    NORMAL("Unreal", "WorldNormal", .encoding = "n/2 + 1/2",
           .axes = "world, left-handed, z up"),
    NORMAL("any", "World_Normal", .axes = "world"),
    NORMAL("any", "NormalWorld", .axes = "world"),
    NORMAL("any", "Normal_World", .axes = "world"),
    NORMAL("RenderMan", "Nworld", .axes = "world"),
    NORMAL("RenderMan, for its denoiser", "__Nworld", .axes = "world"),
    NORMAL("any", "Ncam", .axes = "view"),
    NORMAL("Unreal", "FinalImageWorldNormal", .encoding = "n/2 + 1/2",
           .axes = "world, left-handed, z up"),
    NORMAL("Octane", "Normal (shading)", .encoding = "n/2 + 1/2"),
    NORMAL("Octane, info passes", "Info_ShadingNormal", .encoding = "n/2 + 1/2"),
    NORMAL("Octane for Cinema 4D", "Shading normals", .encoding = "n/2 + 1/2"),
    NORMAL("Cinema 4D", "Material Normals", .encoding = "n/2 + 1/2"),
    NORMAL("Octane", "Geometric normal", .encoding = "n/2 + 1/2"),
    NORMAL("LuxCore", "Geometry_Normal", .axes = "world"),
    NORMAL("Mitsuba", "geo_normal", .axes = "world"),
    NORMAL("Corona", "CGeometry_NormalsGeometry"),
    NORMAL("any", "Ng", .axes = "world"),
    NORMAL("Redshift", "BumpNormals"),
    NORMAL("Arnold, for its denoiser", "N_denoise", .axes = "world"),
    NORMAL("Blender, for its denoiser", "Denoising Normal"),
};

const size_t io_convention_count = sizeof io_conventions / sizeof io_conventions[0];

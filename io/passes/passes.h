/* SPDX-License-Identifier: MIT */
/*
 * passes.h: from the passes that renderers write to what a G-buffer takes. Finds depth
 * and normal channels by the names that renderers use, the camera from metadata or from
 * the caller, overscan as guard band, and the space that the normals are in.
 */
#ifndef CREVICE_IO_PASSES_PASSES_H
#define CREVICE_IO_PASSES_PASSES_H

#include "conventions.h"
#include "io.h"

typedef enum io_normal_space {
    IO_NORMALS_FIND = 0, /* from the camera's metadata, or by fitting a rotation to the
                            normals that depth implies */
    IO_NORMALS_VIEW = 1,
    IO_NORMALS_WORLD = 2 /* needs camera metadata, or the fit */
} io_normal_space;

/*
 * How the caller's user says what a frame does not: the remedies that messages end with,
 * such as "choose with --depth NAME". A member that is NULL stands for plain words.
 */
typedef struct io_passes_remedies {
    const char *depth;        /* to choose the depth channel */
    const char *normal;       /* to choose the normals, or none */
    const char *normal_space; /* to say which space they are in */
    const char *normal_flip;  /* to flip an axis of theirs */
    const char *encoding;     /* to say what the numbers of depth mean */
    const char *vfov;         /* to say which field of view it is */
    const char *camera;       /* to give the field of view, or an orthographic height */
} io_passes_remedies;

/* How the camera is turned and where it stands, in the world that the file's normals and
 * positions are in. */
typedef struct io_pose {
    bool given;
    double to_view[9]; /* world to view: rows right, up, back */
    double eye[3];     /* scene units */
} io_pose;

/* What the caller knows. Zeroed (with depth_format = crv_depth_format_planar()): find
 * all. */
typedef struct io_passes_request {
    const char *depth;  /* name of the depth channel, or of a layer of positions without
                           the component; NULL: find it */
    const char *normal; /* name of the normals without the component ("N", "View.Normal"),
                           "none" to ignore normals; NULL: find them */
    crv_depth_format
        depth_format; /* background INFINITY: 1e10 is used for planar and radial */
    float vfov_rad;   /* > 0: perspective with this vertical field of view of the display
                         window; wins over metadata */
    float hfov_rad;   /* > 0: the same with a horizontal field of view */
    /* > 0: orthographic, height of the display window in scene units */
    float view_height;
    /* Finds the field of view, which none of these three give: normals and depth agree
     * best at the right one. An error if the frame leaves it open. */
    bool fit_vfov;
    io_pose pose; /* wins over metadata */
    io_normal_space normal_space;
    bool flip_normals[3]; /* negate x, y, z of the normals as the file has them */
    /* The encoding is the user's word: another that fits better is told, not taken. */
    bool encoding_given;
    /* Overscan gets a result like the rest, instead of being a guard band; that of
     * G-buffers that crevice made stays one. */
    bool keep_overscan;
    /* For frames of a shot. is_later: not its first, which told what contradicts.
     * usual_reading: io_frame.reading of a frame that decided it, or 0. usual_deviation:
     * io_frame.deviation of the first. zoom_told: no word of another io_frame.zooms. */
    bool is_later, zoom_told;
    int usual_reading;
    double usual_deviation;
    /* Of stereo frames: the eye, NULL for any, and the names of all, with commas. */
    const char *view, *views;
    io_passes_remedies remedies;
    const io_watch *watch; /* of the reading; NULL: nobody */
} io_passes_request;

typedef struct io_frame {
    crv_gbuffer_desc desc; /* guard band = overscan beyond the display window */
    crv_camera camera;
    /* Of the display window, if fit_vfov was asked for; 0: positions told the camera. */
    float fitted_vfov_rad;
    bool has_normals;
    crv_normal_space normal_space;
    /* How depth was read, for io_passes_request.depth_format of a shot's later frames. */
    crv_depth_encoding encoding;
    /* Which way the normals were read, for io_passes_request.usual_reading; 0: none. And
     * whether this frame alone decides it. */
    int reading;
    bool reading_decided;
    double deviation; /* degrees between the normals and depth; 0: there are none */
    /* Directions to view space, row-major; orthogonal, reflections perhaps: those of the
     * file's world, if has_world, and those in the space of the file's normals, which is
     * view space if there are none. */
    bool has_world, normals_in_world;
    double world_to_view[9], normals_to_view[9];
    bool zooms;     /* a later frame, which was seen with another field of view */
    io_image image; /* owns the pixels that the views below show */
    crv_image depth[CRV_MAX_LAYERS]; /* planar, whatever the file holds; background
                                        INFINITY */
    crv_image normals;
} io_frame;

/*
 * Loads a frame. Depth is found as Z, *.Z, *.Depth.Z, *.Depth.V, depth, ... (first match
 * in the order of the table in names.c), further layers as layer2.Z to layer4.Z, or
 * solid2.Z to solid4.Z (then desc.layer_kind is CRV_LAYERS_SOLID), normals as N, Normal,
 * *.Normal and the like with X Y Z or R G B. A PNG or PFM with one channel is depth.
 * Without metadata, vfov_rad or view_height: an error that says how to give it. What was
 * found and decided is logged as CRV_LOG_INFO lines. Returns 0, or -1 after an error
 * line.
 */
int io_frame_load(const char *path, const io_passes_request *request, io_frame *out,
                  const crv_logger *log);

/*
 * The channels of a probed file's pass, by the names that renderers use: one for depth
 * and ambient occlusion, x, y and z for normals, bent normals and, if there is no depth,
 * positions, red, green and blue for the picture itself. Returns how many, 0 if there is
 * none. The names point into the image.
 */
int io_find_pass(const io_image *probed, io_pass_kind kind, const char *found[3]);

/* Frees what the frame owns and zeroes it. */
void io_frame_free(io_frame *frame);

/* Makes (when *gbuffer is NULL) or refills a G-buffer from the frame; *gbuffer must have
 * been made with an equal desc. */
crv_status io_frame_to_gbuffer(const io_frame *frame, struct crv_context *context,
                               crv_gbuffer **gbuffer);

#endif

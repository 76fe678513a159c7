/* SPDX-License-Identifier: MIT */
/* names.h: which channels of a file are depth and normals. */
#ifndef CREVICE_IO_PASSES_NAMES_H
#define CREVICE_IO_PASSES_NAMES_H

#include "passes.h"

typedef struct io__pass_names {
    int32_t layers;                    /* depth channels, 1 to CRV_MAX_LAYERS */
    const char *depth[CRV_MAX_LAYERS]; /* point into the probed image */
    /* x, y, z of positions, which then stand for depth: depth[0] is x. NULL: none. */
    const char *position[3];
    crv_layers layer_kind;          /* solid if further layers are called solidN.Z */
    const char *normal[3];          /* x, y, z; NULL if there are none */
    char normal_base[IO_NAME_SIZE]; /* name without the component, for messages */
} io__pass_names;

/* Chooses among the channels of a probed image, as requested or by the tables of names,
 * and logs the choice. */
int io__choose_passes(const char *path, const io_image *probed,
                      const io_passes_request *request, io__pass_names *out,
                      const crv_logger *log);

/* Its halves, in this order. */
int io__choose_depth(const char *path, const io_image *probed,
                     const io_passes_request *request, io__pass_names *out,
                     const crv_logger *log);
int io__choose_normals(const char *path, const io_image *probed,
                       const io_passes_request *request, io__pass_names *out,
                       const crv_logger *log);

/* Positions by their usual names; false if there are none. */
bool io__find_positions(const io_image *probed, io__pass_names *out);
/* Positions of a layer that the caller names; false if it holds none. */
bool io__request_positions(const io_image *probed, const char *wanted,
                           io__pass_names *out);

/* How well a name stands for depth, with its last piece as component or without one. */
int io__depth_name_rank(const char *name, bool with_component);

#endif

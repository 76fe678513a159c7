/* SPDX-License-Identifier: MIT */
/* Bent normals on their way out: vector_output. */
#ifndef BENT_OUTPUT_GLSL
#define BENT_OUTPUT_GLSL

#include "common.glsl"

/* How BENT_FORM leaves them (crv__bent_form of pipelines.h). */
const int BENT_AS_SUMMED = 0, BENT_UNIT = 1, BENT_OCTAHEDRAL = 2;

/* A unit vector, or zero. */
void write_bent_normal(ivec2 at, vec3 bent)
{
    write_vectors(at, BENT_FORM == BENT_OCTAHEDRAL ? vec4(octahedral_encoded(bent), 0, 0)
                                                   : vec4(bent, 0));
}

/* A mean of vectors, over a surface with this normal, which is the bent normal if the
 * mean is nothing. */
void write_bent_mean(ivec2 at, vec3 mean, vec3 n)
{
    const float squared = dot(mean, mean);
    const bool is_nothing = !(squared > 1e-12 && is_surface(squared));
    if (BENT_FORM == BENT_AS_SUMMED)
        write_bent_normal(at, mean);
    else
        write_bent_normal(at, is_nothing ? n : mean * inversesqrt(squared));
}

#endif

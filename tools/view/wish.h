/* SPDX-License-Identifier: MIT */
/* wish.h: what is to be seen, and what is made of it. */
#ifndef VIEW_WISH_H
#define VIEW_WISH_H

#include "buffers.h"
#include "pool.h"
#include "samples.h"
#include "truth.h"

enum { HALVES = 2, PROBLEM_SIZE = 512 };

/* Where a half's accessibility comes from. */
typedef enum half_content {
    HALF_METHOD,
    HALF_TRUTH, /* ray-traced: what the other half's method estimates, or this one's */
    HALF_OPEN   /* 1 everywhere: no ambient occlusion */
} half_content;

/* As what it is shown. */
typedef enum half_look {
    LOOK_ACCESSIBILITY,
    LOOK_LIT,
    LOOK_DIFFERENCE /* left minus right */
} half_look;

typedef struct half_wish {
    half_content content;
    half_look look;
    crv_options options;
    /* The truth stays what the options were fitted to, whatever they become; false: it is
     * what they say. */
    bool keeps_target;
    reference_options target;
} half_wish;

typedef struct wish {
    int32_t width, height; /* px, of a mesh's picture; frames have their own */
    bool moving;           /* coarse if need be, soon */
    scene_view view;       /* of a mesh */
    int32_t frame;         /* of a shot: its place in the list */
    half_wish half[HALVES];
    double heat_scale; /* the difference that gets the darkest colours */
    /* Whose samples of which pixel are wanted. */
    bool explains;
    int32_t explained_half, explained_x, explained_y;
} wish;

typedef struct half_shown {
    uint32_t *pixels;     /* held; 0xFFRRGGBB */
    float *accessibility; /* held; of each pixel */
    double time_ms;       /* of the method's run; 0: none ran */
    bool measured;        /* against a truth of at least two passes: */
    double rmse;          /* without what the truth's own noise adds */
    double bias;
    bool has_truth;
    truth_state truth;
    float *truth_plane; /* held; NULL if nothing is known of it */
} half_shown;

/* One picture. Free it with shown_free(). */
typedef struct shown {
    wish wish;
    buffers *buffers;   /* held */
    int32_t coarseness; /* each pixel stands for so many of each side */
    half_shown half[HALVES];
    double cast_ms;             /* of the last ray casting or reading */
    bool more_follows;          /* the same picture comes once more, with numbers */
    samples *samples;           /* held; of the wish's pixel; NULL: none */
    double began_s, made_s;     /* when it was begun and done, report_seconds() */
    char problem[PROBLEM_SIZE]; /* why it is not what was wished for; "" if it is */
} shown;

/* What the truth of a half is; of the whole scene, with interpolated normals. */
reference_options wish_target(const wish *w, int half);

/* NULL does nothing. */
void shown_free(shown *s);

/* The same picture, held once more. */
shown shown_hold(const shown *s);

#endif

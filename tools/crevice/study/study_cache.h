/* SPDX-License-Identifier: MIT */
/* study_cache.h: what a view keeps. */
#ifndef TOOL_STUDY_CACHE_H
#define TOOL_STUDY_CACHE_H

#include "study.h"

enum { STUDY_GBUFFERS_MAX = 2 * CRV_MAX_LAYERS };

typedef struct study_gbuffer_entry {
    study_buffers buffers;
    scene_gbuffer cast;
    crv_gbuffer *uploaded;
} study_gbuffer_entry;

typedef struct study_reference_entry {
    study_target target;
    reference_kind kind;
    study_buffers buffers;
    float *accessibility; /* owned */
    study_reference_facts facts;
    bool is_used; /* asked for, and not only traced along with another */
} study_reference_entry;

struct study_cache {
    study_gbuffer_entry gbuffers[STUDY_GBUFFERS_MAX];
    int32_t gbuffer_count;
    study_reference_entry *references;
    int32_t reference_count, reference_capacity;
};

/* Errors only: other messages of what is made over and over would drown the progress. */
const crv_logger *study_quiet_logger(study *s);

bool study_same_buffers(study_buffers a, study_buffers b);

int study_cached_gbuffer(study *s, study_view *v, study_buffers buffers,
                         const study_gbuffer_entry **out);

#endif

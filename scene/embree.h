/* SPDX-License-Identifier: MIT */
/*
 * embree.h: what differs between Embree 3 and Embree 4, and nothing else of Embree.
 */
#ifndef CREVICE_SCENE_EMBREE_H
#define CREVICE_SCENE_EMBREE_H

#include <stdbool.h>

#if CREVICE_EMBREE_VERSION >= 4

#include <embree4/rtcore.h>

/* Finds the nearest hit; rh->hit.geomID stays RTC_INVALID_GEOMETRY_ID where there is
 * none. */
static inline void embree_intersect(RTCScene rtc, struct RTCRayHit *rh)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect1(rtc, rh, &arguments);
}

/* Embree sets tfar to -infinity where the ray is blocked. */
static inline bool embree_occluded(RTCScene rtc, struct RTCRay *ray)
{
    rtcOccluded1(rtc, ray, NULL);
    return ray->tfar < 0.0f;
}

#else

#include <embree3/rtcore.h>

static inline void embree_intersect(RTCScene rtc, struct RTCRayHit *rh)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(rtc, &context, rh);
}

static inline bool embree_occluded(RTCScene rtc, struct RTCRay *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(rtc, &context, ray);
    return ray->tfar < 0.0f;
}

#endif
#endif

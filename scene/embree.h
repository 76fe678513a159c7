/* SPDX-License-Identifier: MIT */
/*
 * embree.h: what differs between Embree 3 and Embree 4, and nothing else of Embree.
 */
#ifndef CREVICE_SCENE_EMBREE_H
#define CREVICE_SCENE_EMBREE_H

#include <stdbool.h>

#if CREVICE_EMBREE_VERSION >= 4

#include <embree4/rtcore.h>

typedef struct RTCRayQueryContext embree_context;

#define EMBREE_SCENE_FLAG_FILTER RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS

/* Finds the nearest hit; rh->hit.geomID stays RTC_INVALID_GEOMETRY_ID if there is
 * none. */
static inline void embree_intersect(RTCScene rtc, struct RTCRayHit *rh)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect1(rtc, rh, &arguments);
}

/* The same, but only hits that the filter lets pass. The context, which the filter gets,
 * may be the first member of something larger. */
static inline void embree_intersect_filtered(RTCScene rtc, struct RTCRayHit *rh,
                                             RTCFilterFunctionN filter,
                                             embree_context *context)
{
    struct RTCIntersectArguments arguments;
    rtcInitRayQueryContext(context);
    rtcInitIntersectArguments(&arguments);
    arguments.flags = (enum RTCRayQueryFlags)(
        RTC_RAY_QUERY_FLAG_COHERENT | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
    arguments.filter = filter;
    arguments.context = context;
    rtcIntersect1(rtc, rh, &arguments);
}

/* Embree sets tfar to -infinity if the ray is blocked. */
static inline bool embree_occluded(RTCScene rtc, struct RTCRay *ray)
{
    rtcOccluded1(rtc, ray, NULL);
    return ray->tfar < 0.0f;
}

#else

#include <embree3/rtcore.h>

typedef struct RTCIntersectContext embree_context;

#define EMBREE_SCENE_FLAG_FILTER RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION

static inline void embree_intersect(RTCScene rtc, struct RTCRayHit *rh)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(rtc, &context, rh);
}

static inline void embree_intersect_filtered(RTCScene rtc, struct RTCRayHit *rh,
                                             RTCFilterFunctionN filter,
                                             embree_context *context)
{
    rtcInitIntersectContext(context);
    context->flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context->filter = filter;
    rtcIntersect1(rtc, context, rh);
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

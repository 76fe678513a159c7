/* SPDX-License-Identifier: MIT */
/* SANITIZED: whether a sanitizer is compiled in. Those reserve so much memory that it
 * cannot be limited. */
#ifndef CREVICE_SYSTEM_SANITIZED_H
#define CREVICE_SYSTEM_SANITIZED_H

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)                  \
    || __has_feature(undefined_behavior_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

#endif

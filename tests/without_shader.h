/* SPDX-License-Identifier: MIT */
/* Methods and filters that have no shader yet: plans on a Vulkan device refuse them. */
#ifndef TESTS_WITHOUT_SHADER_H
#define TESTS_WITHOUT_SHADER_H

#include <string.h>

static inline int is_without_shader(const char *name)
{
    static const char *const NAMES[] = {"bitmask"};
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        if (strcmp(NAMES[i], name) == 0)
            return 1;
    }
    return 0;
}

#endif

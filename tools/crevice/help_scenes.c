/* SPDX-License-Identifier: MIT */
/* help_scenes.c: `crevice help scenes`, what there is without a model. */
#include "help_scenes.h"

#include "scene.h"

void help_scenes(FILE *out)
{
    const scene_parameter *p;
    fprintf(out, "Scenes made in code, as MODEL: builtin:NAME or "
                 "builtin:NAME,KEY=VALUE\n\n");
    for (int32_t i = 0; scene_builtin_name(i); i++) {
        fprintf(out, "  %-10s %s\n", scene_builtin_name(i), scene_builtin_help(i));
        for (int32_t k = 0; (p = scene_builtin_parameter(i, k)); k++) {
            fprintf(out, "             %s=%g to %g: %s", p->key, p->min, p->max, p->help);
            if (p->initial >= p->min)
                fprintf(out, "; default %g", p->initial);
            fprintf(out, "\n");
        }
    }
    fprintf(out, "\nDepth and occlusion of corner, plane, sphere and groove are known in "
                 "closed form.\n");
}

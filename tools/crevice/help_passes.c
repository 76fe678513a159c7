/* SPDX-License-Identifier: MIT */
/* help_passes.c: `crevice help passes`, the renderers' passes that are known by name. */
#include "help_passes.h"

#include "passes/conventions.h"

static void print_rows(FILE *out, io_pass_kind kind)
{
    for (size_t i = 0; i < io_convention_count; i++) {
        const io_convention *row = &io_conventions[i];
        if (row->kind != kind)
            continue;
        fprintf(out, "  %-38s %s", row->name, row->renderer);
        const char *const facts[] = {row->encoding, row->unit, row->background,
                                     row->axes};
        const char *const words[] = {"", "unit: ", "background: ", "axes: "};
        for (int k = 0; k < 4; k++)
            if (facts[k])
                fprintf(out, "; %s%s", words[k], facts[k]);
        fprintf(out, "\n");
    }
}

void help_passes(FILE *out)
{
    fprintf(out, "Passes that `crevice ao` knows by name, in order of preference. A name "
                 "may have a prefix\n(ViewLayer.Depth.Z), an eye (Depth.left.Z) and any "
                 "case. What a row does not say is found\nfrom the frame: the normals "
                 "that depth implies must agree with those that are given.\n\nDepth, as "
                 "NAME.Z, .V, .R, .T or a channel itself:\n");
    print_rows(out, IO_PASS_DEPTH);
    fprintf(out,
            "\nPositions, which stand for depth that is missing and tell the camera, "
            "as NAME.X .Y .Z, .R .G .B or\nNAMEX NAMEY NAMEZ:\n");
    print_rows(out, IO_PASS_POSITION);
    fprintf(out, "\nNormals, as NAME.X .Y .Z, .R .G .B or NAMEX NAMEY NAMEZ:\n");
    print_rows(out, IO_PASS_NORMAL);
    fprintf(out,
            "\nAmbient occlusion, which `crevice compare` takes, as NAME.R, .V, .Y or "
            "a channel itself:\n");
    print_rows(out, IO_PASS_AO);
    fprintf(out, "\nBent normals, which `crevice compare` takes, as NAME.X .Y .Z:\n");
    print_rows(out, IO_PASS_BENT_NORMAL);
    fprintf(out, "\nThe picture itself, which `crevice view` shows with its ambient "
                 "occlusion, as NAME.R .G .B or\nR, G, B:\n");
    print_rows(out, IO_PASS_BEAUTY);
    fprintf(out, "\nOther names are taken if they contain \"depth\", \"position\", "
                 "\"normal\" or \"occlusion\"; "
                 "--depth and --normal choose any.\n");
}

/* SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/option_text.h"
#include "tune_work.h"

static void print_error(const char *view, const char *options, const tune_error *e,
                        double noise)
{
    /* Below the noise nothing is known. */
    if (e->rmse > 0.0 || !(noise > 0.0))
        printf("%-8s %-8s %9.5f  %+9.5f\n", view, options, e->rmse, e->bias);
    else
        printf("%-8s %-8s  <%.5f  %+9.5f\n", view, options, sqrt(noise), e->bias);
}

void tune_print_pair(const tune_work *w, int index, const tune_error *before,
                     const tune_error *after)
{
    const char *name = index == TUNE_FITTED ? "fitted" : "other";
    print_error(name, "before", before, w->view[index].noise);
    print_error(name, "after", after, w->view[index].noise);
}

int tune_write_options(const tune_work *w, const tune_result *found)
{
    const char *path = w->s->in.view.output;
    char text[OPTION_TEXT_SIZE];
    if (!path)
        return EXIT_DONE;
    FILE *stream = fopen(path, "w");
    const bool written = stream
                         && fprintf(stream, "# crevice tune: RMSE %.5f, before %.5f\n%s",
                                    found->after.rmse, found->before.rmse,
                                    option_lines(&found->options, text))
                                > 0;
    const bool closed = stream && !fclose(stream);
    if (!written || !closed) {
        report_error(w->r, "%s: cannot be written: %s; check its folder and the disk",
                     path, strerror(errno));
        return EXIT_FAILED;
    }
    report_info(w->r, "wrote %s", path);
    return EXIT_DONE;
}

/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/heatmap.h"
#include "io.h"
#include "common/output.h"
#include "page_internal.h"

typedef struct picture {
    char path[160];
    char *whole; /* with the page's folder */
    io_image image;
    io_write_options options;
    const crv_logger *log;
} picture;

static int write_picture(void *data)
{
    const picture *w = data;

    return io_write(w->whole, &w->image, &w->options, w->log);
}

static bool begin_picture(page *p, picture *w, const char *name, int32_t width,
                          int32_t height, int32_t channels)
{
    static const char *const names[] = {"R", "G", "B"};
    const char *word = page_failed(p) ? NULL : page_unique(p, name);
    text path = {0};

    *w = (picture){.log = &p->r->logger};
    if (word == NULL)
        return false;
    snprintf(w->path, sizeof w->path, "pictures/%.130s.png", word);
    text_addf(&path, "%s/%s", p->directory, w->path);
    w->whole = path.data;
    if (path.failed)
        page_fail_memory(p);
    else if (io_image_init(&w->image, width, height, names, channels, w->log) != 0)
        p->failed = true;
    return !p->failed;
}

static void end_picture(page *p, picture *w, const char *caption)
{
    if (!p->failed && output_guarded(write_picture, w) != 0)
        p->failed = true;
    if (!p->failed) {
        text_addf(&p->body,
                  "<figure><a href=\"%s\"><img src=\"%s\" width=\"%d\" "
                  "height=\"%d\" loading=\"lazy\" alt=\"",
                  w->path, w->path, w->image.width, w->image.height);
        text_add_escaped(&p->body, caption);
        text_add(&p->body, "\"></a><figcaption>");
        page_words(p, caption);
        text_add(&p->body, "</figcaption></figure>\n");
    }
    io_image_free(&w->image);
    free(w->whole);
}

void page_picture(page *p, const char *name, const float *grey, int32_t width,
                  int32_t height, const char *caption)
{
    picture w;

    if (begin_picture(p, &w, name, width, height, 1))
        memcpy(w.image.channels[0].data, grey,
               (size_t)width * (size_t)height * sizeof *grey);
    end_picture(p, &w, caption);
}

void page_error_map(page *p, const char *name, const float *a, const float *b,
                    const uint8_t *mask, int32_t width, int32_t height, double scale,
                    const char *caption)
{
    picture w;

    if (begin_picture(p, &w, name, width, height, 3))
        heatmap_fill(a, b, mask, (size_t)width * (size_t)height, scale,
                     w.image.channels[0].data, w.image.channels[1].data,
                     w.image.channels[2].data);
    w.options.srgb = true;
    end_picture(p, &w, caption);
}

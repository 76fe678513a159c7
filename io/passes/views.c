/* SPDX-License-Identifier: MIT */
#include "views.h"

#include <string.h>

#include "internal.h"
#include "pieces.h"

/* The piece of the name that is the view, or NULL; not the last, which is a component. */
static const char *view_piece(const char *name, const char *view)
{
    for (const char *at = name, *dot; (dot = strchr(at, '.')) != NULL; at = dot + 1)
        if (io__same_text(at, (size_t)(dot - at), view))
            return at;
    return NULL;
}

bool io_channel_is_of_view(const io_channel *channel, const char *view,
                           char plain[IO_NAME_SIZE])
{
    const char *piece = view_piece(channel->name, view);
    if (channel->view[0] ? !text_is_same(channel->view, view) : !piece)
        return false;
    if (piece)
        snprintf(plain, IO_NAME_SIZE, "%.*s%s", (int)(piece - channel->name),
                 channel->name, piece + strlen(view) + 1);
    else
        snprintf(plain, IO_NAME_SIZE, "%s", channel->name);
    return true;
}

/* Whether it is of one of these views, with commas in between. */
static bool is_of_any(const io_channel *channel, const char *views)
{
    char plain[IO_NAME_SIZE], view[IO_NAME_SIZE];
    for (const char *at = views; at; at = strchr(at, ',')) {
        at += *at == ',';
        snprintf(view, sizeof view, "%.*s", (int)strcspn(at, ","), at);
        if (io_channel_is_of_view(channel, view, plain))
            return true;
    }
    return false;
}

int io__keep_view(const char *path, const io_passes_request *request, io_image *probed,
                  const crv_logger *log)
{
    char plain[IO_NAME_SIZE];
    int32_t own = 0, others = 0, kept = 0;
    if (!request->view)
        return 0;
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const bool is_own =
            io_channel_is_of_view(&probed->channels[i], request->view, plain);
        own += is_own;
        others += !is_own && is_of_any(&probed->channels[i], request->views);
    }
    if (!own && !others)
        return io__fail(log, path,
                        "has no view \"%s\" nor any of the others; write channels such "
                        "as Depth.%s.Z, or a file for each view, named with %%V",
                        request->view, request->view);
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const io_channel *channel = &probed->channels[i];
        if (own ? io_channel_is_of_view(channel, request->view, plain)
                : !channel->view[0] && !is_of_any(channel, request->views))
            probed->channels[kept++] = *channel;
    }
    probed->channel_count = kept;
    if (kept)
        return 0;
    return io__fail(log, path, "has no view \"%s\"; choose of those that there are",
                    request->view);
}

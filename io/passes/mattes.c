/* SPDX-License-Identifier: MIT */
#include "mattes.h"

#include <stdlib.h>
#include <string.h>

#include "cryptomatte.h"
#include "internal.h"

static bool begins(const char **text, const char *word)
{
    const size_t length = strlen(word);
    if (strncmp(*text, word, length) != 0)
        return false;
    *text += length;
    return true;
}

static float clamped(float value)
{
    return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; /* NaN: 0 */
}

/* Whether the value is one of the numbers, which have been checked. */
static bool is_listed(float value, const char *ids)
{
    for (const char *at = ids; at; at = strchr(at, ',')) {
        at += *at == ',';
        const float id = (float)strtol(at, NULL, 10);
        if (value <= id && value >= id)
            return true;
    }
    return false;
}

/* Whole numbers with single commas in between. */
static bool are_ids(const char *ids)
{
    if (!*ids || strspn(ids, "0123456789,-") != strlen(ids))
        return false;
    for (const char *at = ids; at; at = strchr(at, ',')) {
        char *end;
        at += *at == ',' && at > ids;
        strtol(at, &end, 10);
        if (end == at || (*end && *end != ','))
            return false;
    }
    return true;
}

/* One channel as it is, or 1 where it holds one of the ids. */
static int read_channel(const char *path, const char *text, io_image *out,
                        const crv_logger *log)
{
    char name[IO_NAME_SIZE];
    io_image probed = {0};
    const char *ids = strrchr(text, '=');
    if (io_probe(path, &probed, log))
        return -1;
    if (io_image_find(&probed, text))
        ids = NULL;
    io_image_free(&probed);
    snprintf(name, sizeof name, "%.*s", ids ? (int)(ids - text) : (int)strlen(text),
             text);
    if (ids && !are_ids(++ids))
        return io__fail(log, path,
                        "\"%.60s\" are no object ids; give whole numbers, as %.100s=3,5",
                        ids, name);
    const char *const names[] = {name};
    if (io_read(path, names, 1, out, log))
        return -1;
    const size_t count = (size_t)out->width * (size_t)out->height;
    float *data = out->channels[0].data;
    for (size_t i = 0; i < count; i++)
        data[i] = ids ? (is_listed(data[i], ids) ? 1.0f : 0.0f) : clamped(data[i]);
    return 0;
}

int io_matte_read(const char *path, const char *text, const io_image *window,
                  float *coverage, const crv_logger *log)
{
    io_image read = {0};
    const size_t count = (size_t)window->width * (size_t)window->height;
    const bool inverted = begins(&text, "not:");
    const int result = begins(&text, "crypto:")
                           ? io_cryptomatte_read(path, text, &read, log)
                           : read_channel(path, text, &read, log);
    if (result)
        return -1;
    memset(coverage, 0, count * sizeof *coverage);
    io_copy_window(&read, read.channels[0].data, window, coverage);
    io_image_free(&read);
    for (size_t i = 0; inverted && i < count; i++)
        coverage[i] = 1.0f - coverage[i];
    return 0;
}

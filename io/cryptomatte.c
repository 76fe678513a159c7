/* SPDX-License-Identifier: MIT */
#include "cryptomatte.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>

#include "exr.h"

enum { MAX_LAYERS = 16, MAX_RANKS = 64, MAX_IDS = 4096, MAX_MANIFEST = 1 << 28 };

/* One Cryptomatte of a file. */
typedef struct layer {
    char name[IO_NAME_SIZE];
    cJSON *manifest; /* owned; NULL if there is none */
} layer;

typedef struct matte {
    const char *path;
    const crv_logger *log;
    layer layers[MAX_LAYERS];
    int32_t layer_count;
    const layer *chosen; /* that the ids are of */
    uint32_t ids[MAX_IDS];
    int32_t id_count;
} matte;

static uint32_t rotated(uint32_t x, int bits)
{
    return x << bits | x >> (32 - bits);
}

/* Appleby 2011, MurmurHash3_x86_32 with seed 0. */
static uint32_t murmur3(const unsigned char *bytes, size_t length)
{
    uint32_t hash = 0, block = 0;
    for (size_t i = 0; i < length; i++) {
        block |= (uint32_t)bytes[i] << (8 * (i % 4));
        if (i % 4 != 3 && i + 1 != length)
            continue;
        hash ^= rotated(block * 0xcc9e2d51u, 15) * 0x1b873593u;
        if (i % 4 == 3)
            hash = rotated(hash, 13) * 5 + 0xe6546b64u;
        block = 0;
    }
    hash ^= (uint32_t)length;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

uint32_t io_cryptomatte_id(const char *name)
{
    const uint32_t hash = murmur3((const unsigned char *)name, strlen(name));
    const uint32_t exponent = hash >> 23 & 255u;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

/* The whole text of a manifest beside the frame; the caller frees it. */
static char *read_sidecar(const matte *m, const char *name)
{
    io__file file;
    char *path = file_beside(m->path, name), *text = NULL;
    if (path && !io__file_open(path, m->log, &file)) {
        if (file.size < MAX_MANIFEST)
            text = calloc((size_t)file.size + 1, 1);
        if (text && io__read(file.stream, text, (size_t)file.size) != (size_t)file.size)
            text[0] = '\0';
        fclose(file.stream);
    }
    free(path);
    return text;
}

static const char *text_attribute(const io__exr *exr, int part, const char *key,
                                  const char *what)
{
    char name[IO_NAME_SIZE + 32];
    const char *text = NULL;
    int32_t length = 0;
    snprintf(name, sizeof name, "cryptomatte/%.200s/%s", key, what);
    if (exr_attr_get_string(exr->context, part, name, &length, &text) != EXR_ERR_SUCCESS)
        return NULL;
    return text;
}

/* Adds the Cryptomatte whose attributes begin with this key. */
static int add_layer(matte *m, const io__exr *exr, int part, const char *key)
{
    const char *name = text_attribute(exr, part, key, "name");
    const char *hash = text_attribute(exr, part, key, "hash");
    const char *inside = text_attribute(exr, part, key, "manifest");
    const char *beside = text_attribute(exr, part, key, "manif_file");
    if (!name || m->layer_count == MAX_LAYERS)
        return 0;
    for (int32_t i = 0; i < m->layer_count; i++)
        if (!strcmp(m->layers[i].name, name))
            return 0;
    if (hash && strcmp(hash, "MurmurHash3_32") != 0)
        return io__fail(m->log, m->path,
                        "its Cryptomatte \"%s\" is hashed by %.60s, which is not known; "
                        "use MurmurHash3_32",
                        name, hash);
    layer *added = &m->layers[m->layer_count];
    snprintf(added->name, sizeof added->name, "%s", name);
    char *text = !inside && beside ? read_sidecar(m, beside) : NULL;
    if (inside || text)
        added->manifest = cJSON_Parse(inside ? inside : text);
    free(text);
    if (!added->manifest && (inside || beside))
        io__warn(m->log, m->path,
                 "the manifest of its Cryptomatte \"%s\" cannot be read; whole names are "
                 "hashed",
                 name);
    m->layer_count++;
    return 0;
}

/* "cryptomatte/KEY/name" */
static bool is_key(const char *attribute, char key[IO_NAME_SIZE])
{
    static const char prefix[] = "cryptomatte/";
    if (strncmp(attribute, prefix, sizeof prefix - 1) != 0)
        return false;
    const char *begin = attribute + sizeof prefix - 1, *end = strrchr(begin, '/');
    if (!end || strcmp(end, "/name") != 0)
        return false;
    snprintf(key, IO_NAME_SIZE, "%.*s", (int)(end - begin), begin);
    return true;
}

static int find_layers(matte *m, const io__exr *exr)
{
    for (int part = 0; part < exr->part_count; part++) {
        int32_t count = 0;
        exr_get_attribute_count(exr->context, part, &count);
        for (int32_t i = 0; i < count; i++) {
            const exr_attribute_t *attribute = NULL;
            char key[IO_NAME_SIZE];
            if (!exr_get_attribute_by_index(exr->context, part, EXR_ATTR_LIST_FILE_ORDER,
                                            i, &attribute)
                && is_key(attribute->name, key) && add_layer(m, exr, part, key))
                return -1;
        }
    }
    if (!m->layer_count)
        return io__fail(m->log, m->path,
                        "has no Cryptomatte; render with one, or name a matte channel");
    return 0;
}

static int open_layers(matte *m)
{
    io__file file;
    io__exr exr;
    if (io__file_open(m->path, m->log, &file))
        return -1;
    int result = io__exr_open(&file, &exr);
    if (!result) {
        result = find_layers(m, &exr);
        io__exr_close(&exr);
    }
    fclose(file.stream);
    return result;
}

static void add_id(matte *m, uint32_t id)
{
    if (m->id_count < MAX_IDS)
        m->ids[m->id_count++] = id;
}

/* Adds the ids of a manifest whose names fit; returns how many did. */
static int32_t match(matte *m, const layer *from, const char *pattern)
{
    int32_t count = 0;
    const cJSON *entry;
    cJSON_ArrayForEach(entry, from->manifest)
    {
        if (!entry->string
            || (strcmp(pattern, entry->string) != 0
                && !text_fits(entry->string, pattern)))
            continue;
        const bool is_text = cJSON_IsString(entry) && entry->valuestring;
        add_id(m, is_text ? (uint32_t)strtoul(entry->valuestring, NULL, 16)
                          : io_cryptomatte_id(entry->string));
        count++;
    }
    return count;
}

static int fail_name(const matte *m, const char *name)
{
    /* The nearest of the names, as if they were channels. */
    io_image names = {0};
    const cJSON *entry;
    const cJSON *manifest = m->chosen->manifest;
    const size_t count = (size_t)cJSON_GetArraySize(manifest);
    names.channels = calloc(count + 1, sizeof *names.channels);
    if (!names.channels)
        return io__fail(m->log, m->path, "no memory; close other programs");
    cJSON_ArrayForEach(entry, manifest) snprintf(
        names.channels[names.channel_count++].name, IO_NAME_SIZE, "%s", entry->string);
    const char *nearest = io__nearest_channel(&names, name);
    char hint[IO_NAME_SIZE + 32] = "";
    if (nearest)
        snprintf(hint, sizeof hint, "did you mean \"%s\"? ", nearest);
    io__fail(m->log, m->path,
             "nothing is called \"%.200s\" among the %zu objects of its Cryptomatte "
             "\"%s\"; %sA pattern such as \"%.100s*\" may fit none",
             name, count, m->chosen->name, hint, name);
    free(names.channels);
    return -1;
}

/* The first Cryptomatte that knows the name decides for all names. */
static void choose_layer(matte *m, const char *pattern)
{
    const int32_t ids = m->id_count;
    const layer *other = NULL;
    for (int32_t i = 0; i < m->layer_count; i++)
        if (m->layers[i].manifest && match(m, &m->layers[i], pattern)) {
            if (!m->chosen)
                m->chosen = &m->layers[i];
            else
                other = &m->layers[i];
        }
    m->id_count = ids;
    if (!m->chosen)
        m->chosen = &m->layers[0];
    if (other)
        io__warn(m->log, m->path,
                 "\"%s\" is in several Cryptomattes; \"%s\" is used; write \"%s=%s\" for "
                 "the other",
                 pattern, m->chosen->name, other->name, pattern);
}

static int add_name(matte *m, const char *name)
{
    const bool is_pattern = strpbrk(name, "*?[") != NULL;
    if (!m->chosen)
        choose_layer(m, name);
    if (!m->chosen->manifest) {
        if (is_pattern)
            return io__fail(m->log, m->path,
                            "its Cryptomatte \"%s\" has no list of names; give whole "
                            "names instead of \"%s\"",
                            m->chosen->name, name);
        add_id(m, io_cryptomatte_id(name));
        return 0;
    }
    if (match(m, m->chosen, name))
        return 0;
    if (!is_pattern)
        return fail_name(m, name);
    io__warn(m->log, m->path, "nothing in its Cryptomatte \"%s\" fits \"%s\"",
             m->chosen->name, name);
    return 0;
}

static int add_names(matte *m, const char *names)
{
    for (int32_t i = 0; i < m->layer_count; i++) {
        const size_t length = strlen(m->layers[i].name);
        if (!strncmp(names, m->layers[i].name, length) && names[length] == '=') {
            m->chosen = &m->layers[i];
            names += length + 1;
        }
    }
    for (const char *at = names; at; at = strchr(at, ',')) {
        char name[1024];
        at += at > names;
        const size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof name)
            return io__fail(m->log, m->path,
                            "a name of an object is empty or too long; give names with "
                            "single commas in between");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (add_name(m, name))
            return -1;
    }
    return 0;
}

/* "NAME00.R", also behind the name of a part, in either case. */
static const io_channel *find_rank_channel(const io_image *probed, const char *layer_name,
                                           int level, char letter)
{
    char wanted[IO_NAME_SIZE + 16];
    snprintf(wanted, sizeof wanted, "%s%02d.%c", layer_name, level, letter);
    const size_t length = strlen(wanted);
    for (int32_t i = 0; i < probed->channel_count; i++) {
        const char *name = probed->channels[i].name;
        const size_t own = strlen(name);
        if (own < length || (own > length && name[own - length - 1] != '.'))
            continue;
        const char *tail = name + own - length;
        if (!strncmp(tail, wanted, length - 1)
            && toupper((unsigned char)tail[length - 1]) == letter)
            return &probed->channels[i];
    }
    return NULL;
}

/* Ids and coverages in turn. */
static int find_ranks(const matte *m, const io_image *probed,
                      const char *names[MAX_RANKS * 2])
{
    static const char letters[] = "RGBA";
    int count = 0;
    for (int level = 0; count + 4 <= MAX_RANKS * 2; level++) {
        for (int c = 0; c < 4; c++) {
            const io_channel *channel =
                find_rank_channel(probed, m->chosen->name, level, letters[c]);
            if (!channel)
                return count - count % 2;
            if (channel->is_half)
                return io__fail(m->log, m->path,
                                "its Cryptomatte \"%s\" is in half floats, which lose "
                                "its ids; write 32-bit floats",
                                m->chosen->name);
            names[count++] = channel->name;
        }
    }
    return count;
}

static bool is_wanted(const matte *m, float value)
{
    uint32_t id;
    memcpy(&id, &value, sizeof id);
    for (int32_t i = 0; i < m->id_count; i++)
        if (m->ids[i] == id)
            return true;
    return false;
}

/* Sums into the first channel, which held the ids of the first rank. */
static void sum_ranks(const matte *m, const io_image *ranks, float *coverage)
{
    const size_t count = (size_t)ranks->width * (size_t)ranks->height;
    for (size_t i = 0; i < count; i++) {
        float sum = 0.0f;
        for (int32_t c = 0; c + 1 < ranks->channel_count; c += 2) {
            const float share = ranks->channels[c + 1].data[i];
            if (share > 0.0f && is_wanted(m, ranks->channels[c].data[i]))
                sum += share;
        }
        coverage[i] = sum < 1.0f ? sum : 1.0f;
    }
}

static int read_ranks(const matte *m, io_image *out)
{
    const char *names[MAX_RANKS * 2];
    io_image probed = {0}, ranks = {0};
    if (io_probe(m->path, &probed, m->log))
        return -1;
    const int count = find_ranks(m, &probed, names);
    int result = count > 0    ? io_read(m->path, names, count, &ranks, m->log)
                 : count == 0 ? io__fail(m->log, m->path,
                                         "lacks the channels of its Cryptomatte \"%s\"; "
                                         "write them, too",
                                         m->chosen->name)
                              : -1;
    if (!result)
        sum_ranks(m, &ranks, ranks.channels[0].data);
    io_image_free(&probed);
    if (!result)
        *out = ranks;
    return result;
}

int io_cryptomatte_read(const char *path, const char *names, io_image *out,
                        const crv_logger *log)
{
    matte *m = calloc(1, sizeof *m);
    if (!m)
        return io__fail(log, path, "no memory; close other programs");
    m->path = path;
    m->log = log;
    int result = open_layers(m);
    if (!result)
        result = add_names(m, names);
    if (!result)
        result = read_ranks(m, out);
    for (int32_t i = 0; i < m->layer_count; i++)
        cJSON_Delete(m->layers[i].manifest);
    free(m);
    return result;
}

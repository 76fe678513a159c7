/* SPDX-License-Identifier: MIT */
#include "check_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "system/file.h"

/* The length that a binary glTF states, or 0 for any other file. */
static uint64_t stated_glb_length(const unsigned char header[12])
{
    if (memcmp(header, "glTF", 4) != 0)
        return 0;
    return (uint64_t)header[8] | (uint64_t)header[9] << 8 | (uint64_t)header[10] << 16
           | (uint64_t)header[11] << 24;
}

static bool refuse_to_open(const char *path, const crv_logger *log)
{
    scene_log(log, CRV_LOG_ERROR, path, "cannot be opened (%s); check the path",
              strerror(errno));
    return false;
}

/* A PLY without these lines sends assimp's reader beyond the file's end, or round for
 * ever. */
static bool is_sound_ply(FILE *file)
{
    enum { MAX_HEADER_LINES = 10000 };
    char line[512] = "";
    bool has_format = false;
    rewind(file);
    for (int i = 0; i < MAX_HEADER_LINES && fgets(line, sizeof line, file); i++) {
        has_format = has_format || strncmp(line, "format ", 7) == 0;
        if (strncmp(line, "end_header", 10) == 0)
            return has_format;
    }
    return false;
}

static bool is_ply(const unsigned char header[12])
{
    return memcmp(header, "ply", 3) == 0 && (header[3] == '\n' || header[3] == '\r');
}

bool check_mesh_file(const char *path, const crv_logger *log)
{
    unsigned char header[12] = {0};
    file_facts info;
    FILE *file;
    if (!file_look(path, &info))
        return refuse_to_open(path, log);
    if (info.is_folder) {
        scene_log(log, CRV_LOG_ERROR, path, "is a folder; name the mesh file in it");
        return false;
    }
    if (!info.is_regular) {
        scene_log(log, CRV_LOG_ERROR, path, "is not a file on disk; save the mesh first");
        return false;
    }
    file = fopen(path, "rb");
    if (!file)
        return refuse_to_open(path, log);
    const size_t got = fread(header, 1, sizeof header, file);
    const bool bad_ply = got >= 4 && is_ply(header) && !is_sound_ply(file);
    fclose(file);
    if (got == 0) {
        scene_log(log, CRV_LOG_ERROR, path, "is empty; export the model again");
        return false;
    }
    if (bad_ply) {
        scene_log(log, CRV_LOG_ERROR, path,
                  "is truncated or damaged: its PLY header has no end; copy or export it "
                  "again");
        return false;
    }
    if (stated_glb_length(header) > (uint64_t)info.size) {
        scene_log(log, CRV_LOG_ERROR, path,
                  "is truncated (%lld bytes of %llu); copy or export it again",
                  (long long)info.size, (unsigned long long)stated_glb_length(header));
        return false;
    }
    return true;
}

unsigned char *read_whole_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    unsigned char *data = NULL;
    if (file && fseek(file, 0, SEEK_END) == 0) {
        const long length = ftell(file);
        data = length >= 0 ? malloc((size_t)length + 1) : NULL;
        rewind(file);
        *size = data ? fread(data, 1, (size_t)length, file) : 0;
        if (data)
            data[*size] = 0;
    }
    if (file)
        fclose(file);
    return data;
}

/* SPDX-License-Identifier: MIT */
#include "import_memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/file.h"

static size_t read_file(struct aiFile *f, char *out, size_t size, size_t count)
{
    return fread(out, size, count, (FILE *)(void *)f->UserData);
}

static size_t write_file(struct aiFile *f, const char *data, size_t size, size_t count)
{
    (void)f, (void)data, (void)size, (void)count;
    return 0;
}

static size_t tell_file(struct aiFile *f)
{
    const long at = ftell((FILE *)(void *)f->UserData);
    return at > 0 ? (size_t)at : 0;
}

static aiReturn seek_file(struct aiFile *f, size_t offset, enum aiOrigin origin)
{
    const int from = origin == aiOrigin_SET   ? SEEK_SET
                     : origin == aiOrigin_CUR ? SEEK_CUR
                                              : SEEK_END;
    return fseek((FILE *)(void *)f->UserData, (long)offset, from) == 0 ? aiReturn_SUCCESS
                                                                       : aiReturn_FAILURE;
}

static size_t size_file(struct aiFile *f)
{
    FILE *file = (FILE *)(void *)f->UserData;
    const long at = ftell(file);
    long size = 0;
    if (at >= 0 && fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    fseek(file, at, SEEK_SET);
    return size > 0 ? (size_t)size : 0;
}

static void flush_file(struct aiFile *f)
{
    (void)f;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    const import_memory *m = (const import_memory *)(const void *)io->UserData;
    struct aiFile *f = malloc(sizeof *f);
    FILE *file = NULL;
    if (f && mode[0] == 'r')
        file = strcmp(path, m->path) == 0 ? file_of_bytes(m->data, m->size)
                                          : fopen(path, "rb");
    if (!file) {
        free(f);
        return NULL;
    }
    *f = (struct aiFile){.ReadProc = read_file,
                         .WriteProc = write_file,
                         .TellProc = tell_file,
                         .FileSizeProc = size_file,
                         .SeekProc = seek_file,
                         .FlushProc = flush_file,
                         .UserData = (aiUserData)(void *)file};
    return f;
}

static void close_file(struct aiFileIO *io, struct aiFile *f)
{
    (void)io;
    fclose((FILE *)(void *)f->UserData);
    free(f);
}

void import_memory_open(import_memory *m)
{
    m->io = (struct aiFileIO){.OpenProc = open_file,
                              .CloseProc = close_file,
                              .UserData = (aiUserData)(void *)m};
}

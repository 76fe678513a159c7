/* SPDX-License-Identifier: MIT */
/* exr_sink.c: EXR files being written. */
#include <errno.h>

#include <OpenEXRConfig.h>

#include "exr.h"

/* `fail` is left alone: OpenEXR calls this with the context's lock held, and `fail` takes
 * it again, for ever. */
static int64_t write_at(exr_const_context_t context, void *user, const void *buffer,
                        uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    io__exr_sink *sink = user;
    (void)context;
    (void)fail;
    if (!file_write_at(sink->output->file.stream, buffer, size, offset)) {
        sink->io_error = errno;
        return -1;
    }
    return (int64_t)size;
}

exr_result_t io__exr_sink_open(io__exr_sink *sink, io__output *output)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    *sink = (io__exr_sink){.output = output};
    initializer.error_handler_fn = io__exr_say_nothing;
    initializer.user_data = sink;
    initializer.write_fn = write_at;
    return exr_start_write(&sink->context, output->path, EXR_WRITE_FILE_DIRECTLY,
                           &initializer);
}

/*
 * zlib's level 2 instead of its 6: a float picture of 1920x1080 is packed in three
 * quarters of the time and is 1.4 % larger. Older libraries have no choice.
 */
exr_result_t io__exr_set_level(const io__exr_sink *sink, int part)
{
#if OPENEXR_VERSION_MAJOR > 3 || OPENEXR_VERSION_MINOR > 1 || OPENEXR_VERSION_PATCH >= 5
    return exr_set_zip_compression_level(sink->context, part, 2);
#else
    (void)sink;
    (void)part;
    return EXR_ERR_SUCCESS;
#endif
}

/* Readers take a chunk of exactly its unpacked size for one that is not packed; OpenEXR
 * 3.1.5 would write it packed all the same. */
exr_result_t io__exr_write_packed(const io__exr_sink *sink, int part,
                                  const io__exr_chunk *chunk,
                                  const exr_encode_pipeline_t *encode)
{
    const bool raw = encode->compressed_bytes >= encode->packed_bytes;
    const void *bytes = raw ? encode->packed_buffer : encode->compressed_buffer;
    const uint64_t size = raw ? encode->packed_bytes : encode->compressed_bytes;
    if (encode->chunk.type == EXR_STORAGE_TILED)
        return exr_write_tile_chunk(sink->context, part, chunk->x, chunk->y, 0, 0, bytes,
                                    size);
    return exr_write_scanline_chunk(sink->context, part, chunk->y, bytes, size);
}

int io__exr_sink_close(io__exr_sink *sink, exr_result_t code, const char *remedy)
{
    const io__output *output = sink->output;
    if (sink->context) {
        /* Writes the table of chunks, so that it can fail too. */
        const exr_result_t finished = exr_finish(&sink->context);
        code = code ? code : finished;
    }
    if (!code && !sink->io_error)
        return 0;
    if (io__output_stops(output))
        return io__output_stopped(output);
    errno = sink->io_error;
    if (sink->io_error)
        return io__output_fail(output);
    return io__fail(output->log, output->path, "OpenEXR cannot write it (%s); %s",
                    exr_get_default_error_message(code), remedy);
}

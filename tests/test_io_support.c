/* SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <unistd.h>

#include "test_io_support.h"

static char folder[64];
support_log support_lines;

int support_setup(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/crevice-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int each_file(int (*visit)(const char *name, void *user), void *user)
{
    DIR *dir = opendir(folder);
    if (!dir)
        return -1;
    for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir))
        if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, ".."))
            visit(entry->d_name, user);
    return closedir(dir);
}

static int remove_file(const char *name, void *user)
{
    const char *path = support_path(name);
    (void)user;
    return unlink(path) ? rmdir(path) : 0;
}

int support_teardown(void **state)
{
    (void)state;
    each_file(remove_file, NULL);
    return rmdir(folder);
}

const char *support_path(const char *name)
{
    static char paths[8][256];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%.180s", folder, name);
    return path;
}

typedef struct file_count {
    int files;
    bool leftovers;
} file_count;

static int count_file(const char *name, void *user)
{
    file_count *count = user;
    count->files++;
    count->leftovers |= name[0] == '.';
    return 0;
}

int support_file_count(bool *leftovers)
{
    file_count count = {0};
    each_file(count_file, &count);
    *leftovers = count.leftovers;
    return count.files;
}

void support_write_file(const char *path, const void *data, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(data, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

unsigned char *support_read_file(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    const long length = ftell(stream);
    assert_true(length >= 0);
    rewind(stream);
    unsigned char *data = malloc((size_t)length + 1);
    assert_non_null(data);
    *size = fread(data, 1, (size_t)length, stream);
    assert_int_equal(*size, length);
    fclose(stream);
    return data;
}

static void remember(void *user, crv_log_level level, const char *line)
{
    support_log *log = user;
    const size_t used = strlen(log->text);
    log->errors += level == CRV_LOG_ERROR;
    log->warnings += level == CRV_LOG_WARNING;
    log->infos += level == CRV_LOG_INFO;
    if (level == CRV_LOG_ERROR)
        snprintf(log->error, sizeof log->error, "%s", line);
    snprintf(log->text + used, sizeof log->text - used, "%s\n", line);
}

const crv_logger *support_logger(void)
{
    static const crv_logger logger = {remember, &support_lines};
    return &logger;
}

void support_forget(void)
{
    memset(&support_lines, 0, sizeof support_lines);
}

void support_expect_error(const char *path, const char *part)
{
    const char *line = support_lines.error;
    const size_t length = strlen(path);
    if (support_lines.errors != 1 || strncmp(line, path, length)
        || strncmp(line + length, ": ", 2) || !strstr(line, part) || !strchr(line, ';')
        || strchr(line, '\n'))
        fail_msg("%d errors, the last: \"%s\"; expected \"%s: ... %s ...; remedy\"",
                 support_lines.errors, line, path, part);
    support_forget();
}

float support_value(int p, int c, int32_t x, int32_t y)
{
    /* Below 2048 half floats hold every integer. */
    return (float)((x * 7 + y * 13 + c * 101 + p * 307) % 2048);
}

static void ok(exr_result_t code)
{
    if (code != EXR_ERR_SUCCESS)
        fail_msg("OpenEXR: %s", exr_get_default_error_message(code));
}

/* The pixels of one chunk, each channel in a plane of its own. */
static float *fill_chunk(const support_part *part, int p, int32_t x0, int32_t y0,
                         int32_t width, int32_t height)
{
    const size_t plane = (size_t)width * (size_t)height;
    float *data = calloc(plane * (size_t)part->channel_count, sizeof *data);
    assert_non_null(data);
    for (int c = 0; c < part->channel_count; c++)
        for (int32_t y = 0; y < height; y++)
            for (int32_t x = 0; x < width; x++) {
                float *value =
                    &data[(size_t)c * plane + (size_t)y * (size_t)width + (size_t)x];
                *value = support_value(p, c, x0 + x, y0 + y);
                if (part->types[c] == EXR_PIXEL_UINT) {
                    const uint32_t whole = (uint32_t)*value;
                    memcpy(value, &whole, sizeof whole);
                }
            }
    return data;
}

static void encode_chunk(exr_context_t context, const support_part *part, int p,
                         const exr_chunk_info_t *info, int32_t x0, int32_t y0)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    float *data = fill_chunk(part, p, x0, y0, info->width, info->height);
    ok(exr_encoding_initialize(context, p, info, &encode));
    for (int16_t c = 0; c < encode.channel_count; c++) {
        exr_coding_channel_info_t *channel = &encode.channels[c];
        channel->encode_from_ptr =
            (const uint8_t *)(data
                              + (size_t)c * (size_t)info->width * (size_t)info->height);
        channel->user_bytes_per_element = 4;
        channel->user_data_type =
            channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = 4 * (channel->x_samples ? channel->x_samples : 1);
        channel->user_line_stride = info->width * 4;
    }
    ok(exr_encoding_choose_default_routines(context, p, &encode));
    ok(exr_encoding_run(context, p, &encode));
    ok(exr_encoding_destroy(context, &encode));
    free(data);
}

static void write_tiles(exr_context_t context, const support_part *part, int p)
{
    exr_chunk_info_t info;
    for (int32_t y = 0; y * part->tile_height < part->height; y++)
        for (int32_t x = 0; x * part->tile_width < part->width; x++) {
            ok(exr_write_tile_chunk_info(context, p, x, y, 0, 0, &info));
            encode_chunk(context, part, p, &info, x * part->tile_width,
                         y * part->tile_height);
        }
}

static void write_scanlines(exr_context_t context, const support_part *part, int p)
{
    int32_t lines = 0;
    ok(exr_get_scanlines_per_chunk(context, p, &lines));
    for (int32_t y = 0; y < part->height; y += lines) {
        exr_chunk_info_t info;
        ok(exr_write_scanline_chunk_info(context, p, part->min_y + y, &info));
        encode_chunk(context, part, p, &info, 0, y);
    }
}

void support_turn_upside_down(const char *path, int chunks)
{
    static const char attribute[] = "lineOrder\0lineOrder\0\1\0\0"; /* size 1, 0 above */
    size_t size = 0;
    unsigned char *data = support_read_file(path, &size);
    unsigned char *turned = malloc(size);
    uint64_t offsets[64];
    assert_non_null(turned);
    assert_in_range(chunks, 2, 64);
    size_t at = 0;
    while (at + sizeof attribute < size && memcmp(data + at, attribute, sizeof attribute))
        at++;
    assert_true(at + sizeof attribute < size);
    data[at + sizeof attribute] = EXR_LINEORDER_DECREASING_Y;
    /* The table of chunks ends where the first chunk begins. */
    const size_t table_size = (size_t)chunks * sizeof(uint64_t);
    size_t table = 0;
    for (table = at; table + table_size < size; table++) {
        memcpy(offsets, data + table, sizeof(uint64_t));
        if (offsets[0] == table + table_size)
            break;
    }
    memcpy(offsets, data + table, table_size);
    memcpy(turned, data, table + table_size);
    size_t end = table + table_size;
    for (int i = chunks - 1; i >= 0; i--) {
        const size_t next = i + 1 < chunks ? (size_t)offsets[i + 1] : size;
        const size_t length = next - (size_t)offsets[i];
        const uint64_t moved = end;
        memcpy(turned + end, data + offsets[i], length);
        memcpy(turned + table + (size_t)i * sizeof moved, &moved, sizeof moved);
        end += length;
    }
    assert_int_equal(end, size);
    support_write_file(path, turned, size);
    free(turned);
    free(data);
}

static void declare_part(exr_context_t context, const support_part *part, int p,
                         const int32_t display[4])
{
    const exr_attr_v2f_t centre = {.x = 0.0f, .y = 0.0f};
    const exr_attr_box2i_t data = {
        .min = {.x = part->min_x, .y = part->min_y},
        .max = {.x = part->min_x + part->width - 1, .y = part->min_y + part->height - 1}};
    const exr_attr_box2i_t shown = {.min = {.x = display[0], .y = display[1]},
                                    .max = {.x = display[2], .y = display[3]}};
    int index = -1;
    ok(exr_add_part(context, part->name ? part->name : "only", part->storage, &index));
    assert_int_equal(index, p);
    ok(exr_initialize_required_attr(context, p, &shown, &data, 1.0f, &centre, 1.0f,
                                    EXR_LINEORDER_INCREASING_Y, part->compression));
    if (part->storage == EXR_STORAGE_TILED)
        ok(exr_set_tile_descriptor(context, p, (uint32_t)part->tile_width,
                                   (uint32_t)part->tile_height, EXR_TILE_ONE_LEVEL,
                                   EXR_TILE_ROUND_DOWN));
    for (int c = 0; c < part->channel_count; c++) {
        const int32_t sampling =
            part->sampling && c == part->channel_count - 1 ? part->sampling : 1;
        ok(exr_add_channel(context, p, part->channels[c], part->types[c],
                           EXR_PERCEPTUALLY_LOGARITHMIC, sampling, sampling));
    }
}

static void set_matrix(exr_context_t context, int part, const char *name, const float *m)
{
    exr_attr_m44f_t matrix;
    if (!m)
        return;
    memcpy(matrix.m, m, sizeof matrix.m);
    ok(exr_attr_set_m44f(context, part, name, &matrix));
}

void support_make_lens_exr(const char *path, int32_t width, int32_t height,
                           const char *const names[2], const float values[2])
{
    const support_part part = {.storage = EXR_STORAGE_SCANLINE,
                               .compression = EXR_COMPRESSION_ZIP,
                               .width = width,
                               .height = height,
                               .channel_count = 1,
                               .channels = {"Z"},
                               .types = {EXR_PIXEL_FLOAT}};
    const int32_t display[4] = {0, 0, width - 1, height - 1};
    exr_context_t context = NULL;
    ok(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL));
    declare_part(context, &part, 0, display);
    for (int i = 0; i < 2 && names[i]; i++)
        ok(exr_attr_set_float(context, 0, names[i], values[i]));
    ok(exr_write_header(context));
    write_scanlines(context, &part, 0);
    ok(exr_finish(&context));
}

void support_make_exr(const char *path, const support_part *parts, int count,
                      const int32_t display[4], const float *world_to_camera,
                      const float *world_to_ndc)
{
    exr_context_t context = NULL;
    const int32_t own[4] = {parts->min_x, parts->min_y, parts->min_x + parts->width - 1,
                            parts->min_y + parts->height - 1};
    ok(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL));
    for (int p = 0; p < count; p++)
        declare_part(context, &parts[p], p, display ? display : own);
    set_matrix(context, 0, "worldToCamera", world_to_camera);
    set_matrix(context, 0, "worldToNDC", world_to_ndc);
    for (int p = 0; p < count; p++)
        set_matrix(context, p, "worldToNDC", parts[p].world_to_ndc);
    for (int p = 0; p < count; p++)
        if (parts[p].view)
            ok(exr_attr_set_string(context, p, "view", parts[p].view));
    ok(exr_write_header(context));
    for (int p = 0; p < count; p++) {
        if (parts[p].storage == EXR_STORAGE_TILED)
            write_tiles(context, &parts[p], p);
        else
            write_scanlines(context, &parts[p], p);
    }
    ok(exr_finish(&context));
}

void support_make_plain_exr(const char *path, const char *const *names, int count,
                            int32_t width, int32_t height, const float *const *planes)
{
    io_image image;
    assert_int_equal(io_image_init(&image, width, height, names, count, NULL), 0);
    for (int c = 0; c < count; c++)
        memcpy(image.channels[c].data, planes[c],
               (size_t)width * (size_t)height * sizeof(float));
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
}

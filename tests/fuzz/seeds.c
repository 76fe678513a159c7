/* SPDX-License-Identifier: MIT */
/* fuzz_seeds FOLDER: writes the inputs that fuzzers begin from, FOLDER/TARGET/NAME: small
 * sound files of every kind. */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fuzz.h"
#include "seeds.h"

#include "commands.h"
#include "common/viewer_args.h"
#include "import_assimp.h"
#include "reference_internal.h"

static char folder[1024];

void seeds_write(const char *target, const char *name, const void *data, size_t size)
{
    char path[2048];
    snprintf(path, sizeof path, "%s/%s", folder, target);
    FUZZ_CHECK(!mkdir(path, 0777) || errno == EEXIST, "%s", path);
    snprintf(path, sizeof path, "%s/%s/%s", folder, target, name);
    fuzz_file(path, data, size);
}

void seeds_take(const char *target, const char *name, const char *path,
                const char *before, const char *after)
{
    FILE *file = fopen(path, "rb");
    char data[1 << 16];
    FUZZ_CHECK(file, "%s was not written", path);
    memcpy(data, before, strlen(before));
    size_t size = strlen(before);
    size += fread(data + size, 1, sizeof data - size - strlen(after), file);
    FUZZ_CHECK(getc(file) == EOF, "%s is large", path);
    fclose(file);
    memcpy(data + size, after, strlen(after));
    seeds_write(target, name, data, size + strlen(after));
}

/* As scene/import_pipe.c sends it, a message first. */
static void write_pipe(const char *path)
{
import found = {0 };
    FUZZ_CHECK(!import_assimp(path, &found, &fuzz_logger), "%s", path);
    int file = open("pipe", O_RDWR | O_CREAT | O_TRUNC, 0666);
    const crv_logger log = import_pipe_logger(&file);
    log.fn(log.user, CRV_LOG_WARNING, "model: is made by hand; take another");
    FUZZ_CHECK(import_pipe_send(file, &found), "not sent");
    close(file);
    import_free(&found);
    seeds_take("pipe", "triangles", "pipe", "", "");
    remove("pipe");
}

static void write_checkpoint(void)
{
    /* Format and fingerprint are mended by the target; then 16 pixels, 5 of them done. */
    uint8_t data[1 + 48 + REFERENCE_FLOATS * 4 * 16 + 8] = {3};
    data[1 + 32] = 16;
    data[1 + 40] = 5;
    seeds_write("checkpoint", "mended", data, sizeof data);
    data[1 + 40] = 16;
    data[0] = 1;
    seeds_write("checkpoint", "wrong-sum", data, sizeof data);
}

/* The words of a line, one a line, behind the letter of their command. */
static void write_words(const char *name, char letter, const char *line)
{
    char text[2048];
    const int length = snprintf(text, sizeof text, "%c%s", letter, line);
    for (char *c = text; *c; c++)
        if (*c == ' ' || *c == '=')
            *c = '\n';
    seeds_write("text", name, text, (size_t)length);
}

static void write_text(void)
{
    static const command *const commands[] = {
        &command_render,  &command_ao,      &command_gbuffer, &command_reference,
        &command_compare, &command_methods, &command_devices, &command_bench,
        &command_tune,    &command_view};
    enum { COUNT = sizeof commands / sizeof *commands };
    char name[64];
    for (int i = 0; i < COUNT; i++)
        for (int e = 1; commands[i]->examples && commands[i]->examples[e - 1]; e += 2) {
            const char *words = commands[i]->examples[e];
            for (int skip = 0; skip < 2; skip++) /* "crevice" and the command */
                words = strchr(words, ' ') ? strchr(words, ' ') + 1 : "";
            snprintf(name, sizeof name, "%s-%d", commands[i]->name, e / 2);
            write_words(name, (char)('T' + i), words); /* 'T' is 0 modulo 12 */
        }
    for (int32_t m = 0; m < crv_method_count(); m++) {
        char line[2048];
        const crv_method *method = crv_method_at(m);
        snprintf(line, sizeof line, "method %s %s", method->name,
                 crv_preset_text(method, CRV_PRESET_PAPER));
        write_words(method->name, 'T' + COUNT, line);
    }
    write_words("frames", 'T' + COUNT + 1,
                "1-240 1,3,10-20x2 -5--1 shot.####.exr shot.%04d.exr "
                "shot.$F4.exr shot.<frame>.exr");
    static const char *const lights[] = {"wpainted\n30,40,2", "wconstant:1,2,3\nnone",
                                         "wgradient\n-360,90", "wconstant"};
    for (int i = 0; i < 4; i++) {
        snprintf(name, sizeof name, "words-%d", i);
        seeds_write("sky", name, lights[i], strlen(lights[i]));
    }
}

/* In all the ways of tools/common/camera_json.c and camera_chan.c. */
static void write_cameras(void)
{
    static const char look_at[] =
        "a{\"eye\":[1,2,3],\"target\":[0,0,0],\"up\":[0,1,0],\"vfov\":40}";
    static const char matrices[] =
        "a[{\"frame\":1,\"camera_to_world\":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1],"
        "\"hfov\":50},{\"frame\":2,\"world_to_camera\":[[1,0,0,-5],[0,1,0,-6],"
        "[0,0,1,-7],[0,0,0,1]],\"ortho\":3}]";
    static const char lens[] =
        "a{\"cameras\":[{\"frame\":1,\"eye\":[0,0,9],\"target\":[0,0,0],\"lens\":35,"
        "\"sensor\":36}]}";
    static const char angles[] = "b1 0 1 5 -10 20 0 45\n2 0 1 6 -11 21 0 45\n";
    const char *const files[] = {look_at, matrices, lens, angles};
    for (int i = 0; i < 4; i++) {
        char name[32];
        snprintf(name, sizeof name, "cameras-%d", i);
        seeds_write("cameras", name, files[i], strlen(files[i]));
    }
}

/* Numbers of a generator: most of them run. */
static void write_calls(void)
{
    uint32_t state = 1;
    for (int i = 0; i < 96; i++) {
        uint8_t data[200];
        char name[32];
        for (size_t k = 0; k < sizeof data; k++) {
            state = state * 1664525u + 1013904223u;
            data[k] = (uint8_t)(state >> 24);
        }
        data[0] &= 0xbf; /* no failing allocation */
        snprintf(name, sizeof name, "calls-%02d", i);
        seeds_write("api", name, data, sizeof data);
        data[0] = (uint8_t)i; /* each kind in turn */
        seeds_write("convert", name, data, sizeof data);
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
        return 2;
    }
    snprintf(folder, sizeof folder, "%s", argv[1]);
    FUZZ_CHECK(!mkdir(folder, 0777) || errno == EEXIST, "%s", folder);
    seeds_write_pictures();
    seeds_write_models();
    write_pipe("model.obj");
    remove("model.obj");
    write_checkpoint();
    write_text();
    write_calls();
    write_cameras();
    return 0;
}

/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include "fuzz.h"

#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

/* Not through fopen(): some file systems flush what was truncated to nothing. */
const char *fuzz_file(const char *name, const uint8_t *data, size_t size)
{
    const int file = open(name, O_WRONLY | O_CREAT, 0666);
    FUZZ_CHECK(file >= 0 && pwrite(file, data, size, 0) == (ssize_t)size
                   && !ftruncate(file, (off_t)size),
               "%s cannot be written", name);
    close(file);
    return name;
}

int fuzz_errors;

static void check_line(void *user, crv_log_level level, const char *line)
{
    (void)user;
    fuzz_errors += level == CRV_LOG_ERROR;
    FUZZ_CHECK(line[0], "an empty line");
    for (const unsigned char *c = (const unsigned char *)line; *c; c++) {
        FUZZ_CHECK(*c >= 32 && *c != 127, "a control character in: %s", line);
        FUZZ_CHECK(!(c[0] == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0), "C1 in: %s", line);
    }
}

const crv_logger fuzz_logger = {check_line, NULL};

uint32_t fuzz_byte(fuzz_bytes *in)
{
    if (in->left == 0)
        return 0;
    in->left--;
    return *in->at++;
}

uint32_t fuzz_word(fuzz_bytes *in)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value = value << 8 | fuzz_byte(in);
    return value;
}

bool fuzz_seldom(fuzz_bytes *in, uint32_t times)
{
    return fuzz_byte(in) % times == times - 1;
}

int32_t fuzz_int(fuzz_bytes *in, int32_t most)
{
    const uint32_t value = fuzz_byte(in);
    if (value < 252)
        return (int32_t)(value % ((uint32_t)most + 1));
    return value == 252   ? -1
           : value == 253 ? INT32_MAX
           : value == 254 ? INT32_MIN
                          : (int32_t)fuzz_word(in);
}

float fuzz_float(fuzz_bytes *in, float usual)
{
    static const float extreme[] = {0.0f,    -0.0f,  NAN,     INFINITY, -INFINITY,
                                    1e-42f,  1e-30f, 1e-9f,   1e9f,     1e30f,
                                    3.4e38f, -1.0f,  -3.4e38f};
    enum { COUNT = sizeof extreme / sizeof *extreme };
    const uint32_t kind = fuzz_byte(in) % 32;
    if (kind < COUNT)
        return extreme[kind];
    if (kind == COUNT) {
        const uint32_t bits = fuzz_word(in);
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    return kind == COUNT + 1 ? -usual : usual * (0.25f + (float)fuzz_byte(in) / 64.0f);
}

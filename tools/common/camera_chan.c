/* SPDX-License-Identifier: MIT */
/*
 * camera_chan.c: Nuke's .chan, a line a frame: number, position, rotation about x, y and
 * z, and perhaps the vertical field of view, angles in degrees.
 */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera_parse.h"

static const double degree = 3.14159265358979323846 / 180.0;

enum { MOST = 16, FEWEST = 7, WITH_VFOV = 8 };

/* The numbers of a line; -1 if it holds anything else. Goes on to the next line. */
static int read_line(const char **text, double numbers[MOST])
{
    int count = 0;
    const char *p = *text;
    bool good = true;
    for (;;) {
        while (*p == ' ' || *p == '\t' || *p == '\r' || *p == ',')
            p++;
        if (*p == '\0' || *p == '\n' || *p == '#')
            break;
        char *end;
        const double value = strtod(p, &end);
        good = good && end > p && count < MOST && isfinite(value)
               && (isspace((unsigned char)*end) || *end == '\0' || *end == ',');
        if (!good)
            break;
        numbers[count++] = value;
        p = end;
    }
    p += strcspn(p, "\n");
    *text = *p ? p + 1 : p;
    return good ? count : -1;
}

/* m = m * rotation about an axis: what is multiplied last is applied first. */
static void turn(double m[9], int axis, double angle_rad)
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double c = cos(angle_rad), s = sin(angle_rad);
    for (int row = 0; row < 3; row++) {
        const double p = m[3 * row + a], q = m[3 * row + b];
        m[3 * row + a] = c * p + s * q;
        m[3 * row + b] = c * q - s * p;
    }
}

static camera_entry entry_of(const double n[MOST], int count, int order)
{
    camera_entry entry = {.has_frame = true,
                          .frame = (int32_t)n[0],
                          .eye = {n[1], n[2], n[3]},
                          .vfov_rad = count >= WITH_VFOV ? n[7] * degree : 0.0};
    double to_world[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int i = 2; i >= 0; i--) {
        const int axis = camera_file_orders[order][i] - 'x';
        turn(to_world, axis, n[4 + axis] * degree);
    }
    for (int i = 0; i < 9; i++)
        entry.to_view[i] = to_world[i % 3 * 3 + i / 3];
    camera_pose_aim(&entry);
    return entry;
}

int camera_parse_chan(const char *text, int order, camera_file *out, report *r)
{
    int result = EXIT_DONE;
    for (int line = 1; result == EXIT_DONE && *text; line++) {
        double n[MOST];
        const int count = read_line(&text, n);
        if (count == 0)
            continue;
        if (count < FEWEST || !camera_is_frame(n[0])
            || (count >= WITH_VFOV && !(n[7] > 0.0 && n[7] < 180.0))) {
            report_error(
                r,
                "%s: line %d is neither JSON nor a line of .chan (frame tx ty tz "
                "rx ry rz vfov); export the camera again",
                out->path, line);
            return EXIT_FAILED;
        }
        const camera_entry entry = entry_of(n, count, order);
        result = camera_file_add(out, &entry, r);
    }
    return result;
}

/* SPDX-License-Identifier: MIT */
/* Files of cameras: one camera written in every way must be read as that one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "common/frame_camera.h"
#include "common/camera_file.h"

static char path[64];
static report quiet;

static int setup(void **state)
{
    (void)state;
    snprintf(path, sizeof path, "/tmp/crevice-camera-XXXXXX");
    const int file = mkstemp(path);
    report_init(&quiet);
    quiet.quiet = true;
    return file < 0 ? -1 : close(file);
}

static int teardown(void **state)
{
    (void)state;
    return unlink(path);
}

static int load(const char *text, int order, camera_file *out)
{
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    quiet.errors = 0;
    return camera_file_load(path, order, out, &quiet);
}

/* Eye at 1, 2, 3; looks along +x, up is +z: right is -y. By hand. */
static const double expected[9] = {0, -1, 0, 0, 0, 1, -1, 0, 0};

static void expect_pose(const camera_entry *entry)
{
    assert_non_null(entry);
    assert_true(entry->has_pose);
    for (int i = 0; i < 9; i++) /* sines and cosines of whole quarters: rounding only */
        assert_true(fabs(entry->to_view[i] - expected[i]) < 1e-12);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(entry->eye[i] - (1.0 + i)) < 1e-12);
}

static void test_ways_to_write_it(void **state)
{
    (void)state;
    /* 90 degrees about x lifts a view down to a level one, -90 about z turns it from +y
     * to +x: in Blender's words, rotation x 90, z -90. */
    static const char *const texts[] = {
        "{\"eye\": [1, 2, 3], \"target\": [5, 2, 3], \"up\": [0, 0, 2], \"vfov\": 60}",
        "{\"camera_to_world\": [[0, 0, -1, 1], [-1, 0, 0, 2], [0, 1, 0, 3], [0, 0, 0, "
        "1]],"
        " \"vfov\": 60}",
        "{\"camera_to_world\": [0, -2, 0, 0, 0, 0, 2, 0, -2, 0, 0, 0, 1, 2, 3, 1],"
        " \"vfov_degrees\": 60}",
        "{\"world_to_camera\": [[0, -1, 0, 2], [0, 0, 1, -3], [-1, 0, 0, 1], [0, 0, 0, "
        "1]],"
        " \"vfov\": 60}",
        "[{\"frame\": 8, \"eye\": [1, 2, 3], \"target\": [5, 2, 3], \"up\": [0, 0, 1],"
        " \"vfov\": 60}, {\"frame\": 9, \"eye\": [0, 0, 0], \"target\": [1, 0, 0]}]",
        "{\"8\": {\"eye\": [1, 2, 3], \"target\": [2, 2, 3], \"up\": [0, 0, 1],"
        " \"vfov\": 60}}",
        "{\"cams\": {\"9\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],"
        " \"8\": [[0, 0, -1, 1], [-1, 0, 0, 2], [0, 1, 0, 3], [0, 0, 0, 1]]},"
        " \"scene\": \"a\", \"vfov\": 60}",
        "# made by hand\n7 0 0 0 0 0 0 50\n8\t1\t2\t3\t90\t0\t-90\t60\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        camera_file file;
        /* The order in which these angles were measured: x first, then z. */
        const int order = i == 7 ? 1 : CAMERA_FILE_ZXY;
        assert_int_equal(load(texts[i], order, &file), EXIT_DONE);
        const camera_entry *entry = camera_file_find(&file, true, 8, "it", &quiet);
        expect_pose(entry);
        assert_true(fabs(entry->vfov_rad - 3.14159265358979 / 3) < 1e-12);
        assert_true(entry->hfov_rad <= 0.0 && entry->view_height <= 0.0);
        camera_file_free(&file);
    }
}

/* z first, then x, then y: if only x and y are turned, x is applied first. */
static void test_nuke_order(void **state)
{
    (void)state;
    camera_file file;
    assert_int_equal(load("1 0 0 0 90 90 0\n", CAMERA_FILE_ZXY, &file), EXIT_DONE);
    /* Back is +z; about x by 90 it goes to -y, which y leaves alone. Right is x; about y
     * by 90 it goes to -z. */
    const double *m = file.entries[0].to_view;
    assert_true(fabs(m[2] + 1) < 1e-12 && fabs(m[7] + 1) < 1e-12);
    assert_true(file.entries[0].vfov_rad <= 0.0);
    camera_file_free(&file);
}

static void test_lenses(void **state)
{
    (void)state;
    camera_file file;
    assert_int_equal(load("{\"frames\": [{\"frame\": 1}, {\"frame\": 2, \"lens\": 9}],"
                          " \"lens\": 18}",
                          0, &file),
                     EXIT_DONE);
    /* 36 mm over twice 18 and twice 9. */
    assert_true(fabs(tan(0.5 * file.entries[0].hfov_rad) - 1.0) < 1e-12);
    assert_true(fabs(tan(0.5 * file.entries[1].hfov_rad) - 2.0) < 1e-12);
    assert_false(file.entries[0].has_pose);
    camera_file_free(&file);
    assert_int_equal(load("{\"ortho\": 5}", 0, &file), EXIT_DONE);
    assert_true(file.entries[0].view_height == 5.0);
    camera_file_free(&file);
}

static void test_refusals(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "{\"vfov\": 60",
        "{\"vfov\": 180}",
        "{\"vfov\": \"60\"}",
        "{\"vfov\": 60, \"lens\": 35}",
        "{\"name\": \"a\"}",
        "[[1, 2], 3]",
        "{\"eye\": [1, 2, 3], \"target\": [1, 2, 3]}",
        "{\"eye\": [0, 0, 0], \"target\": [0, 1, 0]}",
        "{\"eye\": [0, 0], \"target\": [0, 1, 0]}",
        "{\"camera_to_world\": [[1,0,0,0], [0,1,0,0], [0,0,-1,0], [0,0,0,1]]}",
        "{\"camera_to_world\": [[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}",
        "{\"camera_to_world\": [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 1]]}",
        "{\"camera_to_world\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}",
        "[{\"frame\": 1.5, \"vfov\": 60}]",
        "1 2 3 4 5 6\n",
        "1 0 0 0 0 0 0 180\n",
        "a 0 0 0 0 0 0 60\n",
        "1 0 0 0 0 0 nan 60\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        camera_file file;
        if (load(texts[i], 0, &file) == EXIT_DONE)
            fail_msg("taken: %s", texts[i]);
        assert_int_equal(quiet.errors, 1);
    }
}

static void test_frames(void **state)
{
    (void)state;
    camera_file file;
    assert_int_equal(load("5 0 0 0 0 0 0 60\n7 0 0 0 0 0 0 61\n", 0, &file), EXIT_DONE);
    assert_ptr_equal(camera_file_find(&file, true, 7, "it", &quiet), &file.entries[1]);
    assert_null(camera_file_find(&file, true, 6, "it", &quiet));
    assert_null(camera_file_find(&file, false, 0, "it", &quiet));
    assert_int_equal(quiet.errors, 2);
    camera_file_free(&file);
    assert_int_equal(load("5 0 0 0 0 0 0 60\n", 0, &file), EXIT_DONE);
    assert_non_null(camera_file_find(&file, false, 0, "it", &quiet));
    assert_null(camera_file_find(&file, true, 6, "it", NULL));
    camera_file_free(&file);
    int32_t number = 0;
    assert_true(frame_camera_number("a9/shot_v2.0012.exr", &number) && number == 12);
    assert_true(frame_camera_number("shot.-3.exr", &number) && number == -3);
    assert_true(frame_camera_number("shot-3.exr", &number) && number == 3);
    assert_false(frame_camera_number("a9/shot.exr", &number));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ways_to_write_it), cmocka_unit_test(test_nuke_order),
        cmocka_unit_test(test_lenses),           cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_frames),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}

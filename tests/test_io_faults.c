/* SPDX-License-Identifier: MIT */
/* Disks that fail at every call in turn, interrupts, leftovers, links and names that lie.
 */
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "internal.h"
#include "test_io_support.h"

/* The call that fails next, counted from 0; negative: none. A short call does half. */
static int left_until_fault = -1;
static int fault_errno; /* 0: a short call */
static bool has_failed;
static size_t largest_request;

static bool fails_now(bool can_be_short)
{
    if (!fault_errno && !can_be_short)
        return false;
    if (left_until_fault < 0 || left_until_fault-- > 0)
        return false;
    has_failed = true;
    errno = fault_errno;
    return true;
}

static void plan_fault(int number, int reason)
{
    left_until_fault = number;
    fault_errno = reason;
    has_failed = false;
}

#define WRAP_AT(name, pointer)                                                           \
    ssize_t __real_##name(int file, pointer bytes, size_t size, off_t offset);           \
    ssize_t __wrap_##name(int file, pointer bytes, size_t size, off_t offset);           \
    ssize_t __wrap_##name(int file, pointer bytes, size_t size, off_t offset)            \
    {                                                                                    \
        if (!fails_now(true))                                                            \
            return __real_##name(file, bytes, size, offset);                             \
        return fault_errno ? -1 : __real_##name(file, bytes, (size + 1) / 2, offset);    \
    }
WRAP_AT(pread, void *)
WRAP_AT(pread64, void *)
WRAP_AT(pwrite, const void *)
WRAP_AT(pwrite64, const void *)

#define WRAP_STREAM(name, pointer)                                                       \
    size_t __real_##name(pointer bytes, size_t size, size_t count, FILE *stream);        \
    size_t __wrap_##name(pointer bytes, size_t size, size_t count, FILE *stream);        \
    size_t __wrap_##name(pointer bytes, size_t size, size_t count, FILE *stream)         \
    {                                                                                    \
        return fails_now(false) ? 0 : __real_##name(bytes, size, count, stream);         \
    }
WRAP_STREAM(fread, void *)
WRAP_STREAM(fwrite, const void *)

int __real_fflush(FILE *stream);
int __wrap_fflush(FILE *stream);
int __wrap_fflush(FILE *stream)
{
    return fails_now(false) ? EOF : __real_fflush(stream);
}

int __real_fsync(int file);
int __wrap_fsync(int file);
int __wrap_fsync(int file)
{
    return fails_now(false) ? -1 : __real_fsync(file);
}

int __real_fclose(FILE *stream);
int __wrap_fclose(FILE *stream);
int __wrap_fclose(FILE *stream)
{
    const bool fails = fails_now(false);
    const int result = __real_fclose(stream);
    if (!fails)
        return result;
    errno = fault_errno;
    return EOF;
}

/* A temporary file that another process has locked, in order to remove it. */
static bool is_contended;
static char contended[4096];
static int contender = -1;
static bool is_locked_at_rename;

int __real_flock(int file, int operation);
int __wrap_flock(int file, int operation);
int __wrap_flock(int file, int operation)
{
    if (is_contended) {
        char link[64];
        snprintf(link, sizeof link, "/proc/self/fd/%d", file);
        const ssize_t length = readlink(link, contended, sizeof contended - 1);
        contended[length > 0 ? length : 0] = '\0';
        contender = open(link, O_RDWR);
        is_contended = __real_flock(contender, LOCK_EX | LOCK_NB);
    }
    return __real_flock(file, operation);
}

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to)
{
    if (contended[0])
        unlink(contended); /* what it was locked for */
    contended[0] = '\0';
    /* Nobody may take it for a leftover now. */
    const int other = open(from, O_RDWR);
    is_locked_at_rename = other >= 0 && __real_flock(other, LOCK_EX | LOCK_NB) != 0;
    if (other >= 0)
        close(other);
    return fails_now(false) ? -1 : __real_rename(from, to);
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size)
{
    if (count * size > largest_request)
        largest_request = count * size;
    return __real_calloc(count, size);
}

static const char *const files[] = {"fault.exr", "fault.png", "fault.pfm"};

static void make_image(io_image *image)
{
    static const char *const names[] = {"AO"};
    assert_int_equal(io_image_init(image, 40, 30, names, 1, NULL), 0);
    for (int i = 0; i < 40 * 30; i++)
        image->channels[0].data[i] = (float)(i * 7919 % 1201) / 1200.0f;
}

static void expect_former(const char *path)
{
    size_t size = 0;
    unsigned char *data = support_read_file(path, &size);
    assert_int_equal(size, 6);
    assert_memory_equal(data, "former", 6);
    free(data);
}

static void expect_no_leftovers(void)
{
    bool leftovers = true;
    support_file_count(&leftovers);
    assert_false(leftovers);
}

/* A call that cannot be made waits for nobody: a minute is for ever. */
static void test_writes_that_fail(void **state)
{
    (void)state;
    static const int reasons[] = {ENOSPC, EIO};
    io_image image;
    make_image(&image);
    for (int f = 0; f < 3; f++)
        for (int r = 0; r < 2; r++)
            for (int number = 0;; number++) {
                const char *path = support_path(files[f]);
                support_write_file(path, "former", 6);
                support_forget();
                alarm(60);
                plan_fault(number, reasons[r]);
                const int result = io_write(path, &image, NULL, support_logger());
                plan_fault(-1, 0);
                alarm(0);
                if (!result) {
                    assert_true(number >= 3); /* write, sync, rename at the least */
                    break;
                }
                support_expect_error(path, r ? "Input/output error" : "No space left");
                expect_former(path);
                expect_no_leftovers();
            }
    io_image_free(&image);
}

static void test_reads_that_fail(void **state)
{
    (void)state;
    io_image image;
    for (int f = 0; f < 3; f++) {
        const char *path = support_path(files[f]);
        make_image(&image);
        assert_int_equal(io_write(path, &image, NULL, NULL), 0);
        io_image_free(&image);
        for (int number = 0;; number++) {
            support_forget();
            plan_fault(number, EIO);
            const int result = io_read(path, NULL, 0, &image, support_logger());
            const bool tried = has_failed;
            plan_fault(-1, 0);
            if (!result)
                io_image_free(&image);
            if (!result && !tried) {
                assert_true(number >= 2);
                break;
            }
            if (result) /* closing may fail without harm */
                support_expect_error(path, "Input/output error");
        }
    }
}

/* Interrupted and short calls are gone on with. */
static void test_calls_that_go_on(void **state)
{
    (void)state;
    io_image image, again;
    make_image(&image);
    for (int f = 0; f < 3; f++)
        for (int reason = 0; reason <= EINTR; reason += EINTR) {
            const char *path = support_path(files[f]);
            bool tried = true;
            for (int number = 0; tried; number++) {
                support_forget();
                plan_fault(number, reason);
                if (io_write(path, &image, NULL, support_logger())
                    && !strstr(support_lines.error,
                               "Interrupted")) /* rename() never is */
                    fail_msg("write, call %d: %s", number, support_lines.error);
                tried = has_failed;
            }
            for (int number = 0; number == 0 || has_failed; number++) {
                support_forget();
                plan_fault(number, reason);
                if (io_read(path, NULL, 0, &again, support_logger()))
                    fail_msg("read, call %d: %s", number, support_lines.error);
                const float *a = again.channels[0].data, *b = image.channels[0].data;
                for (int i = 0; i < 40 * 30; i++)
                    assert_true(f == 1 ? a[i] - b[i] < 0.003f && b[i] - a[i] < 0.003f
                                       : !memcmp(&a[i], &b[i], sizeof *a));
                io_image_free(&again);
            }
            plan_fault(-1, 0);
        }
    io_image_free(&image);
}

static void test_leftovers(void **state)
{
    (void)state;
    io_image image;
    make_image(&image);
    const char *left = support_path(".crevice-123-4567-0.tmp");
    const char *busy = support_path(".crevice-124-4567-0.tmp");
    const char *other = support_path(".crevice-notes.txt");
    support_write_file(left, "half", 4);
    support_write_file(busy, "half", 4);
    support_write_file(other, "mine", 4);
    /* A writer holds its file so. */
    const int file = open(busy, O_RDWR);
    assert_true(file >= 0);
    assert_int_equal(flock(file, LOCK_EX), 0);
    support_forget();
    assert_int_equal(io_write(support_path("x.pfm"), &image, NULL, support_logger()), 0);
    assert_int_equal(access(left, F_OK), -1);
    assert_int_equal(access(busy, F_OK), 0);
    assert_int_equal(access(other, F_OK), 0);
    assert_non_null(strstr(support_lines.text, "1 temporary file of a run that was"));
    close(file);
    assert_int_equal(unlink(other), 0);
    assert_int_equal(io_write(support_path("x.pfm"), &image, NULL, support_logger()), 0);
    expect_no_leftovers();
    io_image_free(&image);
}

static void test_links_to_one_file(void **state)
{
    (void)state;
    const char *a = support_path("a.exr"), *b = support_path("b.exr");
    const char *c = support_path("c.exr");
    assert_int_equal(symlink("nowhere.exr", a), 0);
    assert_int_equal(symlink(support_path("nowhere.exr"), b), 0);
    assert_true(io_is_same_file(a, b));
    assert_true(io_is_same_file(a, support_path("nowhere.exr")));
    assert_true(io_is_same_file(support_path("./c.exr"), c));
    assert_false(io_is_same_file(a, c));
    support_write_file(c, "x", 1);
    assert_false(io_is_same_file(a, c));
    support_write_file(a, "x", 1);
    assert_true(io_is_same_file(b, support_path("nowhere.exr")));
}

/* By hand from the tables of Unicode: C1 and its raw bytes, ends of lines, marks of
 * direction, an overlong slash; letters stay. */
static void test_names_that_lie(void **state)
{
    (void)state;
    static const char *const names[][2] = {{"a\x1b[2J", "a?[2J"},
                                           {"b\xc2\x9b", "b?"},
                                           {"c\x9b", "c?"},
                                           {"d\xe2\x80\xae", "d?"},
                                           {"e\xe2\x80\xa8", "e?"},
                                           {"f\xc0\xaf", "f??"},
                                           {"g\xc3\xa9", "g\xc3\xa9"},
                                           {"h\xed\xa0\x80", "h???"},
                                           {"i\xf0\x9f\x98\x80", "i\xf0\x9f\x98\x80"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const char *const wanted[] = {"other"};
        const float value = 1.0f;
        const float *planes[] = {&value};
        const char *path = support_path("names.exr");
        char expected[64];
        io_image image;
        support_make_plain_exr(path, &names[i][0], 1, 1, 1, planes);
        support_forget();
        assert_int_equal(io_read(path, wanted, 1, &image, support_logger()), -1);
        snprintf(expected, sizeof expected, "(there are: %s)", names[i][1]);
        support_expect_error(path, expected);
    }
}

/* Little-endian, as EXR has it. */
static unsigned char *put(unsigned char *to, const void *bytes, size_t size)
{
    memcpy(to, bytes, size);
    return to + size;
}

static unsigned char *put_int(unsigned char *to, int64_t value, size_t size)
{
    for (size_t i = 0; i < size; i++)
        to[i] = (unsigned char)(value >> (8 * i));
    return to + size;
}

static unsigned char *put_attribute(unsigned char *to, const char *name, const char *type,
                                    const void *value, size_t size)
{
    to = put(to, name, strlen(name) + 1);
    to = put(to, type, strlen(type) + 1);
    return put(put_int(to, (int64_t)size, 4), value, size);
}

/* A header of 32768 x 32768 pixels in DWAB compression, and chunks of 8 bytes. */
static void test_tiny_file_of_gigabytes(void **state)
{
    (void)state;
    enum { CHUNKS = 128, LINES = 256 };
    static unsigned char file[8192], box[16], number[8];
    static const unsigned char channels[] = "Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    unsigned char *p = put_int(put_int(file, 20000630, 4), 2, 4);
    p = put_attribute(p, "channels", "chlist", channels, sizeof channels);
    p = put_attribute(p, "compression", "compression", "\x09", 1);
    put_int(put_int(box + 8, 32767, 4), 32767, 4);
    p = put_attribute(p, "dataWindow", "box2i", box, 16);
    p = put_attribute(p, "displayWindow", "box2i", box, 16);
    p = put_attribute(p, "lineOrder", "lineOrder", "\0", 1);
    p = put_attribute(p, "pixelAspectRatio", "float", "\0\0\x80\x3f", 4);
    p = put_attribute(p, "screenWindowCenter", "v2f", number, 8);
    p = put_attribute(p, "screenWindowWidth", "float", "\0\0\x80\x3f", 4);
    p = put(p, "", 1);
    const int64_t table = p - file, first = table + 8 * CHUNKS;
    for (int i = 0; i < CHUNKS; i++) {
        put_int(file + table + 8 * i, first + 16 * i, 8);
        put_int(put_int(file + first + 16 * i, i * LINES, 4), 8, 4);
    }
    const char *path = support_path("tiny.exr");
    io_image image;
    support_write_file(path, file, (size_t)first + 16 * CHUNKS);
    support_forget();
    largest_request = 0;
    assert_int_equal(io_read(path, NULL, 0, &image, support_logger()), -1);
    support_expect_error(path, "");
    assert_true(largest_request < 1u << 20); /* the picture: 4 GiB */
}

/* Another process takes a file that was made a moment ago for a leftover. */
static void test_removal_by_others(void **state)
{
    static const char *const names[] = {"AO"};
    const char *path = support_path("contended.exr");
    io_image image;
    struct stat status;
    (void)state;
    if (access("/proc/self/fd", R_OK)) {
        print_message("no /proc: skipped\n");
        skip();
    }
    support_forget();
    plan_fault(-1, 0);
    assert_int_equal(io_image_init(&image, 4, 4, names, 1, NULL), 0);
    is_contended = true;
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    assert_true(contender >= 0);
    close(contender);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(support_lines.errors, 0);
    assert_true(is_locked_at_rename);
    io_image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_writes_that_fail),
        cmocka_unit_test(test_reads_that_fail),
        cmocka_unit_test(test_calls_that_go_on),
        cmocka_unit_test(test_leftovers),
        cmocka_unit_test(test_removal_by_others),
        cmocka_unit_test(test_links_to_one_file),
        cmocka_unit_test(test_names_that_lie),
        cmocka_unit_test(test_tiny_file_of_gigabytes),
    };
    return cmocka_run_group_tests(tests, support_setup, support_teardown);
}

# SPDX-License-Identifier: MIT
# Tests of io/: files and passes.
find_package(OpenEXR 3.1 REQUIRED)
find_package(PNG REQUIRED)
add_library(crevice_io_support STATIC test_io_support.c)
target_compile_definitions(crevice_io_support PUBLIC _XOPEN_SOURCE=700)
target_link_libraries(crevice_io_support
    PRIVATE crevice_flags
    PUBLIC crevice_io OpenEXR::OpenEXRCore PNG::PNG PkgConfig::CMOCKA ${CREVICE_LIBM})

crevice_test(test_system SOURCES test_system.c LIBS crevice_io_support)
crevice_test(test_io_exr SOURCES test_io_exr.c LIBS crevice_io_support)
crevice_test(test_io_append SOURCES test_io_append.c LIBS crevice_io_support)
crevice_test(test_views SOURCES test_views.c LIBS crevice_io_support)
crevice_test(test_mattes SOURCES test_mattes.c LIBS crevice_io_support)
crevice_test(test_io_formats SOURCES test_io_formats.c LIBS crevice_io_support)
crevice_test(test_io_bad SOURCES test_io_bad.c LIBS crevice_io_support)
crevice_test(test_io_normal_fit SOURCES test_io_normal_fit.c LIBS crevice_io_support)
# Calls of the system that the linker hands to the test, which lets them fail.
crevice_test(test_io_faults SOURCES test_io_faults.c LIBS crevice_io_support)
foreach(call pread pread64 pwrite pwrite64 fread fwrite fflush fsync fclose rename flock calloc)
    target_link_options(test_io_faults PRIVATE LINKER:--wrap=${call})
endforeach()
crevice_test(test_passes_names SOURCES test_passes_names.c LIBS crevice_io_support)
crevice_test(test_passes_evidence
    SOURCES test_passes_evidence.c passes_scene.c LIBS crevice_io_support)
crevice_test(test_passes_encodings
    SOURCES test_passes_encodings.c passes_scene.c LIBS crevice_io_support)
crevice_test(test_passes_lens SOURCES test_passes_lens.c LIBS crevice_io_support)
crevice_test(test_passes_positions
    SOURCES test_passes_positions.c LIBS crevice_io_support)
crevice_test(test_passes SOURCES test_passes.c LIBS crevice_io_support)

# SPDX-License-Identifier: MIT
# Tests of libcrevice itself.
add_library(crevice_fixture STATIC fixture.c)
target_link_libraries(crevice_fixture PRIVATE crevice_flags PUBLIC crevice::crevice PkgConfig::CMOCKA ${CREVICE_LIBM})

# Short ones, which run on every target.
if(NOT CMAKE_CROSSCOMPILING_EMULATOR MATCHES "qemu") # for which it is not short
    crevice_test(test_gbuffer SOURCES test_gbuffer.c LIBS crevice_fixture)
endif()
crevice_test(test_options SOURCES test_options.c LIBS crevice_fixture)
crevice_test(test_api SOURCES test_api.c LIBS crevice_fixture)
crevice_test(test_ao SOURCES test_ao.c LIBS crevice_fixture)
crevice_test(test_camera SOURCES test_camera.c LIBS crevice_fixture)
crevice_test(test_filters SOURCES test_filters.c LIBS crevice_fixture)
crevice_test(test_rows SOURCES test_rows.c LIBS crevice_fixture)
crevice_test(test_progress SOURCES test_progress.c LIBS crevice_fixture)
if(NOT EMSCRIPTEN) # its modules have one thread
    crevice_test(test_parallel SOURCES test_parallel.c ${PROJECT_SOURCE_DIR}/src/base/parallel.c)
    target_include_directories(test_parallel PRIVATE ${PROJECT_SOURCE_DIR}/src)
endif()
if(CMAKE_CROSSCOMPILING)
    return()
endif()
find_package(Threads REQUIRED)
crevice_test(test_host_threads SOURCES test_host_threads.c
    LIBS crevice_fixture Threads::Threads)

# Longer ones, and those that need POSIX or the library's insides.
crevice_test(test_closed_forms SOURCES test_closed_forms.c quadrature.c LIBS crevice_fixture)
set_tests_properties(test_closed_forms PROPERTIES LABELS numbers)
if(CREVICE_SANITIZE MATCHES "thread") # the other properties look at one thread's work
    set(conformance_arguments --threads)
elseif(CREVICE_SANITIZE)
    set(conformance_arguments --memory)
endif()
crevice_test(test_conformance SOURCES test_conformance.c LIBS crevice_fixture
    ARGS ${conformance_arguments})
crevice_test(test_bent SOURCES test_bent.c LIBS crevice_fixture)
# More threads than the system can start are not tried.
add_test(NAME test_ao_many_threads COMMAND test_ao)
set_tests_properties(test_ao_many_threads PROPERTIES
    ENVIRONMENT OMP_NUM_THREADS=100000 TIMEOUT ${CREVICE_TEST_TIMEOUT})
crevice_test(test_set_options SOURCES test_set_options.c LIBS crevice_fixture)
crevice_test(test_locale SOURCES test_locale.c LIBS crevice_fixture)
crevice_test(test_noise SOURCES test_noise.c LIBS crevice_internal)
crevice_test(test_thickness SOURCES test_thickness.c fixture.c LIBS crevice_internal)
crevice_test(test_deinterleaved SOURCES test_deinterleaved.c deinterleaved_reference.c deinterleaved_gtao.c deinterleaved_bitmask.c simd_case.c simd_run.c fixture.c
    LIBS crevice_internal)
crevice_test(test_filter_planes SOURCES test_filter_planes.c LIBS crevice_internal)
crevice_test(test_plan SOURCES test_plan.c fixture.c LIBS crevice_internal)

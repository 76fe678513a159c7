# SPDX-License-Identifier: MIT
# The environment in which every test runs under a sanitizer.
if(CREVICE_SANITIZE MATCHES "thread")
    # Embree, TBB, assimp and the OpenMP runtime are not compiled for ThreadSanitizer, and
    # what they do among themselves is theirs. That a parallel loop orders its body against
    # the code around it is known only to Archer, a plug-in of clang's OpenMP runtime, which
    # lies beside that runtime where nobody looks for it.
    set(environment "TSAN_OPTIONS=ignore_noninstrumented_modules=1 halt_on_error=1")
    if(CREVICE_OPENMP)
        find_package(OpenMP COMPONENTS C)
        get_filename_component(runtime "${OpenMP_omp_LIBRARY}" REALPATH)
        get_filename_component(runtime "${runtime}" DIRECTORY)
        find_file(CREVICE_ARCHER libarcher.so HINTS ${runtime} PATH_SUFFIXES lib)
        if(NOT CREVICE_ARCHER)
            message(FATAL_ERROR "ThreadSanitizer needs libarcher.so of clang's OpenMP "
                "(Debian package libomp-dev) beside ${OpenMP_omp_LIBRARY}, "
                "or CREVICE_OPENMP=OFF")
        endif()
        list(APPEND environment "OMP_TOOL_LIBRARIES=${CREVICE_ARCHER}")
    endif()
else()
    set(environment
        "ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1"
        "UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1"
        "LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_SOURCE_DIR}/leaks.txt:print_suppressions=0")
endif()

# Drivers that compute on the CPU leave memory of LLVM's behind when they are unloaded, and
# then nobody knows whose it was. What the library takes is counted by test_vulkan_failures.
set(vulkan_environment ${environment})
list(TRANSFORM vulkan_environment REPLACE "^(ASAN_OPTIONS=.*)" "\\1:detect_leaks=0")

get_property(tests DIRECTORY PROPERTY TESTS)
foreach(test IN LISTS tests)
    get_property(labels TEST ${test} PROPERTY LABELS)
    if("vulkan" IN_LIST labels)
        set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT ${vulkan_environment})
    else()
        set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT ${environment})
    endif()
endforeach()

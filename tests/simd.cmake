# SPDX-License-Identifier: MIT
# The kernels against the specification. Needs nothing but the library, so that it is
# built and run for other machines too.
add_executable(test_simd test_simd.c simd_case.c simd_run.c)
target_link_libraries(test_simd PRIVATE crevice::crevice crevice_flags ${CREVICE_LIBM})
target_include_directories(test_simd PRIVATE ${PROJECT_BINARY_DIR}/src) # crevice_sets.h
get_property(crevice_sets GLOBAL PROPERTY CREVICE_SETS)
foreach(set IN LISTS crevice_sets)
    add_library(test_simd_${set} OBJECT simd_words_tmpl.c)
    foreach(property COMPILE_DEFINITIONS COMPILE_OPTIONS INCLUDE_DIRECTORIES OSX_ARCHITECTURES)
        get_target_property(value crevice_kernels_${set} ${property})
        if(value)
            set_property(TARGET test_simd_${set} PROPERTY ${property} ${value})
        endif()
    endforeach()
    target_link_libraries(test_simd_${set} PRIVATE crevice_flags)
    target_link_libraries(test_simd PRIVATE test_simd_${set})
endforeach()
# The seed is fixed, so that a change is judged by itself; by hand every run has another.
if(CMAKE_CROSSCOMPILING)
    set(cases --cases 30) # emulated, it is ten times slower
endif()
add_test(NAME test_simd COMMAND test_simd --seed 1 ${cases})
set_tests_properties(test_simd PROPERTIES TIMEOUT ${CREVICE_TEST_TIMEOUT})

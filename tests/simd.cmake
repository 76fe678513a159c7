# SPDX-License-Identifier: MIT
# The kernels against the specification. Needs nothing but the library, so that it is
# built and run for other machines too.
add_executable(test_simd test_simd.c simd_case.c simd_run.c)
target_link_libraries(test_simd PRIVATE crevice::crevice crevice_flags m)
foreach(set sse4 avx2 avx512 neon)
    if(TARGET crevice_kernels_${set})
        string(TOUPPER ${set} SET)
        get_target_property(options crevice_kernels_${set} COMPILE_OPTIONS)
        add_library(test_simd_${set} OBJECT simd_words_tmpl.c)
        target_compile_definitions(test_simd_${set} PRIVATE CRV__SIMD_${SET})
        if(options)
            target_compile_options(test_simd_${set} PRIVATE ${options})
        endif()
        target_include_directories(test_simd_${set} PRIVATE
            ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
        target_link_libraries(test_simd_${set} PRIVATE crevice_flags)
        target_link_libraries(test_simd PRIVATE test_simd_${set})
        target_compile_definitions(test_simd PRIVATE TEST_SIMD_${SET})
    endif()
endforeach()
# The seed is fixed, so that a change is judged by itself; by hand every run has another.
if(CMAKE_CROSSCOMPILING)
    set(cases --cases 30) # emulated, it is ten times slower
endif()
add_test(NAME test_simd COMMAND test_simd --seed 1 ${cases})
set_tests_properties(test_simd PROPERTIES TIMEOUT ${CREVICE_TEST_TIMEOUT})

# SPDX-License-Identifier: MIT
# The Vulkan backend, on whatever device is first: lavapipe where there is no GPU. Tests
# are skipped where there is none, unless CI is set.
add_executable(test_vulkan_agreement test_vulkan_agreement.c simd_case.c)
target_link_libraries(test_vulkan_agreement PRIVATE crevice::crevice crevice_flags ${CREVICE_LIBM})
# The seed is fixed, so that a change is judged by itself; by hand every run has another.
# Sanitizers look at the C code, which is much the same in every case.
set(crevice_vulkan_cases 12)
if(CREVICE_SANITIZE)
    set(crevice_vulkan_cases 2)
endif()
add_test(NAME test_vulkan_agreement COMMAND test_vulkan_agreement --seed 1
    --cases ${crevice_vulkan_cases})

# The label "once": what depends on shaders, driver or large scenes more than on who compiled
# the C code, and is run with one compiler. The label "long": most of it is an emulated GPU
# that compiles shaders for a minute; ./check leaves it to ./check --all.

# Other ways to the same picture: half floats, depth deinterleaved.
add_test(NAME vulkan_half_deinterleaved COMMAND test_vulkan_agreement --seed 1 --half 1 --layout 1
    --cases ${crevice_vulkan_cases})

# The suites of the CPU, unchanged.
foreach(suite conformance closed_forms filters bent)
    add_test(NAME vulkan_${suite} COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/on_vulkan.sh
        $<TARGET_FILE:test_vulkan_agreement> $<TARGET_FILE:test_${suite}>)
    list(APPEND crevice_vulkan_tests vulkan_${suite})
endforeach()
set_tests_properties(test_vulkan_agreement PROPERTIES
    LABELS vulkan TIMEOUT 600 SKIP_RETURN_CODE 77)
set_tests_properties(vulkan_half_deinterleaved ${crevice_vulkan_tests} PROPERTIES
    LABELS "vulkan;once;long" TIMEOUT 600 SKIP_RETURN_CODE 77 COST 50)

# Runs of several submissions.
crevice_test(test_vulkan_long SOURCES test_vulkan_long.c LIBS crevice_fixture)
set_tests_properties(test_vulkan_long PROPERTIES LABELS vulkan SKIP_RETURN_CODE 77)

# vulkan_validated(NAME FEATURES PROGRAM...): under the validation layer.
function(vulkan_validated name features)
    add_test(NAME vulkan_validation_${name} COMMAND sh
        ${CMAKE_CURRENT_SOURCE_DIR}/validated.sh ${features} ${ARGN})
    set_tests_properties(vulkan_validation_${name} PROPERTIES
        LABELS "vulkan;once;long" TIMEOUT 600 SKIP_RETURN_CODE 77)
endfunction()

# Plans, with synchronisation and best practices; and with the shaders instrumented, each
# method and filter once, since lavapipe takes seconds for each shader.
set(enable VK_VALIDATION_FEATURE_ENABLE)
vulkan_validated(synchronization
    "${enable}_SYNCHRONIZATION_VALIDATION_EXT:${enable}_BEST_PRACTICES_EXT"
    $<TARGET_FILE:test_vulkan_agreement> --seed 1 --cases 5 --half 1 --layout 1)
vulkan_validated(gpu ${enable}_GPU_ASSISTED_EXT
    $<TARGET_FILE:test_vulkan_agreement> --seed 1 --cases 1 --half 1 --layout 1)

# The example that is a renderer of its own, under the validation layer.
if(TARGET example_vulkan_host)
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
    add_test(NAME example_vulkan_host COMMAND ${Python3_EXECUTABLE}
        ${CMAKE_CURRENT_SOURCE_DIR}/check_vulkan_host.py $<TARGET_FILE:example_vulkan_host>
        ${CMAKE_CURRENT_BINARY_DIR}/example_vulkan_host)
    set_tests_properties(example_vulkan_host PROPERTIES
        LABELS vulkan TIMEOUT ${CREVICE_TEST_TIMEOUT} SKIP_RETURN_CODE 77)
endif()

# What renderers call, under the validation layer.
find_package(Vulkan QUIET)
if(Vulkan_FOUND)
    foreach(name pass bent frames views formats failures)
        set(test test_vulkan_${name})
        crevice_test(${test} SOURCES ${test}.c vulkan_driver.c vulkan_engine.c vulkan_scene.c
                vulkan_stage.c vulkan_texels.c ${PROJECT_SOURCE_DIR}/examples/vulkan_host_setup.c
            LIBS crevice_fixture Vulkan::Vulkan)
        set_tests_properties(${test} PROPERTIES
            LABELS vulkan TIMEOUT 600 SKIP_RETURN_CODE 77)
    endforeach()
    # The least device that may be listed for portability, by a loader that stands in for the
    # real one.
    if(UNIX AND NOT APPLE)
        add_library(vulkan_portable SHARED vulkan_portable.c)
        target_compile_definitions(vulkan_portable PRIVATE "REAL_LOADER=\"${Vulkan_LIBRARY}\"")
        target_link_libraries(vulkan_portable PRIVATE Vulkan::Headers crevice_flags ${CMAKE_DL_LIBS})
        set_target_properties(vulkan_portable PROPERTIES OUTPUT_NAME vulkan SOVERSION 1
            LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/portable)
        add_test(NAME vulkan_portable COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/on_portable.sh
            ${CMAKE_CURRENT_BINARY_DIR}/portable $<TARGET_FILE:test_vulkan_agreement>)
        set_tests_properties(vulkan_portable PROPERTIES
            LABELS "vulkan;once" TIMEOUT 300 SKIP_RETURN_CODE 77)
    endif()
    # Bent normals; views, sizes, layers, options and noise that change each frame.
    foreach(name bent frames views)
        vulkan_validated(${name}
            "${enable}_SYNCHRONIZATION_VALIDATION_EXT:${enable}_BEST_PRACTICES_EXT"
            $<TARGET_FILE:test_vulkan_${name}>)
    endforeach()
    # Images of the host's, with the shaders instrumented.
    vulkan_validated(gpu_pass ${enable}_GPU_ASSISTED_EXT
        $<TARGET_FILE:test_vulkan_formats> --usual)
endif()

if(TARGET crevice_tool)
    tool_test(tool_vulkan)
    set_tests_properties(tool_vulkan PROPERTIES LABELS "vulkan;once;long" TIMEOUT 600)
endif()

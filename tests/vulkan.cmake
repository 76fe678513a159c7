# SPDX-License-Identifier: MIT
# The Vulkan backend, on whatever device is first: lavapipe where there is no GPU. Tests
# are skipped where there is none, unless CI is set.
add_executable(test_vulkan_agreement test_vulkan_agreement.c simd_case.c)
target_link_libraries(test_vulkan_agreement PRIVATE crevice::crevice crevice_flags m)
# The seed is fixed, so that a change is judged by itself; by hand every run has another.
add_test(NAME test_vulkan_agreement COMMAND test_vulkan_agreement --seed 1)

# Other ways to the same picture: half floats, depth taken apart.
add_test(NAME vulkan_half_apart COMMAND test_vulkan_agreement --seed 1 --half 1 --layout 1)

# The suites of the CPU, unchanged.
foreach(suite conformance closed_forms filters)
    add_test(NAME vulkan_${suite} COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/on_vulkan.sh
        $<TARGET_FILE:test_vulkan_agreement> $<TARGET_FILE:test_${suite}>)
    list(APPEND crevice_vulkan_tests vulkan_${suite})
endforeach()
set_tests_properties(test_vulkan_agreement vulkan_half_apart ${crevice_vulkan_tests} PROPERTIES
    LABELS vulkan TIMEOUT 600 SKIP_RETURN_CODE 77)

# Plans under the validation layer, with synchronisation and best practices, and once more
# with the shaders instrumented.
foreach(enabled
        "SYNCHRONIZATION_VALIDATION_EXT:VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT"
        GPU_ASSISTED_EXT)
    string(REGEX REPLACE "_.*" "" name ${enabled})
    string(TOLOWER vulkan_validation_${name} name)
    set(cases 5)
    if(enabled STREQUAL "GPU_ASSISTED_EXT")
        set(cases 1) # instrumenting takes lavapipe seconds for each shader
    endif()
    add_test(NAME ${name} COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/validated.sh
        VK_VALIDATION_FEATURE_ENABLE_${enabled} $<TARGET_FILE:test_vulkan_agreement>
        --seed 1 --cases ${cases} --half 1 --layout 1)
    set_tests_properties(${name} PROPERTIES LABELS vulkan TIMEOUT 600 SKIP_RETURN_CODE 77)
endforeach()

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
    foreach(test test_vulkan_pass test_vulkan_failures)
        crevice_test(${test} SOURCES ${test}.c vulkan_engine.c
                ${PROJECT_SOURCE_DIR}/examples/vulkan_host_setup.c
            LIBS crevice_fixture Vulkan::Vulkan)
        set_tests_properties(${test} PROPERTIES
            LABELS vulkan TIMEOUT 600 SKIP_RETURN_CODE 77)
    endforeach()
endif()

if(TARGET crevice_tool)
    tool_test(tool_vulkan)
    set_tests_properties(tool_vulkan PROPERTIES LABELS vulkan TIMEOUT 600)
endif()

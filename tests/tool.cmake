# SPDX-License-Identifier: MIT
# The command-line tool: its parts that compute, then whole runs of it.
set(tool_dir ${PROJECT_SOURCE_DIR}/tools/crevice)

crevice_test(test_tool_metrics SOURCES test_tool_metrics.c LIBS crevice_common)
crevice_test(test_tool_metrics_fit SOURCES test_tool_metrics_fit.c LIBS crevice_common)
crevice_test(test_tool_tune SOURCES test_tool_tune.c LIBS crevice_common)
crevice_test(test_tool_metrics_flip SOURCES test_tool_metrics_flip.c LIBS crevice_common)
crevice_test(test_tool_bounces SOURCES test_tool_bounces.c LIBS crevice_common)
crevice_test(test_tool_metrics_heatmap
    SOURCES test_tool_metrics_heatmap.c LIBS crevice_common)
crevice_test(test_tool_args
    SOURCES test_tool_args.c LIBS crevice_common)
target_include_directories(test_tool_args PRIVATE ${tool_dir} ${PROJECT_SOURCE_DIR}/tools)

crevice_test(test_tool_camera
    SOURCES test_tool_camera.c LIBS crevice_common)
target_compile_definitions(test_tool_camera PRIVATE _XOPEN_SOURCE=700)
target_include_directories(test_tool_camera PRIVATE ${tool_dir} ${PROJECT_SOURCE_DIR}/tools)

crevice_test(test_tool_shrink
    SOURCES test_tool_shrink.c ${tool_dir}/shrink.c ${tool_dir}/frame_facts.c
    LIBS crevice_common)
target_include_directories(test_tool_shrink
    PRIVATE ${tool_dir} ${PROJECT_SOURCE_DIR}/tools)

# Each script gets the tool and a folder of its own to write in.
function(tool_test name)
    add_test(NAME ${name} COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/${name}.sh
        $<TARGET_FILE:crevice_tool> ${CMAKE_CURRENT_BINARY_DIR}/${name})
    set_tests_properties(${name} PROPERTIES
        TIMEOUT ${CREVICE_TEST_TIMEOUT} SKIP_RETURN_CODE 77)
endfunction()

tool_test(tool_help)
tool_test(tool_manual)
tool_test(tool_render)
tool_test(tool_methods)
tool_test(tool_relief)
tool_test(tool_light)
tool_test(tool_ao)
tool_test(tool_append)
tool_test(tool_bent)
tool_test(tool_masks)
tool_test(tool_shrink)
tool_test(tool_shot)
tool_test(tool_views)
tool_test(tool_compare)
tool_test(tool_tune)
tool_test(tool_devices)
set_tests_properties(tool_devices PROPERTIES LABELS vulkan TIMEOUT 600)
tool_test(tool_errors)
tool_test(tool_faults)
tool_test(tool_shared)
set_tests_properties(tool_shared PROPERTIES LABELS once TIMEOUT 600)
tool_test(tool_bench)
set_tests_properties(tool_bench PROPERTIES TIMEOUT 600)
tool_test(farm_slurm)
# One machine has room for one cluster at a time.
set_tests_properties(farm_slurm PROPERTIES RESOURCE_LOCK slurm)

# SPDX-License-Identifier: MIT
# The ray-traced reference: its random numbers, its closed forms, another renderer, and
# whole runs of the tool. After scene.cmake and tool.cmake.
crevice_test(test_reference_sampling SOURCES test_reference_sampling.c
    LIBS test_scene_support)
crevice_test(test_reference SOURCES test_reference.c LIBS test_scene_support)
crevice_test(test_scene_bent SOURCES test_scene_bent.c LIBS test_scene_support)
crevice_test(test_reference_checkpoint SOURCES test_reference_checkpoint.c
    LIBS test_scene_support)
if(TARGET crevice_io)
    crevice_test(test_reference_blender SOURCES test_reference_blender.c
        LIBS test_scene_support crevice_io)
    set_tests_properties(test_reference_blender PROPERTIES LABELS once)
endif()
if(COMMAND tool_test)
    tool_test(tool_reference)
endif()

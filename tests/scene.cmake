# SPDX-License-Identifier: MIT
find_package(PNG REQUIRED)
add_library(test_scene_support STATIC test_scene_support.c)
target_link_libraries(test_scene_support
    PUBLIC crevice_scene PkgConfig::CMOCKA ${CREVICE_LIBM} PRIVATE crevice_flags)

foreach(subject IN ITEMS load import far gltf normals frame raycast engines layers gbuffer
        texture sky opening shade)
    crevice_test(test_scene_${subject} SOURCES test_scene_${subject}.c
        LIBS test_scene_support)
endforeach()
target_link_libraries(test_scene_gltf PRIVATE PNG::PNG)
if(TARGET crevice_io)
    crevice_test(test_scene_blender SOURCES test_scene_blender.c
        LIBS test_scene_support crevice_io)
endif()

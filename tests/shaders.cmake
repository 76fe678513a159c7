# SPDX-License-Identifier: MIT
# Shaders, as far as they can be checked without a device.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
get_target_property(crevice_shader_target crevice_shaders CREVICE_TARGET_ENV)
add_test(NAME shaders_valid COMMAND ${Python3_EXECUTABLE}
    ${CMAKE_CURRENT_SOURCE_DIR}/check_shaders.py ${PROJECT_SOURCE_DIR} ${CREVICE_GLSLANG}
    ${crevice_shader_target} ${CMAKE_C_COMPILER})
set_tests_properties(shaders_valid PROPERTIES LABELS "shaders;once" TIMEOUT 120 SKIP_RETURN_CODE 77)

# What others lift: into other languages, and alone into a shader of their own.
add_test(NAME shaders_translate COMMAND ${Python3_EXECUTABLE}
    ${CMAKE_CURRENT_SOURCE_DIR}/check_translations.py ${PROJECT_SOURCE_DIR} ${CREVICE_GLSLANG}
    ${crevice_shader_target})
set_tests_properties(shaders_translate PROPERTIES
    LABELS "shaders;once" TIMEOUT 120 SKIP_RETURN_CODE 77)

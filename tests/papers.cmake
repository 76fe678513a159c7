# SPDX-License-Identifier: MIT
# What the papers state, and what only some of them have.
crevice_test(test_multisample SOURCES test_multisample.c LIBS crevice_fixture)
crevice_test(test_patterns SOURCES test_patterns.c LIBS crevice_internal)
crevice_test(test_fields SOURCES test_fields.c LIBS crevice_fixture)
crevice_test(test_papers SOURCES test_papers.c quadrature.c LIBS crevice_fixture)
crevice_test(test_occluders SOURCES test_occluders.c LIBS crevice_fixture)

# The examples draw pictures.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET example_implicit)
    add_test(NAME example_pictures COMMAND ${Python3_EXECUTABLE}
        ${CMAKE_CURRENT_SOURCE_DIR}/check_pictures.py $<TARGET_FILE:example_implicit>
        $<TARGET_FILE:example_multisample> ${CMAKE_CURRENT_BINARY_DIR}/example_pictures)
    set_tests_properties(example_pictures PROPERTIES TIMEOUT ${CREVICE_TEST_TIMEOUT})
endif()

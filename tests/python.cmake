# SPDX-License-Identifier: MIT
# The Python module, by pytest. Needs numpy and pytest beside the interpreter that the module
# was built for.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME python_module COMMAND ${Python3_EXECUTABLE} -m pytest -q -W error -p no:cacheprovider
    ${PROJECT_SOURCE_DIR}/python/tests)
set(environment "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
if(TARGET crevice_tool)
    list(APPEND environment "CREVICE_TOOL=$<TARGET_FILE:crevice_tool>")
endif()
set_tests_properties(python_module PROPERTIES ENVIRONMENT "${environment}" TIMEOUT 300)

# SPDX-License-Identifier: MIT
# The study: its parts, and a small run of the whole with the tool. Its modules are Debian's
# packages, which belong to the system's own Python. Sanitizers have nothing to find there.
if(CREVICE_SANITIZE)
    return()
endif()
find_program(CREVICE_STUDY_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(CREVICE_STUDY_PYTHON python3 REQUIRED)
add_test(NAME study COMMAND ${CREVICE_STUDY_PYTHON} ${PROJECT_SOURCE_DIR}/study/tests/run.py
    $<TARGET_FILE:crevice_tool> ${CMAKE_CURRENT_BINARY_DIR}/study)
add_test(NAME study_structure COMMAND ${CREVICE_STUDY_PYTHON}
    ${PROJECT_SOURCE_DIR}/study/tests/run.py $<TARGET_FILE:crevice_tool>
    ${CMAKE_CURRENT_BINARY_DIR}/study_structure test_structure.py)
set_tests_properties(study study_structure PROPERTIES
    LABELS study TIMEOUT 900 SKIP_RETURN_CODE 77 COST 100) # among the first to start

# SPDX-License-Identifier: MIT
# The viewer: what it computes, and its window on a display of its own.
crevice_test(test_view SOURCES test_view.c LIBS crevice_view_core)
crevice_test(test_view_truth SOURCES test_view_truth.c LIBS crevice_view_core)

add_test(NAME view_window COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/view_window.sh
    $<TARGET_FILE:crevice_tool> ${CMAKE_CURRENT_BINARY_DIR}/view_window
    $<TARGET_EXISTS:crevice_view>)
set_tests_properties(view_window PROPERTIES LABELS once
    TIMEOUT 600 SKIP_RETURN_CODE 77)

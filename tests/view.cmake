# SPDX-License-Identifier: MIT
# The viewer: what it computes.
crevice_test(test_view SOURCES test_view.c LIBS crevice_view_core)
crevice_test(test_view_truth SOURCES test_view_truth.c LIBS crevice_view_core)

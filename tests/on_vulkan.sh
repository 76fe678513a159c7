#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a test program with its frames computed on a Vulkan device; exit code 77 where there is
# none. Usage: on_vulkan.sh TEST_VULKAN_AGREEMENT PROGRAM
set -eu
"$1" --cases 0 || exit $?
CREVICE_TEST_DEVICE=vulkan exec "$2"

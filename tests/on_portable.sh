#!/bin/sh
# SPDX-License-Identifier: MIT
# Every method and filter on the least device that may be listed for portability, and the line
# if one lacks what is needed. Usage: on_portable.sh FOLDER_OF_LOADER TEST_VULKAN_AGREEMENT
set -eu
"$2" --cases 0 >/dev/null || exit $? # 77: there is no device at all
LD_LIBRARY_PATH=$1${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export LD_LIBRARY_PATH
code=0
output=$("$2" --seed 1 --cases 1 2>&1) || code=$?
printf '%s\n' "$output"
[ $code -eq 0 ] || exit 1
told=$(printf '%s\n' "$output" | grep '^portable: ' | sort -u)
[ "$told" = "portable: a device is made" ] || { echo "not on such a device, or not well"; exit 1; }
output=$(CREVICE_TEST_LACKS=1 "$2" --seed 1 --cases 0 2>&1) && { echo "not refused"; exit 1; }
printf '%s\n' "$output" | grep -q 'it has no shaderStorageImageWriteWithoutFormat' ||
    { printf '%s\n' "$output"; echo "no reason"; exit 1; }

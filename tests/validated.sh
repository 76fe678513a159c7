#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a program under the Khronos validation layer; fails where the layer has anything to say.
# Exit code 77 where the layer is missing, unless CI is set.
# Usage: validated.sh FEATURE[:FEATURE...] PROGRAM [ARGUMENT...]
set -eu
VK_LAYER_ENABLES=$(printf '%s' "$1" | tr ':' ';')
VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
VK_LOADER_DEBUG=layer # it says which layers it loads
export VK_LAYER_ENABLES VK_INSTANCE_LAYERS VK_LOADER_DEBUG
shift
code=0
output=$("$@" 2>&1) || code=$?
if ! printf '%s\n' "$output" | grep -qi 'loading layer library.*khronos_validation'; then
    echo "no validation layer (vulkan-validationlayers)"
    [ -n "${CI:-}" ] && exit 1
    exit 77
fi
printf '%s\n' "$output" | grep -v 'LAYER:' || true
if printf '%s\n' "$output" | grep -qE 'VUID-|SYNC-HAZARD|UNASSIGNED|ERROR / SPEC'; then
    echo "the validation layer has something to say"
    exit 1
fi
exit $code

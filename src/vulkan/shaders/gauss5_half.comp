/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#define HALF_FLOATS
#include "gauss5.glsl"
#include "filter_half.glsl"

/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require

#define HALF_FLOATS
#include "gauss5.glsl"
#include "filter_half.glsl"

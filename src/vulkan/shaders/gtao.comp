/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "gtao.glsl"
#include "estimate.glsl"

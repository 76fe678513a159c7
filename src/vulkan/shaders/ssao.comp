/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "ssao.glsl"
#include "estimate.glsl"

/* SPDX-License-Identifier: MIT */
#version 460
#extension GL_GOOGLE_include_directive : require

#include "alchemy.glsl"
#include "estimate.glsl"

/* SPDX-License-Identifier: MIT */
#version 460

/* Boxes and balls on a floor. A renderer would read its meshes from buffers. */
layout(push_constant) uniform Push {
    vec4 view[3]; /* world to view, by rows */
    vec2 scale, shift; /* of view space, to the buffers' clip space */
    float z_near;
};
layout(location = 0) out vec3 world_normal;

const int BOXES = 14, RINGS = 24, SECTORS = 48;
const vec4 BALLS[4] = vec4[4](vec4(2.5, 1.1, 0.4, 0.5), vec4(-0.4, 0.6, 0, 0.6),
                              vec4(0.7, 0.35, 0.7, 0.35), vec4(0.9, 0.2, -0.3, 0.2));
const ivec2 QUAD[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0),
                               ivec2(1, 1), ivec2(0, 1));

/* The middle of a box's bottom, and its size. */
void box_at(int i, out vec3 foot, out vec3 size)
{
    foot = vec3(0, -0.2, 0); /* the floor */
    size = vec3(14, 0.2, 14);
    if (i >= 1 && i < 6) { /* steps */
        foot = vec3(-2.6, 0, -2 + 0.5 * (i - 1));
        size = vec3(1.6, 1.5 - 0.3 * (i - 1), 0.5);
    } else if (i >= 6 && i < 12) { /* columns */
        foot = vec3(-1 + 0.6 * (i - 6), 0, -2.2);
        size = vec3(0.25, 1.8, 0.25);
    } else if (i == 12) { /* a beam on them */
        foot = vec3(0.5, 1.8, -2.2);
        size = vec3(3.8, 0.3, 0.6);
    } else if (i == 13) { /* a pedestal */
        foot = vec3(2.5, 0, 0.4);
        size = vec3(1, 0.6, 1);
    }
}

vec3 on_box(int i, int vertex)
{
    const int axis = vertex / 12, way = vertex / 6 % 2 * 2 - 1;
    vec3 foot, size, side;
    box_at(i, foot, size);
    side[axis] = way;
    side[(axis + 1) % 3] = 2 * QUAD[vertex % 6].x - 1;
    side[(axis + 2) % 3] = 2 * QUAD[vertex % 6].y - 1;
    world_normal = vec3(0);
    world_normal[axis] = way;
    return foot + vec3(0, size.y / 2, 0) + size / 2 * side;
}

vec3 on_ball(int i, int vertex)
{
    const int quad = vertex / 6;
    const ivec2 corner = ivec2(quad / SECTORS, quad % SECTORS) + QUAD[vertex % 6];
    const vec2 angle = radians(vec2(180, 360)) * corner / vec2(RINGS, SECTORS);
    world_normal = vec3(sin(angle.x) * cos(angle.y), cos(angle.x), sin(angle.x) * sin(angle.y));
    return BALLS[i].xyz + BALLS[i].w * world_normal;
}

void main()
{
    const int i = gl_InstanceIndex;
    const vec4 at =
        vec4(i < BOXES ? on_box(i, gl_VertexIndex) : on_ball(i - BOXES, gl_VertexIndex), 1);
    const vec3 v = vec3(dot(view[0], at), dot(view[1], at), dot(view[2], at));
    gl_Position = vec4(scale * v.xy + shift * v.z, z_near, -v.z);
}

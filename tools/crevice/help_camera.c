/* SPDX-License-Identifier: MIT */
/* help_camera.c: `crevice help camera`, what --camera FILE reads. */
#include "help_camera.h"

void help_camera(FILE *out)
{
    fputs(
        "Files of cameras, for `crevice ao --camera FILE`, `crevice render` and `crevice "
        "gbuffer`.\n\n"
        "JSON. A camera is an object:\n"
        "  \"eye\", \"target\", \"up\"    three numbers each; up is [0, 1, 0] if it is "
        "left out\n"
        "  \"camera_to_world\"        instead of these: four rows of four numbers, "
        "translation in\n"
        "                           the last column or the last row\n"
        "  \"world_to_camera\"        its inverse\n"
        "  \"vfov\" or \"hfov\"         full vertical or horizontal field of view in "
        "degrees\n"
        "  \"lens\" with \"sensor\"     instead of these: focal length and width of the "
        "sensor in mm;\n"
        "                           a sensor that is left out is 36\n"
        "  \"ortho\"                  instead of these: height of an orthographic view\n"
        "  \"frame\"                  the frame's number\n"
        "View space has x right, y up, and looks along -z, as in Blender, Maya, Nuke and "
        "glTF.\n"
        "A shot is a list of cameras with frames, or an object {\"8\": camera, \"9\": "
        "camera ...},\n"
        "alone or as a member of an object that holds what the frames share, such as "
        "\"lens\".\n"
        "Instead of a camera there may be just its camera_to_world.\n\n"
        ".chan, as Nuke writes it: a line a frame, frame tx ty tz rx ry rz vfov, angles "
        "in degrees.\n"
        "The field of view may be missing; give --vfov, --hfov or --lens then. The order "
        "of the\nrotations is not in the file: --camera-order, Nuke's zxy by "
        "default.\n\n"
        "The number of a frame is that of --frames, or the last one in the file's name. "
        "A file that\nholds one camera is for every frame.\n",
        out);
}

/* SPDX-License-Identifier: MIT */
/*
 * closed_forms.h: what every method must converge to in a 90-degree V groove. The camera
 * is orthographic and looks along the bisector, so that floor and wall are both at 45
 * degrees to it; c is the distance of a floor point from the wall in radii, in (0, 1].
 */
#ifndef TOOL_STUDY_CLOSED_FORMS_H
#define TOOL_STUDY_CLOSED_FORMS_H

/* Occlusion, 1 - A. */
double closed_form_cosine_none(double c);
double closed_form_cosine_linear(double c);
double closed_form_uniform_none(double c);
double closed_form_uniform_linear(double c);
double closed_form_tangent_sphere(double c);

/* vo: the part of the ball's open half that the wall cuts off. */
double closed_form_vo(double c);

/* ssao: the part of the whole ball that is behind the floor or the wall. */
double closed_form_ssao(double c);

/* alchemy's sum (eq. 10 of the 2011 paper) over the disk, as a single integral, by
 * Simpson's rule. Lengths are in radii: depth is that of the point, eps an area; sigma
 * is 1. Not clamped: it passes 1 where the wall is near. */
double closed_form_alchemy(double c, double depth, double beta, double eps);

#endif

// What a force field says of itself: one table feeds parser, messages and the written scene.
//
// A field is a struct with
//   name, help       how scenes call it, and what it does
//   params           its table: numbers and vectors of the struct, in the order of the scene
//   Step<R>          one step of dt at a node: built once a step by Step<R>::of(field, dt); R: float or double
//     (v, x)         the velocity after dt [m/s] of a node at x [m] that moves at v and feels nothing else
//     fastest(s, x)  a bound of |velocity| after dt at x, for any velocity of at most s [m/s]; never below s, and it
//                    must not fall with dt
#pragma once
#include "dreampm/physics/member_param.h"

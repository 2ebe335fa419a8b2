// rocker.h - rockers and bogies: the links between a rover's body and its wheels, one chain a side.
//
//   four wheels   a rocker carries the rear and the front wheel of its side
//   six wheels    a rocker carries the outer wheel of one end and, on a pivot, a bogie with the middle wheel and the outer one of the other
//   end
// The rockers turn on the body about one axis across it, coupled by a differential: a bar on a vertical pivot of the body, its ends held to
// a horn of each rocker by a rod, so that
//   pitch of the body = (pitch of the left rocker + pitch of the right one)/2                                   (1)
// to the rods' slant, (h (1 - cos r))^2/(2 l h) for rockers turned by r against the body: below 1 mrad at 0.35 rad. All wheels are borne
// statically: with the weight B of the body, R of a rocker and G of a bogie at x ahead, and p_k the places of pivots and wheels,
//   sum of loads = B/2 + R + G,  moments of rocker and of bogie about the bogie's pivot vanish                    (2)  levers
// Pivots are free of friction and of stops (assumed). A link has half its mass at each end, where wheels and
// pivots are (assumed); wheels are part of their link.
// Chottiner 1992, Bickler US patent 4840394 (1989): the kinematics; (2) is statics.
#pragma once

#include "layout.h"

#include <array>
#include <vector>

namespace traction::sim {

struct RockerSide {          // in the plane of a side: x ahead of the centre of mass, z over the ground, all level
    int rocker_wheel = 0;    // slots
    std::vector<int> others; // of the rocker (four) or of the bogie (six), rear first
};
RockerSide rocker_side(const LayoutParameters &layout, int side); // 0 left, 1 right

// (2): what each slot bears, over the rover's weight; level, at rest. body_kg is what is neither rocker nor bogie.
std::array<double, wheel_most> rocker_loads(const LayoutParameters &layout, double mass_kg, double half_wheelbase_m, double wheel_radius_m);

// Where a link's own centre is, (x, z): halfway between its ends.
struct LinkPlace {
    double ahead_m = 0, height_m = 0, length_m = 0;
};
LinkPlace rocker_place(const LayoutParameters &layout, double half_wheelbase_m, double wheel_radius_m);
LinkPlace bogie_place(const LayoutParameters &layout, double half_wheelbase_m, double wheel_radius_m);

} // namespace traction::sim

// can_fault.h - what a CAN bus does to the frames that somebody sends, at scripted times. hal/sim carries it out (docs/can.md).
#pragma once

namespace traction::sim {

enum class CanFaultKind {
    lost,       // each frame is lost with probability `share`
    duplicated, // each comes twice with probability `share`
    late,       // each comes one tick later, behind the newer one, with probability `share`
    corrupted,  // up to eight neighbouring bits of its data flip, unseen by the controllers, with probability `share`
    silent,     // the node neither hears nor speaks
    bus_off,    // its controller has left the bus and knows it
};

enum class CanNode { wheel0, wheel1, wheel2, wheel3, sensors, computer, all }; // whose frames; wheels first: their index is their wheel

struct CanFault {
    CanFaultKind kind = CanFaultKind::lost;
    CanNode node = CanNode::all;
    double share = 1;
    double from_s = 0, to_s = 0;
};

} // namespace traction::sim

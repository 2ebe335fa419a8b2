// track_heading.h - the heading of a machine whose place is measured and whose heading is not: an antenna's or a marker's track.
//
//   psi(t) = integral of the gyro + delta(t),   delta = arg sum_window D conj(s exp(i integral of the gyro))                 (1)
//
// D: way from row to row in the track's own frame, less what a point away from the middle goes as the body turns; s: the wheels' way, with
// its sign. The window is 10 s to either side, and as much more as the heading needs to be known to 0.02 rad; it ends where the log pauses
// or the track does. So neither the frame's direction nor the gyro's bias need be known. A body whose wheels point forward goes along its
// heading on the whole; rollers do not.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace traction::lab {

struct TrackRow { // from one fix to a later one
    std::complex<double> way_m;
    double rim_m = 0;              // the wheels' way, forward positive
    double turned_rad[2] = {0, 0}; // integral of the gyro at its ends
    bool begins = false;           // the row before it does not end where this begins: the log or the track paused
};

struct TrackHeading {
    std::vector<double> delta_rad; // per row; empty: the track does not tell it
    double agreement = 0;          // share of the way that lies along the heading, 1 at most
};

// The way of the body's middle in its own frame: forward, left. delta_rad turns what is in `turned_rad` to the track's frame.
std::complex<double> way_of_body(const TrackRow &row, std::complex<double> lever_m, double delta_rad);

// lever_m: of the point that is tracked from the middle, forward and left; noise_m: of a row's way; row_s: its length.
TrackHeading track_heading(const std::vector<TrackRow> &rows, std::complex<double> lever_m, double noise_m, double row_s);

} // namespace traction::lab

// rut.h - the soil's memory: what every wheel has left behind, for the wheel that comes next.
//
// A trail is a chain of pieces laid every few millimetres of a wheel's own path, each with the depth at its two ends. A wheel at a place
// finds depth * overlap, the largest over all pieces:
//   overlap = 1 - distance/width, 0 beyond the width                                                        (1)
// where the distance is that to the piece. No cell, no axis: a drive does not depend on where or in which direction it goes. (1) is the
// share of a strip of that width that another one covers; that depths mix in this share is assumed.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace traction::sim {

struct RutPiece {
    double x0_m, y0_m, depth0_m; // one end
    double x1_m, y1_m, depth1_m; // the other
};

// The pieces of all wheels.
class RutMemory {
  public:
    explicit RutMemory(double width_m = 0.042); // of the wheels, > 0
    void add(const RutPiece &piece);
    double depth(double x_m, double y_m) const; // (1); 0 where nothing rolled
    double width_m() const { return width_m_; }
    std::size_t size() const { return pieces_.size(); }
    std::uint64_t hash() const;

  private:
    std::int64_t index(double place_m) const; // of a cell
    double width_m_, cell_m_, longest_m_ = 0, deepest_m_ = 0;
    std::vector<RutPiece> pieces_;
    struct End { // the second one
        double x_m, y_m;
        std::uint32_t piece;
    };
    std::unordered_map<std::uint64_t, std::vector<End>> near_; // where to look; the answer does not depend on it
};

// One wheel in the memory: what it finds under itself, and what it leaves behind.
class RutTrace {
  public:
    static constexpr double piece_m = 0.005; // an eighth of a contact length: assumed

    // The depth left here by earlier passes. `sinkage_m` is the wheel's own. A piece is found when its wheel has been a width away from
    // it, so that a wheel does not find what it stands in; on its way back it does. What was found follows over one piece of path.
    double follow(RutMemory &memory, double x_m, double y_m, double sinkage_m);
    double found_m() const { return found_m_; }
    double deepest_m() const { return deepest_m_; }

  private:
    void lay(RutMemory &memory, double x_m, double y_m);
    std::vector<RutPiece> waiting_; // laid, and still near
    RutPiece last_{};               // its first end is where the next piece begins, its second where the wheel was
    double path_m_ = 0, from_m_ = 0, to_m_ = 0, found_m_ = 0, deepest_m_ = 0;
    bool started_ = false;
};

} // namespace traction::sim

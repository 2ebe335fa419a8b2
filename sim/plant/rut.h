// rut.h - the soil's memory along the track: how deep each place was rolled before, for the wheel that comes next.
#pragma once

#include <cstdint>
#include <vector>

namespace traction::sim {

// The largest depth reached in each 2 cm cell. Open addressing, grows as needed.
class RutMemory {
  public:
    RutMemory();
    static std::uint64_t cell(double x_m, double y_m); // never 0
    double depth(std::uint64_t cell) const;            // 0 where nothing rolled
    void mark(std::uint64_t cell, double depth_m);
    std::uint64_t hash() const; // of all cells, whatever their order

  private:
    struct Slot {
        std::uint64_t cell = 0; // 0: empty
        double depth_m = 0;
    };
    std::size_t find(std::uint64_t cell) const;
    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

// One wheel in the memory: what it finds under itself, and what it leaves when it moves on.
class RutTrace {
  public:
    // The depth left here by earlier passes; `sinkage_m` is the wheel's own. Own marks are written when the cell is left, so a
    // wheel does not find its own rut under itself; the found depth follows from cell to cell over half a cell's travel.
    double follow(RutMemory &memory, double x_m, double y_m, double sinkage_m, double travel_m);
    double found_m() const { return found_m_; }
    double deepest_m() const { return deepest_m_; }

  private:
    std::uint64_t cell_ = 0;
    double target_m_ = 0, found_m_ = 0, deepest_m_ = 0;
};

} // namespace traction::sim

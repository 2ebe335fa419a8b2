#include "rut.h"

#include <bit>
#include <cmath>

namespace traction::sim {

namespace {

constexpr double cell_m = 0.02; // half a contact length: assumed

// splitmix64's finaliser
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

} // namespace

RutMemory::RutMemory() : slots_(1024) {}

std::uint64_t RutMemory::cell(double x_m, double y_m) {
    const auto index = [](double place_m) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(place_m / cell_m + 0.5)) + 0x40000000) & 0xffffffffu;
    };
    return (index(x_m) << 32) | index(y_m);
}

std::size_t RutMemory::find(std::uint64_t cell) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = static_cast<std::size_t>(mix(cell)) & mask;
    while (slots_[i].cell != 0 && slots_[i].cell != cell) i = (i + 1) & mask;
    return i;
}

double RutMemory::depth(std::uint64_t cell) const { return slots_[find(cell)].depth_m; }

void RutMemory::mark(std::uint64_t cell, double depth_m) {
    std::size_t i = find(cell);
    if (slots_[i].cell == 0) {
        if (2 * (used_ + 1) > slots_.size()) {
            std::vector<Slot> old(2 * slots_.size());
            old.swap(slots_);
            for (const Slot &slot : old)
                if (slot.cell != 0) slots_[find(slot.cell)] = slot;
            i = find(cell);
        }
        slots_[i].cell = cell;
        ++used_;
    }
    if (depth_m > slots_[i].depth_m) slots_[i].depth_m = depth_m;
}

std::uint64_t RutMemory::hash() const {
    std::uint64_t sum = 0;
    for (const Slot &slot : slots_)
        if (slot.cell != 0) sum ^= mix(slot.cell ^ mix(std::bit_cast<std::uint64_t>(slot.depth_m)));
    return sum;
}

double RutTrace::follow(RutMemory &memory, double x_m, double y_m, double sinkage_m, double travel_m) {
    const std::uint64_t here = RutMemory::cell(x_m, y_m);
    if (here != cell_) {
        if (cell_ != 0) memory.mark(cell_, deepest_m_);
        cell_ = here;
        target_m_ = memory.depth(here);
        deepest_m_ = 0;
    }
    if (sinkage_m > deepest_m_) deepest_m_ = sinkage_m;
    const double share = std::fabs(travel_m) / (0.5 * cell_m);
    found_m_ += (target_m_ - found_m_) * (share < 1 ? share : 1);
    return found_m_;
}

} // namespace traction::sim

#include "rut.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace traction::sim {

namespace {

// splitmix64's finaliser
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

double squared(double x_m, double y_m) { return x_m * x_m + y_m * y_m; }

std::uint64_t cell_at(std::int64_t column, std::int64_t row) {
    return (static_cast<std::uint64_t>(column) << 32) | (static_cast<std::uint64_t>(row) & 0xffffffffu);
}

// Far enough from both ends to be found.
bool is_left(const RutPiece &piece, double x_m, double y_m, double width_m) {
    const double far2 = width_m * width_m;
    return squared(piece.x0_m - x_m, piece.y0_m - y_m) > far2 && squared(piece.x1_m - x_m, piece.y1_m - y_m) > far2;
}

} // namespace

// A piece lies in the cell of its second end: whatever is near enough to count lies in the nine cells around.
RutMemory::RutMemory(double width_m) : width_m_(width_m), cell_m_(width_m + 2 * RutTrace::piece_m) {}

std::int64_t RutMemory::index(double place_m) const { return static_cast<std::int64_t>(std::floor(place_m / cell_m_)); }

void RutMemory::add(const RutPiece &piece) {
    near_[cell_at(index(piece.x1_m), index(piece.y1_m))].push_back({piece.x1_m, piece.y1_m, static_cast<std::uint32_t>(pieces_.size())});
    pieces_.push_back(piece);
    longest_m_ = std::max(longest_m_, std::sqrt(squared(piece.x1_m - piece.x0_m, piece.y1_m - piece.y0_m)));
    deepest_m_ = std::max({deepest_m_, piece.depth0_m, piece.depth1_m});
}

double RutMemory::depth(double x_m, double y_m) const {
    double found = 0;
    const double reach2 = width_m_ * width_m_;
    double far_m = 1.0001 * (width_m_ + longest_m_), far2 = far_m * far_m; // of its second end: no piece reaches so far
    const std::int64_t column = index(x_m), row = index(y_m);
    const double in_x_m = x_m - static_cast<double>(column) * cell_m_, in_y_m = y_m - static_cast<double>(row) * cell_m_;
    const auto gap_m = [this](std::int64_t to, double in_m) { return to == 0 ? 0 : to < 0 ? in_m : cell_m_ - in_m; };
    for (const std::int64_t right : {0, -1, 1}) // its own cell first
        for (const std::int64_t up : {0, -1, 1}) {
            if (squared(gap_m(right, in_x_m), gap_m(up, in_y_m)) > far2) continue;
            const auto list = near_.find(cell_at(column + right, row + up));
            if (list == near_.end()) continue;
            for (const End &end : list->second) {
                if (squared(x_m - end.x_m, y_m - end.y_m) > far2) continue;
                const RutPiece &p = pieces_[end.piece];
                const double dx = p.x1_m - p.x0_m, dy = p.y1_m - p.y0_m, length2 = squared(dx, dy);
                const double along = length2 > 0 ? ((x_m - p.x0_m) * dx + (y_m - p.y0_m) * dy) / length2 : 0;
                const double share = std::clamp(along, 0.0, 1.0);
                const double apart2 = squared(x_m - (p.x0_m + share * dx), y_m - (p.y0_m + share * dy));
                if (apart2 >= reach2) continue;
                const double overlap = 1 - std::sqrt(apart2) / width_m_; // (1)
                const double here = overlap * (p.depth0_m + share * (p.depth1_m - p.depth0_m));
                if (!(here > found)) continue;
                found = here;
                far_m = 1.0001 * (width_m_ * (1 - found / deepest_m_) + longest_m_), far2 = far_m * far_m; // beyond, none is deeper by (1)
            }
        }
    return found;
}

std::uint64_t RutMemory::hash() const {
    std::uint64_t sum = 0;
    for (const RutPiece &p : pieces_)
        for (const double value : {p.x0_m, p.y0_m, p.depth0_m, p.x1_m, p.y1_m, p.depth1_m})
            sum = mix(sum ^ std::bit_cast<std::uint64_t>(value));
    return sum;
}

void RutTrace::lay(RutMemory &memory, double x_m, double y_m) {
    const RutPiece piece{last_.x0_m, last_.y0_m, last_.depth0_m, x_m, y_m, deepest_m_};
    if (piece.depth0_m > found_m_ || piece.depth1_m > found_m_) waiting_.push_back(piece); // else it rolls in a deeper rut
    last_.x0_m = x_m, last_.y0_m = y_m, last_.depth0_m = deepest_m_;
    constexpr std::size_t most = 64; // a wheel that rocks on the spot: the oldest count as left
    for (std::size_t i = 0; i < waiting_.size();) {
        if (!is_left(waiting_[i], x_m, y_m, memory.width_m()) && waiting_.size() <= most) {
            ++i;
            continue;
        }
        memory.add(waiting_[i]);
        waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

double RutTrace::follow(RutMemory &memory, double x_m, double y_m, double sinkage_m) {
    if (!started_) {
        last_ = {x_m, y_m, sinkage_m, x_m, y_m, sinkage_m};
        started_ = true;
    }
    path_m_ += std::sqrt(squared(x_m - last_.x1_m, y_m - last_.y1_m));
    last_.x1_m = x_m, last_.y1_m = y_m;
    deepest_m_ = std::max(deepest_m_, sinkage_m);
    if (path_m_ >= piece_m) {
        lay(memory, x_m, y_m);
        path_m_ = 0, deepest_m_ = sinkage_m;
        from_m_ = found_m_, to_m_ = memory.depth(x_m, y_m);
    }
    found_m_ = from_m_ + (to_m_ - from_m_) * std::min(path_m_ / piece_m, 1.0);
    return found_m_;
}

} // namespace traction::sim

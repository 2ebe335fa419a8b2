#include "columns.h"

#include <algorithm>

namespace traction::lab {

Eigen::MatrixXd Columns::of(const Candidate &c) {
    Eigen::MatrixXd out(problem_.row_scale.size(), static_cast<Eigen::Index>(c.strengths.size()));
    for (std::size_t j = 0; j < c.strengths.size(); ++j)
        out.col(static_cast<Eigen::Index>(j)) = column(c, j).cwiseProduct(problem_.row_scale);
    return out;
}

Eigen::VectorXd Columns::column(const Candidate &c, std::size_t j) {
    const FreeParameter &p = c.strengths[j];
    if (c.free_shape || p.slots.size() < 2) return single(c, j, p);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem_.row_scale.size());
    for (const Slot &slot : p.slots) {
        FreeParameter one = p;
        one.slots = {slot};
        one.wheel = slot.wheel;
        sum += single(c, j, one);
    }
    return sum;
}

Eigen::VectorXd Columns::single(const Candidate &c, std::size_t j, const FreeParameter &p) {
    std::string key = c.effect + "/" + p.key + "/" + std::to_string(p.slots.size() == 1 ? p.slots[0].wheel : -1);
    for (const auto &[name, value] : c.variant) key += "/" + name + std::to_string(value);
    const auto found = cache_.find(key);
    if (found != cache_.end()) return found->second.whole();
    const auto keep = [&](Eigen::VectorXd column) {
        cache_.emplace(key, SparseJacobian(problem_.data(), column));
        return column;
    };
    if (is_patch(c.effect)) return keep(patch(c, p));
    Physics at = physics_;
    Candidate one = c;
    one.wheel = p.slots.size() == 1 && p.slots[0].in_wheel != nullptr ? p.slots[0].wheel : c.wheel;
    one.prepare(at);
    return keep(problem_.column(at, p, c.step[j]).cwiseQuotient(problem_.row_scale));
}

// A patch is the sum of the cells of the path that it covers.
Eigen::VectorXd Columns::patch(const Candidate &c, const FreeParameter &p) {
    const std::vector<double> &path = problem_.forward().motion().path_m;
    std::vector<Eigen::VectorXd> &cells = ground_[c.effect].cells;
    if (cells.empty()) {
        const auto [low, high] = std::minmax_element(path.begin(), path.end());
        cell_start_ = *low;
        cell_length_ = std::max(0.125, (*high - *low) / 32);
        cells.resize(static_cast<std::size_t>((*high - *low) / cell_length_) + 1);
    }
    double start = 0, length = 0;
    for (const auto &[key, value] : c.variant) (key == "start_m" ? start : length) = value;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem_.row_scale.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double begin = cell_start_ + static_cast<double>(i) * cell_length_;
        const double overlap = std::min(begin + cell_length_, start + length) - std::max(begin, start);
        if (overlap <= 0) continue;
        if (cells[i].size() == 0) fill_cells(c, p, i);
        sum += overlap / cell_length_ * cells[i];
    }
    return sum;
}

// To a unit of the patch: of the ground's strength, or of its resistance over the load.
UnitResponse Columns::response(bool strength) {
    const Motion &motion = problem_.forward().motion();
    UnitResponse unit = unit_response(problem_.data(), physics_, motion, strength ? TermTarget::soil_strength : TermTarget::rolling);
    for (std::size_t i = 0; i < unit.force.size() && !strength; ++i)
        for (std::size_t k = 0; k < unit.force[i].size(); ++k)
            unit.force[i][k] *= motion.wheel[i].load_N[k], unit.traction[i][k] *= motion.wheel[i].load_N[k];
    return unit;
}

// Cell `first` and some after it: as shapes of the ground's strength where nothing forbids, else one by one.
void Columns::fill_cells(const Candidate &c, const FreeParameter &p, std::size_t first) {
    Forward &forward = problem_.forward();
    Ground &ground = ground_[c.effect];
    if (forward.has_linear_base() && physics_.terms.empty() && plain_currents(physics_)) {
        if (ground.unit.force.empty()) ground.unit = response(c.effect == "soil_patch");
        const std::size_t count = std::min(most_shapes, ground.cells.size() - first);
        const auto cells = make_cells(Axis::path, cell_start_ + static_cast<double>(first) * cell_length_, cell_length_);
        const Eigen::MatrixXd columns = forward.shaped(physics_, ground.unit, *cells, count);
        for (std::size_t j = 0; j < count; ++j) ground.cells[first + j] = columns.col(static_cast<Eigen::Index>(j));
        return;
    }
    Physics at = physics_;
    (c.effect == "soil_patch" ? at.body.patch_start_m : at.body.heavy_start_m) = cell_start_ + static_cast<double>(first) * cell_length_;
    (c.effect == "soil_patch" ? at.body.patch_length_m : at.body.heavy_length_m) = cell_length_;
    ground.cells[first] = problem_.column(at, p, c.step[0]).cwiseQuotient(problem_.row_scale);
}

} // namespace traction::lab

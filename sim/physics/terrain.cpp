#include "terrain.h"

#include "math.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace traction::sim {

namespace {

constexpr double reference_1_m = 0.1; // n0 of ISO 8608
constexpr int rings = 24, spokes = 8; // waves of the roughness: wave numbers times directions
constexpr double reach = 0.95;        // of the radius, in which a wheel looks for what carries it

// splitmix64's sequence, as 0..1
double uniform(std::uint64_t &state) {
    std::uint64_t h = state += 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((h ^ (h >> 31)) >> 11) * (1.0 / 9007199254740992.0);
}

// Catmull-Rom's weights of nodes -1, 0, 1, 2 at u of 0..1.
std::array<double, 4> weights(double u) {
    const double u2 = u * u, u3 = u2 * u;
    return {0.5 * (-u + 2 * u2 - u3), 0.5 * (2 - 5 * u2 + 3 * u3), 0.5 * (u + 4 * u2 - 3 * u3), 0.5 * (u3 - u2)};
}

template <class Node> double between(double x, double y, const Node &node) {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
    const std::array<double, 4> a = weights(x - fx), b = weights(y - fy);
    double sum = 0;
    for (int row = 0; row < 4; ++row) {
        double line = 0;
        for (int column = 0; column < 4; ++column) line += a[static_cast<std::size_t>(column)] * node(i + column - 1, j + row - 1);
        sum += b[static_cast<std::size_t>(row)] * line;
    }
    return sum;
}

double number_in(const std::string &field, const std::string &place) {
    const char *first = field.data(), *last = first + field.size();
    while (first < last && (*first == ' ' || *first == '\t')) ++first;
    while (last > first && (last[-1] == ' ' || last[-1] == '\t' || last[-1] == '\r')) --last;
    double value = 0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc{} || end != last || !std::isfinite(value))
        throw std::runtime_error(place + ": '" + std::string(first, last) + "' is not a number; write heights in metres, between commas");
    return value;
}

} // namespace

double HeightMap::at(int column, int row) const {
    const int i = std::clamp(column, 0, columns - 1), j = std::clamp(row, 0, rows - 1);
    return height_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)];
}

HeightMap read_height_map(const std::string &path, double cell_m, double height_scale) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + ": cannot be read; name a CSV of heights");
    HeightMap map;
    map.cell_m = cell_m;
    std::string line, field;
    for (int number = 1; std::getline(in, line); ++number) {
        if (const auto comment = line.find('#'); comment != std::string::npos) line.resize(comment);
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        int columns = 0;
        for (std::size_t from = 0; from <= line.size(); ++columns) {
            const std::size_t to = std::min(line.find(',', from), line.size());
            const std::string place = path + ':' + std::to_string(number) + ", field " + std::to_string(columns + 1);
            map.height_m.push_back(height_scale * number_in(line.substr(from, to - from), place));
            from = to + 1;
        }
        if (map.rows == 0) map.columns = columns;
        if (columns != map.columns)
            throw std::runtime_error(path + ':' + std::to_string(number) + ": " + std::to_string(columns) +
                                     " heights where the first row has " + std::to_string(map.columns) + "; give every row as many");
        if (map.height_m.size() > height_map_most)
            throw std::runtime_error(path + ": more than 4 million heights; take a coarser lattice or a part of it");
        ++map.rows;
    }
    if (map.rows < 2 || map.columns < 2) throw std::runtime_error(path + ": a height map needs two rows and two columns at least");
    return map;
}

double iso_8608_m3(char roughness_class) { // geometric means of table C.1: 16e-6 m^3 for A, four times as much a class
    if (roughness_class < 'A' || roughness_class > 'H') return 0;
    double value = 16e-6;
    for (char c = 'A'; c < roughness_class; ++c) value *= 4;
    return value;
}

Relief::Relief(const Terrain &terrain, std::uint64_t seed)
    : terrain_(terrain), ahead_x_(math::cos(terrain.profile_direction_rad)), ahead_y_(math::sin(terrain.profile_direction_rad)),
      node_step_m_(terrain.shortest_m / 8) {
    double sum = 0;
    for (std::size_t i = 0; i < terrain_.profile.size(); ++i) {
        const ProfilePoint &b = terrain_.profile[i], &a = terrain_.profile[i > 0 ? i - 1 : 0];
        sum += 0.5 * (a.height_m + b.height_m) * (b.distance_m - a.distance_m);
        area_.push_back(sum);
    }
    if (terrain_.roughness_m3 <= 0) return;
    const double spectrum = terrain_.roughness_m3 * reference_1_m * reference_1_m / 4; // A of S = A/k^3, (2)
    const double low = 1 / terrain_.longest_m, high = 1 / terrain_.shortest_m;
    const double ratio = math::exp(math::log(high / low) / rings);
    double from = low;
    for (int ring = 0; ring < rings; ++ring) {
        const double to = from * ratio;
        const double variance = 2 * math::pi * spectrum * (1 / from - 1 / to); // S over the ring
        for (int spoke = 0; spoke < spokes; ++spoke) {
            const double turn = math::pi * (spoke + uniform(seed)) / spokes;   // half a turn: a wave is its own opposite
            const double q = uniform(seed), k = 1 / ((1 - q) / from + q / to); // drawn as the ring's variance lies
            const double phase = 2 * math::pi * uniform(seed), wave = 2 * math::pi * k;
            waves_.push_back({wave * math::cos(turn), wave * math::sin(turn), phase, std::sqrt(2 * variance / spokes)});
        }
        from = to;
    }
}

double Relief::node_m(std::int64_t i, std::int64_t j) {
    const std::int64_t bi = i >> 4, bj = j >> 4; // blocks of 16, downwards
    const std::uint64_t key = (static_cast<std::uint64_t>(bi) << 32) ^ (static_cast<std::uint64_t>(bj) & 0xffffffffu);
    if (last_ == nullptr || key != last_key_) {
        std::unique_ptr<Block> &found = blocks_[key];
        if (!found) {
            found = std::make_unique<Block>();
            for (int row = 0; row < block; ++row) // a wave along a row is a rotation
                for (const Wave &wave : waves_) {
                    const double x = static_cast<double>(bi * block) * node_step_m_,
                                 y = static_cast<double>(bj * block + row) * node_step_m_;
                    const double at = wave.kx * x + wave.ky * y + wave.phase, by = wave.kx * node_step_m_;
                    const double cos_by = math::cos(by), sin_by = math::sin(by);
                    double re = wave.amplitude_m * math::cos(at), im = wave.amplitude_m * math::sin(at);
                    for (int column = 0; column < block; ++column) {
                        (*found)[static_cast<std::size_t>(row) * block + static_cast<std::size_t>(column)] += re;
                        const double next = re * cos_by - im * sin_by;
                        im = re * sin_by + im * cos_by;
                        re = next;
                    }
                }
        }
        last_ = found.get();
        last_key_ = key;
    }
    return (*last_)[static_cast<std::size_t>((j - bj * block) * block + (i - bi * block))];
}

double Relief::rough_m(double x_m, double y_m) {
    return between(x_m / node_step_m_, y_m / node_step_m_, [this](std::int64_t i, std::int64_t j) { return node_m(i, j); });
}

double Relief::smooth_m(double x_m, double y_m) {
    double height = waves_.empty() ? 0 : rough_m(x_m, y_m);
    if (const HeightMap *map = terrain_.map.get()) {
        // beyond the map its edge goes on level: far places must not overflow the index
        const double x = std::clamp((x_m - map->x_m) / map->cell_m, -2.0, map->columns + 1.0);
        const double y = std::clamp((y_m - map->y_m) / map->cell_m, -2.0, map->rows + 1.0);
        height += between(x, y, [map](std::int64_t i, std::int64_t j) { return map->at(static_cast<int>(i), static_cast<int>(j)); });
    }
    return height;
}

// Integral of the profile's height from its first point on.
double Relief::profile_area(double distance_m) const {
    const std::vector<ProfilePoint> &points = terrain_.profile;
    if (distance_m <= points.front().distance_m) return points.front().height_m * (distance_m - points.front().distance_m);
    if (distance_m >= points.back().distance_m) return area_.back() + points.back().height_m * (distance_m - points.back().distance_m);
    std::size_t i = 1;
    while (points[i].distance_m < distance_m) ++i;
    const ProfilePoint &a = points[i - 1], &b = points[i];
    const double run = distance_m - a.distance_m, slope = (b.height_m - a.height_m) / (b.distance_m - a.distance_m);
    return area_[i - 1] + run * (a.height_m + 0.5 * slope * run);
}

// The profile's height, on a step the upper one; its mean over blur_m where that is more than 0.
double Relief::profile_m(double distance_m, double blur_m) const {
    const std::vector<ProfilePoint> &points = terrain_.profile;
    if (points.empty()) return 0;
    constexpr double sharp_m = 1e-4; // below it a mean would lose its digits
    if (blur_m > sharp_m) return (profile_area(distance_m + 0.5 * blur_m) - profile_area(distance_m - 0.5 * blur_m)) / blur_m;
    if (distance_m <= points.front().distance_m - 1e-9) return points.front().height_m;
    double height = points.back().height_m;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].distance_m < distance_m - 1e-9) continue;
        if (points[i].distance_m <= distance_m + 1e-9) { // on a point: the highest there
            height = points[i].height_m;
            for (std::size_t k = i + 1; k < points.size() && points[k].distance_m <= distance_m + 1e-9; ++k)
                height = std::max(height, points[k].height_m);
            return height;
        }
        const ProfilePoint &a = points[i - 1], &b = points[i];
        return a.height_m + (b.height_m - a.height_m) * (distance_m - a.distance_m) / (b.distance_m - a.distance_m);
    }
    return height;
}

double Relief::height_m(double x_m, double y_m) { return profile_m(x_m * ahead_x_ + y_m * ahead_y_, 0) + smooth_m(x_m, y_m); }

double Relief::carried_m(double u, double x_m, double y_m, double c, double s, double radius_m, const Cut &cut, double most_m) {
    const double height = profile_m(cut.origin_m + u * cut.along, cut.blur_m) + smooth_m(x_m + u * c, y_m + u * s);
    return std::min(height, most_m) + (std::sqrt(radius_m * radius_m - u * u) - radius_m);
}

Rest Relief::rest(double x_m, double y_m, double c, double s, double radius_m, double width_m) {
    const double across = -s * ahead_x_ + c * ahead_y_; // of the profile's direction, to the wheel's left
    const Cut cut{x_m * ahead_x_ + y_m * ahead_y_, c * ahead_x_ + s * ahead_y_, width_m * std::fabs(across)};
    const double step = std::min(radius_m / 10, waves_.empty() ? radius_m : terrain_.shortest_m / 8), most = reach * radius_m;
    double best = carried_m(0, x_m, y_m, c, s, radius_m, cut), at = 0;
    const double wall_m = best + radius_m - std::sqrt(radius_m * radius_m - most * most); // higher, it would lift the wheel all at once
    const auto carried = [&](double u) { return carried_m(u, x_m, y_m, c, s, radius_m, cut, wall_m); };
    bool corner = false;
    const auto offer = [&](double u, bool is_corner) {
        if (std::fabs(u) > most) return;
        const double value = carried(u);
        if (value > best) best = value, at = u, corner = is_corner;
    };
    for (int i = 1; i * step <= most; ++i) offer(i * step, false), offer(-i * step, false);
    if (std::fabs(cut.along) > 1e-6)
        for (const ProfilePoint &point : terrain_.profile)
            for (const double edge : {-0.5, 0.5}) offer((point.distance_m + edge * cut.blur_m - cut.origin_m) / cut.along, true);
    if (!corner) // the vertex of a parabola, twice
        for (const double h : {0.5 * step, 0.1 * step}) {
            const double before = carried(std::max(at - h, -most)), after = carried(std::min(at + h, most));
            const double bend = before - 2 * best + after;
            if (bend < 0) offer(std::clamp(at + 0.5 * h * (before - after) / bend, at - h, at + h), false);
        }
    Rest rest{best, at / std::sqrt(radius_m * radius_m - at * at), 0};
    const double px = x_m + at * c, py = y_m + at * s, w = 0.5 * width_m;
    rest.rise_left = (smooth_m(px - w * s, py + w * c) - smooth_m(px + w * s, py - w * c)) / width_m;
    if (!terrain_.profile.empty() && cut.blur_m > 1e-4) {
        const double d = cut.origin_m + at * cut.along, b = 0.5 * cut.blur_m;
        rest.rise_left += (profile_m(d + b, 0) - profile_m(d - b, 0)) / cut.blur_m * across;
    }
    return rest;
}

} // namespace traction::sim

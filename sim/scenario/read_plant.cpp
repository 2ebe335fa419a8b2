#include "scenario.h"

#include "read_parts.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace traction::sim {

namespace {

// The keys that a soil law has, over those of the library's soil.
void read_soil(Keys &keys, Soil &soil) {
    std::string names;
    for (const Soil &known : soil_library()) names += (names.empty() ? "" : ", ") + known.name;
    if (keys.has("soil")) {
        const Soil *found = find_soil(keys.text("soil", ""));
        if (found == nullptr) keys.fail("soil", "no such soil", "use one of: " + names);
        soil = *found;
    }
    soil.adhesion_N = keys.number("adhesion_N", soil.adhesion_N, {0, 100});
    soil.fm_per_fn = keys.number("fm_per_fn", soil.fm_per_fn, {0.01, 5});
    soil.shear_slip = keys.number("shear_slip", soil.shear_slip, {0.001, 5});
    soil.rolling_coefficient = keys.number("rolling_coefficient", soil.rolling_coefficient, {0, 1});
    soil.lateral_coefficient = keys.number("lateral_coefficient", soil.lateral_coefficient, {0, 5});
}

SoilPatch read_patch(const toml::table &table, const std::string &file, const std::string &path, const Soil &around) {
    Keys keys(table, file, path);
    SoilPatch patch{.soil = around};
    patch.x_min_m = keys.need_number("x_min_m", {-1000, 1000});
    patch.x_max_m = keys.need_number("x_max_m", {patch.x_min_m, 1000});
    patch.y_min_m = keys.number("y_min_m", patch.y_min_m, {-1e9, 1e9});
    patch.y_max_m = keys.number("y_max_m", patch.y_max_m, {patch.y_min_m, 1e9});
    read_soil(keys, patch.soil);
    keys.finish();
    return patch;
}

// A height map by its keys: of a CSV, or of a picture, whose pixels have no scale of their own.
std::shared_ptr<const HeightMap> read_map(Keys &keys, const std::string &file) {
    const std::string path = (std::filesystem::path(file).parent_path() / keys.text("map", "")).string();
    const double x_m = keys.number("map_x_m", 0, {-1000, 1000}), y_m = keys.number("map_y_m", 0, {-1000, 1000});
    const bool picture = is_height_picture(path);
    for (const std::string_view key : {"map_white_m", "map_black_m"})
        if (!picture && keys.has(key)) keys.fail(key, "is of a PNG, and the map is a CSV", "scale a CSV's heights by map_height");
    if (picture && keys.has("map_height"))
        keys.fail("map_height", "is of a CSV, and the map is a PNG", "give the heights of white and black: map_white_m, map_black_m");
    constexpr Range cell{0.001, 10}, height{-1000, 1000};
    const double cell_m = picture ? keys.need_number("map_cell_m", cell) : keys.number("map_cell_m", 0.02, cell);
    const double white_m = picture ? keys.need_number("map_white_m", height) : 0,
                 black_m = picture ? keys.number("map_black_m", 0, height) : 0;
    const double factor = picture ? 1 : keys.number("map_height", 1, height);
    try {
        HeightMap read = picture ? read_height_picture(path, cell_m, black_m, white_m) : read_height_map(path, cell_m, factor);
        read.x_m = x_m, read.y_m = y_m;
        return std::make_shared<const HeightMap>(std::move(read));
    } catch (const std::runtime_error &error) {
        keys.fail("map", error.what(), "the file's place is counted from the scenario's folder");
    }
}

// [ground.terrain]: what is not flat.
void read_terrain(const toml::table &table, const std::string &file, Terrain &terrain) {
    Keys keys(table, file, "ground.terrain");
    if (const toml::array *list = keys.array("profile"))
        for (const toml::node &node : *list) {
            const toml::array *pair = node.as_array();
            if (pair == nullptr || pair->size() != 2)
                keys.fail_at(node, "profile", "is not a list of pairs",
                             "write [[distance_m, height_m], ...], as [[1.0, 0.0], [1.0, 0.02]] for a step");
            const ProfilePoint point{keys.number_of((*pair)[0], "profile", {-1000, 1000}),
                                     keys.number_of((*pair)[1], "profile", {-100, 100})};
            if (!terrain.profile.empty() && point.distance_m < terrain.profile.back().distance_m)
                keys.fail_at(node, "profile", "it lies before the point above", "order the points by their distance");
            terrain.profile.push_back(point);
        }
    terrain.profile_direction_rad = keys.number("profile_direction_rad", 0, {-10, 10});
    if (keys.has("roughness")) {
        const std::string name = keys.text("roughness", "");
        terrain.roughness_m3 = name.size() == 1 ? iso_8608_m3(name[0]) : 0;
        if (terrain.roughness_m3 == 0) keys.fail("roughness", "not a class of ISO 8608", "use one of: A, B, C, D, E, F, G, H");
        terrain.roughness_m3 *= keys.number("roughness_scale", 1, {0.001, 10});
        terrain.longest_m = keys.number("longest_m", terrain.longest_m, {0.1, 100});
        terrain.shortest_m = keys.number("shortest_m", terrain.shortest_m, {0.01, 0.5 * terrain.longest_m});
    }
    if (keys.has("map")) terrain.map = read_map(keys, file);
    keys.finish();
}

} // namespace

void read_ground(const toml::table &table, const std::string &file, Scenario &scenario) {
    Keys keys(table, file, "ground");
    Ground &ground = scenario.plant.ground;
    read_soil(keys, ground.soil);
    constexpr std::array<std::string_view, 3> laws{"aggregated", "bekker", "arc"}; // ContactLaw, in its order
    ground.contact = static_cast<ContactLaw>(keys.word("contact", "aggregated", laws));
    ground.gradient_1_m = keys.number("gradient_1_m", 0, {-1, 1});
    ground.gradient_direction_rad = keys.number("gradient_direction_rad", 0, {-10, 10});
    ground.slope_rad = keys.number("slope_rad", 0, {-0.5, 0.5});
    ground.slope_direction_rad = keys.number("slope_direction_rad", 0, {-10, 10});
    if (const toml::array *list = keys.array("slope_steps")) {
        for (const toml::node &node : *list) {
            const toml::array *pair = node.as_array();
            if (pair == nullptr || pair->size() != 2)
                keys.fail_at(node, "slope_steps", "is not a list of pairs",
                             "write [[path_m, slope_rad], ...], as [[1.0, 0.05], [3.0, 0.0]]");
            const SlopeStep step{keys.number_of((*pair)[0], "slope_steps", {-1000, 1000}),
                                 keys.number_of((*pair)[1], "slope_steps", {-0.5, 0.5})};
            if (!ground.slope_steps.empty() && step.path_m <= ground.slope_steps.back().path_m)
                keys.fail_at(node, "slope_steps", "its path does not lie after the one before", "order the steps by their path");
            ground.slope_steps.push_back(step);
        }
    }
    ground.slope_blend_m = keys.number("slope_blend_m", ground.slope_blend_m, {0.001, 10});
    ground.grip_noise = keys.number("grip_noise", ground.soil.law == TractionLaw::janosi ? 0.06 : 0.02, {0, 0.5});
    ground.grip_length_m = keys.number("grip_length_m", ground.grip_length_m, {0.02, 10});
    if (const toml::table *terrain = keys.table("terrain")) read_terrain(*terrain, file, ground.terrain);
    if (keys.has("seed")) scenario.ground_seed = static_cast<std::uint64_t>(keys.integer("seed", 1, 0, INT64_MAX));
    if (const toml::array *list = keys.tables("patch"))
        for (std::size_t i = 0; i < list->size(); i++)
            ground.patches.push_back(read_patch(*(*list)[i].as_table(), file, "ground.patch[" + std::to_string(i) + "]", ground.soil));
    keys.finish();
}

} // namespace traction::sim

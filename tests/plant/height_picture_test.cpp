// Height maps as pictures, written here by libpng: heights against a closed form, and bit for bit against a CSV of the same heights; what
// is torn, or no such picture, is refused.
#include "sim/plant/plant.h"

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <gtest/gtest.h>
#include <png.h>
#include <stdexcept>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

struct Picture {
    int columns = 2, rows = 2, bits = 16, colour = PNG_COLOR_TYPE_GRAY, interlace = PNG_INTERLACE_NONE;
    std::vector<int> count; // of each channel, line by line, the top one first
};

// Writes the picture; without `pixels` its head and where its pixels would begin. False: libpng refuses to write it.
bool write_png(const std::string &path, const Picture &picture, bool pixels = true) {
    std::FILE *file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::vector<std::vector<png_byte>> lines;
    std::vector<png_bytep> rows;
    const std::size_t each = pixels ? picture.count.size() / static_cast<std::size_t>(picture.rows) : 0;
    for (std::size_t row = 0; pixels && row < static_cast<std::size_t>(picture.rows); ++row) {
        std::vector<png_byte> line;
        for (std::size_t k = 0; k < each; ++k) {
            const int count = picture.count[row * each + k];
            if (picture.bits == 16) line.push_back(static_cast<png_byte>(count >> 8));
            line.push_back(static_cast<png_byte>(count & 255));
        }
        lines.push_back(line);
    }
    for (auto &line : lines) rows.push_back(line.data());
    bool written = false;
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_init_io(png, file);
        png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_IHDR(png, info, static_cast<png_uint_32>(picture.columns), static_cast<png_uint_32>(picture.rows), picture.bits,
                     picture.colour, picture.interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        const png_color black{0, 0, 0};
        if (picture.colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, &black, 1);
        png_write_info(png, info);
        if (pixels) {
            if (picture.bits < 8) png_set_packing(png);
            png_write_image(png, rows.data());
            png_write_end(png, info);
        }
        written = true;
    }
    png_destroy_write_struct(&png, &info);
    if (!pixels) std::fwrite("\0\0\0\1IDAT", 1, 8, file);
    std::fclose(file);
    return written;
}

constexpr int columns = 60, rows = 45;
constexpr double cell_m = 0.02, black_m = -0.03, white_m = 0.05;

// 6 cm of hills, 0.4 m and 0.6 m long.
double hills_m(double x_m, double y_m) {
    return 0.01 + 0.03 * std::sin(2 * 3.14159265358979 * (x_m / 0.4)) * std::cos(2 * 3.14159265358979 * (y_m / 0.6));
}

Picture hills(int bits, int interlace = PNG_INTERLACE_NONE) {
    Picture out{.columns = columns, .rows = rows, .bits = bits, .interlace = interlace, .count = {}};
    for (int line = 0; line < rows; ++line)
        for (int column = 0; column < columns; ++column) {
            const double share = (hills_m(cell_m * column, cell_m * (rows - 1 - line)) - black_m) / (white_m - black_m);
            out.count.push_back(static_cast<int>(std::lround(share * ((1 << bits) - 1))));
        }
    return out;
}

std::string in_temp(const std::string &name) { return testing::TempDir() + name; }

std::string told(const std::string &path) {
    try {
        read_height_picture(path, 0.1, 0, 1);
    } catch (const std::runtime_error &error) {
        return std::string(error.what()).substr(path.size());
    }
    return "read";
}

std::string bytes_of(const std::string &path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

} // namespace

TEST(HeightPicture, its_heights_are_the_surface_to_half_a_count) {
    const std::string path = in_temp("hills.png");
    for (const int bits : {8, 16}) {
        ASSERT_TRUE(write_png(path, hills(bits)));
        Terrain terrain;
        terrain.map = std::make_shared<const HeightMap>(read_height_picture(path, cell_m, black_m, white_m));
        const double half_count_m = 0.5 * (white_m - black_m) / ((1 << bits) - 1);
        ASSERT_EQ(terrain.map->columns, columns);
        ASSERT_EQ(terrain.map->rows, rows);
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                EXPECT_NEAR(terrain.map->at(column, row), hills_m(cell_m * column, cell_m * row), half_count_m * (1 + 1e-9));
        Relief relief(terrain, 1);
        double worst_m = 0;
        for (double x = 0.1; x < 1.0; x += 0.0137)
            for (double y = 0.1; y < 0.7; y += 0.0171) worst_m = std::max(worst_m, std::fabs(relief.height_m(x, y) - hills_m(x, y)));
        // between nodes Catmull-Rom: its error (k h)^3/24 of a wave (derived from its third-order truncation), kh = 0.31 and 0.21, and
        // the nodes' half counts times the weights' sum of magnitudes, (1.25)^2
        EXPECT_LT(worst_m, 0.03 * (0.31 * 0.31 * 0.31 + 0.21 * 0.21 * 0.21) / 24 + 1.5625 * half_count_m) << bits;
    }
}

TEST(HeightPicture, picture_csv_and_interlaced_picture_of_the_same_heights_are_one_ground_bit_for_bit) {
    const std::string path = in_temp("same.png"), csv = in_temp("same.csv");
    for (const int bits : {8, 16}) {
        ASSERT_TRUE(write_png(path, hills(bits)));
        const HeightMap picture = read_height_picture(path, cell_m, black_m, white_m);
        ASSERT_TRUE(write_png(path, hills(bits, PNG_INTERLACE_ADAM7)));
        EXPECT_EQ(read_height_picture(path, cell_m, black_m, white_m).height_m, picture.height_m);
        {
            const Picture counts = hills(bits); // the numbers that the format's equation gives, the lowest line first
            const double m_per_count = (white_m - black_m) / ((1 << bits) - 1);
            std::ofstream out(csv);
            out.precision(17);
            for (int row = rows - 1; row >= 0; --row)
                for (int column = 0; column < columns; ++column)
                    out << black_m + counts.count[static_cast<std::size_t>(row * columns + column)] * m_per_count
                        << (column + 1 < columns ? "," : "\n");
        }
        const HeightMap numbers = read_height_map(csv, cell_m, 1);
        ASSERT_EQ(numbers.height_m, picture.height_m);
        std::uint64_t hash[2] = {};
        for (const bool from_csv : {false, true}) {
            PlantConfig config;
            config.ground.soil = *find_soil("gravel");
            config.ground.terrain.map = std::make_shared<const HeightMap>(from_csv ? numbers : picture);
            config.x_m = 0.3, config.y_m = 0.4;
            Plant plant(config);
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, 0.5);
            for (int k = 0; k < 1000; ++k) plant.step();
            hash[from_csv ? 1 : 0] = plant.state_hash();
        }
        EXPECT_EQ(hash[0], hash[1]);
    }
}

TEST(HeightPicture, lies_as_a_map_does_with_its_top_at_the_highest_y) {
    const std::string path = in_temp("corners.png");
    ASSERT_TRUE(write_png(path, {.columns = 2, .rows = 2, .bits = 8, .count = {51, 102, 153, 255}}));
    const HeightMap map = read_height_picture(path, 0.1, 0, 1);
    EXPECT_DOUBLE_EQ(map.at(0, 1), 0.2);
    EXPECT_DOUBLE_EQ(map.at(1, 1), 0.4);
    EXPECT_DOUBLE_EQ(map.at(0, 0), 0.6);
    EXPECT_DOUBLE_EQ(map.at(1, 0), 1.0);
}

TEST(HeightPicture, a_torn_file_is_refused_wherever_it_is_torn_and_a_wrong_byte_is_refused_or_changes_no_height) {
    const std::string path = in_temp("torn.png");
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
        ASSERT_TRUE(write_png(path, hills(16, interlace)));
        const std::string whole = bytes_of(path);
        const std::vector<double> heights_m = read_height_picture(path, 0.1, 0, 1).height_m;
        for (std::size_t length = 0; length < whole.size(); length += length < 64 || length + 20 > whole.size() ? 1 : 97) {
            std::ofstream(path, std::ios::binary) << whole.substr(0, length);
            EXPECT_NE(told(path), "read") << length;
            if (length >= 8) {
                EXPECT_EQ(told(path).substr(0, 21), ": is torn or damaged ") << length;
            }
        }
        for (std::size_t at = 0; at < whole.size(); at += 31) {
            std::string wrong = whole;
            wrong[at] = static_cast<char>(wrong[at] ^ 0x10);
            std::ofstream(path, std::ios::binary) << wrong;
            if (told(path) == "read") { // libpng 1.6.48 does not look at the last checksum, that of the end mark
                EXPECT_EQ(read_height_picture(path, 0.1, 0, 1).height_m, heights_m) << at;
                EXPECT_GE(at, whole.size() - 4);
            }
        }
    }
}

TEST(HeightPicture, what_is_no_grey_picture_of_8_or_16_bit_is_named_with_its_mend) {
    const std::string path = in_temp("kind.png"), mend = "; save it as grey of 8 or 16 bit";
    const std::vector<int> few(4 * 2 * 2, 0);
    const auto refused = [&](Picture picture, int channels) {
        picture.count.assign(few.begin(), few.begin() + 4 * channels);
        EXPECT_TRUE(write_png(path, picture));
        return told(path);
    };
    EXPECT_EQ(refused({.bits = 8, .colour = PNG_COLOR_TYPE_RGB, .count = {}}, 3), ": is in colour, not grey" + mend);
    EXPECT_EQ(refused({.bits = 16, .colour = PNG_COLOR_TYPE_RGB_ALPHA, .count = {}}, 4), ": is in colour, not grey" + mend);
    EXPECT_EQ(refused({.bits = 8, .colour = PNG_COLOR_TYPE_PALETTE, .count = {}}, 1), ": is in colour, not grey" + mend);
    EXPECT_EQ(refused({.bits = 8, .colour = PNG_COLOR_TYPE_GRAY_ALPHA, .count = {}}, 2),
              ": has transparency (an alpha channel)" + mend + ", without alpha");
    EXPECT_EQ(refused({.bits = 4, .count = {}}, 1), ": has 4 bit" + mend);
    ASSERT_TRUE(write_png(path, {.columns = 4, .rows = 1, .count = {0, 0, 0, 0}}));
    EXPECT_EQ(told(path), ": a height map needs two rows and two columns at least");
    std::ofstream(path) << "0,1\n0,1\n";
    EXPECT_EQ(told(path), ": is not a PNG; save it as a grey PNG of 8 or 16 bit, or name a CSV of heights .csv");
    EXPECT_EQ(told(path + ".none"), ": cannot be read; name a PNG of heights");
}

// A file of 41 bytes that claims 8 TB: refused before any pixel has a place.
TEST(HeightPicture, an_absurd_size_is_refused_by_its_head) {
    const std::string path = in_temp("absurd.png");
    ASSERT_TRUE(write_png(path, {.columns = 2'000'000, .rows = 2'000'000, .count = {}}, false));
    EXPECT_EQ(told(path), ": 2000000 x 2000000 pixels are more than 4 million; scale it down or take a part of it");
    ASSERT_TRUE(write_png(path, {.columns = 2001, .rows = 2000, .count = {}}, false));
    EXPECT_EQ(told(path), ": 2001 x 2000 pixels are more than 4 million; scale it down or take a part of it");
    ASSERT_TRUE(write_png(path, {.columns = 2000, .rows = 2000, .count = {}}, false)); // just allowed, and then torn
    EXPECT_EQ(told(path).substr(0, 21), ": is torn or damaged ");
}

TEST(HeightPicture, is_known_by_its_name_or_by_its_first_bytes) {
    const std::string named = in_temp("a.PNG"), unnamed = in_temp("picture_without_a_name"), csv = in_temp("b.csv");
    ASSERT_TRUE(write_png(unnamed, {.count = {0, 1, 2, 3}}));
    std::ofstream(csv) << "0,1\n0,1\n";
    EXPECT_TRUE(is_height_picture(named)); // though it is not there: then it is missing, not a CSV
    EXPECT_TRUE(is_height_picture(unnamed));
    EXPECT_FALSE(is_height_picture(csv));
    EXPECT_FALSE(is_height_picture(in_temp("none.csv")));
}

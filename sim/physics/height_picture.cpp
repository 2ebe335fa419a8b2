#include "terrain.h"

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <png.h>
#include <stdexcept>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

namespace traction::sim {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;

constexpr std::size_t signature_bytes = 8;
constexpr png_alloc_size_t chunk_bytes_most = 1'000'000; // what one text or profile beside the picture may unpack to

bool begins_as_png(std::FILE *file) {
    std::array<png_byte, signature_bytes> head{};
    const bool same = std::fread(head.data(), 1, head.size(), file) == head.size() && png_sig_cmp(head.data(), 0, signature_bytes) == 0;
    std::rewind(file);
    return same;
}

// What libpng is given, and what it said. All of it outlives the jump by which libpng reports an error.
struct Reading {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::array<char, 160> error{};
    int bits = 0, colour = 0;
    std::size_t columns = 0, rows = 0;
    std::vector<png_byte> bytes;
    std::vector<png_bytep> lines;
    ~Reading() { png_destroy_read_struct(&png, &info, nullptr); }
};

void tell(png_structp png, png_const_charp text) {
    auto &error = static_cast<Reading *>(png_get_error_ptr(png))->error;
    std::snprintf(error.data(), error.size(), "%s", text);
    png_longjmp(png, 1);
}

void tell_nothing(png_structp, png_const_charp) {}

// These two hold no object with a destructor: libpng's errors come back by longjmp. False: `error` says why.
bool read_head(Reading &reading, std::FILE *file) {
    if (setjmp(png_jmpbuf(reading.png)) != 0) return false;
    png_init_io(reading.png, file);
    png_set_user_limits(reading.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // the number of pixels is bounded in check_kind
    png_set_chunk_malloc_max(reading.png, chunk_bytes_most);
    png_read_info(reading.png, reading.info);
    reading.bits = png_get_bit_depth(reading.png, reading.info);
    reading.colour = png_get_color_type(reading.png, reading.info);
    reading.columns = png_get_image_width(reading.png, reading.info);
    reading.rows = png_get_image_height(reading.png, reading.info);
    return true;
}

bool read_pixels(Reading &reading) {
    if (setjmp(png_jmpbuf(reading.png)) != 0) return false;
    png_set_interlace_handling(reading.png);
    png_read_update_info(reading.png, reading.info);
    png_read_image(reading.png, reading.lines.data());
    png_read_end(reading.png, nullptr);
    return true;
}

void check_kind(const Reading &reading, const std::string &path) {
    const std::string mend = "; save it as grey of 8 or 16 bit";
    if ((reading.colour & PNG_COLOR_MASK_COLOR) != 0) throw std::runtime_error(path + ": is in colour, not grey" + mend);
    if ((reading.colour & PNG_COLOR_MASK_ALPHA) != 0)
        throw std::runtime_error(path + ": has transparency (an alpha channel)" + mend + ", without alpha");
    if (reading.bits != 8 && reading.bits != 16) throw std::runtime_error(path + ": has " + std::to_string(reading.bits) + " bit" + mend);
    if (reading.rows < 2 || reading.columns < 2) throw std::runtime_error(path + ": a height map needs two rows and two columns at least");
    if (reading.columns * reading.rows > height_map_most)
        throw std::runtime_error(path + ": " + std::to_string(reading.columns) + " x " + std::to_string(reading.rows) +
                                 " pixels are more than 4 million; scale it down or take a part of it");
}

} // namespace

bool is_height_picture(const std::string &path) {
    std::string ending = path.size() >= 4 ? path.substr(path.size() - 4) : "";
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".png") return true;
    const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
    return file && begins_as_png(file.get());
}

HeightMap read_height_picture(const std::string &path, double cell_m, double black_m, double white_m) {
    const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw std::runtime_error(path + ": cannot be read; name a PNG of heights");
    if (!begins_as_png(file.get()))
        throw std::runtime_error(path + ": is not a PNG; save it as a grey PNG of 8 or 16 bit, or name a CSV of heights .csv");
    Reading reading;
    reading.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, tell, tell_nothing);
    reading.info = reading.png != nullptr ? png_create_info_struct(reading.png) : nullptr;
    if (reading.info == nullptr) throw std::runtime_error(path + ": libpng cannot start; there is no memory, or it is another version");
    const auto torn = [&] {
        return std::runtime_error(path + ": is torn or damaged (libpng: " + reading.error.data() + "); save it again");
    };
    if (!read_head(reading, file.get())) throw torn();
    check_kind(reading, path);
    const std::size_t bytes_each = reading.bits == 16 ? 2 : 1, line_bytes = bytes_each * reading.columns;
    reading.bytes.resize(line_bytes * reading.rows);
    for (std::size_t row = 0; row < reading.rows; ++row) reading.lines.push_back(reading.bytes.data() + row * line_bytes);
    if (!read_pixels(reading)) throw torn();

    HeightMap map{.columns = static_cast<int>(reading.columns), .rows = static_cast<int>(reading.rows), .cell_m = cell_m, .height_m = {}};
    map.height_m.reserve(reading.columns * reading.rows);
    const double m_per_count = (white_m - black_m) / (bytes_each == 2 ? 65535 : 255);
    for (std::size_t row = reading.rows; row-- > 0;)
        for (std::size_t column = 0; column < reading.columns; ++column) {
            const png_byte *at = reading.lines[row] + bytes_each * column; // the high byte first
            const int count = bytes_each == 2 ? 256 * at[0] + at[1] : at[0];
            map.height_m.push_back(black_m + count * m_per_count);
        }
    return map;
}

} // namespace traction::sim

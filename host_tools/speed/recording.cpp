#include "recording.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>

namespace traction::speed {

namespace {

constexpr std::size_t least_samples = 512; // two windows of the firmware
constexpr double rate_tolerance = 0.02;    // [1] beyond it a rate and time stamps contradict each other, assumed

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

double median_step_s(const std::vector<double> &t_s) {
    std::vector<double> step;
    for (std::size_t i = 1; i < t_s.size(); i++) step.push_back(t_s[i] - t_s[i - 1]);
    std::nth_element(step.begin(), step.begin() + static_cast<std::ptrdiff_t>(step.size() / 2), step.end());
    return step[step.size() / 2];
}

} // namespace

Recording from_log(const log::Log &log, const std::string &column, double rate_Hz) {
    const log::Signal *signal = log.find(column);
    if (signal == nullptr)
        throw log::LogError(log.source, 0, 0, "there is no column " + column + ", so there is no radar to listen to",
                            "name the column of the converter's samples with --column, or map it to radar.adc_count (docs/log_format.md)");
    if (signal->t_s.size() < least_samples)
        throw log::LogError(log.source, 0, 0, column + " has " + std::to_string(signal->t_s.size()) + " samples",
                            "give at least 512: two windows of the transform");
    const double stamped_Hz = 1 / median_step_s(signal->t_s);
    if (rate_Hz <= 0) {
        const auto stated = log.header.find("radar.sample_rate_Hz");
        rate_Hz = stated != log.header.end() ? std::strtod(stated->second.c_str(), nullptr) : 0;
        if (rate_Hz <= 0) rate_Hz = stamped_Hz;
    }
    if (std::fabs(stamped_Hz / rate_Hz - 1) > rate_tolerance)
        throw log::LogError(log.source, 0, 0,
                            column + " is stamped at " + number_text(stamped_Hz) + " Hz, but its rate is said to be " +
                                number_text(rate_Hz),
                            "give the true one with --rate, or mend radar.sample_rate_Hz in the header");
    Recording out{.source = log.source, .column = column, .rate_Hz = rate_Hz, .start_s = signal->t_s.front(), .number = {}, .value = {}};
    for (std::size_t i = 0; i < signal->t_s.size(); i++) {
        auto n = std::llround((signal->t_s[i] - out.start_s) * rate_Hz);
        if (!out.number.empty()) n = std::max(n, static_cast<long long>(out.number.back()) + 1); // stamps tremble, samples do not
        out.number.push_back(n);
        out.value.push_back(signal->value[i]);
    }
    return out;
}

namespace {

// Little-endian numbers out of the bytes of a file.
class Bytes {
  public:
    Bytes(std::string text, std::string path) : text_(std::move(text)), path_(std::move(path)) {}
    std::size_t size() const { return text_.size(); }
    std::string tag(std::size_t at) const { return at + 4 <= text_.size() ? text_.substr(at, 4) : std::string(); }
    std::uint32_t whole(std::size_t at, std::size_t bytes) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes && at + i < text_.size(); i++)
            value |= static_cast<std::uint32_t>(static_cast<unsigned char>(text_[at + i])) << (8 * i);
        return value;
    }
    [[noreturn]] void fail(const std::string &what, const std::string &mend) const { throw log::LogError(path_, 0, 0, what, mend); }

  private:
    std::string text_, path_;
};

struct WavFormat {
    std::uint32_t kind = 0, channels = 0, rate_Hz = 0, bits = 0;
    std::size_t data = 0, bytes = 0;
};

constexpr std::uint32_t pcm = 1, floating = 3, extensible = 0xfffe;

WavFormat read_format(const Bytes &file) {
    const std::string mend = "give a RIFF WAV file: PCM of 8, 16, 24 or 32 bits, or float of 32 bits";
    if (file.tag(0) != "RIFF" || file.tag(8) != "WAVE") file.fail("not a WAV file", mend);
    WavFormat format;
    for (std::size_t at = 12; at + 8 <= file.size();) {
        const std::size_t length = file.whole(at + 4, 4), body = at + 8;
        if (file.tag(at) == "fmt " && length >= 16) {
            format.kind = file.whole(body, 2);
            format.channels = file.whole(body + 2, 2);
            format.rate_Hz = file.whole(body + 4, 4);
            format.bits = file.whole(body + 14, 2);
            if (format.kind == extensible && length >= 26) format.kind = file.whole(body + 24, 2);
        } else if (file.tag(at) == "data") {
            format.data = body;
            format.bytes = std::min(length, file.size() - body); // a recorder that was cut off leaves a length that is too large
            break;
        }
        at = body + length + length % 2;
    }
    const bool known = (format.kind == pcm && (format.bits == 8 || format.bits == 16 || format.bits == 24 || format.bits == 32)) ||
                       (format.kind == floating && format.bits == 32);
    if (format.data == 0 || format.channels == 0 || format.rate_Hz == 0) file.fail("a WAV file without format or data", mend);
    if (!known) file.fail("samples of kind " + std::to_string(format.kind) + " with " + std::to_string(format.bits) + " bits", mend);
    return format;
}

double sample_at(const Bytes &file, const WavFormat &format, std::size_t at) {
    const std::uint32_t raw = file.whole(at, format.bits / 8);
    if (format.kind == floating) return static_cast<double>(std::bit_cast<float>(raw));
    if (format.bits == 8) return static_cast<double>(raw) - 128; // offset binary
    const std::uint32_t shift = 32 - format.bits;
    return static_cast<double>(static_cast<std::int32_t>(raw << shift) >> shift);
}

} // namespace

Recording from_wav(const std::string &path, int channel, double rate_Hz) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw log::FileError(path, 0, 0, "cannot be read", "give the path of a WAV file");
    const Bytes file(std::string(std::istreambuf_iterator<char>(stream), {}), path);
    const WavFormat format = read_format(file);
    if (static_cast<std::uint32_t>(channel) >= format.channels)
        file.fail("there is no channel " + std::to_string(channel), "give --channel 0 to " + std::to_string(format.channels - 1));
    const std::size_t one = format.bits / 8, frame = one * format.channels, frames = format.bytes / frame;
    Recording out{.source = path, .column = "", .rate_Hz = rate_Hz > 0 ? rate_Hz : format.rate_Hz, .start_s = 0, .number = {}, .value = {}};
    for (std::size_t i = 0; i < frames; i++) {
        const double value = sample_at(file, format, format.data + i * frame + static_cast<std::size_t>(channel) * one);
        out.number.push_back(static_cast<std::int64_t>(i));
        out.value.push_back(std::isfinite(value) ? value : 0);
    }
    if (frames < least_samples) file.fail(std::to_string(frames) + " samples", "give at least 512: two windows of the transform");
    return out;
}

namespace {

bool are_counts(const Recording &recording, int max_count) {
    return std::all_of(recording.value.begin(), recording.value.end(),
                       [max_count](double v) { return v >= 0 && v <= max_count && v == std::floor(v); });
}

// Hamming-windowed sinc that passes up to 0.42 of the new rate; 16 new samples long; sum 1.
std::vector<double> low_pass(int thin) {
    const int half = 8 * thin;
    std::vector<double> tap;
    double sum = 0;
    for (int i = -half; i <= half; i++) {
        const double x = std::numbers::pi * 0.94 * i / thin; // -6 dB at 0.47 of the new rate
        tap.push_back((i == 0 ? 1 : std::sin(x) / x) * (0.54 + 0.46 * std::cos(std::numbers::pi * i / half)));
        sum += tap.back();
    }
    for (double &t : tap) t /= sum;
    return tap;
}

// Every thin-th sample of the filtered recording. A sample that is missing is left out of the sum; a new one is missing where a quarter of
// its weight is.
Recording thinned(const Recording &in, int thin) {
    const std::vector<double> tap = low_pass(thin);
    const int half = 8 * thin;
    double mean = 0;
    for (const double v : in.value) mean += v / static_cast<double>(in.value.size());
    Recording out{.source = in.source, .column = in.column, .rate_Hz = in.rate_Hz / thin, .start_s = in.start_s, .number = {}, .value = {}};
    std::size_t first = 0;
    for (std::int64_t m = 0; m * thin <= in.number.back(); m++) {
        const std::int64_t centre = m * thin;
        while (first < in.number.size() && in.number[first] < centre - half) first++;
        double sum = 0, weight = 0;
        for (std::size_t i = first; i < in.number.size() && in.number[i] <= centre + half; i++) {
            const double w = tap[static_cast<std::size_t>(in.number[i] - centre + half)];
            sum += w * (in.value[i] - mean);
            weight += w;
        }
        if (weight < 0.75 && m > 0 && centre + half < in.number.back()) continue;
        out.number.push_back(m);
        out.value.push_back(mean + sum);
    }
    return out;
}

} // namespace

Counts to_counts(const Recording &recording, double need_Hz, int offset_count, int max_count) {
    constexpr double kept = 0.42;    // of the new rate, that the low-pass passes whole
    constexpr double usual_Hz = 512; // a window of half a second, as the reference radar's; the firmware's noise is stated for it
    const double least_Hz = std::max(usual_Hz, need_Hz / kept);
    const int thin = std::max(1, static_cast<int>(recording.rate_Hz / least_Hz));
    const bool counts = are_counts(recording, max_count);
    const Recording now = thin > 1 ? thinned(recording, thin) : recording;
    Counts out{.rate_Hz = now.rate_Hz, .start_s = now.start_s, .thinned = thin, .number = now.number, .count = {}};
    out.as_is = counts && thin == 1;
    if (!counts) {
        for (const double v : now.value) out.centre += v / static_cast<double>(now.value.size());
        std::vector<double> size;
        for (const double v : now.value) size.push_back(std::fabs(v - out.centre));
        const auto loud = size.begin() + static_cast<std::ptrdiff_t>(size.size() - 1 - size.size() / 1000);
        std::nth_element(size.begin(), loud, size.end());
        out.gain = *loud > 0 ? 400 / *loud : 1;
    }
    for (const double v : now.value) {
        const double count = counts ? v : offset_count + out.gain * (v - out.centre);
        const double held = std::clamp(std::floor(count + 0.5), 0.0, static_cast<double>(max_count));
        out.railed += held == 0 || held == max_count ? 1 : 0;
        out.count.push_back(static_cast<std::uint16_t>(held));
    }
    out.lost = now.number.back() + 1 - static_cast<std::int64_t>(now.number.size());
    return out;
}

} // namespace traction::speed

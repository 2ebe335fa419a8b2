// recording.h - what a radar's converter delivered, from a log or from a WAV file, as counts that the firmware takes.
//
// Here the firmware takes 10-bit counts at 202 to 20000 Hz. Whole numbers of 0 to 1023 pass as they are; anything else (volts, 16-bit
// audio) is scaled by one factor for the whole recording, so that its loudest thousandth reaches 400 counts from the middle. A faster
// recording is filtered and thinned by a whole number: a windowed-sinc low-pass of 16 new samples' length, without delay.
#pragma once

#include "host_tools/log/log.h"

#include <cstdint>
#include <string>
#include <vector>

namespace traction::speed {

struct Recording {
    std::string source, column;       // column: of a log; empty for a WAV file
    double rate_Hz = 0;               // of `number`
    double start_s = 0;               // time of sample number 0
    std::vector<std::int64_t> number; // of each sample on the converter's clock, rising; a gap: samples were lost
    std::vector<double> value;
    double time_s(std::size_t i) const { return start_s + static_cast<double>(number[i]) / rate_Hz; }
};

// The column of a log. rate_Hz 0: the header's radar.sample_rate_Hz, else that of the time stamps. Throws log::LogError where there is no
// such column, where it has fewer than 512 samples, or where the rate contradicts the time stamps by more than 2 %.
Recording from_log(const log::Log &log, const std::string &column, double rate_Hz);

// The first or another channel (from 0) of a RIFF WAV file: PCM of 8, 16, 24, 32 bits or float of 32. rate_Hz 0: the header's. Throws
// log::LogError, log::FileError.
Recording from_wav(const std::string &path, int channel, double rate_Hz);

struct Counts {
    double rate_Hz = 0, start_s = 0;
    int thinned = 1;        // new samples are 1 in so many
    double gain = 1;        // counts per unit of the recording
    double centre = 0;      // value that became offset_count
    bool as_is = true;      // gain 1, nothing thinned
    std::int64_t lost = 0;  // samples missing between the first and the last
    std::size_t railed = 0; // at 0 or max_count
    std::vector<std::int64_t> number;
    std::vector<std::uint16_t> count;
};

// need_Hz: the highest frequency that must be kept.
Counts to_counts(const Recording &recording, double need_Hz, int offset_count, int max_count);

} // namespace traction::speed

// Every way to spoil a log that the project promises to name: a drive of the simulator and one of the independent rover, spoilt one way at
// a time, written to a file and checked as a user would check it. The same drives unspoilt pass.
#include "files.h"
#include "synthetic.h"

#include "host_tools/check/check.h"
#include "host_tools/simulate/simulate.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

using namespace traction;
using namespace traction::test;

namespace {

struct Corruption {
    const char *name;
    std::function<void(log::Log &)> spoil;             // the log before it is written
    const char *finding, *signal, *word;               // what check must say, of what, in which words
    std::function<std::string(std::string)> rewrite{}; // the file's text
};

void drop(log::Log &log, const std::function<bool(std::size_t)> &gone) {
    for (log::Signal &signal : log.signals) {
        log::Signal kept{signal.name, {}, {}};
        for (std::size_t i = 0; i < signal.t_s.size(); ++i)
            if (!gone(static_cast<std::size_t>(std::lround(signal.t_s[i] * 100))))
                kept.t_s.push_back(signal.t_s[i]), kept.value.push_back(signal.value[i]);
        signal = std::move(kept);
    }
}

// Every third number of one column becomes the word nan.
std::string with_nan(const std::string &text, const std::string &column) {
    std::istringstream in(text);
    std::string out, line;
    std::ptrdiff_t place = -1;
    int row = 0;
    while (std::getline(in, line)) {
        if (!line.empty() && line[0] != '#') {
            std::vector<std::string> cells;
            std::istringstream parts(line + ",");
            for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
            if (place < 0) {
                place = std::find(cells.begin(), cells.end(), column) - cells.begin();
            } else if (!cells[static_cast<std::size_t>(place)].empty() && ++row % 3 == 0) {
                cells[static_cast<std::size_t>(place)] = "nan";
                line.clear();
                for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + cells[i];
            }
        }
        out += line + "\n";
    }
    return out;
}

const std::vector<Corruption> &corruptions() {
    static const std::vector<Corruption> list = {
        {"nan", [](log::Log &) {}, "not_finite", "wheel1.current_A", "",
         [](std::string text) { return with_nan(text, "wheel1.current_A"); }},
        {"dead_sensor",
         [](log::Log &log) {
             for (double &v : at(log, "wheel2.current_A").value) v = 0;
         },
         "dead_sensor", "wheel2.current_A", ""},
        {"swapped_wheels", [](log::Log &log) { exchange(log, "wheel0.current_A", "wheel3.current_A"); }, "swapped_wheels",
         "wheel0.current_A", ""},
        {"deg_per_s", [](log::Log &log) { scale(log, "imu.gyro_z_rad_s", 57.2958); }, "unit", "imu.gyro_z_rad_s", "deg/s"},
        {"rpm", [](log::Log &log) { scale(log, "wheel1.speed_rad_s", 9.5493); }, "unit", "wheel1.speed_rad_s", "rpm"},
        {"milliampere", [](log::Log &log) { scale(log, "wheel3.current_A", 1000); }, "unit", "wheel3.current_A", "mA"},
        {"wrong_sign", [](log::Log &log) { scale(log, "wheel1.current_A", -1); }, "sign", "wheel1.current_A", ""},
        {"thirty_percent_missing", [](log::Log &log) { drop(log, [](std::size_t tick) { return (tick * 2654435761U >> 7U) % 10 < 3; }); },
         "samples_missing", "wheel0.speed_rad_s", "30"},
        {"clock_jump",
         [](log::Log &log) {
             for (log::Signal &s : log.signals)
                 for (double &t : s.t_s) t += t > 20 ? 7 : 0;
         },
         "clock_jump", "", "7"},
        {"clock_set_back", [](log::Log &) {}, "clock_jump", "", "",
         [](const std::string &text) { // the second half once more, behind the end
             const std::size_t half = text.find('\n', text.size() / 2) + 1;
             return text + text.substr(half);
         }},
    };
    return list;
}

log::Log drive_of(const std::string &source) {
    if (source == "plant") return simulate(sim::read_scenario("scenarios/identification.toml")).log;
    generator::GeneratorConfig config;
    config.soil = generator::Soil::sand;
    config.seed = 12;
    log::Log log = generator::generate(config);
    for (log::Signal &s : log.signals) { // counts into speeds over 50 ms, as a rover's firmware would
        const std::size_t end = s.name.find(".encoder_count");
        if (end == std::string::npos) continue;
        s.name = s.name.substr(0, end) + ".speed_rad_s";
        const std::vector<double> count = s.value;
        for (std::size_t i = 0; i < count.size(); ++i) {
            const std::size_t a = i < 2 ? 0 : i - 2, b = std::min(count.size() - 1, i + 2);
            s.value[i] = (count[b] - count[a]) / (s.t_s[b] - s.t_s[a]) * 2 * 3.14159265358979 / 6000;
        }
    }
    return log;
}

std::string listed(const check::Report &report) {
    std::string out;
    for (const check::Finding &f : report.findings)
        out += std::string(check::severity_name(f.severity)) + " " + f.id + " [" + f.signal + "] " + f.text + "\n";
    return out;
}

check::Report checked(const log::Log &log, const std::function<std::string(std::string)> &rewrite, bool known) {
    const File place("corruption.csv", "");
    log::write_csv(log, place.path());
    if (rewrite) {
        std::ifstream in(place.path());
        std::ostringstream text;
        text << in.rdbuf();
        in.close();
        std::ofstream(place.path()) << rewrite(text.str());
    }
    const check::Machine rover{.wheel_radius_m = 0.057, .back_emf_Vs = 0.265, .resistance_ohm = 3.24, .wheels_point_forward = true};
    return check::check_file(place.path(), "", known ? rover : check::Machine{});
}

class Corrupted : public testing::TestWithParam<const char *> {};

TEST_P(Corrupted, log_is_named_for_what_it_is_and_the_sound_one_passes) {
    const log::Log sound = drive_of(GetParam());
    for (const bool known : {false, true}) {
        const check::Report clean = checked(sound, {}, known);
        EXPECT_TRUE(clean.passed()) << listed(clean);
        for (const Corruption &c : corruptions()) {
            SCOPED_TRACE(std::string(c.name) + (known ? ", machine known" : ", machine unknown"));
            EXPECT_EQ(clean.find(c.finding, c.signal), nullptr) << listed(clean);
            log::Log log = sound;
            c.spoil(log);
            const check::Report report = checked(log, c.rewrite, known);
            const check::Finding *finding = report.find(c.finding, c.signal);
            if (finding == nullptr) {
                ADD_FAILURE() << listed(report);
                continue;
            }
            EXPECT_EQ(finding->severity, check::Severity::error) << finding->text;
            EXPECT_NE(finding->text.find(c.word), std::string::npos) << finding->text;
            EXPECT_FALSE(finding->mend.empty());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Corrupted, testing::Values("plant", "independent_rover"),
                         [](const auto &source) { return std::string(source.param); });

} // namespace

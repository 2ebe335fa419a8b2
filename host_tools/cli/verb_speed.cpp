// verb_speed.cpp - traction speed LOG: ground speed with its uncertainty from a recorded radar, by the rover's firmware.
#include "rows.h"
#include "verbs.h"

#include "host_tools/report/report.h"
#include "host_tools/report/svg.h"
#include "host_tools/speed/radar_choice.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace traction::cli {

namespace {

struct SpeedOptions {
    std::string log, map, column = "radar.adc_count", accel, reference, reference_log, target = "ground", out, plot, report;
    double rate_Hz = 0, carrier_GHz = 0, vertical_deg = 0, horizontal_deg = 0, depression_deg = 0, band_low_Hz = 0, band_high_Hz = 0,
           speed_high_m_s = 0, scale = 0, agility_m_s2 = 0;
    bool carrier = false, vertical = false, horizontal = false, depression = false, low = false, high = false, highest = false,
         scaled = false;
    int channel = 0;
    bool no_wheels = false, paper = false;
    speed::RadarChoice radar;
};

speed::RadarChoice choice_of(const SpeedOptions &options) {
    speed::RadarChoice choice = options.radar;
    const auto take = [](bool given, double value, std::optional<double> &into) {
        if (given) into = value;
    };
    take(options.carrier, options.carrier_GHz * 1e9, choice.carrier_Hz);
    take(options.vertical, options.vertical_deg, choice.vertical_deg);
    take(options.horizontal, options.horizontal_deg, choice.horizontal_deg);
    take(options.depression, options.depression_deg, choice.depression_deg);
    take(options.low, options.band_low_Hz, choice.band_low_Hz);
    take(options.high, options.band_high_Hz, choice.band_high_Hz);
    take(options.highest, options.speed_high_m_s, choice.speed_high_m_s);
    take(options.scaled, options.scale, choice.scale);
    choice.point = options.target == "point";
    return choice;
}

// The signal that is named, of the reference's log or of the recording's; truth.speed_m_s where none is named; empty: there is none.
log::Signal reference_of(const SpeedOptions &options, const log::Log *log) {
    const log::Log other = options.reference_log.empty() ? log::Log{} : log::read_csv(options.reference_log);
    const log::Log *from = options.reference_log.empty() ? log : &other;
    const bool wanted = !options.reference.empty() || !options.reference_log.empty();
    const std::string name = options.reference.empty() ? "truth.speed_m_s" : options.reference;
    const log::Signal *signal = from != nullptr ? from->find(name) : nullptr;
    if (signal == nullptr && wanted)
        throw log::LogError(from != nullptr ? from->source : options.log, 0, 0, "there is no column " + name,
                            "name the reference's column with --reference, and its file with --reference-log");
    return signal != nullptr ? *signal : log::Signal{};
}

report::Figure figure_of(const speed::Result &result, const log::Signal &reference) {
    report::Series band{.name = "two standard deviations", .mark = report::Mark::band, .x = result.t_s};
    report::Series speed{.name = "estimate", .x = result.t_s, .y = result.speed_m_s};
    report::Series values{.name = "Doppler values", .mark = report::Mark::scatter, .x = result.doppler.t_s, .y = result.doppler.value};
    report::Series wide{.name = "standard deviation", .x = result.t_s, .y = result.std_m_s};
    const double most = 1.1 * result.highest_m_s;
    for (std::size_t i = 0; i < result.t_s.size(); i++) {
        band.y.push_back(std::fmax(result.speed_m_s[i] - 2 * result.std_m_s[i], -most));
        band.y_high.push_back(std::fmin(result.speed_m_s[i] + 2 * result.std_m_s[i], most));
    }
    report::Panel upper{.title = "Ground speed", .y_label = "speed [m/s]", .series = {band, speed, values}};
    if (!reference.t_s.empty()) upper.series.push_back({.name = reference.name, .x = reference.t_s, .y = reference.value});
    return {.title = "Speed from the recorded radar",
            .x_label = "time [s]",
            .panels = {upper, {.title = "What the estimator claims", .y_label = "std [m/s]", .series = {wide}, .log_y = true}}};
}

nlohmann::json judgement_json(const speed::Judgement &j) {
    return {{"reference", j.reference}, {"ticks", j.ticks}, {"rmse_m_s", j.rmse_m_s},     {"bias_m_s", j.bias_m_s},
            {"worst_m_s", j.worst_m_s}, {"nees", j.nees},   {"within_1_std", j.within_1}, {"within_2_std", j.within_2}};
}

std::string counts_words(const speed::Recording &recording, const speed::Counts &counts) {
    char text[200];
    std::snprintf(text, sizeof text, "%zu samples at %.6g Hz", recording.value.size(), recording.rate_Hz);
    std::string out = text;
    if (counts.thinned > 1) {
        std::snprintf(text, sizeof text, ", filtered and thinned to 1 in %d: %.6g Hz", counts.thinned, counts.rate_Hz);
        out += text;
    }
    if (!counts.as_is && counts.gain != 1) {
        std::snprintf(text, sizeof text, ", scaled by %.4g counts per unit", counts.gain);
        out += text;
    }
    if (counts.lost > 0) out += ", " + std::to_string(counts.lost) + " lost";
    if (counts.railed > 0) out += ", " + std::to_string(counts.railed) + " at a rail";
    return out;
}

void say(const speed::Result &r, const speed::Settings &settings, const std::string &samples) {
    std::printf("%s\n", samples.c_str());
    std::printf("radar %.5g GHz, %.3g deg off the path, hears %.2g to %.3g m/s; %s, %s\n", settings.radar.carrier_Hz / 1e9,
                settings.radar.depression_deg, r.lowest_m_s, r.highest_m_s, r.used_accel ? "with accelerometer" : "no accelerometer",
                r.used_wheels ? "wheels tell the sign" : "no wheels: begins forward");
    std::printf("%zu Doppler values: %zu quiet, %zu that fit no ground, %zu beyond the band\n", r.values, r.quiet, r.spoilt, r.beyond);
    if (std::isnan(r.first_s))
        std::printf("no speed was heard\n");
    else
        std::printf("first after %.2f s; mean speed %.4f m/s, mean standard deviation %.4f m/s\n", r.first_s, r.mean_m_s, r.mean_std_m_s);
}

void write_report(const SpeedOptions &options, const speed::Result &result, const std::string &svg, const std::string &samples,
                  const nlohmann::json &judged) {
    nlohmann::json rows = nlohmann::json::array();
    rows.push_back({"recording", samples});
    rows.push_back({"mean speed [m/s]", result.mean_m_s});
    rows.push_back({"mean standard deviation [m/s]", result.mean_std_m_s});
    rows.push_back({"Doppler values, of them quiet", std::to_string(result.values) + ", " + std::to_string(result.quiet)});
    rows.push_back({"fitting no ground, beyond the band", std::to_string(result.spoilt) + ", " + std::to_string(result.beyond)});
    if (!judged.is_null())
        for (const auto &[key, value] : judged.items()) rows.push_back({key, value});
    const nlohmann::json page = {{"schema", "traction.figures/1"},
                                 {"title", "Ground speed from " + std::filesystem::path(options.log).filename().string()},
                                 {"intro", "The rover's own firmware, run over a recorded radar (traction speed)."},
                                 {"figures",
                                  {{{"id", "speed"},
                                    {"title", "Speed and its uncertainty"},
                                    {"paper", ""},
                                    {"ours", ""},
                                    {"verdict", ""},
                                    {"svg", svg},
                                    {"notes", ""}}}},
                                 {"tables", {{{"title", "In numbers"}, {"columns", {"what", "value"}}, {"rows", rows}, {"notes", ""}}}}};
    report::write_html(page, options.report);
}

void run_speed(const SpeedOptions &options, Outcome &outcome) {
    const bool wav = std::filesystem::path(options.log).extension() == ".wav" || std::filesystem::path(options.log).extension() == ".WAV";
    const log::Log log = wav ? log::Log{} : log::read_csv(options.log, options.map);
    const log::Log *from = wav ? nullptr : &log;
    speed::Settings settings;
    try {
        settings = speed::settings_of(choice_of(options), from);
    } catch (const std::invalid_argument &error) {
        throw log::LogError(options.log, 0, 0, error.what(), "mend the header, or describe the radar with --rover or --carrier-GHz");
    }
    settings.paper = options.paper;
    settings.agility_m_s2 = options.agility_m_s2;
    const speed::Recording recording =
        wav ? speed::from_wav(options.log, options.channel, options.rate_Hz) : speed::from_log(log, options.column, options.rate_Hz);
    const double need_Hz = 2 * settings.radar.carrier_Hz / 299792458.0 * settings.radar.speed_high_m_s;
    const speed::Counts counts = speed::to_counts(recording, need_Hz, settings.offset_count, settings.max_count);
    const speed::Helpers helpers =
        wav ? speed::Helpers{} : speed::helpers_of(log, options.accel, !options.no_wheels, settings.wheel_radius_m);
    const speed::Result result = speed::measure(counts, helpers, settings, options.log);
    const std::string samples = counts_words(recording, counts);
    say(result, settings, samples);
    const log::Signal reference = reference_of(options, from);
    nlohmann::json judged;
    if (!reference.t_s.empty() && !std::isnan(result.first_s)) {
        const speed::Judgement j = speed::judge(result, reference, options.log);
        judged = judgement_json(j);
        std::printf(
            "against %s at %zu ticks: RMSE %.4f m/s, mean error %+.4f, worst %.3f; NEES %.2f, %.0f %% within one and %.0f %% within "
            "two standard deviations\n",
            j.reference.c_str(), j.ticks, j.rmse_m_s, j.bias_m_s, j.worst_m_s, j.nees, 100 * j.within_1, 100 * j.within_2);
    }
    const std::string svg = options.plot.empty() && options.report.empty() ? "" : report::to_svg(figure_of(result, reference));
    if (!options.out.empty()) log::write_csv(speed::to_log(result, settings, options.log), options.out);
    if (!options.plot.empty() && std::filesystem::path(options.plot).extension() == ".png")
        report::write_png(svg, options.plot);
    else if (!options.plot.empty())
        report::write_text(svg, options.plot);
    if (!options.report.empty()) write_report(options, result, svg, samples, judged);
    for (const std::string &file : {options.out, options.plot, options.report})
        if (!file.empty()) std::printf("wrote %s\n", file.c_str());
    outcome.json = {{"schema", "traction.speed/1"},
                    {"samples", recording.value.size()},
                    {"rate_Hz", recording.rate_Hz},
                    {"thinned", counts.thinned},
                    {"lost", counts.lost},
                    {"values", result.values},
                    {"quiet", result.quiet},
                    {"spoilt", result.spoilt},
                    {"beyond", result.beyond},
                    {"first_s", std::isnan(result.first_s) ? nlohmann::json() : nlohmann::json(result.first_s)},
                    {"mean_m_s", result.mean_m_s},
                    {"mean_std_m_s", result.mean_std_m_s},
                    {"against", judged}};
    if (std::isnan(result.first_s)) outcome.exit_code = exit_negative;
}

std::string check_figure(const std::string &path) {
    const std::string ending = std::filesystem::path(path).extension().string();
    return path == "-" || ending == ".svg" || ending == ".png" ? "" : "must end in .svg or .png, or be - for SVG on standard output";
}

std::vector<Option> radar_rows(SpeedOptions &o) {
    return {
        {.name = "--rover",
         .into = &o.radar.rover,
         .help = "take the radar from this description (rovers/*.toml)",
         .value = "FILE",
         .kind = Kind::rover},
        {.name = "--radar",
         .into = &o.radar.model,
         .help = "a radar of table II",
         .value = "NAME",
         .one_of = {"MDU1130", "DJ Radar II", "DJ Radar III", "DRS1000"},
         .excludes = {"--rover"}},
        {.name = "--carrier-GHz",
         .into = &o.carrier_GHz,
         .help = "carrier of a radar of your own; its filters are taken as open unless --band-low, --band-high say otherwise",
         .value = "GHZ",
         .range = Range{1, 200},
         .given = &o.carrier},
        {.name = "--vertical-deg",
         .into = &o.vertical_deg,
         .help = "one-way 3 dB width of its beam, up and down",
         .value = "DEG",
         .range = Range{1, 120},
         .given = &o.vertical},
        {.name = "--horizontal-deg",
         .into = &o.horizontal_deg,
         .help = "and left and right",
         .value = "DEG",
         .range = Range{1, 120},
         .given = &o.horizontal},
        {.name = "--depression-deg",
         .into = &o.depression_deg,
         .help = "angle of its axis below horizontal; of a point target: between its path and the line of sight",
         .value = "DEG",
         .range = Range{0, 70},
         .given = &o.depression},
        {.name = "--band-low", .into = &o.band_low_Hz, .help = "its high-pass", .value = "HZ", .range = Range{0, 1e5}, .given = &o.low},
        {.name = "--band-high", .into = &o.band_high_Hz, .help = "its low-pass", .value = "HZ", .range = Range{1, 1e9}, .given = &o.high},
        {.name = "--speed-high",
         .into = &o.speed_high_m_s,
         .help = "highest speed to look for; 1.35 of ground, 15 of a point target when left out",
         .value = "M_S",
         .range = Range{0.05, 100},
         .given = &o.highest},
        {.name = "--scale",
         .into = &o.scale,
         .help = "true over geometric speed, as `traction calibrate` finds it",
         .value = "X",
         .range = Range{0.5, 2},
         .given = &o.scaled},
        {.name = "--target",
         .into = &o.target,
         .help = "what moves: the ground under a rover, or a point (a car past a roadside module)",
         .shows_default = true,
         .one_of = {"ground", "point"}}};
}

} // namespace

Verb verb_speed() {
    const auto options = std::make_shared<SpeedOptions>();
    SpeedOptions &o = *options;
    return {
        .name = "speed",
        .summary = "ground speed with its uncertainty from a recorded radar (CSV or WAV), by the rover's firmware",
        .options = rows(
            {log_row(o.log, "log (CSV) with the converter's samples, or a .wav file"),
             map_row(o.map),
             {.name = "--column", .into = &o.column, .help = "the converter's samples in the log", .value = "NAME", .shows_default = true},
             {.name = "--channel", .into = &o.channel, .help = "of a WAV file", .value = "N", .shows_default = true, .range = Range{0, 63}},
             {.name = "--rate",
              .into = &o.rate_Hz,
              .help = "rate of the samples, where neither header nor time stamps tell it",
              .value = "HZ",
              .range = Range{202, 1e6}}},
            rows(radar_rows(o),
                 {{.name = "--accel",
                   .into = &o.accel,
                   .help = "column of the forward acceleration, or none; imu.accel_x_m_s2 when left out",
                   .value = "NAME"},
                  {.name = "--no-wheels", .into = &o.no_wheels, .help = "do not take the sign from wheel speeds in the log"},
                  {.name = "--paper", .into = &o.paper, .help = "the paper's estimator instead"},
                  {.name = "--reference",
                   .into = &o.reference,
                   .help = "column of a true speed to be judged against; truth.speed_m_s when left out",
                   .value = "NAME"},
                  {.name = "--reference-log",
                   .into = &o.reference_log,
                   .help = "the log that has it, on the same clock",
                   .value = "FILE",
                   .kind = Kind::log},
                  {.name = "--out", .into = &o.out, .help = "write speed and uncertainty (CSV)", .value = "FILE", .kind = Kind::output},
                  {.name = "--plot",
                   .into = &o.plot,
                   .help = "write a figure",
                   .value = "FILE.svg|png",
                   .kind = Kind::output,
                   .check = check_figure},
                  report_row(o.report)})),
        .run = [options](Outcome &outcome) { run_speed(*options, outcome); },
        .details = "The radar's spectra are computed from its numbers at the start (a second or so). Faster recordings are filtered and "
                   "thinned; whole numbers of 0 to 1023 pass as they are, anything else is scaled. Without wheels the sign cannot be "
                   "known: the recording is taken to begin forward. Exit code 1: no speed was heard."};
}

} // namespace traction::cli

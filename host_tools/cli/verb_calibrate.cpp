// verb_calibrate.cpp - traction calibrate LOG: the radar's scale and mounting angle, into the rover's parameter file.
#include "rows.h"
#include "verbs.h"

#include "host_tools/calibrate/calibrate.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct CalibrateOptions {
    std::string log, map, parameters, truth = "auto";
    double radius_m = 0.057; // [m] table I, Lhomme-Desages
};

void run_calibrate(const CalibrateOptions &options, Outcome &outcome) {
    const CalibrationTruth truth = options.truth == "camera"   ? CalibrationTruth::camera
                                   : options.truth == "wheels" ? CalibrationTruth::wheels
                                                               : CalibrationTruth::automatic;
    const Calibration c = calibrate(log::read_csv(options.log, options.map), truth, options.radius_m);
    std::printf("truth: %s, %d steady windows\nscale %.4f +- %.4f (one sigma)\nmounting angle %.1f +- %.1f deg, if nothing else causes "
                "the scale;\n"
                "  one scale cannot tell the angle from the ground: %.1f, %.1f or %.1f deg where the echo goes with sin^0, sin^1 or "
                "sin^2 of the depression, each +- %.1f\n",
                c.truth.c_str(), c.windows, c.scale, c.scale_std, c.angle_deg, c.angle_std_deg, c.angle_by_exponent_deg[0],
                c.angle_by_exponent_deg[1], c.angle_by_exponent_deg[2], c.angle_known_ground_std_deg);
    if (!options.parameters.empty()) {
        char comment[120];
        std::snprintf(comment, sizeof comment, "+- %.4f, %d windows against %s, traction calibrate", c.scale_std, c.windows,
                      c.truth.c_str());
        put_parameter(options.parameters, "doppler_scale", c.scale, comment);
        std::printf("wrote %s\n", options.parameters.c_str());
    }
    outcome.json = {{"schema", "traction.calibrate/1"},
                    {"truth", c.truth},
                    {"windows", c.windows},
                    {"scale", c.scale},
                    {"scale_std", c.scale_std},
                    {"angle_deg", c.angle_deg},
                    {"angle_std_deg", c.angle_std_deg},
                    {"angle_known_ground_std_deg", c.angle_known_ground_std_deg},
                    {"angle_by_exponent_deg", c.angle_by_exponent_deg}};
}

} // namespace

Verb verb_calibrate() {
    const auto options = std::make_shared<CalibrateOptions>();
    return {.name = "calibrate",
            .summary = "the radar's scale and mounting angle from a drive on firm ground",
            .options = {log_row(options->log, "log (CSV) with radar.adc_count and a camera, or wheel speeds on firm ground"),
                        map_row(options->map),
                        {.name = "--truth",
                         .into = &options->truth,
                         .help = "what tells the true speed",
                         .shows_default = true,
                         .one_of = {"auto", "camera", "wheels"}},
                        {.name = "--wheel-radius-m",
                         .into = &options->radius_m,
                         .help = "under load, for --truth wheels",
                         .value = "M",
                         .shows_default = true,
                         .range = Range{0.01, 0.5}},
                        {.name = "--parameters",
                         .into = &options->parameters,
                         .help = "set doppler_scale in this parameter file of the firmware",
                         .value = "FILE",
                         .kind = Kind::output}},
            .run = [options](Outcome &outcome) { run_calibrate(*options, outcome); }};
}

} // namespace traction::cli

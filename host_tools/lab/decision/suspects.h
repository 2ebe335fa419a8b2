// suspects.h - data of a model that a log may find grossly wrong, and by what a suspicion is believed.
#pragma once

#include "doubt.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traction::lab {

inline constexpr double notable = 0.95; // of the error as stated: a mass that a log hardly tells wanders for less

// What a data sheet, a ruler or a scale says, and how a mistake in it is looked for.
struct Datum {
    const char *table, *key, *name;
    double gross = 1.4; // times, or one over: a data sheet, a scale is not wrong by that much, and no effect of the catalogue is as large
    bool more_is_an_effect = false; // of the catalogue: whether it is the cause has been decided there, only less is a matter of the model
    double little = 0;              // a difference, in its unit, that is none, whatever its ratio: where the fit has moved it by itself
};
std::vector<const Datum *> all_data(); // but for the track, which is asked by itself

std::vector<Parameter *> values_of(Model &model, const Datum &datum);

// The datum times `start`, free from a hundredth to six times that. Whether the model has it.
bool set_free(Model &model, const Datum &datum, double start);

// A search that began at `start` times what is stated and ended at `ratio` times its own begin stands at the edge of what it may be: where
// it goes on; nothing: it ended within.
std::optional<double> from_the_edge(double start, double ratio);

bool is_gross(const Suspect &suspect);

// May some datum be at fault? `worst`, (1) of doubt.h before any effect, or two effects and more that take a quarter off the error: before
// and after them, in noises. How much is left where no effect and no shape was found says it by itself (is_no_ground): uneven ground leaves
// 3 to 6 times the noise. So does a balance that is left as a whole, whatever was named.
bool is_suspicious(double worst, std::size_t accepted, double before, double after);
bool is_no_ground(double error);
bool describes_nothing(double worst);

// The part of the log where the model leaves the most, balance by balance; a row counts as four times its balance's mean at most.
Dataset worst_stretch(const Problem &first);

// Of a fitted model on the rows of a part of its log, in units of noise, as overall_error() has it.
double error_within(const Problem &fitted, const Dataset &part);

// What no model goes below: the scatter of the residuals from row to row, which a prediction has no part in, for it follows the wheels.
double fit_scatter(const Problem &fitted);

// The error as overall_error() has it, with `squares` of each row taken off.
double error_less(const Problem &fitted, const Eigen::VectorXd &squares);

// Data of the sheet at their bounds.
bool strained(const Problem &problem);

// The datum that an effect of the catalogue changes; nullptr: of none.
const Datum *number_of(std::string_view effect);

// What was named and a datum: an effect of the catalogue that changes the datum itself, within what the catalogue gives it, or one that
// acts as the datum does. Of such two the effect is told.
enum class Kin { none, acts_alike, its_number };
Kin kin_of(const Problem &last, const Datum &datum);

// Whether what was named has two of these witnesses of a speed read falsely: camera, radar, gyro, all wheels. That they agree with one
// another is likelier than that all are wrong, and what is wrong is then how the machine turns by its wheels: the track.
bool names_several_scales(const Problem &last);
const Datum &track();
// The track alone explains nine tenths of what those names do (assumed): one mistake is simpler than several.
bool does_as_much(const Suspect &suspect, double before, double left);

// Of the error as stated, `before`, the largest share that is_suspect() lets a datum leave; `left`: what is left with all that was
// accepted.
double largest_share(std::size_t accepted, double before, double left);

// Is a datum, set free, to be told instead of the `accepted` effects? relieves: what was named leaves the sheet contradicted, and the datum
// does not; lead: by how many standard errors the datum predicts blocks left out better. Asked only where it matters.
bool is_suspect(const Suspect &suspect, std::size_t accepted, double before, double left, const std::function<bool()> &relieves,
                const std::function<double()> &lead, const std::function<Kin()> &kin);

// Least error first, each quantity once.
std::vector<Suspect> told_once(std::vector<Suspect> suspects);

// The first three, in words; where there is none, how much of a signal is left: `worst`, (1) of doubt.h.
std::string what_to_look_at(const std::vector<Suspect> &suspects, double worst);

} // namespace traction::lab

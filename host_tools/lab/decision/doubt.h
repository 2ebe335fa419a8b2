// doubt.h - does the model describe the log at all? Where it does not, no effect of a catalogue is to be named.
//
//   m_b^2 = max(0, mean(e_b^2 - n_b^2)) / mean(y_b^2)      share of a balance's signal that the fitted model leaves, noise n taken out (1)
//
// A missing effect leaves part of a balance; a machine that is another one leaves as much as the signal itself, or is described far better
// by one of its data being grossly different: then that datum is what to look at.
#pragma once

#include "host_tools/lab/fit/problem.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traction::lab {

// One datum of the model, moved as far as the log asks for.
struct Suspect {
    std::string quantity; // "rover.mass_kg"
    double stated = 0, fitted = 0;
    std::string unit;
    double error = 0;               // of the model so changed, with no effect, in units of noise
    double gross = 0;               // ratio from which it is no tolerance
    bool more_is_an_effect = false; // of the catalogue: judged there
};

struct Doubt {
    std::vector<Suspect> suspects; // one of these grossly different would describe the log; least error first; may be empty
    std::string text;              // what to look at
    double error = 0; // of the model in units of noise, with the numbers that its fit alone moved grossly held at what is stated
};

// (1) of every balance of a fitted problem.
std::vector<double> misfits(const Problem &problem);

// The largest (1) of currents by either balance, radar and camera, forces and torques. Acceleration and yaw rate are near zero in a drive
// straight on at one speed, and what is left of them is ground: not asked.
double worst_misfit(const Problem &problem);

// Share by which the fit within the priors has itself taken grossly away, beyond three stated deviations, the number that this effect of
// the catalogue changes; nothing where it has not.
std::optional<double> taken_by_the_fit(const Model &stated, const Problem &fitted, std::string_view effect);

// Every datum of the model that a log can tell, each grossly free by itself; least error first.
std::vector<Suspect> gross_errors(const Model &stated, const Dataset &data);

// `first`: the model's problem, fitted within its priors. `last`: the same with all that was accepted, `accepted` effects; `shape_gain`:
// share of the error that a structure-free shape takes off beside them, 0 for none. Nothing where the model describes the log.
std::optional<Doubt> doubt(const Model &stated, const Dataset &data, Problem &first, const Problem &last, std::size_t accepted,
                           double shape_gain);

} // namespace traction::lab

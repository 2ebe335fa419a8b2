// Scenarios (file, text or dict, with keys changed), rovers, and the drive of a scenario.
#include "scenario.h"

#include "host_tools/lab/model/model.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/fault_names.h"
#include "host_tools/simulate/simulate.h"
#include "sim/scenario/scenario_table.h"

#include <cstdio>
#include <memory>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <tuple>

namespace traction::python {

namespace {

[[noreturn]] void refuse(const std::string &file, const std::string &key, const std::string &value, const std::string &wrong,
                         const std::string &mend) {
    throw sim::ScenarioError(file, 0, key, value, wrong, mend);
}

template <typename Into> void put(const nb::handle &value, const std::string &file, const std::string &key, const Into &into);

toml::array array_of(const nb::handle &list, const std::string &file, const std::string &key) {
    toml::array out;
    std::size_t i = 0;
    for (const nb::handle item : nb::borrow<nb::sequence>(list))
        put(item, file, key + '[' + std::to_string(i++) + ']', [&](auto &&node) { out.push_back(std::forward<decltype(node)>(node)); });
    return out;
}

toml::table table_of(const nb::handle &dict, const std::string &file, const std::string &key) {
    toml::table out;
    for (const auto [name, value] : nb::borrow<nb::dict>(dict)) {
        const std::string word = nb::cast<std::string>(nb::str(name));
        put(value, file, key.empty() ? word : key + '.' + word,
            [&](auto &&node) { out.insert_or_assign(word, std::forward<decltype(node)>(node)); });
    }
    return out;
}

// A Python value as a TOML node, handed to `into`.
template <typename Into> void put(const nb::handle &value, const std::string &file, const std::string &key, const Into &into) {
    if (nb::isinstance<nb::bool_>(value)) return into(nb::cast<bool>(value));
    if (nb::isinstance<nb::int_>(value)) return into(nb::cast<std::int64_t>(value));
    if (nb::isinstance<nb::float_>(value)) return into(nb::cast<double>(value));
    if (nb::isinstance<nb::str>(value)) return into(nb::cast<std::string>(value));
    if (nb::isinstance<nb::dict>(value)) return into(table_of(value, file, key));
    if (nb::isinstance<nb::list>(value) || nb::isinstance<nb::tuple>(value)) return into(array_of(value, file, key));
    refuse(file, key, nb::cast<std::string>(nb::str(value)), "no value that TOML knows",
           "give a number, a text, True or False, a list or a dict");
}

// "drive[2].slip", "drive.2.slip": its words.
std::vector<std::string> words_of(const std::string &key) {
    std::vector<std::string> words(1);
    for (const char c : key) {
        if (c == '.' || c == '[')
            words.emplace_back();
        else if (c != ']')
            words.back() += c;
    }
    return words;
}

toml::node *item_of(toml::array &list, const std::string &word, const std::string &file, const std::string &key) {
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), i);
    if (error != std::errc() || end != word.data() + word.size() || i >= list.size())
        refuse(file, key, "", "there is no [" + word + "] in a list of " + std::to_string(list.size()),
               list.empty() ? "the list is empty" : "give 0 to " + std::to_string(list.size() - 1));
    return list.get(i);
}

// Puts one changed key where its words say; tables that are not there are made.
void change(toml::table &root, const std::string &key, const nb::handle &value, const std::string &file) {
    const std::vector<std::string> words = words_of(key);
    toml::node *at = &root;
    for (std::size_t i = 0; i + 1 < words.size(); i++) {
        if (toml::table *table = at->as_table()) {
            if (table->get(words[i]) == nullptr) table->insert(words[i], toml::table());
            at = table->get(words[i]);
        } else if (toml::array *list = at->as_array()) {
            at = item_of(*list, words[i], file, key);
        } else {
            refuse(file, key, "", words[i] + " stands in no table",
                   "give the key as docs/scenario_format.md writes it, such as ground.soil");
        }
    }
    if (toml::table *table = at->as_table()) {
        put(value, file, key, [&](auto &&node) { table->insert_or_assign(words.back(), std::forward<decltype(node)>(node)); });
    } else if (toml::array *list = at->as_array()) {
        const auto place = list->begin() + (item_of(*list, words.back(), file, key), std::stol(words.back()));
        put(value, file, key, [&](auto &&node) { list->replace(place, std::forward<decltype(node)>(node)); });
    } else {
        refuse(file, key, "", "stands in no table", "give the key as docs/scenario_format.md writes it, such as ground.soil");
    }
}

ScenarioData with_changes(toml::table table, const nb::dict &changes, const std::string &file) {
    for (const auto [key, value] : changes) change(table, nb::cast<std::string>(key), value, file);
    std::ostringstream text;
    text << table << '\n';
    return {sim::scenario_of_table(table, text.str(), file)};
}

ScenarioData of_text(const std::string &text, const std::string &file, const nb::dict &changes) {
    if (changes.size() == 0) return {sim::parse_scenario(text, file)};
    return with_changes(sim::scenario_table(text, file), changes, file);
}

ScenarioData of_dict(const nb::dict &dict, const std::string &file, const nb::dict &changes) {
    return with_changes(table_of(dict, file, ""), changes, file);
}

struct Drive {
    std::shared_ptr<LogData> log, truth; // truth: null unless asked for
    std::uint64_t seed = 0, ticks = 0;
    std::uint32_t faults = 0;
    std::string fault_words, trace_hash, seal;
};

struct DriveOptions {
    std::optional<std::uint64_t> seed, hide;
    int hide_count = 1;
    std::vector<std::string> effects;
    std::string firmware;
    bool truth = false, record = true;
};

Drive drive(const ScenarioData &given, const DriveOptions &how) {
    const nb::gil_scoped_release free;
    Signals signals;
    SimulateOptions options;
    options.seed = how.seed;
    for (const std::string &text : how.effects) options.effects.push_back(sim::parse_effect(text));
    if (how.hide) options.hide = sim::HiddenDraw{.seed = *how.hide, .count = how.hide_count, .among = {}};
    if (!how.firmware.empty()) options.firmware = how.firmware;
    options.truth = how.truth;
    options.record = how.record;
    options.after_second = [&signals] { signals.poll(); };
    SimulationResult result = simulate(given.scenario, options);
    Drive out{.log = std::make_shared<LogData>(),
              .truth = nullptr,
              .seed = how.seed.value_or(given.scenario.seed),
              .ticks = result.ticks,
              .faults = result.faults,
              .fault_words = fault_names(result.faults),
              .trace_hash = {},
              .seal = {}};
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(result.trace_hash));
    out.trace_hash = hash;
    if (!result.hidden.empty()) out.seal = sim::seal_text(result.hidden, given.scenario.name, result.hide_seed);
    out.log->log = std::move(result.log);
    out.log->log.source = given.scenario.name;
    if (how.truth) {
        out.truth = std::make_shared<LogData>();
        out.truth->log = std::move(result.truth);
        out.truth->log.source = given.scenario.name;
    }
    return out;
}

using RoverRow = std::tuple<std::string, double, std::string, bool, std::string>; // section.name, value, unit, given, source

std::vector<RoverRow> rows_of(const RoverData &self) {
    std::vector<RoverRow> rows;
    for (std::size_t i = 0; i < self.rover.values.size(); i++) {
        const sim::RoverKey &key = sim::rover_keys()[i];
        const sim::RoverValue &value = self.rover.values[i];
        rows.emplace_back(std::string(key.section) + '.' + std::string(key.name), value.value, std::string(key.unit), value.given,
                          value.source);
    }
    return rows;
}

} // namespace

void bind_scenario(nb::module_ &m) {
    nb::class_<ScenarioData>(m, "ScenarioData")
        .def_static("of_text", &of_text, nb::arg("text"), nb::arg("file"), nb::arg("changes"))
        .def_static("of_dict", &of_dict, nb::arg("table"), nb::arg("file"), nb::arg("changes"))
        .def("set_rover", [](ScenarioData &self, const RoverData &rover) { sim::set_rover(self.scenario, rover.rover); })
        .def("set_believes", [](ScenarioData &self, const RoverData &rover) { self.scenario.firmware.believes = rover.rover; })
        .def_prop_ro("name", [](const ScenarioData &self) { return self.scenario.name; })
        .def_prop_ro("title", [](const ScenarioData &self) { return self.scenario.title; })
        .def_prop_ro("text", [](const ScenarioData &self) { return self.scenario.text; })
        .def_prop_ro("seed", [](const ScenarioData &self) { return self.scenario.seed; })
        .def_prop_ro("duration_s", [](const ScenarioData &self) { return self.scenario.duration_s; });
    nb::class_<Drive>(m, "Drive")
        .def_ro("log", &Drive::log)
        .def_ro("truth", &Drive::truth)
        .def_ro("seed", &Drive::seed)
        .def_ro("ticks", &Drive::ticks)
        .def_ro("faults", &Drive::faults)
        .def_ro("fault_words", &Drive::fault_words)
        .def_ro("trace_hash", &Drive::trace_hash)
        .def_ro("seal", &Drive::seal);
    m.def(
        "drive",
        [](const ScenarioData &scenario, std::optional<std::uint64_t> seed, const std::vector<std::string> &effects,
           std::optional<std::uint64_t> hide, int hide_count, const std::string &firmware, bool truth, bool record) {
            return drive(scenario, {.seed = seed,
                                    .hide = hide,
                                    .hide_count = hide_count,
                                    .effects = effects,
                                    .firmware = firmware,
                                    .truth = truth,
                                    .record = record});
        },
        nb::arg("scenario"), nb::arg("seed").none(), nb::arg("effects"), nb::arg("hide").none(), nb::arg("hide_count"), nb::arg("firmware"),
        nb::arg("truth"), nb::arg("record"));
    nb::class_<RoverData>(m, "RoverData")
        .def(nb::init<>())
        .def_static("read", [](const std::string &path) { return RoverData{sim::read_rover_file(path)}; })
        .def_static("parse", [](const std::string &text, const std::string &file) { return RoverData{sim::parse_rover(text, file)}; })
        .def_prop_ro("name", [](const RoverData &self) { return self.rover.name; })
        .def_prop_ro("radar", [](const RoverData &self) { return self.rover.radar; })
        .def_prop_ro("rows", &rows_of)
        .def("firmware_text", [](const RoverData &self) { return firmware_text(self.rover); })
        .def("model_text", [](const RoverData &self, const std::string &soil) { return model_text(self.rover, soil); });
}

} // namespace traction::python

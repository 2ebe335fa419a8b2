// The lab's verbs on logs in memory; results as JSON text, which the Python half makes objects of.
#include "bind.h"

#include "host_tools/cli/drive_view.h"
#include "host_tools/lab/answer.h"
#include "host_tools/lab/fit/checkpoint.h"
#include "host_tools/lab/result/effects_json.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/report/report.h"
#include "host_tools/report/svg.h"
#include "host_tools/simulate/trial.h"
#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <memory>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <functional>
#include <map>
#include <optional>
#include <utility>

namespace traction::python {

namespace {

// What a verb is asked about: logs of one machine, and how they are to be read.
struct Inputs {
    std::vector<std::shared_ptr<LogData>> logs, validate;
    std::shared_ptr<LogData> repeat;
    double from_s = 0, to_s = 0;
    std::vector<std::string> despite;
};

// The logs under their own names; two of one name get a number.
lab::Request request_of(const Inputs &inputs) {
    auto held = std::make_shared<std::map<std::string, std::shared_ptr<LogData>>>();
    const auto hold = [&](const std::shared_ptr<LogData> &data) {
        std::string name = data->log.source.empty() ? "log" : data->log.source;
        for (int i = 2; held->count(name) != 0; i++) name = data->log.source + " (" + std::to_string(i) + ")";
        (*held)[name] = data;
        return name;
    };
    lab::Request request;
    request.from_s = inputs.from_s, request.to_s = inputs.to_s, request.despite = inputs.despite;
    for (const auto &log : inputs.logs) request.logs.push_back(hold(log));
    for (const auto &log : inputs.validate) request.validate.push_back(hold(log));
    if (inputs.repeat) request.repeat = hold(inputs.repeat);
    request.read = [held](const std::string &name, const std::string &, std::vector<log::Repair> &repairs) {
        const LogData &data = *held->at(name);
        repairs = data.repairs;
        return data.log;
    };
    return request;
}

struct Result {
    std::string json, text, kind;
    std::optional<lab::Model> model;
    bool negative = false;
    std::string scenario = {};
    std::string replay = {}; // the drive for the page, JSON; empty: the log says nowhere where the rover was
};

Result result_of(lab::Answer &&answer) {
    return {answer.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), answer.text, answer.kind, std::move(answer.model),
            answer.negative};
}

// With the drive that the command line's page has, too.
Result drawn(Result &&result, const lab::Session &session) {
    const nlohmann::json page = cli::with_replay(nlohmann::json::object(), session);
    if (page.contains("replay")) result.replay = page.at("replay").dump();
    return std::move(result);
}

void write_report(const std::string &json, const std::string &path, const std::string &replay) {
    nlohmann::json page = nlohmann::json::parse(json);
    if (!replay.empty()) page["replay"] = nlohmann::json::parse(replay);
    report::write_html(page, path);
}

// Runs without the GIL; Ctrl-C is heard before every fit.
template <typename Work> Result computed(const Work &work) {
    const nb::gil_scoped_release free;
    Signals signals;
    const lab::CheckpointScope scope([&signals] { signals.poll(); });
    return work();
}

lab::AnswerOptions options_of(const std::optional<std::function<void(int, int)>> &progress) {
    lab::AnswerOptions options;
    options.drive = simulated_rover();
    if (progress)
        options.progress = [&progress](int done, int of) {
            const nb::gil_scoped_acquire gil;
            (*progress)(done, of);
        };
    return options;
}

Result compare(const lab::Model &model, const Inputs &inputs, bool fitted) {
    return computed([&] {
        const lab::Session session = lab::open_session(request_of(inputs), model);
        return drawn(result_of(lab::compare_answer(session, fitted)), session);
    });
}

Result diagnose(const lab::Model &model, const Inputs &inputs, const std::optional<std::function<void(int, int)>> &progress) {
    return computed([&] {
        const lab::Request request = request_of(inputs);
        const lab::Session session = lab::open_session(request, model);
        return drawn(result_of(lab::diagnose_answer(session, request, options_of(progress), true)), session);
    });
}

Result add(const lab::Model &model, const Inputs &inputs, const std::string &effect, int wheel, const std::string &effect_file) {
    return computed([&] {
        const lab::Request request = request_of(inputs);
        const lab::Session session = lab::open_session(request, model);
        return drawn(result_of(lab::add_answer(session, request, effect, wheel, effect_file)), session);
    });
}

Result fit(const lab::Model &model, const Inputs &inputs, const std::optional<std::vector<std::string>> &profile) {
    return computed([&] {
        const lab::Request request = request_of(inputs);
        const lab::Session session = lab::open_session(request, model);
        return drawn(result_of(lab::fit_answer(session, request, true, profile)), session);
    });
}

Result next(const lab::Model &model, const Inputs &inputs, const std::vector<std::string> &effects, bool all) {
    return computed([&] {
        std::optional<lab::Session> session;
        if (!inputs.logs.empty()) session = lab::open_session(request_of(inputs), model);
        lab::NextAnswer answer = lab::next_answer(session ? &*session : nullptr, model, effects, all, options_of(std::nullopt));
        const std::string scenario = answer.scenario;
        Result result = result_of(std::move(answer));
        result.scenario = scenario;
        return result;
    });
}

std::vector<double> numbers(const nlohmann::json &list) {
    std::vector<double> out;
    for (const auto &item : list) out.push_back(item.is_number() ? item.get<double>() : std::nan(""));
    return out;
}

// Measured and model of the balances that are worst, over time.
std::string residual_svg(const std::string &result_json, std::size_t most) {
    const nlohmann::json result = nlohmann::json::parse(result_json);
    std::vector<const nlohmann::json *> balances;
    for (const auto &b : result.at("balances")) balances.push_back(&b);
    std::stable_sort(balances.begin(), balances.end(),
                     [](const auto *a, const auto *b) { return a->value("nrmse", 0.0) > b->value("nrmse", 0.0); });
    report::Figure figure{.title = "measured and model, worst balances", .x_label = "time [s]"};
    for (std::size_t i = 0; i < std::min(most, balances.size()); i++) {
        const nlohmann::json &b = *balances[i];
        const std::vector<double> t_s = numbers(b.at("t_s"));
        figure.panels.push_back({.title = b.at("name"),
                                 .y_label = "[" + b.at("unit").get<std::string>() + "]",
                                 .series = {{.name = "measured", .x = t_s, .y = numbers(b.at("measured"))},
                                            {.name = "model", .x = t_s, .y = numbers(b.at("model"))}}});
    }
    return report::to_svg(figure);
}

void bind_model(nb::module_ &m) {
    nb::class_<lab::Model>(m, "ModelData")
        .def_static("read", [](const std::string &path) { return lab::read_model(path); })
        .def_static("parse", [](const std::string &text, const std::string &file) { return lab::parse_model(text, file); })
        .def_prop_ro("name", [](const lab::Model &self) { return self.name; })
        .def_prop_ro("file", [](const lab::Model &self) { return self.file; })
        .def_prop_ro("text", [](const lab::Model &self) { return lab::model_text(self); })
        .def_prop_ro("head", [](const lab::Model &self) { return lab::head_json("history", self, lab::Dataset{}).dump(); })
        .def_prop_ro("ladder",
                     [](const lab::Model &self) {
                         std::vector<lab::LadderStep> ladder;
                         for (const lab::LineageEntry &e : self.lineage) ladder.push_back({e.label, e.train, e.heldout, e.floor});
                         return lab::ladder_json(ladder).dump();
                     })
        .def("write", [](const lab::Model &self, const std::string &path) { lab::write_model(self, path); })
        .def("without", [](const lab::Model &self, const std::string &effect, int wheel) {
            std::size_t dropped = 0;
            return lab::without_effect(self, effect, wheel, dropped);
        });
}

} // namespace

void bind_lab(nb::module_ &m) {
    bind_model(m);
    nb::class_<Inputs>(m, "Inputs")
        .def(nb::init<>())
        .def_rw("logs", &Inputs::logs)
        .def_rw("validate", &Inputs::validate)
        .def_prop_rw(
            "repeat", [](const Inputs &self) { return self.repeat; },
            [](Inputs &self, std::shared_ptr<LogData> log) { self.repeat = std::move(log); }, nb::for_setter(nb::arg("log").none()))
        .def_rw("from_s", &Inputs::from_s)
        .def_rw("to_s", &Inputs::to_s)
        .def_rw("despite", &Inputs::despite);
    nb::class_<Result>(m, "LabResult")
        .def_ro("json", &Result::json)
        .def_ro("text", &Result::text)
        .def_ro("kind", &Result::kind)
        .def_ro("model", &Result::model)
        .def_ro("negative", &Result::negative)
        .def_ro("scenario", &Result::scenario)
        .def_ro("replay", &Result::replay);
    m.def("compare", &compare, nb::arg("model"), nb::arg("inputs"), nb::arg("fitted"));
    m.def("diagnose", &diagnose, nb::arg("model"), nb::arg("inputs"), nb::arg("progress").none());
    m.def("add", &add, nb::arg("model"), nb::arg("inputs"), nb::arg("effect"), nb::arg("wheel"), nb::arg("effect_file"));
    m.def("fit", &fit, nb::arg("model"), nb::arg("inputs"), nb::arg("profile").none());
    m.def("next", &next, nb::arg("model"), nb::arg("inputs"), nb::arg("effects"), nb::arg("all"));
    m.def("effects", [] {
        nlohmann::json list = nlohmann::json::array();
        for (const sim::Effect &effect : sim::catalogue()) list.push_back(lab::effect_json(effect));
        return list.dump();
    });
    m.def("report_html", [](const std::string &json) { return report::to_html(nlohmann::json::parse(json)); });
    m.def("write_report", &write_report, nb::arg("json"), nb::arg("path"), nb::arg("replay") = "");
    m.def("residual_svg", &residual_svg, nb::arg("json"), nb::arg("most"));
}

} // namespace traction::python
